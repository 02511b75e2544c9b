"""A group of commands whose modules are imported only when one of them runs."""

from __future__ import annotations

from importlib import import_module

import click

__all__ = ["COMMANDS", "LazyGroup"]

#: The commands in the order of the help, with the line that the help shows for them. Each is the
#: object `command` of the module colladaphy.cli.<name>, or of the module named below.
COMMANDS = {
    "validate": "Check documents and report everything that is wrong with them.",
    "info": "Show what a document holds.",
    "convert": "Read any version, mend it, and write valid COLLADA.",
    "repair": "Mend a document, and say what was changed.",
    "diff": "Compare the Worlds of two documents, body by body.",
    "simulate": "Run a document's World, and write the result.",
    "demo": "Store and load the six test cases of the thesis, and compare bit by bit.",
    "rules": "List the codes of all findings.",
    "explain": "Explain the code of a finding.",
}
_MODULES = {"rules": "catalogue"}


class LazyGroup(click.Group):
    """Knows its commands by name; the help of the group needs none of their modules."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import the module of one command."""
        if cmd_name not in COMMANDS:
            return None
        module = import_module(f"colladaphy.cli.{_MODULES.get(cmd_name, cmd_name)}")
        command = module.command
        assert isinstance(command, click.Command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The list of commands in the help, from the table above."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """As click does, but a misspelt command is answered with the likely one."""
        name = args[0] if args else ""
        if name and name not in COMMANDS and not name.startswith("-"):
            from difflib import get_close_matches

            close = get_close_matches(name, COMMANDS, 1)
            hint = f" Did you mean {close[0]!r}?" if close else ""
            ctx.fail(f"There is no command {name!r}.{hint}")
        return super().resolve_command(ctx, args)

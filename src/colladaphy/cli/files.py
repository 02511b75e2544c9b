"""File arguments: a path, or - for a standard stream."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

import click

from colladaphy.errors import InputError, OutputError

if TYPE_CHECKING:
    from colladaphy.source.limits import Limits

__all__ = [
    "convention_option",
    "format_option",
    "limits_option",
    "refuse_same",
    "source_of",
    "target_of",
    "units_options",
]

_Function = TypeVar("_Function", bound=Callable[..., Any])


def source_of(name: str) -> str | BinaryIO:
    """What a file argument reads from; InputError where that is a closed standard input."""
    if name != "-":
        return name
    if sys.stdin is None:
        from colladaphy.source import rules

        raise InputError(rules.UNREADABLE.at(message="Standard input is closed."))
    return sys.stdin.buffer


def target_of(name: str) -> str | BinaryIO:
    """What a file argument writes to; OutputError where that is a closed standard output."""
    if name != "-":
        return name
    if sys.stdout is None:
        from colladaphy.source import rules

        raise OutputError(rules.OUTPUT_FAILED.at(message="Standard output is closed."))
    return sys.stdout.buffer


def refuse_same(option: str, name: str, others: Iterable[str]) -> None:
    """Refuse an output that would replace another file of the same command."""
    if any(name == other or Path(name).resolve() == Path(other).resolve() for other in others):
        raise click.BadParameter(f"{name!r} is another file of this command.", param_hint=option)


def format_option(function: _Function) -> _Function:
    """The option ``--format text|json``."""
    option = click.option(
        "--format",
        "form",
        type=click.Choice(["text", "json"]),
        default="text",
        show_default=True,
        help="For people, or for programs.",
    )
    return option(function)


def convention_option(function: _Function) -> _Function:
    """The option ``--convention``."""
    option = click.option(
        "--convention",
        default="auto",
        show_default=True,
        metavar="NAME",
        callback=_convention,
        help="Whose reading of the standard the document follows; 'none' takes the standard's.",
    )
    return option(function)


def _convention(_: click.Context, __: click.Parameter, value: str) -> str:
    if value in ("auto", "none"):
        return value
    from colladaphy.conform.conventions import conventions

    names = [known.name for known in conventions()]
    if value not in names:
        raise click.BadParameter(f"{value!r} is not one of {', '.join(['auto', 'none', *names])}.")
    return value


def units_options(function: _Function) -> _Function:
    """The options ``--si`` and ``--up-axis``: in which unit and axes a World is wanted."""
    function = click.option(
        "--up-axis",
        type=click.Choice(["X_UP", "Y_UP", "Z_UP"]),
        help="Turn the World so that this axis is up.",
    )(function)
    return click.option("--si", is_flag=True, help="Lengths in metres, whatever the unit is.")(
        function
    )


def limits_option(function: _Function) -> _Function:
    """The option ``--limit NAME=NUMBER``, which becomes a `Limits` or None."""
    option = click.option(
        "--limit",
        "limits",
        multiple=True,
        metavar="NAME=NUMBER",
        callback=_limits,
        help="For trusted files: bytes, depth, text, elements, archive_entries, archive_ratio "
        "or total may be larger (or smaller) than usual.",
    )
    return option(function)


def _limits(_: click.Context, __: click.Parameter, values: tuple[str, ...]) -> Limits | None:
    if not values:
        return None
    from colladaphy.source.limits import Limits

    chosen: dict[str, int] = {}
    for value in values:
        name, _sign, number = value.partition("=")
        if not number.isdecimal():
            raise click.BadParameter(f"{value!r} is not of the form NAME=NUMBER.")
        chosen[name] = int(number)
    try:
        return Limits(**chosen)
    except TypeError:
        names = ", ".join(Limits.__slots__)
        raise click.BadParameter(f"The limits are {names}.") from None
    except ValueError as error:
        raise click.BadParameter(f"{error}.") from None

"""``colladaphy explain``."""

from __future__ import annotations

import click

from colladaphy.cli.console import say

__all__ = ["command"]


@click.command("explain")
@click.argument("code")
def command(code: str) -> None:
    """Explain what the CODE of a finding means, and what to do about it."""
    from colladaphy.validation.catalogue import find_rule, similar_codes
    from colladaphy.validation.tellers import tellers

    rule = find_rule(code)
    if rule is None:
        close = similar_codes(code)
        hint = f" Did you mean {' or '.join(close)}?" if close else " See 'colladaphy rules'."
        raise click.BadParameter(f"There is no code {code!r}.{hint}", param_hint="CODE")
    say(f"{rule.code} ({rule.severity}, stage {rule.stage}; by {', '.join(tellers(rule.code))})")
    say(f"  {rule.summary}")
    if rule.why:
        say(f"  Why it matters: {rule.why}")
    if rule.hint:
        say(f"  What to do: {rule.hint}")
    if rule.section:
        say(f"  Stands on: {rule.section}")

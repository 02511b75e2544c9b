"""``colladaphy rules``."""

from __future__ import annotations

import json
from dataclasses import asdict

import click

from colladaphy.cli.console import say
from colladaphy.cli.files import format_option

__all__ = ["command"]


@click.command("rules")
@click.option("--stage", help="Only the rules of this stage, such as xml or repair.")
@click.option("--by", "use", help="Only what this can report, such as validate or simulate.")
@format_option
def command(stage: str | None, use: str | None, form: str) -> None:
    """List the codes of all findings: their stage, their severity, and who can report them."""
    from colladaphy.validation import all_rules
    from colladaphy.validation.tellers import TELLERS, tellers

    rules = all_rules()
    if stage is not None:
        stages = list(dict.fromkeys(rule.stage for rule in rules))
        if stage not in stages:
            raise click.BadParameter(f"{stage!r} is not one of {', '.join(stages)}.")
        rules = tuple(rule for rule in rules if rule.stage == stage)
    if use is not None:
        if use not in TELLERS:
            raise click.BadParameter(f"{use!r} is not one of {', '.join(TELLERS)}.")
        rules = tuple(rule for rule in rules if use in tellers(rule.code))
    if form == "json":
        told = [asdict(rule) | {"stage": rule.stage, "by": tellers(rule.code)} for rule in rules]
        say(json.dumps(told, indent=2))
        return
    width = max((len(rule.code) for rule in rules), default=0)
    last = None
    for rule in rules:
        if rule.stage != last:
            say(f"{rule.stage}:")
            last = rule.stage
        say(f"  {rule.code:{width}}  {rule.severity:7}  {rule.summary} "
            f"({', '.join(tellers(rule.code))})")  # fmt: skip

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
@format_option
def command(stage: str | None, form: str) -> None:
    """List the codes of all findings, by the stage that reports them."""
    from colladaphy.validation import all_rules

    rules = all_rules()
    if stage is not None:
        stages = list(dict.fromkeys(rule.stage for rule in rules))
        if stage not in stages:
            raise click.BadParameter(f"{stage!r} is not one of {', '.join(stages)}.")
        rules = tuple(rule for rule in rules if rule.stage == stage)
    if form == "json":
        say(json.dumps([asdict(rule) | {"stage": rule.stage} for rule in rules], indent=2))
        return
    width = max(len(rule.code) for rule in rules)
    for rule in rules:
        say(f"{rule.code:{width}}  {rule.severity:7}  {rule.summary}")

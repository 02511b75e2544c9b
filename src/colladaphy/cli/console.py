"""What commands say, and to whom: results to standard output, all else to standard error."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, TypeVar

import click

from colladaphy.cli.progress import Bar, aside

if TYPE_CHECKING:
    from colladaphy.findings import Finding, Report

__all__ = [
    "EXIT_FINDINGS",
    "EXIT_INTERNAL",
    "EXIT_IO",
    "note",
    "note_changes",
    "paint",
    "say",
    "say_findings",
    "steps",
]

EXIT_FINDINGS = 1
EXIT_IO = 2
EXIT_INTERNAL = 3

_COLOURS = {"error": "red", "warning": "yellow", "info": "blue", "hint": "cyan", "valid": "green"}
_Item = TypeVar("_Item")


def paint(text: str, severity: str) -> str:
    """A text in the colour of a severity."""
    return click.style(text, fg=_COLOURS.get(severity), bold=severity == "error")


def _colour() -> bool | None:
    """None lets click decide: colours on a terminal, none in a file.

    NO_COLOR (https://no-color.org) wins over FORCE_COLOR (https://force-color.org).
    """
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return False if os.environ.get("TERM") == "dumb" else None


def say(text: str) -> None:
    """A line of the result."""
    with aside():
        click.echo(text, color=_colour())


def note(text: str) -> None:
    """A line that is not part of the result."""
    with aside():
        click.echo(text, err=True, color=_colour())


def note_changes(report: Report, most: int | None = 3) -> None:
    """What was changed, to standard error."""
    from colladaphy.validation.reporters.text import changes

    for line in changes(report, paint=paint, most=most):
        note(line)


def say_findings(findings: Iterable[Finding]) -> None:
    """What went wrong, to standard error; what was merely noticed before it is left out."""
    from colladaphy.findings import Severity
    from colladaphy.validation.reporters.text import finding_lines

    known = list(findings)
    faults = [finding for finding in known if finding.severity is Severity.ERROR]
    for finding in faults or known:
        for line in finding_lines(finding, paint):
            note(line)


def steps(items: Iterable[_Item], label: str) -> Iterator[_Item]:
    """The items, counted on standard error while a person looks on."""
    known = list(items)
    bar = Bar(label, len(known))
    try:
        for number, item in enumerate(known):
            bar(number)
            yield item
    finally:
        bar.clear()

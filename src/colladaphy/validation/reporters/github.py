"""Annotations of GitHub's workflows: commands in the log, which its pages show at the lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from colladaphy.findings import Severity
from colladaphy.validation.checking import Checked
from colladaphy.validation.reporters.places import labelled, place_of
from colladaphy.validation.reporters.presentation import Presentation, printable
from colladaphy.validation.reporters.totals import Totals

__all__ = ["render"]

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning"}


def render(results: Iterable[Checked], _: Presentation) -> Iterator[str]:
    """A command a finding, the gravest first, as GitHub shows ten of a kind; then the sums."""
    known = list(results)
    found = [(finding, result.report) for result in known for finding in result.report]
    levels = list(Severity)
    for finding, report in sorted(found, key=lambda pair: levels.index(pair[0].severity)):
        place = place_of(finding, report)
        values = {
            "title": finding.code,
            "file": place.file,
            "line": place.line,
            "col": place.column,
        }
        properties = ",".join(
            f"{name}={_property(printable(str(value)))}"
            for name, value in values.items()
            if value is not None
        )
        command = _COMMANDS.get(finding.severity, "notice")
        message = labelled(finding, place)
        if finding.hint:
            message += f"\n{finding.hint}"
        message = "\n".join(printable(line) for line in message.splitlines())
        yield f"::{command} {properties}::{_data(message)}"
    yield Totals(known).line()


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")

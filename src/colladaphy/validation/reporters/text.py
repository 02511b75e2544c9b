"""The report that people read."""

from __future__ import annotations

from collections.abc import Iterator

from colladaphy.findings import Finding, Report
from colladaphy.validation.reporters.presentation import Paint, plain, printable
from colladaphy.validation.reporters.totals import counted

__all__ = ["as_text", "changes", "finding_lines", "summary"]


def as_text(report: Report, *, paint: Paint = plain) -> Iterator[str]:
    """The report's lines: each finding with its place and its hint, then the summary.

    `paint` colours a text by a severity's name.
    """
    for finding in report.findings:
        yield from finding_lines(finding, paint)
    yield summary(report, paint=paint)


def changes(report: Report, *, paint: Paint = plain, most: int | None = 3) -> Iterator[str]:
    """What was changed, a line a finding, and at most `most` lines a code; then how many."""
    shown: dict[str, int] = {}
    for finding in report.findings:
        shown[finding.code] = shown.get(finding.code, 0) + 1
        if most is None or shown[finding.code] <= most:
            yield next(finding_lines(finding, paint))
    for code, count in shown.items():
        if most is not None and count > most:
            yield f"... and {count - most} more of {code}"
    yield f"{report.file or 'document'}: {counted(report.counts) or 'nothing to change'}"


def summary(report: Report, *, paint: Paint = plain) -> str:
    """One line: is it valid, and how many findings of which severity are there?"""
    counts = counted(report.counts)
    name = report.file or "document"
    if report.valid:
        return f"{name}: {paint('valid', 'valid')}" + (f" ({counts})" if counts else "")
    return f"{name}: {paint('not valid', 'error')} ({counts})"


def finding_lines(finding: Finding, paint: Paint) -> Iterator[str]:
    """A finding with its place, its path and its hint."""
    place = ":".join(str(part) for part in (finding.file, finding.line, finding.column) if part)
    severity = paint(str(finding.severity), str(finding.severity))
    head = f"{place}: " if place else ""
    yield f"{printable(head)}{severity}: {_line(finding.message)} [{finding.code}]"
    if finding.path:
        yield f"    at {printable(finding.path)}"
    if finding.hint:
        yield f"    {_line(finding.hint)}"


def _line(text: str) -> str:
    return printable(" ".join(text.split()))

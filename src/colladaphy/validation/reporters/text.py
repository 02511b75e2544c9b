"""The report that people read."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from colladaphy.findings import Finding, Report

__all__ = ["as_text", "changes", "finding_lines", "summary"]

_PLURALS = {"error": "errors", "warning": "warnings", "info": "infos", "hint": "hints"}

Paint = Callable[[str, str], str]


def _plain(text: str, _: str) -> str:
    return text


def as_text(report: Report, *, paint: Paint = _plain) -> Iterator[str]:
    """The report's lines: each finding with its place and its hint, then the summary.

    `paint` colours a text by a severity's name.
    """
    for finding in report.findings:
        yield from finding_lines(finding, paint)
    yield summary(report, paint=paint)


def changes(report: Report, *, paint: Paint = _plain, most: int | None = 3) -> Iterator[str]:
    """What was changed, a line a finding, and at most `most` lines a code; then how many."""
    shown: dict[str, int] = {}
    for finding in report.findings:
        shown[finding.code] = shown.get(finding.code, 0) + 1
        if most is None or shown[finding.code] <= most:
            yield next(finding_lines(finding, paint))
    for code, count in shown.items():
        if most is not None and count > most:
            yield f"... and {count - most} more of {code}"
    yield f"{report.file or 'document'}: {_counted(report) or 'nothing to change'}"


def summary(report: Report, *, paint: Paint = _plain) -> str:
    """One line: is it valid, and how many findings of which severity are there?"""
    counts = _counted(report)
    name = report.file or "document"
    if report.valid:
        return f"{name}: {paint('valid', 'valid')}" + (f" ({counts})" if counts else "")
    return f"{name}: {paint('not valid', 'error')} ({counts})"


def finding_lines(finding: Finding, paint: Paint) -> Iterator[str]:
    """A finding with its place, its path and its hint."""
    place = ":".join(str(part) for part in (finding.file, finding.line, finding.column) if part)
    severity = paint(str(finding.severity), str(finding.severity))
    head = f"{place}: " if place else ""
    yield f"{head}{severity}: {finding.message} [{finding.code}]"
    if finding.path:
        yield f"    at {finding.path}"
    if finding.hint:
        yield f"    {finding.hint}"


def _counted(report: Report) -> str:
    return ", ".join(
        f"{count} {severity if count == 1 else _PLURALS[severity]}"
        for severity, count in report.counts.items()
        if count
    )

"""The report that people read."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from colladaphy.findings import Finding, Report

__all__ = ["as_text", "summary"]

_PLURALS = {"error": "errors", "warning": "warnings", "info": "infos", "hint": "hints"}

Paint = Callable[[str, str], str]


def _plain(text: str, _: str) -> str:
    return text


def as_text(report: Report, *, paint: Paint = _plain, most: int | None = None) -> Iterator[str]:
    """The report's lines: each finding with its place and its hint, then the summary.

    `paint` colours a text by a severity's name. At most `most` findings of one code are shown in
    full, and how many more there are is said.
    """
    shown: dict[str, int] = {}
    for finding in report.findings:
        shown[finding.code] = shown.get(finding.code, 0) + 1
        if most is None or shown[finding.code] <= most:
            yield from _lines(finding, paint)
    for code, count in shown.items():
        if most is not None and count > most:
            yield f"... and {count - most} more of {code}"
    yield summary(report, paint=paint)


def summary(report: Report, *, paint: Paint = _plain) -> str:
    """One line: is it valid, and how many findings of which severity are there?"""
    counts = ", ".join(
        f"{count} {severity if count == 1 else _PLURALS[severity]}"
        for severity, count in report.counts.items()
        if count
    )
    name = report.file or "document"
    if report.valid:
        return f"{name}: {paint('valid', 'valid')}" + (f" ({counts})" if counts else "")
    return f"{name}: {paint('not valid', 'error')} ({counts})"


def _lines(finding: Finding, paint: Paint) -> Iterator[str]:
    place = ":".join(str(part) for part in (finding.file, finding.line, finding.column) if part)
    severity = paint(str(finding.severity), str(finding.severity))
    head = f"{place}: " if place else ""
    yield f"{head}{severity}: {finding.message} [{finding.code}]"
    if finding.path:
        yield f"    at {finding.path}"
    if finding.hint:
        yield f"    {finding.hint}"

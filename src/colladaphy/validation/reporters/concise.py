"""A line a finding: ``file:line:column: severity: message [code]``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from colladaphy.findings import Finding
from colladaphy.validation.checking import Checked
from colladaphy.validation.reporters.grouping import grouped
from colladaphy.validation.reporters.presentation import Paint, Presentation, printable
from colladaphy.validation.reporters.totals import Totals, counted, hidden

__all__ = ["closing", "head", "render", "verdict"]


def render(results: Iterable[Checked], presentation: Presentation) -> Iterator[str]:
    """The lines of the report; each file's come as soon as it is checked."""
    totals = Totals()
    for result in results:
        totals.add(result)
        if presentation.statistics:
            continue
        for group in grouped(result.report, presentation.most):
            for finding in group.shown:
                yield head(finding, result, presentation.paint)
            if group.rest:
                code = group.rest[0].code
                yield f"{printable(result.report.file or '-')}: {group.more()} [{code}]"
        if not presentation.quiet:
            yield verdict(result, presentation.paint)
    yield from closing(totals, presentation)


def head(finding: Finding, result: Checked, paint: Paint) -> str:
    """The line of a finding."""
    file = finding.file or result.report.file
    place = ":".join(str(part) for part in (file, finding.line, finding.column) if part)
    severity = paint(str(finding.severity), str(finding.severity))
    mark = ", mendable" if finding.repair is not None else ""
    message = printable(" ".join(finding.message.split()))
    return f"{printable(place)}: {severity}: {message} [{finding.code}{mark}]"


def verdict(result: Checked, paint: Paint) -> str:
    """The line of a file: is it valid, and how many findings of which severity are there?"""
    words = [counted(result.report.counts), *hidden(result.ignored, result.known)]
    said = ", ".join(word for word in words if word)
    if not result.readable:
        state = paint("cannot be read", "error")
    elif result.report.valid:
        state = paint("valid", "valid")
    else:
        state = paint("not valid", "error")
    return f"{printable(result.report.file or '-')}: {state}" + (f" ({said})" if said else "")


def closing(totals: Totals, presentation: Presentation) -> Iterator[str]:
    """What is said of all files together."""
    if presentation.statistics:
        yield from totals.statistics()
    if presentation.quiet:
        return
    if totals.files != 1 or presentation.statistics:
        yield totals.line()

"""The report that people read: the source, why it matters, and what to do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from colladaphy.findings import Finding
from colladaphy.validation.checking import Checked
from colladaphy.validation.reporters.concise import closing, head, verdict
from colladaphy.validation.reporters.grouping import Group, grouped
from colladaphy.validation.reporters.presentation import Presentation, printable
from colladaphy.validation.reporters.totals import Totals

__all__ = ["render"]

_Lines = dict[str, dict[int, str]]
_RELATED = 3


def render(results: Iterable[Checked], presentation: Presentation) -> Iterator[str]:
    """The lines of the report; each file's come as soon as it is checked."""
    totals = Totals()
    for result in results:
        totals.add(result)
        if presentation.statistics:
            continue
        groups = grouped(result.report, presentation.most)
        lines = _lines(result, groups, presentation)
        for group in groups:
            yield from _group(group, result, lines, presentation)
        if not presentation.quiet:
            yield verdict(result, presentation.paint)
    yield from closing(totals, presentation)


def _lines(result: Checked, groups: list[Group], presentation: Presentation) -> _Lines:
    """The lines of the sources that are shown, by file; each file is read once."""
    if not groups:
        return {}
    from colladaphy.validation.reporters.excerpts import wanted_lines

    wanted: dict[str, set[int]] = {}
    for group in groups if result.readable else ():
        for finding in group.shown:
            file = finding.file or result.report.file
            if file is not None:
                wanted.setdefault(file, set()).update(wanted_lines(finding))
    return {file: presentation.sources.lines(file, numbers) for file, numbers in wanted.items()}


def _group(
    group: Group, result: Checked, lines: _Lines, presentation: Presentation
) -> Iterator[str]:
    from colladaphy.validation.reporters.excerpts import excerpt

    first = group.shown[0] if group.shown else None
    for finding in group.shown:
        yield head(finding, result, presentation.paint)
        rows = excerpt(finding, lines.get(finding.file or result.report.file or "", {}))
        numbers = [number for number, _ in rows if number is not None]
        width = len(str(numbers[-1])) if numbers else 1
        if rows:
            yield f"{'':{width}} |"
            for number, text in rows:
                shown = str(number) if number is not None else ""
                marks = number is None
                text = presentation.paint(text, str(finding.severity)) if marks else text
                yield f"{shown:>{width}} | {text}".rstrip()
        for note in _notes(finding, first):
            yield f"{'':{width}} = {printable(' '.join(note.split()))}"
        yield ""
    if group.rest:
        yield f"{group.more()} [{group.rest[0].code}]"
        yield ""


def _notes(finding: Finding, first: Finding | None) -> Iterator[str]:
    """What is said below the excerpt; what the first of a kind said is not said again."""
    first = None if finding is first else first
    if finding.path:
        yield f"at: {finding.path}" + (f" (sid {finding.sid})" if finding.sid else "")
    for path, line in finding.related[:_RELATED]:
        yield f"see: {path}" + (f" (line {line})" if line else "")
    if len(finding.related) > _RELATED:
        yield f"see: … and {len(finding.related) - _RELATED} more"
    if finding.why and (first is None or finding.why != first.why):
        yield f"why: {finding.why}"
    if finding.hint and (first is None or finding.hint != first.hint):
        yield f"help: {finding.hint}"
    if finding.repair and (first is None or finding.repair != first.repair):
        yield f"repair: 'colladaphy repair' mends this ({finding.repair})"

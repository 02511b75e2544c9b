"""An excerpt of the source with a mark under what a finding is about."""

from __future__ import annotations

import re
from collections.abc import Mapping

from rich.cells import cell_len

from colladaphy.findings import Finding
from colladaphy.validation.reporters.presentation import printable

__all__ = ["Excerpt", "excerpt", "wanted_lines"]

_WIDTH = 96
_LEAD = 24
_TAG = re.compile(r"<[^\s<>/]+")
# One after the other, so that what stands in a value is no attribute and no end.
_IN_TAG = re.compile(
    r"""(?:[\w.-]+:)?(?P<name>[\w.-]+)\s*=\s*(?:"[^"]*(?:"|$)|'[^']*(?:'|$))|"[^"]*(?:"|$)|>"""
)
_MOST = 6
"""Lines of a start tag that are looked at for its attribute."""

Excerpt = list[tuple[int | None, str]]
"""Lines with their numbers; the line of the mark has none."""


def wanted_lines(finding: Finding) -> range:
    """The lines that an excerpt may need."""
    if finding.line is None:
        return range(0)
    return range(finding.line, finding.line + (_MOST if finding.attribute else 1))


def excerpt(finding: Finding, lines: Mapping[int, str]) -> Excerpt:
    """The line that a finding stands at and the mark below; empty where the line is not known.

    The mark is under the attribute that it is about, or under the name of the element, or, where
    markup itself is wrong, under one character. Long lines are cut around it.
    """
    if finding.line is None or finding.line not in lines:
        return []
    line, begin, end = _span(finding, lines)
    rows: Excerpt = []
    for number in range(finding.line, line):
        text = printable(lines[number])
        rows.append((number, text[:_WIDTH] + "…" * (len(text) > _WIDTH)))
    text = lines[line]
    begin = min(begin, len(text))
    end = max(min(end, len(text)), begin + 1)
    first = 0 if end <= _WIDTH else max(0, begin - _LEAD)
    last = min(len(text), max(first + _WIDTH, min(end, begin + _WIDTH)))
    before = "…" * (first > 0) + printable(text[first:begin])
    marked = printable(text[begin : min(end, last)])
    after = printable(text[end:last]) + "…" * (last < len(text))
    rows.append((line, (before + marked + after).rstrip()))
    rows.append((None, " " * cell_len(before) + "^" * max(cell_len(marked), 1)))
    return rows


def _span(finding: Finding, lines: Mapping[int, str]) -> tuple[int, int, int]:
    """The line of the mark, and where it begins and ends, counted from 0."""
    assert finding.line is not None
    text = lines[finding.line]
    if finding.column is None:
        begin = len(text) - len(text.lstrip())
        return finding.line, begin, len(text.rstrip())
    begin = finding.column - 1
    if finding.attribute is not None and text[begin : begin + 1] == "<":
        name = finding.attribute.rpartition("}")[2]
        number, start = finding.line, begin
        while number in lines:
            line = lines[number]
            for found in _IN_TAG.finditer(line, start):
                if found[0] == ">":
                    break
                if found["name"] == name:
                    return number, found.start(), found.end()
            else:
                number, start = number + 1, 0
                continue
            break
    tag = _TAG.match(text, begin)
    return finding.line, begin, tag.end() if tag else begin + 1

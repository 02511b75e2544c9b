"""Telling from the bytes alone that a document holds the limits, so that no tree is needed.

The answers are one-sided: no is no fault, it only means that a tree has to tell.
"""

from __future__ import annotations

import re

from colladaphy.source.limits import LIBXML2_DEPTH, Limits
from colladaphy.source.xml import element_count, root_start

__all__ = ["after_declaration", "in_short_pieces", "is_plain", "next_break"]

_S = rb"[ \t\r\n]"
_START = re.compile(
    rb"(?:\xef\xbb\xbf)?"
    rb"(?:<\?xml" + _S + rb"+version=[\"']1\.0[\"']"
    rb"(?:" + _S + rb"+encoding=[\"'](?i:utf-8)[\"'])?"
    rb"(?:" + _S + rb"+standalone=[\"'](?:yes|no)[\"'])?" + _S + rb"*\?>)?" + _S + rb"*(?=<)"
)
_ROOT = re.compile(rb"<(?:[A-Za-z_][A-Za-z0-9_.-]*:)?COLLADA[ \t\r\n/>]")

_WINDOW = 4096
_SHORTEST_LIMIT = 1000
_MOST_BREAKS = 100


def after_declaration(data: bytes) -> int | None:
    """Where a document begins behind its XML declaration; None if it may not be UTF-8."""
    found = _START.match(data)
    return None if found is None else found.end()


def is_plain(data: bytes, limits: Limits) -> bool:
    """Whether `parse_bytes` is sure to accept the bytes, if they are well-formed.

    They are UTF-8 without a DOCTYPE, their root is called COLLADA, and no limit is passed but,
    perhaps, that of depth: at 256 levels, which every limit above allows, libxml2 stops by itself.
    """
    start = after_declaration(data)
    if start is None:
        return False
    root = root_start(data, start)
    if _ROOT.match(data, root) is None:
        return False
    if limits.depth < LIBXML2_DEPTH or element_count(data, limits) > limits.elements:
        return False
    return root <= limits.text and in_short_pieces(data, limits.text, root)


def in_short_pieces(data: bytes, longest: int, start: int = 0) -> bool:
    """Whether no text, attribute or comment is longer than `longest`, and none comes in many bits.

    Where libxml2 validates while it parses, it appends text bit by bit and measures it anew each
    time: a text with n references, comments or letters beyond ASCII takes n² steps.
    """
    return (
        longest >= _SHORTEST_LIMIT
        and _runs_are_short(data, longest, start)
        and _breaks_are_few(data, longest, start)
    )


def _runs_are_short(data: bytes, longest: int, position: int) -> bool:
    """What is between two ``<``; only runs that fill a window can be long, so few are measured."""
    step = min(_WINDOW, longest // 2)
    size = len(data)
    while position < size:
        if data.find(b"<", position, position + step) >= 0:
            position += step
            continue
        end = data.find(b"<", position + step)
        end = size if end < 0 else end
        run = data[max(data.rfind(b"<", 0, position), 0) : end]
        if len(run) > longest or b"&" in run or not run.isascii():
            return False
        position = end
    return True


def _breaks_are_few(data: bytes, longest: int, position: int) -> bool:
    """Comments and instructions; CDATA is left to trees."""
    comment, instruction = next_break(data, b"!", position), next_break(data, b"?", position)
    beside = 0
    last = -1
    while comment >= 0 or instruction >= 0:
        if instruction < 0 or 0 <= comment < instruction:
            if not data.startswith(b"<!--", comment):
                return False
            begin, position = comment, data.find(b"-->", comment + 4)
        else:
            begin, position = instruction, data.find(b"?>", instruction + 2)
        if position < 0 or position - begin > longest:
            return False
        beside += begin == last
        if beside > _MOST_BREAKS:
            return False
        last = data.find(b"<", position)
        if 0 <= comment < position:
            comment = next_break(data, b"!", position)
        if 0 <= instruction < position:
            instruction = next_break(data, b"?", position)
    return True


def next_break(data: bytes, mark: bytes, start: int) -> int:
    """The next ``<`` that a mark (``!``, ``?``) follows; -1 if there is none.

    To look for the rarer character takes a tenth of the time.
    """
    place = data.find(mark, start + 1)
    while place >= 0 and data[place - 1 : place] != b"<":
        place = data.find(mark, place + 1)
    return max(place - 1, -1)

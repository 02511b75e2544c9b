"""Telling from the bytes alone that a document holds the limits, so that no tree is needed.

The answers are one-sided: no is no fault, it only means that a tree has to tell.
"""

from __future__ import annotations

import re

from colladaphy.source.limits import LIBXML2_DEPTH, Limits
from colladaphy.source.xml import element_count, root_start

__all__ = ["after_declaration", "in_short_pieces", "is_plain"]

_S = rb"[ \t\r\n]"
_START = re.compile(
    rb"(?:\xef\xbb\xbf)?"
    rb"(?:<\?xml" + _S + rb"+version=[\"']1\.0[\"']"
    rb"(?:" + _S + rb"+encoding=[\"'](?i:utf-8)[\"'])?"
    rb"(?:" + _S + rb"+standalone=[\"'](?:yes|no)[\"'])?" + _S + rb"*\?>)?" + _S + rb"*(?=<)"
)
_ROOT = re.compile(rb"<(?:[A-Za-z_][A-Za-z0-9_.-]*:)?COLLADA[ \t\r\n/>]")
_BREAK = re.compile(rb"<[!?]")

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
    if data.find(b"!", position) < 0 and data.find(b"?", position) < 0:
        return True
    beside = 0
    last = -1
    while (found := _BREAK.search(data, position)) is not None:
        begin = found.start()
        if data.startswith(b"<!--", begin):
            position = data.find(b"-->", begin + 4)
        elif data.startswith(b"<?", begin):
            position = data.find(b"?>", begin + 2)
        else:
            return False
        if position < 0 or position - begin > longest:
            return False
        beside += begin == last
        if beside > _MOST_BREAKS:
            return False
        last = data.find(b"<", position)
    return True

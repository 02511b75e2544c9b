"""The bytes of a document in the plain spelling that the index of it needs.

Most documents have it, and are taken as they are. Comments and processing instructions are blanked
out with bytes of zero, which every text drops, so that nothing else moves. Whatever is spelled
otherwise (CDATA sections, single quotes, other encodings) is taken from libxml2's serialisation.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from lxml import etree

from colladaphy.source.plain import next_break

__all__ = ["Tree", "direct", "plain", "serialised"]

Tree = etree._ElementTree | Callable[[], etree._ElementTree] | None
"""A parsed tree, or what makes one if it is needed; None: parse the bytes."""

_DECLARATION: Final = re.compile(
    rb"<\?xml[ \t\r\n][^>]*?(?:encoding[ \t\r\n]*=[ \t\r\n]*[\"']([^\"']*)[\"'][^>]*?)?\?>"
)
_SINGLE: Final = re.compile(rb"=[ \t\r\n]*'")
_PLAIN_ENCODINGS: Final = (b"utf-8", b"utf8", b"us-ascii", b"ascii")
_UTF8_MARK: Final = b"\xef\xbb\xbf"


def plain(data: bytes, tree: Tree = None) -> tuple[bytes | bytearray, int]:
    """The bytes to index, and where the first tag (or blanks before it) is.

    They are `data` itself or a copy of the same length where no more than comments and processing
    instructions had to be blanked out.
    """
    taken = direct(data)
    return taken if taken is not None else serialised(data, tree)


def direct(data: bytes) -> tuple[bytes | bytearray, int] | None:
    """The same without a tree; None where the bytes themselves are not plain."""
    taken = _taken(data)
    if taken is not None and b"'" in taken[0] and _SINGLE.search(taken[0], taken[1]):
        return None
    return taken


def serialised(data: bytes, tree: Tree = None) -> tuple[bytes | bytearray, int]:
    """The plain bytes of the parsed tree, with the same elements in the same order."""
    parsed = tree() if callable(tree) else tree
    if parsed is None:
        parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
        parsed = etree.ElementTree(etree.fromstring(data, parser))
    text = _written(parsed.getroot())
    taken = _taken(text)
    if taken is None:
        # The tree holds CDATA sections as such: parse what was written, which makes them texts.
        taken = _taken(_written(etree.fromstring(text, etree.XMLParser(huge_tree=True))))
    assert taken is not None
    return taken


def _written(root: etree._Element) -> bytes:
    return etree.tostring(root, encoding="UTF-8", xml_declaration=False, with_tail=False)


def _taken(data: bytes) -> tuple[bytes | bytearray, int] | None:
    """The bytes as they are but for comments; None where they are not plain."""
    start = len(_UTF8_MARK) if data.startswith(_UTF8_MARK) else 0
    if data.startswith(b"<?xml", start):
        found = _DECLARATION.match(data, start)
        if found is None or (found[1] or b"utf-8").lower() not in _PLAIN_ENCODINGS:
            return None
        start = found.end()
    elif data[start : start + 1] not in (b"<", b" ", b"\t", b"\r", b"\n"):
        return None  # UTF-16 and the like
    elif b"\0" in data[start : start + 4]:
        return None
    blanked = _blanked(data, start)
    return None if blanked is None else (blanked, start)


def _blanked(data: bytes, start: int) -> bytes | bytearray | None:
    """Without comments and processing instructions; None where there is anything else of `<!`."""
    comment, instruction = next_break(data, b"!", start), next_break(data, b"?", start)
    if comment < 0 and instruction < 0:
        return data
    made = bytearray(data)
    while comment >= 0 or instruction >= 0:
        if instruction < 0 or 0 <= comment < instruction:
            if not data.startswith(b"<!--", comment):
                return None
            begin, end = comment, data.find(b"-->", comment + 4) + 3
        else:
            begin, end = instruction, data.find(b"?>", instruction + 2) + 2
        if end < begin:
            return None
        made[begin:end] = bytes(end - begin)
        if 0 <= comment < end:
            comment = next_break(data, b"!", end)
        if 0 <= instruction < end:
            instruction = next_break(data, b"?", end)
    return made

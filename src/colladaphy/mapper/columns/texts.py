"""Records of one kind as text, and what a pattern finds in them.

libxml2 writes a subtree as text in one way only, and far faster than Python can look at its
elements. A pattern that matches the whole text of a record therefore says of the tree, not of the
file, what stands in it, and that nothing else does.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import COLLADA, PE
from colladaphy.mapper.bulk import numbers_of

__all__ = ["Column", "count_of", "number_rows", "recognised", "whole_text"]

Array = NDArray[Any]
Column = tuple[str, ...]
"""Texts of one field, empty where a record has none."""


def whole_text(parent: etree._Element, name: str) -> str | None:
    """The text of an element behind its start tag, for patterns that look for `name` elements.

    None where tags in it could mean something else than they seem to: where a comment, CDATA, an
    instruction or an attribute could hold a tag (they cannot elsewhere), where the name has a
    prefix, or where a namespace is declared.
    """
    prefixes = parent.nsmap
    if prefixes.get(None) != COLLADA or prefixes.get("pe", PE) != PE:
        return None
    text = etree.tostring(parent, encoding="unicode", with_tail=False)
    start = text.index(">") + 1
    # To look for a rare character first takes a tenth of the time.
    if ("!" in text and "<!" in text) or ("?" in text and "<?" in text):
        return None
    if f":{name}" in text or text.find("xmlns", start) >= 0:
        return None
    return text[start:]


def count_of(parent: etree._Element, name: str) -> int:
    """The number of children of a name in COLLADA's namespace."""
    return int(float(str(_count(name)(parent))))


@cache
def _count(name: str) -> etree.XPath:
    return etree.XPath(f"count(c:{name})", namespaces={"c": COLLADA})


def recognised(
    pattern: re.Pattern[str], parent: etree._Element, name: str, count: int
) -> tuple[Array, dict[str, Column]]:
    """Which of the `count` children of a name a pattern matches, and its named groups in those.

    The pattern matches a whole child, with its end tag and what stands before it; such a child
    must not be empty.
    """
    text = whole_text(parent, name)
    end = f"</{name}>"
    # A child has one such end tag, so if there are as many as children, none is within a child.
    if text is None or not count or text.count(end) != count:
        return np.zeros(0, dtype=np.int64), {}
    groups = pattern.findall(text)
    rows = np.arange(count)
    if len(groups) != count:
        matches = [pattern.fullmatch(part + end) for part in text.split(end)[:-1]]
        groups = [match.groups("") for match in matches if match is not None]
        rows = np.flatnonzero([match is not None for match in matches])
    columns = list(zip(*groups, strict=True)) or [()] * pattern.groups
    return rows, {name: columns[number - 1] for name, number in pattern.groupindex.items()}


def number_rows(texts: Column, width: int) -> tuple[Array, Array]:
    """Rows of numbers (n, width), zeros where there is no text, and where there is one (n,).

    ValueError where the numbers are not so many.
    """
    count = len(texts)
    has = np.ones(count, dtype=np.bool_)
    missing = texts.count("")
    if missing == count:
        return np.zeros((count, width)), ~has
    if not missing:
        if texts[0] == texts[-1] and texts.count(texts[0]) == count:
            return np.repeat(numbers_of(texts[:1], width), count, axis=0), has
        return numbers_of(texts, width), has
    has[:] = list(map(bool, texts))
    numbers = np.zeros((count, width))
    numbers[has] = numbers_of([text for text in texts if text], width)
    return numbers, has

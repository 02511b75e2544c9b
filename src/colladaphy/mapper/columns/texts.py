"""Records of one kind as text, and what a pattern finds in them.

libxml2 writes a subtree as text in one way only, and far faster than Python can look at its
elements. A pattern that matches the whole text of a record therefore says of the tree, not of the
file, what stands in it, and that nothing else does.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import COLLADA, PE
from colladaphy.mapper.bulk import numbers_of

__all__ = ["Column", "number_rows", "recognised", "record_texts", "whole_text"]

Array = NDArray[Any]
Column = tuple[str | None, ...]


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


def record_texts(parent: etree._Element, name: str, count: int) -> list[str] | None:
    """The texts of the `count` children of a name, without their end tags; None if not told apart.

    Such a child must not be empty. What stands before a child counts as its own.
    """
    text = whole_text(parent, name)
    if text is None:
        return None
    parts = text.split(f"</{name}>")
    # A child has one such end tag, so if there are as many as children, none is within a child.
    return parts[:-1] if len(parts) == count + 1 else None


def recognised(pattern: re.Pattern[str], texts: Sequence[str]) -> tuple[Array, dict[str, Column]]:
    """Which of the texts a pattern matches as a whole, and its named groups in those."""
    matches = list(map(pattern.fullmatch, texts))
    groups = [match.groups() for match in matches if match is not None]
    if len(groups) == len(texts):
        rows = np.arange(len(texts))
    else:
        rows = np.array([row for row, match in enumerate(matches) if match is not None], np.int64)
    columns = list(zip(*groups, strict=True)) or [()] * pattern.groups
    return rows, {name: columns[number - 1] for name, number in pattern.groupindex.items()}


def number_rows(texts: Column, width: int) -> tuple[Array, Array]:
    """Rows of numbers (n, width), zeros for None, and where there is a text (n,).

    ValueError where the numbers are not so many.
    """
    count = len(texts)
    given = [text for text in texts if text is not None]
    has = np.ones(count, dtype=np.bool_)
    if not given:
        return np.zeros((count, width)), ~has
    if len(given) == count:
        if given[0] == given[-1] and given.count(given[0]) == count:
            return np.repeat(numbers_of(given[:1], width), count, axis=0), has
        return numbers_of(given, width), has
    has[:] = [text is not None for text in texts]
    numbers = np.zeros((count, width))
    numbers[has] = numbers_of(given, width)
    return numbers, has

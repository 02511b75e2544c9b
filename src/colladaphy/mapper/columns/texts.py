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
    if "<!" in text or "<?" in text or f":{name}" in text or text.find("xmlns", start) >= 0:
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
    missing = texts.count(None)
    if missing == count:
        return np.zeros((count, width)), np.zeros(count, dtype=np.bool_)
    if not missing:
        if texts.count(texts[0]) == count:
            return np.repeat(_parsed(texts[:1], width), count, axis=0), np.ones(count, np.bool_)
        return _parsed(texts, width), np.ones(count, dtype=np.bool_)
    has = np.array([text is not None for text in texts], dtype=np.bool_)
    numbers = np.zeros((count, width))
    numbers[has] = _parsed([text for text in texts if text is not None], width)
    return numbers, has


def _parsed(texts: Sequence[str | None], width: int) -> Array:
    numbers = np.fromstring(" ".join(texts), sep=" ")  # type: ignore[arg-type]
    if len(numbers) != len(texts) * width:
        raise ValueError(f"there are {len(numbers)} numbers in {len(texts)} texts of {width}")
    return numbers.reshape(-1, width)

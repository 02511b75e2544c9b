"""Where elements stand in the source as it came."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.columns.index import Index
from colladaphy.columns.plain import Tree

__all__ = ["Place", "Places"]

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class Place:
    """Line and column of the start tag's `<`, counted from 1; None where that is not known."""

    line: int | None
    column: int | None = None


def _line(element: etree._Element) -> int | None:
    line = element.sourceline
    return line if isinstance(line, int) else None


class Places:
    """Places of elements, by their numbers in the order of the document."""

    def __init__(self, index: Index, source: bytes | bytearray | None, tree: Tree = None) -> None:
        """`source` is what was indexed, as it came; None where that was a serialisation."""
        self._index = index
        self._source = source
        self._tree = tree
        self._lines: Array | None = None
        self._inner = self._begins = np.zeros(0, np.int64)

    def place(self, ordinal: int) -> Place:
        """The place of one element."""
        return self.places((ordinal,))[0]

    def places(self, ordinals: Iterable[int]) -> list[Place]:
        """The places of many."""
        numbers = [int(ordinal) for ordinal in ordinals]
        if self._source is None:
            if self._tree is None:
                return [Place(None)] * len(numbers)
            if len(numbers) < 4:
                elements = [self.element(number) for number in numbers]
            else:
                elements = self.elements(numbers)
            return [Place(_line(element)) for element in elements]
        if self._lines is None:
            # Comments are blanked in what was indexed, but have lines.
            self._lines = np.flatnonzero(np.frombuffer(self._source, np.uint8) == 10)
            begin = 3 if self._source.startswith(b"\xef\xbb\xbf") else 0
            self._begins = np.concatenate([[begin], self._lines + 1])
            if not self._source.isascii():
                # The bytes that begin no character.
                bytes_ = np.frombuffer(self._source, np.uint8)
                self._inner = np.flatnonzero((bytes_ & 0xC0) == 0x80)
        offsets = self._index.start[numbers].astype(np.int64) - 1
        lines = np.searchsorted(self._lines, offsets)
        begins = self._begins[lines]
        inner = np.searchsorted(self._inner, offsets) - np.searchsorted(self._inner, begins)
        columns = offsets - begins - inner + 1
        return [
            Place(line + 1, column)
            for line, column in zip(lines.tolist(), columns.tolist(), strict=True)
        ]

    def _root(self) -> etree._Element:
        if callable(self._tree):
            self._tree = self._tree()
        if self._tree is None:
            raise ValueError("the document was read without a tree: give one to `Document.of`")
        return self._tree.getroot()

    def element(self, ordinal: int) -> etree._Element:
        """The element of the tree."""
        parent = self._index.parent
        path = []
        row = int(ordinal)
        while row > 0:
            above = int(parent[row])
            path.append(int(np.count_nonzero(parent[above + 1 : row] == above)))
            row = above
        element = self._root()
        for number in reversed(path):
            element = next(islice(element.iterchildren("*"), number, None))
        return element

    def elements(self, ordinals: Iterable[int]) -> list[etree._Element]:
        """The elements of the tree of many numbers, in one pass over it."""
        numbers = np.asarray(ordinals, dtype=np.int64)
        wanted = distinct(numbers)
        steps = np.diff(wanted, prepend=-1) - 1
        walk = self._root().iter("*")
        found = [next(islice(walk, step, None)) for step in steps.tolist()]
        return [found[place] for place in np.searchsorted(wanted, numbers).tolist()]

    def texts_within(self, ordinals: Iterable[int]) -> list[bytes]:
        """What was indexed of whole elements, from the start tag to the end tag."""
        index = self._index
        numbers = np.asarray(ordinals, dtype=np.int64)
        lasts = index.last_within(numbers)
        closings = index.level[lasts] - index.level[numbers] + ~index.is_empty(lasts)
        data = index.data
        texts = []
        for number, last, count in zip(
            numbers.tolist(), lasts.tolist(), closings.tolist(), strict=True
        ):
            end = int(index.stop[last])
            for _ in range(count):
                end = data.find(b">", end + 1)
            texts.append(bytes(data[int(index.start[number]) - 1 : end + 1]))
        return texts

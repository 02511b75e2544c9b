"""The structural index of a document: where every element, its text and its attributes stand.

Whole-array operations over the bytes find all tags at once, a block of some hundred kilobytes
after the other, so that what is looked at stays in the processor's cache. One row is one opening
tag, in the order of the document. Nothing is made for an element in Python.

The bytes are those of a well-formed document in UTF-8 that is plain: attributes in double quotes
without blanks around the equals sign, no `>` but those of tags, no CDATA sections. What is not
plain is refused (`NotPlain`); libxml2's serialisation of it is plain. Comments and processing
instructions are blanked first (see `colladaphy.columns.plain`).
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.closings import Closings, Tagged
from colladaphy.columns.growing import Growing
from colladaphy.columns.names import Names, NotPlain
from colladaphy.columns.words import Words

__all__ = ["BLOCK", "Index", "NotPlain"]

Array = NDArray[Any]
U = np.uint64

BLOCK: Final = 1 << 20
_MANY_NAMES = 256
_LT, _GT, _QUOTE, _SLASH, _EQUALS, _BLANK = 60, 62, 34, 47, 61, 32
_BEYOND_BLANK, _TOPS = U(0x2121212121212121), U(0x8080808080808080)
_PLACES: Final = U(0x0001020304050607)


class Index:
    """One row an element; `parent` is -1 for the root."""

    def __init__(
        self,
        data: bytes | bytearray,
        start: int = 0,
        block: int = BLOCK,
        *,
        closings: Closings | None = None,
    ) -> None:
        """Index `data` from `start`, where the first tag or blanks before it are.

        Documents that are not known to be well-formed are checked with `closings`.
        """
        self._closings = closings
        size = len(data)
        self.data = data
        self.bytes: Array = np.frombuffer(data, np.uint8)
        self.words = Words(self.bytes)
        offset = np.int32 if size < 2**31 - 64 else np.int64
        self.names = Names()
        """The names of elements as they are written, by their codes."""
        self._last: list[int] = []  # the last element at each depth, over all blocks
        self._count = 0
        self._depth = 0
        # start, stop, text_end, codes, parent, level; name_end, attributed, quotes, quote_places
        types = [offset, offset, offset, np.int16, np.int32, np.int16,
                 offset, np.int32, np.int32, offset]  # fmt: skip
        columns = [Growing(kind) for kind in types]
        while start < size:
            stop = size if size - start <= 2 * block else data.find(b"<", start + block)
            stop = size if stop < 0 else stop
            for column, part in zip(columns, self._block(start, stop), strict=True):
                column.add(part, stop / size)
            start = stop
        if self._depth != 0 or not self._count:
            raise NotPlain("tags are not balanced")
        arrays = [column.array() for column in columns]
        self.start, self.stop, self.text_end, self.codes, self.parent, self.level = arrays[:6]
        """Where the name starts, where the tag ends (its `>`), where the text behind it ends, the
        code of the name, the parent, the number of elements around it and itself."""
        self.name_end, self.attributed, self.quotes, self.quote_places = arrays[6:]
        """Of the elements with attributes: ends of names, their rows, counts of quotes; the
        places of all quotes."""
        if closings is not None:
            closings.check()
            self._closings = None
        ends = np.cumsum(self.quotes, dtype=np.int64)
        self.first_quote = (ends - self.quotes).astype(offset)
        self._by_code: dict[int, Array] = {}
        self.scratch = np.full(len(self.start), -1, dtype=np.int32)
        """A number for each element, -1 whenever nobody is at work with it."""

    def __len__(self) -> int:
        return len(self.start)

    def rows(self, code: int) -> Array:
        """The elements (n,) of a name, in the order of the document."""
        found = self._by_code.get(code)
        if found is None:
            if len(self.names.texts) > _MANY_NAMES:
                self._sort_by_code()
                return self.rows(code)
            found = self._by_code[code] = np.flatnonzero(self.codes == code).astype(np.int32)
        return found

    def _sort_by_code(self) -> None:
        """Find the elements of all names at once."""
        sorting = np.argsort(self.codes, kind="stable").astype(np.int32)
        codes = np.arange(len(self.names.texts) + 1)
        cuts = np.searchsorted(self.codes[sorting], codes).tolist()
        self._by_code = {code: sorting[cuts[code] : cuts[code + 1]] for code in codes[:-1].tolist()}

    def parted(self, code: int, parts: list[Array]) -> list[int]:
        """Give the elements of a name, in parts, codes of their own; the first part keeps it."""
        codes = [code, *(self.names.add() for _ in parts[1:])]
        if codes[-1] > np.iinfo(self.codes.dtype).max:
            self.codes = self.codes.astype(np.int32)
        for fresh, rows in zip(codes, parts, strict=True):
            self.codes[rows] = fresh
            self._by_code[fresh] = rows
        return codes

    def is_empty(self, rows: Array) -> Array:
        """Whether the tags of elements are closed in themselves."""
        return np.asarray(self.bytes[self.stop[rows] - 1] == _SLASH)

    def last_within(self, rows: Array) -> Array:
        """The last descendant (n,) of elements; an element without any is its own."""
        if len(rows) <= 16:
            return np.array([self._last_of(int(row)) for row in rows.tolist()], np.int64)
        return self.lasts[rows]

    @cached_property
    def lasts(self) -> Array:
        """The last descendant of every element."""
        lasts = np.arange(len(self), dtype=np.int32)
        # Of many children the last one is what stays.
        lasts[self.parent[1:]] = lasts[1:]
        while True:
            further = lasts[lasts]
            if np.array_equal(further, lasts):
                return lasts
            lasts = further

    def _last_of(self, row: int) -> int:
        """The element before the next one that is not deeper."""
        begin, step = row + 1, 64
        while begin < len(self):
            out = np.flatnonzero(self.level[begin : begin + step] <= self.level[row])
            if len(out):
                return begin + int(out[0]) - 1
            begin, step = begin + step, step * 2
        return len(self) - 1

    # --- one block

    def _block(self, begin: int, end: int) -> list[Array]:
        part = self.bytes[begin:end]
        mark = part == _LT
        mark |= part == _GT
        mark |= part == _QUOTE
        # Places stay of the type that numpy indexes with; only what is kept is made smaller.
        places = np.flatnonzero(mark)
        kinds = part[places]
        places += begin
        part = self.bytes
        left = np.flatnonzero(kinds == _LT)
        right = np.flatnonzero(kinds == _GT)
        if len(left) != len(right) or not (np.all(left < right) and np.all(right[:-1] < left[1:])):
            raise NotPlain("brackets that are no tags")
        lt, gt = places[left], places[right]
        closing = part[lt + 1] == _SLASH
        opening = np.flatnonzero(~closing)
        stop = gt[opening]
        empty = part[stop - 1] == _SLASH
        start = lt[opening] + 1
        quotes = (right - left)[opening] - 1
        # Depths, and the parents of elements: the last one before it that is one level up.
        step = np.int8(1) - (closing.view(np.int8) << 1)
        step[opening[empty]] = 0
        running = np.cumsum(step, dtype=np.int32)  # of int16 it takes seven times as long
        level = running[opening].astype(np.int16)
        level += np.int16(self._depth)
        level += empty.view(np.int8)
        parent = self._parents(level)
        # Where texts end: at the next tag, which for the last one is in the next block.
        text_end = np.append(lt[1:], end)[opening]
        np.copyto(text_end, stop + 1, where=empty)
        name_end = stop - empty
        attributed = np.flatnonzero(quotes)
        words = self.words.at(start)
        name_end[attributed] = _name_ends(self.words, start[attributed], words[attributed])
        _trim(part, start, name_end, quotes)
        codes = self.names.codes(self.words, start, name_end - start, words)
        if self._closings is not None:
            lengths = name_end - start
            depths = running + np.int32(self._depth)
            tags = Tagged(lt, gt, closing, depths, opening, words, lengths, codes, end)
            self._closings.add(self.words, self.names, tags)
        self._depth += int(running[-1]) if len(running) else 0
        quote_places = _quotes(part, places, left[opening[attributed]], quotes[attributed])
        rows = attributed + self._count
        self._count += len(opening)
        return [start, stop, text_end, codes, parent, level,
                name_end[attributed], rows, quotes[attributed], quote_places]  # fmt: skip

    def _parents(self, level: Array) -> Array:
        """The parents of a block's elements; `level` is 1 for the root."""
        parent = np.full(len(level), -1, np.int32)
        if not len(level):
            return parent
        base = np.int32(self._count)
        lowest, highest = int(level.min()), int(level.max())
        self._last += [-1] * (highest - len(self._last))
        above = np.zeros(0, np.intp)
        latest = []
        for depth in range(lowest, highest + 1):
            here = np.flatnonzero(level == depth)
            carried = self._last[depth - 2] if depth > 1 else -1
            if not len(above):
                parent[here] = carried
            else:
                place = above.searchsorted(here) - 1
                found = above[place].astype(np.int32) + base
                if len(here) and here[0] < above[0]:
                    found[place < 0] = carried
                parent[here] = found
            above = here
            latest.append(int(here[-1]) + int(base) if len(here) else self._last[depth - 1])
        self._last[lowest - 1 : highest] = latest
        return parent


def _name_ends(words: Words, start: Array, first: Array) -> Array:
    """Where the first blank is behind each start, eight bytes at a time; the `first` are given."""
    ends = np.empty(len(start), np.intp)
    todo = np.arange(len(start))
    shift = 0
    while len(todo):
        at = start[todo] + shift
        word = words.at(at) if shift else first
        # The top bits of bytes that are blanks or below; the lowest one set is exact.
        low = (word - _BEYOND_BLANK) & ~word & _TOPS
        hit = np.flatnonzero(low)
        first = low[hit]
        first &= ~first + U(1)
        # 1 << 8k becomes k: the product moves the byte that is k to the top.
        first >>= U(7)
        first *= _PLACES
        first >>= U(56)
        ends[todo[hit]] = at[hit] + first.view(np.int64)
        if len(hit) == len(todo):
            break
        todo, shift = todo[low == 0], shift + 8
    return ends


def _trim(part: Array, start: Array, name_end: Array, quotes: Array) -> None:
    """Take blanks off names of tags without attributes, as in `<a >`."""
    odd = np.flatnonzero((quotes == 0) & (part[name_end - 1] <= _BLANK))
    for row in odd.tolist():
        text = bytes(part[start[row] : name_end[row]])
        name_end[row] = start[row] + len(text.rstrip(b" \t\r\n"))


def _quotes(part: Array, places: Array, left: Array, quotes: Array) -> Array:
    """The places of all quotes of the elements with attributes, checked."""
    if not len(left):
        return np.zeros(0, np.int32)
    if np.any(quotes & 1):
        raise NotPlain("a quote within quotes")
    total = np.cumsum(quotes)
    step = np.ones(int(total[-1]), np.intp)
    step[0] = left[0] + 1
    step[total[:-1]] = left[1:] + 1 - (left[:-1] + quotes[:-1])
    found = places[np.cumsum(step)]
    opens = found[::2]
    if not np.all(part[opens - 1] == _EQUALS) or np.any(part[opens - 2] <= _BLANK):
        raise NotPlain("blanks around an equals sign")
    return np.asarray(found)

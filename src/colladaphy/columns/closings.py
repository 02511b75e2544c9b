"""Whether tags and the gaps between them are well-formed, as far as the index does not say.

Closing tags have the names of the tags that they close, and nothing but blanks stands where no
text of a simple element is.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.growing import Growing
from colladaphy.columns.names import Names, NotPlain
from colladaphy.columns.words import LOW, Words

__all__ = ["Closings", "Tagged"]

Array = NDArray[Any]
U = np.uint64

_SLASH: Final = 47
_DEEPEST: Final = 1000
"""Levels that libxml2 refuses by far."""
_BYTES: Final = 0x0101010101010101
_LOW_FIVE, _BIT_FIVE, _TOP_TWO = U(0x1F * _BYTES), U(0x20 * _BYTES), U(0xC0 * _BYTES)


class Tagged(NamedTuple):
    """The tags of a block of a document."""

    begins: Array
    """(n,) where each begins."""
    ends: Array
    """(n,) where its `>` is."""
    closing: Array
    """(n,) which ones close an element."""
    depths: Array
    """(n,) how many elements are open behind it."""
    opening: Array
    """(m,) those that open an element."""
    words: Array
    """(m,) the first eight bytes of their names, zeros behind those."""
    lengths: Array
    """(m,) of their names."""
    codes: Array
    """(m,) of their names."""
    stop: int
    """Where the block ends."""


class Closings:
    """The closing tags of a document, added block by block."""

    def __init__(self) -> None:
        self._opened = Growing(np.int16), Growing(np.int16)
        self._closed = Growing(np.int16), Growing(np.int16)

    def add(self, words: Words, names: Names, tags: Tagged) -> None:
        """Take a block of a document."""
        if not len(tags.begins):
            return
        if not 0 <= int(tags.depths.min()) <= int(tags.depths.max()) <= _DEEPEST:
            raise NotPlain("tags are not balanced")
        simple = _simple(words.data, tags)
        begins, after = tags.begins, np.append(tags.begins[1:], tags.stop)
        gaps = np.flatnonzero(~simple & (after - tags.ends > 1))
        _blanks_only(words, tags.ends[gaps] + 1, after[gaps])
        # Elements of text only are closed by the next tag; in one block, that is seen at once.
        simple[-1] = False
        mine = simple[tags.opening]
        mine &= tags.lengths <= 8
        here = np.flatnonzero(mine)
        closing = tags.opening[here] + 1
        names_begin = begins[closing] + 2
        same = tags.ends[closing] - names_begin == tags.lengths[here]
        same &= words.at(names_begin) & LOW.take(tags.lengths[here]) == tags.words[here]
        if not bool(same.all()):
            raise NotPlain("a closing tag of another name")
        left = tags.closing.copy()
        left[closing] = False
        rest = np.flatnonzero(left)
        done = tags.stop / len(words.data)
        names_begin = begins[rest] + 2
        self._closed[0].add(names.codes(words, names_begin, tags.ends[rest] - names_begin), done)
        self._closed[1].add(tags.depths[rest].astype(np.int16), done)
        others = np.flatnonzero(~mine & (words.data[tags.ends[tags.opening] - 1] != _SLASH))
        self._opened[0].add(tags.codes[others], done)
        self._opened[1].add((tags.depths[tags.opening[others]] - 1).astype(np.int16), done)

    def check(self) -> None:
        """Compare the tags that are left, when all blocks were added."""
        codes, levels = (column.array() for column in self._opened)
        closed, depths = (column.array() for column in self._closed)
        # At one level, tags are opened and closed in turn.
        if len(codes) != len(closed) or not np.array_equal(
            codes[np.argsort(levels, kind="stable")], closed[np.argsort(depths, kind="stable")]
        ):
            raise NotPlain("a closing tag of another name")


def _simple(data: Array, tags: Tagged) -> Array:
    """(n,) which tags open an element whose next tag closes it."""
    found = np.empty_like(tags.closing)
    found[:-1] = tags.closing[1:]
    found[-1] = tags.stop + 1 < len(data) and data[tags.stop + 1] == _SLASH
    found &= ~tags.closing
    found &= data[tags.ends - 1] != _SLASH
    return found


def _blanks_only(words: Words, start: Array, end: Array) -> None:
    length = end - start
    while len(start):
        word = words.at(start)
        # What is not of the gap counts as a blank: zeros do.
        word &= LOW.take(np.minimum(length, 8))
        # Blanks are 0x20, or less: control characters are looked for elsewhere.
        beyond = ((word & _LOW_FIVE) + _LOW_FIVE) & word & _BIT_FIVE
        beyond |= word & _TOP_TWO
        if bool(beyond.any()):
            raise NotPlain("text between elements")
        more = np.flatnonzero(length > 8)
        start, length = start[more] + 8, length[more] - 8

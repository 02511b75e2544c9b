"""Ids and scoped ids of a document, matched with references without a string for any of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.factors import hashes_of
from colladaphy.columns.texts import Ranges

__all__ = ["Identifiers"]

Array = NDArray[Any]
U = np.uint64
_BLANK = 32
_SCOPE = U(0xD6E8FEB86659FD93)


class Identifiers:
    """Ids (n,) as they are written, with their elements, in the order of the document.

    Scoped ones have the element that they are in beside them. There are none at all where one may
    be spelled in another way than a reference to it.
    """

    def __init__(self, elements: Array, ranges: Ranges, scopes: Array | None = None) -> None:
        made = ranges.words()
        self._words: Array = np.zeros((0, 1), U)
        self._lengths: Array = np.zeros(0, np.int64)
        if made is not None and not _has_blanks(made[0]):
            self._words, self._lengths = made
        self._elements = elements
        self._scopes = np.zeros(len(elements), np.int64) if scopes is None else scopes
        hashes = hashes_of(self._words, self._lengths)
        hashes ^= _of_scopes(self._scopes[: len(hashes)])
        self._order = np.argsort(hashes, kind="stable")
        self._hashes = hashes[self._order]

    def all_differ(self) -> bool:
        """Whether no two of one scope are the same, as far as is seen at once."""
        whole = len(self._hashes) == len(self._elements)
        return whole and not bool(np.any(self._hashes[1:] == self._hashes[:-1]))

    def matched(self, ranges: Ranges, scopes: Array | None = None) -> Array:
        """The first element (n,) of each id, in the scope that is given for it; -1 for none.

        Of a few it may be -1 all the same.
        """
        found = np.full(len(ranges), -1, np.int64)
        if not len(self._hashes) or not len(ranges):
            return found
        lengths = ranges.stops - ranges.starts
        rows = np.flatnonzero((lengths > 0) & (lengths <= self._lengths.max()))
        made = ranges.take(rows).words()
        if made is None or not len(rows):
            return found
        words, lengths = made
        width = self._words.shape[1]
        if words.shape[1] < width:
            words = np.pad(words, ((0, 0), (0, width - words.shape[1])))
        hashes = hashes_of(words, lengths)
        mine = np.zeros(len(rows), np.int64) if scopes is None else scopes[rows]
        hashes ^= _of_scopes(mine)
        at = np.minimum(np.searchsorted(self._hashes, hashes), len(self._hashes) - 1)
        same = self._hashes[at] == hashes
        at = self._order[at]
        same &= (self._lengths[at] == lengths) & (self._scopes[at] == mine)
        same &= (self._words[at] == words).all(axis=1)
        found[rows[same]] = self._elements[at[same]]
        return found

    def referred(self, ranges: Ranges) -> Array:
        """The same for references that are ``#`` and an id."""
        found = np.full(len(ranges), -1, np.int64)
        filled = np.flatnonzero(ranges.stops > ranges.starts)
        rows = filled[ranges.all_words.data[ranges.starts[filled]] == ord("#")]
        ids = Ranges(ranges.all_words, ranges.starts[rows] + 1, ranges.stops[rows])
        found[rows] = self.matched(ids)
        return found


def _has_blanks(words: Array) -> bool:
    letters = words.view(np.uint8)
    return bool(np.any((letters <= _BLANK) & (letters > 0)))


def _of_scopes(scopes: Array) -> Array:
    return scopes.astype(np.int64).view(U) * _SCOPE

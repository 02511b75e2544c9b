"""The bytes of a document, eight at a time, from any places at once."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["LOW", "Words"]

Array = NDArray[Any]
U = np.uint64

LOW: Final = np.array([(1 << (8 * k)) - 1 for k in range(8)] + [2**64 - 1], dtype=U)
"""Masks of the first k bytes of a little-endian word."""
_FIRST, _BLANK, _BYTE = U(0xFF), U(32), U(8)
_SEVEN, _ONE, _THREE, _TURN = 7, U(1), U(3), U(63)


class Words:
    """Little-endian words of eight bytes, zeros behind the last byte.

    A word is put together from the two aligned ones that it lies in: numpy reads those in a third
    of the time that unaligned ones take.
    """

    def __init__(self, data: Array) -> None:
        self.data = data
        whole = len(data) // 8
        self._aligned = data[: whole * 8].view("<u8")
        self._edge = max(whole * 8 - 8, 0)
        rest = np.zeros(32, np.uint8)
        rest[: len(data) - self._edge] = data[self._edge :]
        self._rest = np.ndarray((25,), "<u8", rest, 0, (1,)).copy()
        self._kept: dict[tuple[int, int, int], tuple[Array, Array, Array | None]] = {}

    def keep(self, starts: Array, values: Array, counts: Array | None) -> None:
        """Remember the numbers in texts for whoever asks first.

        `counts` says how many each has; None where all have the same number.
        """
        self._kept[len(starts), int(starts[0]), int(starts[-1])] = starts, values, counts

    def kept(self, starts: Array) -> tuple[Array, Array | None] | None:
        """What was remembered of texts, forgotten hereby; None if nothing was."""
        found = self._kept.get((len(starts), int(starts[0]), int(starts[-1])))
        if found is None or not np.array_equal(found[0], starts):
            return None
        del self._kept[len(starts), int(starts[0]), int(starts[-1])]
        return found[1:]

    def kept_of_some(self, starts: Array) -> list[tuple[Array, Array, Array | None]]:
        """The same for parts of the texts: rows of these with what was remembered of them."""
        if not self._kept or bool(np.any(starts[1:] <= starts[:-1])):
            return []
        keys = np.array(list(self._kept), np.int64)
        at = np.minimum(np.searchsorted(starts, keys[:, 1]), len(starts) - 1)
        found = []
        for key in map(tuple, keys[starts[at] == keys[:, 1]].tolist()):
            texts, values, counts = self._kept[key]
            rows = np.minimum(np.searchsorted(starts, texts), len(starts) - 1)
            if np.array_equal(starts[rows], texts):
                del self._kept[key]
                found.append((rows, values, counts))
        return found

    def at(self, places: Array) -> Array:
        """The words (n,) that begin at places within the bytes."""
        places = places.astype(np.int64, copy=False)
        if not len(places):
            return np.zeros(0, U)
        if int(places.max()) < self._edge:
            return self._inner(places)
        words = np.empty(len(places), U)
        inner = places < self._edge
        words[inner] = self._inner(places[inner])
        words[~inner] = self._rest[np.minimum(places[~inner] - self._edge, 24)]
        return words

    def end_with(self, ends: Array, key: bytes) -> Array:
        """Whether a key, with a blank before it, ends at each place (n,)."""
        # The blank before the key and seven bytes of it, then the rest.
        start = ends - len(key) - 1
        same = start > 0
        start = np.maximum(start, 0)
        words = self.at(start)
        same &= (words & _FIRST) <= _BLANK
        first = key[:7]
        words >>= _BYTE
        same &= (words & LOW[len(first)]) == U(int.from_bytes(first, "little"))
        for place in range(7, len(key), 8):
            part = key[place : place + 8]
            words = self.at(start + (place + 1)) & LOW[len(part)]
            same &= words == U(int.from_bytes(part, "little"))
        return np.asarray(same)

    def _inner(self, places: Array) -> Array:
        number = places >> 3
        shift = (places & _SEVEN).view(U)
        shift <<= _THREE
        words: Array = self._aligned.take(number)
        words >>= shift
        number += 1
        rest = self._aligned.take(number)
        # Shifted by 64 less that many bits, in two steps, as a shift by 64 does nothing.
        shift ^= _TURN
        rest <<= _ONE
        rest <<= shift
        words |= rest
        return words

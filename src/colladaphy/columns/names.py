"""The names of elements: which are the same, for whole arrays of them at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.words import LOW, Words

__all__ = ["Names", "NotPlain"]

Array = NDArray[Any]
U = np.uint64


class NotPlain(ValueError):  # noqa: N818
    """The bytes hold what the index cannot tell apart by looking at single characters."""


class Names:
    """Codes of the names of elements: a hash table that whole arrays are looked up in.

    The table knows a name by its length, its first and its last eight bytes; what is between them
    is compared. The few that it cannot hold are looked up one by one.
    """

    _ROOM = 512

    def __init__(self) -> None:
        self.texts: list[bytes] = []
        """The names by their codes."""
        self._known: dict[bytes, int] = {}
        self._listed: list[int] = []  # the codes in the table
        self._keys: set[tuple[int, bytes, bytes]] = set()
        self._multiplier = 0x9E3779B97F4A7C15
        self._bits = 14
        self._rebuild()

    def add(self) -> int:
        """A code that no name has yet."""
        self.texts.append(b"")
        return len(self.texts) - 1

    def codes(self, words: Words, start: Array, length: Array, first: Array | None = None) -> Array:
        """The codes (n,) of names that stand at `start` in the bytes.

        `first` are the words there, if they are known; they are overwritten.
        """
        if not len(start):
            return np.zeros(0, np.int16)
        first = words.at(start) if first is None else first
        first &= LOW.take(length, mode="clip")
        last = np.zeros(len(start), U)
        long = np.flatnonzero(length > 8)
        last[long] = words.at(start[long] + length[long] - 8)
        middle = long[length[long] > 16]
        while True:
            found = self._look_up(first, last, length)
            self._check_middles(words, start[middle], length[middle], found, middle)
            unknown = np.flatnonzero(found < 0)
            if not len(unknown):
                return found
            few = unknown[:256]  # mostly the same few names
            if not self._learn(words.data, start[few], length[few]):
                return self._one_by_one(words.data, start, length, found, unknown)

    def _look_up(self, first: Array, last: Array, length: Array) -> Array:
        place = self._table.take(self._buckets(first, last, length)).astype(np.intp)
        same = self._first.take(place) == first
        same &= self._lengths.take(place) == length
        same &= self._last.take(place) == last
        found: Array = self._codes.take(place)
        if not bool(same.all()):
            found[~same] = -1
        return found

    def _buckets(self, first: Array, last: Array, length: Array) -> Array:
        mixed = last >> U(3)
        mixed ^= first
        mixed ^= last << U(7)
        mixed ^= length.view(U)
        mixed *= U(self._multiplier)
        mixed >>= U(64 - self._bits)
        return mixed.view(np.int64)

    def _code(self, name: bytes) -> int:
        code = self._known.get(name)
        if code is None:
            code = self._known[name] = len(self.texts)
            self.texts.append(name)
        return code

    def _learn(self, data: Array, start: Array, length: Array) -> bool:
        """Take names into the table; whether it has any more than before."""
        before = len(self._listed)
        for at, size in zip(start.tolist(), length.tolist(), strict=True):
            name = data[at : at + size].tobytes()
            key = (size, name[:8], name[-8:])
            if key not in self._keys and len(self._listed) < self._ROOM:
                self._keys.add(key)
                self._listed.append(self._code(name))
        if len(self._listed) > before:
            self._rebuild()
        return len(self._listed) > before

    def _one_by_one(
        self, data: Array, start: Array, length: Array, found: Array, unknown: Array
    ) -> Array:
        codes = [
            self._code(data[at : at + size].tobytes())
            for at, size in zip(start[unknown].tolist(), length[unknown].tolist(), strict=True)
        ]
        if len(self.texts) > 32_000:
            found = found.astype(np.int32)
        found[unknown] = codes
        return found

    def _rebuild(self) -> None:
        names = [self.texts[code] for code in self._listed] or [b""]
        self._names = names
        codes = np.array(self._listed or [-1], np.int32)
        self._codes = codes.astype(np.int16) if codes.max() < 32_000 else codes
        self._lengths = np.array([len(name) for name in names], np.int64)
        self._first = self._words(0)
        self._last = np.array(
            [int.from_bytes(name[-8:], "little") if len(name) > 8 else 0 for name in names],
            dtype=U,
        )
        while len(names) ** 2 > (1 << self._bits):
            self._bits += 1
        for _ in range(64):
            buckets = self._buckets(self._first, self._last, self._lengths)
            kept = np.unique(buckets, return_index=True)[1]
            if len(kept) == len(names):
                break
            self._multiplier = (self._multiplier * _STEP + _SHIFT) % (1 << 64) | 1
        else:  # names made to collide are looked up one by one
            self._listed = [self._listed[place] for place in np.sort(kept).tolist()]
            self._rebuild()
            return
        self._table = np.zeros(1 << self._bits, np.int16)
        self._table[buckets] = np.arange(len(names), dtype=np.int16)

    def _words(self, place: int) -> Array:
        """Eight bytes of each name in the table, zeros behind its end."""
        parts = [name[place : place + 8] for name in self._names]
        return np.array([int.from_bytes(part, "little") for part in parts], dtype=U)

    def _check_middles(
        self, words: Words, start: Array, length: Array, found: Array, rows: Array
    ) -> None:
        """Take back what was found where the middles of names longer than two words differ."""
        if not len(rows):
            return
        codes = found[rows]
        place = np.zeros(max(len(self.texts), 1), np.int32)
        place[self._codes] = np.arange(len(self._codes))
        place = place[codes]
        for offset in range(8, int(length.max()) - 8, 8):
            here = np.flatnonzero((length > offset + 8) & (codes >= 0))
            middles = self._words(offset)[place[here]]
            found[rows[here[words.at(start[here] + offset) != middles]]] = -1


_STEP, _SHIFT = 6364136223846793005, 1442695040888963407

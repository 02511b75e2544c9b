"""Which of many short texts are the same, without a string for any of them."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.texts import Ranges

__all__ = ["factors_of", "hashes_of"]

Array = NDArray[Any]
U = np.uint64


def factors_of(ranges: Ranges) -> tuple[Array, Array]:
    """Which texts are the same: the number of each one's (n,), and a row (m,) that has it."""
    if ranges.all_equal():
        return np.zeros(len(ranges), np.int64), np.zeros(1, np.int64)
    made = ranges.words()
    if made is not None and len(ranges):
        words, lengths = made
        few = _few(words, lengths)
        if few is not None:
            return few
        mixed = hashes_of(words, lengths)
        _, rows, numbers = np.unique(mixed, return_index=True, return_inverse=True)
        first = rows[numbers]
        if np.array_equal(words[first], words) and np.array_equal(lengths[first], lengths):
            return numbers, rows
    known: dict[bytes, int] = {}
    numbers = np.array([known.setdefault(text, len(known)) for text in ranges.texts()], np.int64)
    return numbers, np.unique(numbers, return_index=True)[1]


def hashes_of(words: Array, lengths: Array) -> Array:
    """A number (n,) for each text (n, k); different ones have the same by accident only."""
    mixed = lengths.astype(U)
    for column in range(words.shape[1]):
        mixed ^= words[:, column]
        mixed *= _MIX
        mixed ^= mixed >> U(29)
    return mixed


def _few(words: Array, lengths: Array) -> tuple[Array, Array] | None:
    """The same for texts of which there are hardly any different ones; None for others."""
    numbers = np.full(len(lengths), -1, np.int64)
    rows: list[int] = []
    left = np.arange(len(lengths))
    while len(left):
        if len(rows) == _MOST_LOOKED_FOR:
            return None
        first = left[0]
        same = lengths[left] == lengths[first]
        for column in range(words.shape[1]):
            same &= words[left, column] == words[first, column]
        numbers[left[same]] = len(rows)
        rows.append(int(first))
        left = left[~same]
    return numbers, np.array(rows, np.int64)


_MOST_LOOKED_FOR = 6
_MIX: Final = U(0x9E3779B97F4A7C15)

"""Where numbers may have an exponent without digits, found in long texts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["exponents"]

_BLOCK = 1 << 17
"""So many bytes stay in the processor's cache."""

_FIRST, _COUNT = np.uint8(ord(".")), np.uint8(ord("[") - ord(".") + 1)
"""Digits, and what may stand before an ``e`` where a number was taken apart."""
_E, _LOWER = np.uint8(ord("e")), np.uint8(0x20)
_DIGITS = np.zeros(256, dtype=np.bool_)
_DIGITS[list(b"0123456789")] = True


def exponents(data: bytes) -> Iterator[int]:
    """Places just before an ``e`` that follows a digit, or the like, and that no digit follows."""
    codes = np.frombuffer(data, dtype=np.uint8)
    for start in range(0, len(codes), _BLOCK):
        block = codes[start : start + _BLOCK + 3]
        yield from (_places(block) + start).tolist()


def _places(codes: NDArray[np.uint8]) -> NDArray[Any]:
    found = codes[:-1] - _FIRST < _COUNT
    found &= codes[1:] | _LOWER == _E
    places = np.flatnonzero(found)
    after = codes[np.minimum(places + 2, len(codes) - 1)]
    places, after = places[~_DIGITS[after]], after[~_DIGITS[after]]
    signed = (after == ord("-")) | (after == ord("+"))
    digit = _DIGITS[codes[np.minimum(places + 3, len(codes) - 1)]]
    kept: NDArray[Any] = places[~(signed & digit)]
    return kept

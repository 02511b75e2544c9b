"""Numbers bit by bit, and angles in degrees that convert back exactly."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["DEGREE", "degrees_exactly", "differs", "same_bits"]

Array = NDArray[Any]

DEGREE = math.pi / 180.0
"""One degree in radians; angles are converted with one multiplication by it."""


def same_bits(first: Array, second: Array) -> Array:
    """Where two arrays of doubles of the same shape agree in every bit (so that 0 is not -0)."""
    return np.asarray(_bits(first) == _bits(second))


def differs(rows: Array, other: ArrayLike) -> NDArray[np.bool_]:
    """Which rows (n, …) are not the same as those of `other`, or as one row, in every bit."""
    count = len(rows)
    if not count:
        return np.zeros(0, np.bool_)
    bits = _bits(rows).reshape(count, -1)
    others = _bits(np.asarray(other))
    if others.ndim == rows.ndim:
        if np.array_equal(bits, others.reshape(bits.shape)):
            return np.zeros(count, np.bool_)
        others = others.reshape(bits.shape)
    else:
        others = np.broadcast_to(others.reshape(-1), bits.shape[1:])
    # Column by column: numpy is slow to reduce rows that are short.
    found = np.zeros(count, np.int64)
    for column in range(bits.shape[1]):
        found |= bits[:, column] ^ others[..., column]
    return np.asarray(found != 0)


def _bits(values: Array) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64).view(np.int64)


def degrees_exactly(radians: Array) -> tuple[Array, Array]:
    """Degrees that convert back to the same radians where there are any, and where there are.

    Of the neighbouring doubles the one is taken whose product with `DEGREE` is exact.
    """
    radians = np.asarray(radians, dtype=np.float64)
    with np.errstate(all="ignore"):
        best = radians / DEGREE
        exact = same_bits(best * DEGREE, radians)
        for towards in (np.inf, -np.inf):
            other = np.nextafter(best, towards)
            better = ~exact & same_bits(other * DEGREE, radians)
            best = np.where(better, other, best)
            exact |= better
    best = np.where(np.isfinite(radians) & ~np.isfinite(best), np.sign(radians) * 1.7e308, best)
    return best, exact

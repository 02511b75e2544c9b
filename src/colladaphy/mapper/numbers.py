"""Numbers as text and back, exactly.

The shortest text that reads back to the same double, without a fraction that is zero: ``0.1``,
``-0``, ``5e-324``, ``INF`` (XML Schema's spelling). Columns become text in one go.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.mapper.bulk import texts_of

__all__ = [
    "DEGREE",
    "column_texts",
    "degrees_exactly",
    "differs",
    "float_text",
    "floats_text",
    "row_texts",
    "same_bits",
]

Array = NDArray[Any]

DEGREE = math.pi / 180.0
"""One degree in radians; angles are converted with one multiplication by it."""


def float_text(value: float) -> str:
    """One number."""
    if value - value != 0.0:
        return "NaN" if value != value else ("INF" if value > 0 else "-INF")
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def floats_text(values: Iterable[float]) -> str:
    """Numbers, separated by blanks."""
    return " ".join(map(float_text, values))


def column_texts(column: Array) -> list[str]:
    """One text for each of (n,) finite numbers."""
    return row_texts(column.reshape(-1, 1))


def row_texts(rows: Array) -> list[str]:
    """One text for each row of (n, m) finite numbers."""
    return texts_of(rows)


def same_bits(first: Array, second: Array) -> Array:
    """Where two arrays of doubles of the same shape agree in every bit (so that 0 is not -0)."""
    one = np.ascontiguousarray(first, dtype=np.float64).view(np.int64)
    other = np.ascontiguousarray(second, dtype=np.float64).view(np.int64)
    return np.asarray(one == other)


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

"""Counts, strides, offsets and indices of a document, as numbers to count with."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["counted"]

_MOST = 1 << 30
"""More values than a document has: it is of 2**31 bytes at most, and a value of two."""


def counted(values: NDArray[Any]) -> NDArray[np.int64]:
    """The same integers as int64 that two may be multiplied of.

    The schema allows any integer, also one beyond 64 bits. All that is more than a document can
    have values of is alike: it is out of every range.
    """
    if values.dtype == object:
        values = np.array([min(max(int(value), -_MOST), _MOST) for value in values.flat], np.int64)
    return np.asarray(np.clip(values, -_MOST, _MOST), np.int64)

"""Inertia tensors by column, as nine numbers a row."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["diagonals", "symmetric_parts", "turned_tensors"]

Array = NDArray[Any]


def diagonals(moments: Array) -> Array:
    """The tensors (n, 9) of principal moments (n, 3) along the axes."""
    made = np.zeros((len(moments), 9))
    made[:, [0, 4, 8]] = moments
    return made


def turned_tensors(tensors: Array, orientations: Array, turned: Array) -> Array:
    """R·T·Rᵀ: the tensors of turned frames, in the axes they are turned in."""
    rows = np.flatnonzero(turned)
    if not len(rows):
        return tensors
    w, x, y, z = orientations[rows].T
    r = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    t = tensors[rows].T
    with np.errstate(all="ignore"):
        half = [
            [r[i][0] * t[j] + r[i][1] * t[3 + j] + r[i][2] * t[6 + j] for j in range(3)]
            for i in range(3)
        ]
        made = [
            [half[i][0] * r[j][0] + half[i][1] * r[j][1] + half[i][2] * r[j][2] for j in range(3)]
            for i in range(3)
        ]
    result = tensors.copy()
    for i in range(3):
        for j in range(3):
            # Symmetric to the last bit, as an inertia is.
            result[rows, 3 * i + j] = made[i][j] if i <= j else made[j][i]
    return result


def symmetric_parts(tensors: Array) -> Array:
    """(T + Tᵀ)/2 of (n, 9)."""
    across = tensors.reshape(-1, 3, 3).transpose(0, 2, 1).reshape(-1, 9)
    with np.errstate(all="ignore"):
        return np.asarray(0.5 * tensors + 0.5 * across)

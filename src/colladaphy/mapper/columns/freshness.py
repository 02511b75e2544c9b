"""Where two profiles plainly say the same (see `mapper.staleness`).

How far values may differ depends on how exactly their record is written. Here the strictest
measure is taken for all: what agrees by it agrees by any.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.document.poses import DEGREE

__all__ = ["same_numbers", "same_turns"]

Array = NDArray[Any]

_STRICTEST = 0.5e-14
"""The relative difference that fifteen digits allow, a little less than `Precision` does."""
_STRICTEST_TURN = 7.9 * _STRICTEST


def same_numbers(one: Array, other: Array) -> Array:
    """Which rows of (n, m) agree in every number, each to its own size (n,)."""
    with np.errstate(all="ignore"):
        size = np.maximum(np.abs(one), np.abs(other))
        close = np.abs(one - other) <= _STRICTEST * size
    return np.asarray(np.all((one == other) | (close & np.isfinite(size)), axis=1))


def same_turns(turned: Array, turns: Array, quaternions: Array) -> Array:
    """Which rotations, axis and angle in degrees (n, 4) where `turned`, are the quaternions."""
    with np.errstate(all="ignore"):
        axis, degrees = turns[:, :3], turns[:, 3]
        length = np.sqrt(np.sum(axis * axis, axis=1))
        norm = np.sqrt(np.sum(quaternions * quaternions, axis=1))
        half = np.fmod(degrees, 720.0) * DEGREE * 0.5
        stated = np.empty((len(turns), 4))
        stated[:, 0] = np.cos(half)
        stated[:, 1:] = axis * (np.sin(half) / length)[:, None]
        usable = (length > 1e-100) & (length < 1e100) & np.isfinite(degrees)
        still = ~turned | (degrees == 0.0)
        stated[still] = (1.0, 0.0, 0.0, 0.0)
        exact = quaternions / norm[:, None]
        apart = np.minimum(
            np.sum((stated - exact) ** 2, axis=1), np.sum((stated + exact) ** 2, axis=1)
        )
        close = apart <= _STRICTEST_TURN**2
    return np.asarray(close & (usable | still) & (norm > 1e-100) & (norm < 1e100))

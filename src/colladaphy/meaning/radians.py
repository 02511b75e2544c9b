"""Angles in degrees that look as if they were written in radians."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["written_as_radians"]

Array = NDArray[Any]

_ANGLES: Final = math.pi * np.array([1 / 6, 0.25, 1 / 3, 0.5, 2 / 3, 0.75, 5 / 6, 1.0, 1.5, 2.0])
_DIGITS: Final = 3e-6
"""As far as 1.5708 is from a quarter of a circle."""


def written_as_radians(angles: Array) -> Array:
    """Which angles (n,) are known parts of a circle in radians, to five digits."""
    sizes = np.abs(angles)
    nearest = np.abs(sizes[:, None] - _ANGLES).argmin(axis=1)
    return np.asarray(np.abs(sizes / _ANGLES[nearest] - 1.0) <= _DIGITS)

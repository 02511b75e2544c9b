"""Planes: their normal and displacement, and their pose, are the same thing said twice.

The pose is what moves, in columns as one by one. The normal and the displacement are kept as they
were given as long as they agree with it to rounding, and follow from it where they don't.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations

__all__ = ["agreeing"]

Floats = NDArray[np.float64]

_ROUNDING = 16 * float(np.finfo(np.float64).eps)


def agreeing(dimensions: Floats, position: Floats, orientation: Floats) -> Floats:
    """Normal and displacement (4,) that agree with a pose, from those that were stored."""
    result = np.array(dimensions)
    turned = rotations.to_matrix(orientation)[:, 2]
    if not np.all(np.abs(turned - result[:3]) <= _ROUNDING):
        result[:3] = turned
    normal, stored = result[:3].tolist(), float(result[3])
    products = [a * b for a, b in zip(normal, position.tolist(), strict=True)]
    derived = sum(products)
    if math.isfinite(derived) and abs(derived - stored) > _ROUNDING * sum(map(abs, products)):
        result[3] = derived
    return result

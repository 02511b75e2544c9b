"""Planes: their normal and displacement, and their pose, are the same thing said twice.

The pose is what moves, in columns as one by one. The normal and the displacement are kept as they
were given as long as they agree with it to rounding, and follow from it where they don't.
"""

from __future__ import annotations

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
    with np.errstate(all="ignore"):
        products = (result[:3] * position).tolist()
    derived = sum(products)
    if not abs(derived - result[3]) <= _ROUNDING * sum(map(abs, products)):
        result[3] = derived
    return result

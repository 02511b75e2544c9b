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


def agreeing(dimensions: Floats, positions: Floats, orientations: Floats) -> Floats:
    """Normals and displacements (..., 4) that agree with poses, from those that were stored."""
    result = np.array(dimensions)
    normals, stored = result[..., :3], result[..., 3]
    turned = rotations.to_matrix(orientations)[..., 2]
    moved = ~np.all(np.abs(turned - normals) <= _ROUNDING, axis=-1, keepdims=True)
    np.copyto(normals, turned, where=moved)
    with np.errstate(all="ignore"):
        products = normals * positions
        derived, size = products.sum(axis=-1), np.abs(products).sum(axis=-1)
        away = np.isfinite(derived) & (np.abs(derived - stored) > _ROUNDING * size)
    result[..., 3] = np.where(away, derived, stored)
    return result

"""A plane in space, and vectors as seen in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Frame", "along"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Frame:
    """A plane in space: all points x with normal·x = offset, seen along u and v."""

    normal: Floats
    u: Floats
    v: Floats
    offset: float

    @classmethod
    def across(cls, normal: Floats, offset: float = 0.0) -> Frame:
        """The frame of a unit normal; u × v = normal."""
        # The axis after the normal's largest, in cyclic order: coordinate planes stay exact.
        first = np.zeros(3)
        first[(int(np.argmax(np.abs(normal))) + 1) % 3] = 1.0
        u = first - normal * float(along(first, normal))
        u = u / np.sqrt(float(along(u, u)))
        return cls(normal, u, np.cross(normal, u), offset)

    def flat(self, vectors: Floats) -> Floats:
        """Coordinates (..., 2) of vectors (..., 3) along u and v."""
        return np.stack([along(vectors, self.u), along(vectors, self.v)], axis=-1)

    def height(self, vectors: Floats) -> Floats:
        """Component (...) of vectors (..., 3) along the normal."""
        return along(vectors, self.normal)

    def lift(self, flat: Floats, height: Floats | float = 0.0) -> Floats:
        """Vectors (..., 3) of coordinates (..., 2) and a component along the normal."""
        up = np.asarray(height)[..., None] * self.normal
        return np.asarray(up + flat[..., :1] * self.u + flat[..., 1:] * self.v)


def along(vectors: Floats, axis: Floats) -> Floats:
    """Component (...) of vectors (..., 3) along an axis (3,)."""
    # Term by term: the same bits however the array lies in memory.
    x, y, z = (vectors[..., i] * axis[i] for i in range(3))
    return np.asarray(x + y + z)

"""Poses as position and quaternion, put after each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations

__all__ = ["ORIGIN", "Pose"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a frame is in another one: origin (3,) and rotation (4,)."""

    position: Floats
    orientation: Floats

    @classmethod
    def of(cls, position: ArrayLike, orientation: ArrayLike) -> Pose:
        """A pose with its quaternion at length one."""
        return cls(np.array(position, dtype=np.float64), rotations.normalize(orientation))

    def __matmul__(self, other: Pose) -> Pose:
        """The pose `other`, given in this frame, seen from outside."""
        return Pose(
            self.position + rotations.rotate(self.orientation, other.position),
            rotations.multiply(self.orientation, other.orientation),
        )

    def inverse(self) -> Pose:
        """Where the outside is, seen from this frame."""
        back = rotations.conjugate(self.orientation)
        return Pose(-rotations.rotate(back, self.position), back)


ORIGIN = Pose.of((0.0, 0.0, 0.0), rotations.IDENTITY)

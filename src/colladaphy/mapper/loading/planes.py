"""Planes and their poses: the pose of a plane turns (0, 0, 1) onto its normal."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses, rotate_vectors, unit_quaternions
from colladaphy.world import rotations

__all__ = ["plane_poses", "planes_at"]

Array = NDArray[Any]


def planes_at(poses: Poses) -> Array:
    """Normal and displacement (n, 4) of planes that stand at poses."""
    turns = unit_quaternions(poses.orientations)
    normals = rotate_vectors(turns, np.tile([0.0, 0.0, 1.0], (len(poses), 1)))
    a, b, c = normals.T
    x, y, z = poses.positions.T
    return np.column_stack([normals, a * x + b * y + c * z])


def plane_poses(planes: Array) -> Poses:
    """Where planes (n, 4) stand of which nothing but the equation is known."""
    with np.errstate(all="ignore"):
        positions = planes[:, :3] * planes[:, 3:]
    return Poses.of(len(planes), positions, rotations.between((0.0, 0.0, 1.0), planes[:, :3]))

"""Planes and their poses: the pose of a plane turns (0, 0, 1) onto its normal."""

from __future__ import annotations

from colladaphy.document.poses import Pose, rotate_vector, unit_quaternion
from colladaphy.mapper.plans import Dimensions
from colladaphy.world import rotations

__all__ = ["plane_at", "plane_pose"]


def plane_at(pose: Pose) -> Dimensions:
    """Normal and displacement of a plane that stands at a pose."""
    a, b, c = rotate_vector(unit_quaternion(pose.rotation), (0.0, 0.0, 1.0))
    x, y, z = pose.translation
    return a, b, c, a * x + b * y + c * z


def plane_pose(plane: Dimensions) -> Pose:
    """Where a plane stands of which nothing but its equation is known."""
    a, b, c, displacement = plane
    w, x, y, z = rotations.between((0.0, 0.0, 1.0), (a, b, c)).tolist()
    return Pose((a * displacement, b * displacement, c * displacement), (w, x, y, z))

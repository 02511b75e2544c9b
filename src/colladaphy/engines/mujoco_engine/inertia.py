"""Inertia tensors as principal moments, within what MuJoCo accepts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import Kind, rotations

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["SLACK", "are_points", "inertias_of", "principal"]

Floats = NDArray[np.float64]

SLACK: Final = 1e-6
"""How much (relative) a tensor may violate A + B ≥ C or its symmetry by rounding."""


_AXES: Final = np.arange(3)
_GYRATION: Final = 0.01
"""Of the size of a World, the radius of gyration that a point mass is given."""


def are_points(masses: Floats, inertias: Floats) -> NDArray[np.bool_]:
    """Which bodies (n,) are masses without any inertia, with which MuJoCo cannot compute."""
    return np.asarray((masses > 0.0) & ~np.any(inertias, axis=(1, 2)))


def inertias_of(world: World) -> Floats:
    """The inertias (n, 3, 3) of all bodies; those of point masses are small against the World.

    Its size is that of shapes and of the arms of joints, which stay the same while it runs.
    """
    inertias = np.array(world.inertias)
    points = are_points(world.masses, inertias)
    if points.any():
        joints = world.joints.columns()
        arms = joints["positions"][joints["bodies"] > 0]
        sizes = world.dimensions[world.kinds != Kind.PLANE]
        size = max(float(np.abs(arms).max(initial=0.0)), float(sizes.max(initial=0.0))) or 1.0
        with np.errstate(over="ignore"):
            moments = world.masses[points] * np.square(_GYRATION * size)
        inertias[np.flatnonzero(points)[:, None], _AXES, _AXES] = moments[:, None]
    return inertias


def principal(inertia: Floats) -> tuple[Floats, Floats]:
    """Principal moments (3,) and the rotation (4,) from their axes to the body's.

    Moments are corrected to A + B ≥ C, by no more than rounding where `SLACK` was checked.
    """
    tensor = np.asarray(inertia)
    if np.count_nonzero(tensor - np.diag(np.diagonal(tensor))) == 0:
        moments, turn = np.array(np.diagonal(tensor)), np.array(rotations.IDENTITY)
    else:
        moments, axes = np.linalg.eigh(0.5 * (tensor + tensor.T))
        if np.linalg.det(axes) < 0:
            axes[:, 0] = -axes[:, 0]
        turn = rotations.from_matrix(axes)
    largest = int(np.argmax(moments))
    others = float(np.sum(np.delete(moments, largest)))
    moments[largest] = min(float(moments[largest]), others)
    return moments, turn

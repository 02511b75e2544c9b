"""Volumes and inertias of solid primitives, vectorised; the formulas of pe, and elliptic ones.

A row of `dimensions` is (x, y, z, length): semi-axes along the body's own axes, and for a box
its full side lengths. Kinds that have no such dimension leave it zero:

| kind | x | y | z | length |
|-|-|-|-|-|
| sphere | radius | | | |
| box | full length | full length | full length | |
| capsule | of the caps, along the axis | across | across | of the cylinder, without the caps |
| cylinder | | across | across | of the cylinder |
| ellipsoid | semi-axis | semi-axis | semi-axis | |
| plane | normal x | normal y | normal z | displacement |

The axis of capsules and cylinders is x.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.kinds import Kind

__all__ = ["COUNTS", "NEEDED", "solid_inertia", "solid_volume"]

Floats = NDArray[np.float64]

NEEDED: Final[dict[Kind, tuple[int, ...]]] = {
    Kind.SPHERE: (0,),
    Kind.BOX: (0, 1, 2),
    Kind.CAPSULE: (0, 1, 2, 3),
    Kind.CYLINDER: (1, 2, 3),
    Kind.ELLIPSOID: (0, 1, 2),
}
"""The dimensions of a kind that must be positive."""

COUNTS: Final[dict[Kind, str]] = {
    Kind.SPHERE: "radius",
    Kind.BOX: "lengths x, y, z",
    Kind.CAPSULE: "radii and length",
    Kind.CYLINDER: "radii and length",
    Kind.ELLIPSOID: "radii x, y, z",
}
"""What these are called in messages."""


def solid_volume(kind: Kind, dimensions: Floats) -> Floats:
    """Volumes (n,) of solids of one kind with `dimensions` (n, 4)."""
    x, y, z, length = (dimensions[:, i] for i in range(4))
    match kind:
        case Kind.SPHERE:
            return 4.0 / 3.0 * np.pi * x * x * x
        case Kind.BOX:
            return x * y * z
        case Kind.CAPSULE:
            return np.pi * y * z * (4.0 / 3.0 * x + length)
        case Kind.CYLINDER:
            return np.pi * y * z * length
        case Kind.ELLIPSOID:
            return 4.0 / 3.0 * np.pi * x * y * z
        case _:
            return np.zeros(len(dimensions))


def solid_inertia(kind: Kind, dimensions: Floats, masses: Floats) -> Floats:
    """Principal inertias (n, 3) about the centre of mass, in the body's own axes."""
    x, y, z, length = (dimensions[:, i] for i in range(4))
    match kind:
        case Kind.SPHERE:
            across = 0.4 * masses * x * x
            return np.stack([across, across, across], axis=-1)
        case Kind.BOX:
            twelfth = masses / 12.0
            return _across(twelfth * x * x, twelfth * y * y, twelfth * z * z)
        case Kind.ELLIPSOID:
            fifth = masses / 5.0
            return _across(fifth * x * x, fifth * y * y, fifth * z * z)
        case Kind.CYLINDER:
            quarter = masses / 4.0
            return _across(masses / 12.0 * length * length, quarter * y * y, quarter * z * z)
        case Kind.CAPSULE:
            share = length / (length + 4.0 / 3.0 * x)
            cylinder = masses * share
            caps = masses - cylinder
            along = cylinder * length * length / 12.0 + caps * (
                0.2 * x * x + 0.375 * x * length + 0.25 * length * length
            )
            quarter, fifth = cylinder / 4.0, caps / 5.0
            return _across(along, (quarter + fifth) * y * y, (quarter + fifth) * z * z)
        case _:
            return np.zeros((len(dimensions), 3))


def _across(xx: Floats, yy: Floats, zz: Floats) -> Floats:
    """Moments of inertia from the second moments of mass along each axis."""
    return np.stack([yy + zz, xx + zz, xx + yy], axis=-1)

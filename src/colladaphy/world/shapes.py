"""Volumes and inertias of solid primitives; the formulas of pe, and elliptic ones.

Each formula is written once, for single numbers and for arrays: both have the same bits.

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

import math
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.kinds import Kind

__all__ = ["COUNTS", "NEEDED", "principal_inertia", "solid_volume", "volume"]

Floats = NDArray[np.float64]
Number = TypeVar("Number", float, Floats)

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


def solid_volume(kind: int, dimensions: Floats) -> Floats:
    """Volumes (n,) of solids of one kind with `dimensions` (n, 4)."""
    x, y, z, length = (dimensions[:, i] for i in range(4))
    return volume(kind, x, y, z, length)


def volume(kind: int, x: Number, y: Number, z: Number, length: Number) -> Number:
    """Volume of a solid; numbers, or arrays of them, all of one kind."""
    match kind:
        case Kind.SPHERE:
            return 4.0 / 3.0 * math.pi * x * x * x
        case Kind.BOX:
            return x * y * z
        case Kind.CAPSULE:
            return math.pi * y * z * (4.0 / 3.0 * x + length)
        case Kind.CYLINDER:
            return math.pi * y * z * length
        case Kind.ELLIPSOID:
            return 4.0 / 3.0 * math.pi * x * y * z
        case _:
            return x - x


def principal_inertia(
    kind: int, mass: Number, x: Number, y: Number, z: Number, length: Number
) -> tuple[Number, Number, Number]:
    """Principal inertias about the centre of mass, in the body's own axes."""
    match kind:
        case Kind.SPHERE:
            across = 0.4 * mass * x * x
            return across, across, across
        case Kind.BOX:
            twelfth = mass / 12.0
            return _across(twelfth * x * x, twelfth * y * y, twelfth * z * z)
        case Kind.ELLIPSOID:
            fifth = mass / 5.0
            return _across(fifth * x * x, fifth * y * y, fifth * z * z)
        case Kind.CYLINDER:
            quarter = mass / 4.0
            return _across(mass / 12.0 * length * length, quarter * y * y, quarter * z * z)
        case Kind.CAPSULE:
            share = length / (length + 4.0 / 3.0 * x)
            cylinder = mass * share
            caps = mass - cylinder
            along = cylinder * length * length / 12.0 + caps * (
                0.2 * x * x + 0.375 * x * length + 0.25 * length * length
            )
            quarter, fifth = cylinder / 4.0, caps / 5.0
            return _across(along, (quarter + fifth) * y * y, (quarter + fifth) * z * z)
        case _:
            return mass - mass, mass - mass, mass - mass


def _across(xx: Number, yy: Number, zz: Number) -> tuple[Number, Number, Number]:
    """Moments of inertia from the second moments of mass along each axis."""
    return yy + zz, xx + zz, xx + yy

"""Volumes and centres of shapes, and meshes for those that Bullet has no primitive for."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Solid", "capsule_mesh", "cylinder_mesh", "mesh_solid", "primitive_solid"]

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
_SEGMENTS = 32


class Solid(NamedTuple):
    """Volume and centre of mass, in the frame of the shape."""

    volume: float
    center: Floats


def primitive_solid(name: str, values: Mapping[str, Sequence[float]]) -> Solid | None:
    """The solid of a primitive of COLLADA 1.5 from its numbers; None for a plane."""
    if name == "box":
        x, y, z = values["half_extents"]
        volume = 8.0 * x * y * z
    elif name == "sphere":
        volume = 4.0 / 3.0 * math.pi * math.prod(3 * [values["radius"][0]])
    elif name == "cylinder":
        volume = math.pi * values["radius"][0] * values["radius"][1] * values["height"][0]
    elif name == "capsule":
        x, y, z = values["radius"]
        volume = math.pi * x * z * (values["height"][0] + 4.0 / 3.0 * y)
    else:
        return None
    return Solid(volume, np.zeros(3))


def mesh_solid(points: Floats, triangles: Integers) -> Solid | None:
    """The solid that a closed surface encloses (divergence theorem).

    None where it has none, or where no number is great or small enough for its volume.
    """
    if not len(triangles) or not np.all(np.isfinite(points)):
        return None
    # In a cube about the origin, so that far away meshes keep their digits and huge or tiny ones
    # do not leave the range of numbers.
    halves = points / 2
    middle = halves.min(axis=0) / 2 + halves.max(axis=0) / 2
    size = float(np.abs(halves - middle).max())
    if not size > 0.0:
        return None
    inner = (halves - middle) / size
    a, b, c = np.moveaxis(inner[triangles], 1, 0)
    parts = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    share = float(parts.sum())
    if not abs(share) > 1e-9 * float(np.prod(np.ptp(inner, axis=0))):
        return None
    center = (parts[:, None] * (a + b + c) / 4.0).sum(axis=0) / share
    volume = abs(share) * (2 * size) * (2 * size) * (2 * size)
    if not 0.0 < volume < math.inf:
        return None
    return Solid(volume, 2 * (center * size + middle))


def cylinder_mesh(height: float, radii: Sequence[float]) -> tuple[Floats, Integers]:
    """Points and triangles of a cylinder about y with these radii along x and z."""
    x, z = radii
    return _lathe([(-height / 2, x, z), (height / 2, x, z)])


def capsule_mesh(height: float, radii: Sequence[float]) -> tuple[Floats, Integers]:
    """Points and triangles of a capsule about y with these radii along x, y and z."""
    x, y, z = radii
    quarter = _SEGMENTS // 4
    rings = []
    for end in (-1.0, 1.0):
        steps = range(1, quarter + 1) if end < 0 else range(quarter, 0, -1)
        for step in steps:
            angle = math.pi / 2 * step / quarter
            rise = end * (height / 2 + y * math.cos(angle))
            rings.append((rise, x * math.sin(angle), z * math.sin(angle)))
    poles = (-height / 2 - y, height / 2 + y)
    return _lathe(rings, poles)


def _lathe(
    rings: Sequence[tuple[float, float, float]], poles: tuple[float, float] | None = None
) -> tuple[Floats, Integers]:
    """A closed surface through rings (height, radius x, radius z) from below to above."""
    turns = np.arange(_SEGMENTS) * (2 * math.pi / _SEGMENTS)
    points = [
        (x * math.cos(turn), height, z * math.sin(turn)) for height, x, z in rings for turn in turns
    ]
    low, high = len(points), len(points) + 1
    points += [(0.0, height, 0.0) for height in poles or (rings[0][0], rings[-1][0])]
    triangles = []
    for i in range(_SEGMENTS):
        j = (i + 1) % _SEGMENTS
        for ring in range(len(rings) - 1):
            base, above = ring * _SEGMENTS, (ring + 1) * _SEGMENTS
            triangles += [(base + i, above + i, base + j), (base + j, above + i, above + j)]
        last = (len(rings) - 1) * _SEGMENTS
        triangles += [(low, i, j), (high, last + j, last + i)]
    return np.array(points), np.array(triangles, dtype=np.int64)

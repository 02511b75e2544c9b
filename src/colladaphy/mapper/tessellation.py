"""Primitives as convex meshes, for readers that know no primitives.

The meshes are in the World's body frame and touch the primitive at its ends along all three axes,
so that their extent tells what they stand for.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.kinds import Kind
from colladaphy.world.meshes import Mesh

__all__ = ["extent", "tessellate"]

Array = NDArray[Any]

_AROUND = 24  # a multiple of four, so that the ends along y and z are vertices
_ALONG = 6  # rings between the middle of a sphere and its pole


def extent(kind: Kind, dimensions: tuple[float, ...]) -> Array | None:
    """Half of the size (3,) along the axes of the body frame; None for what has none."""
    x, y, z, length = dimensions
    match kind:
        case Kind.SPHERE:
            return np.array([x, x, x])
        case Kind.BOX:
            return np.array([x, y, z]) / 2.0
        case Kind.ELLIPSOID:
            return np.array([x, y, z])
        case Kind.CAPSULE:
            return np.array([x + length / 2.0, y, z])
        case Kind.CYLINDER:
            return np.array([length / 2.0, y, z])
        case _:
            return None


def tessellate(kind: Kind, dimensions: tuple[float, ...], id: int) -> Mesh:
    """The convex mesh of a primitive that is not a plane."""
    x, y, z, length = dimensions
    if kind is Kind.BOX:
        profile = [(-x / 2.0, 1.0), (x / 2.0, 1.0)]
        around = [
            (-y / 2.0, -z / 2.0),
            (y / 2.0, -z / 2.0),
            (y / 2.0, z / 2.0),
            (-y / 2.0, z / 2.0),
        ]
    else:
        profile = _profile(kind, x, length)
        radii = (x, x) if kind is Kind.SPHERE else (y, z)
        around = [(radii[0] * c, radii[1] * s) for c, s in _circle()]
    return _revolved(profile, around, id)


def _circle() -> list[tuple[float, float]]:
    """Cosines and sines around; exact at the quarters."""
    made = []
    for step in range(_AROUND):
        angle = 2.0 * np.pi * step / _AROUND
        made.append((float(np.cos(angle)), float(np.sin(angle))))
    quarter = _AROUND // 4
    for turn, exact in enumerate([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]):
        made[turn * quarter] = exact
    return made


def _profile(kind: Kind, x: float, length: float) -> list[tuple[float, float]]:
    """Places along the axis, and the share of the radius there; ends have none."""
    if kind is Kind.CYLINDER:
        return [(-length / 2.0, 1.0), (length / 2.0, 1.0)]
    half = length / 2.0 if kind is Kind.CAPSULE else 0.0
    angles = [np.pi / 2.0 * step / _ALONG for step in range(1, _ALONG)]
    cap = [(float(np.sin(angle)), float(np.cos(angle))) for angle in angles]
    upper = [(half + x * height, share) for height, share in cap]
    lower = [(-half - x * height, share) for height, share in reversed(cap)]
    middle = [(-half, 1.0), (half, 1.0)] if half else [(0.0, 1.0)]
    return [(-half - x, 0.0), *lower, *middle, *upper, (half + x, 0.0)]


def _revolved(
    profile: list[tuple[float, float]], around: list[tuple[float, float]], id: int
) -> Mesh:
    """Rings joined by triangles; flat ends get a fan, pointed ones a vertex."""
    count = len(around)
    vertices: list[tuple[float, float, float]] = []
    rings: list[list[int]] = []
    for place, share in profile:
        start = len(vertices)
        if share == 0.0:
            vertices.append((place, 0.0, 0.0))
            rings.append([start] * count)
        else:
            vertices += [(place, y * share, z * share) for y, z in around]
            rings.append(list(range(start, start + count)))
    faces: list[tuple[int, int, int]] = []
    for lower, upper in pairwise(rings):
        for step in range(count):
            after = (step + 1) % count
            faces.append((lower[step], lower[after], upper[after]))
            faces.append((lower[step], upper[after], upper[step]))
    for step in range(1, count - 1):
        faces.append((rings[0][0], rings[0][step + 1], rings[0][step]))
        faces.append((rings[-1][0], rings[-1][step], rings[-1][step + 1]))
    solid = [face for face in faces if len(set(face)) == 3]
    return Mesh(vertices, solid, convex=True, id=id)

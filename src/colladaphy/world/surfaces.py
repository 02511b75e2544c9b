"""Inertias of hollow primitives: all of the mass spread evenly over the surface.

The mass of a hollow body is that of the solid (volume times density) unless it is given; only
its distribution differs (COLLADA 1.5 §6 <hollow>).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.kinds import Kind

__all__ = ["hollow_moments"]

Floats = NDArray[np.float64]

# Enough nodes for twelve digits up to an aspect ratio of about 10; smooth integrands converge
# spectrally, so that more only matters for needles and discs.
_NODES = 96
# How many surfaces are integrated at once: of elliptic ones, as many as a cache holds.
_AT_ONCE = 32


def hollow_moments(kind: Kind, dimensions: Floats) -> Floats:
    """Mean squares of x, y and z over the surfaces of centred primitives of one kind, (n, 3).

    `dimensions` are (n, 4). The moment of inertia about x is mass·(mean y² + mean z²), and so on.
    """
    scale = dimensions.max(axis=1, keepdims=True)
    sizes = dimensions / scale
    if kind is Kind.SPHERE:
        means = np.repeat(sizes[:, :1] * sizes[:, :1] / 3.0, 3, axis=1)
    elif kind is Kind.BOX:
        means = _boxes(sizes[:, :3])
    else:
        different, where = np.unique(sizes, axis=0, return_inverse=True)
        means = np.empty((len(different), 3))
        section = different[:, 1] == different[:, 2]
        for rows, angles in ((section, _ROUND), (~section, _quarter())):
            places = np.flatnonzero(rows)
            for start in range(0, len(places), _AT_ONCE):
                part = places[start : start + _AT_ONCE]
                means[part] = _integrated(kind, different[part], angles)
        means = means[where.reshape(-1)]
    return np.asarray(means * scale * scale)


def _boxes(sides: Floats) -> Floats:
    x, y, z = sides.T
    faces = np.stack([y * z, x * z, x * y], axis=1)  # the area of one face across each axis
    area = 2.0 * faces.sum(axis=1, keepdims=True)
    squares = sides * sides
    # Over the two faces across an axis its square is side²/4, over the other four side²/12.
    return np.asarray((2.0 * faces * squares / 4.0 + (area - 2.0 * faces) * squares / 12.0) / area)


Angles = tuple[Floats, Floats, Floats]
"""Squares of the cosines and sines of angles about x, and their weights, 2π together."""

# Nothing on a round section depends on the angle but these squares, and their mean is a half.
_ROUND: Angles = (np.array([0.5]), np.array([0.5]), np.array([2.0 * np.pi]))


@lru_cache(maxsize=1)
def _quarter() -> Angles:
    """One quarter of a circle, which stands for all four by symmetry."""
    angles = np.arange(_NODES // 2 + 1) * (np.pi / _NODES)
    weights = np.full(len(angles), 4.0 * np.pi / _NODES)
    weights[[0, -1]] *= 0.5
    return np.cos(angles) ** 2, np.sin(angles) ** 2, weights


@lru_cache(maxsize=1)
def _half() -> tuple[Floats, Floats]:
    """Nodes and weights from 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return np.asarray(0.5 * (nodes + 1.0)), np.asarray(0.5 * weights)


def _integrated(kind: Kind, sizes: Floats, angles: Angles) -> Floats:
    x, y, z, length = (sizes[:, axis, None] for axis in range(4))
    if kind is Kind.ELLIPSOID:
        parts = [_caps(x, y, z, length, angles)]
    elif kind is Kind.CYLINDER:
        parts = [_wall(y, z, length, angles), _discs(y, z, length)]
    else:
        parts = [_wall(y, z, length, angles), _caps(x, y, z, length, angles)]
    integrals = sum(parts[1:], parts[0])
    return np.asarray(integrals[:, 1:] / integrals[:, :1])


# Each of these gives an area and the integrals of x², y², z² over it, (n, 4).


def _wall(y: Floats, z: Floats, length: Floats, angles: Angles) -> Floats:
    cosines, sines, weights = angles
    element = np.sqrt(y * y * sines + z * z * cosines) * weights * length
    area = element.sum(axis=1, keepdims=True)
    across = [(element * squares).sum(axis=1, keepdims=True) for squares in (cosines, sines)]
    return np.concatenate(
        [area, area * length * length / 12.0, y * y * across[0], z * z * across[1]], axis=1
    )


def _discs(y: Floats, z: Floats, length: Floats) -> Floats:
    area = 2.0 * np.pi * y * z
    moments = [area * length * length / 4.0, area * y * y / 4.0, area * z * z / 4.0]
    return np.concatenate([area, *moments], axis=1)


def _caps(x: Floats, y: Floats, z: Floats, length: Floats, angles: Angles) -> Floats:
    """Both halves of an ellipsoid, `length` apart; their integrals are equal by symmetry."""
    nodes, heights = _half()
    cosines, sines, weights = angles
    u = np.repeat(nodes, len(weights))
    across = 1.0 - u * u
    squares = u * u, across * np.tile(cosines, _NODES), across * np.tile(sines, _NODES)
    # The area element of the sphere stretched by (x, y, z).
    stretch = (y * z) ** 2 * squares[0] + (x * z) ** 2 * squares[1] + (x * y) ** 2 * squares[2]
    element = np.sqrt(stretch) * (2.0 * np.repeat(heights, len(weights)) * np.tile(weights, _NODES))
    along = (0.5 * length + x * u) ** 2
    moments = [along, y * y * squares[1], z * z * squares[2]]
    integrals = [element, *(element * moment for moment in moments)]
    return np.stack([integral.sum(axis=1) for integral in integrals], axis=1)

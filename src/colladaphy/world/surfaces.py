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
        means = np.array([_integrated(kind, *size) for size in different.tolist()])
        means = means[where.reshape(-1)]
    return np.asarray(means * scale * scale)


def _integrated(kind: Kind, x: float, y: float, z: float, length: float) -> Floats:
    match kind:
        case Kind.ELLIPSOID:
            return _weigh([_ellipsoid(x, y, z)])
        case Kind.CYLINDER:
            return _weigh([_wall(y, z, length), _discs(y, z, length)])
        case _:
            return _weigh([_wall(y, z, length), _caps(x, y, z, length)])


Part = tuple[float, Floats]
"""An area and the integrals of x², y², z² over it."""


def _weigh(parts: list[Part]) -> Floats:
    area = sum(part[0] for part in parts)
    return np.asarray(sum(part[1] for part in parts) / area)


def _boxes(sides: Floats) -> Floats:
    x, y, z = sides.T
    faces = np.stack([y * z, x * z, x * y], axis=1)  # the area of one face across each axis
    area = 2.0 * faces.sum(axis=1, keepdims=True)
    squares = sides * sides
    # Over the two faces across an axis its square is side²/4, over the other four side²/12.
    return np.asarray((2.0 * faces * squares / 4.0 + (area - 2.0 * faces) * squares / 12.0) / area)


@lru_cache(maxsize=1)
def _quadrature() -> tuple[Floats, Floats, Floats]:
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    angles = np.arange(2 * _NODES, dtype=np.float64) * (np.pi / _NODES)
    return np.asarray(nodes), np.asarray(weights), angles


def _ellipsoid(x: float, y: float, z: float) -> Part:
    u, weights, angle = _quadrature()
    across = np.sqrt(1.0 - u * u)[:, None]
    px = np.broadcast_to(u[:, None], (len(u), len(angle)))
    py, pz = across * np.cos(angle), across * np.sin(angle)
    # The area element of the sphere stretched by (x, y, z).
    stretch = np.sqrt((y * z * px) ** 2 + (x * z * py) ** 2 + (x * y * pz) ** 2)
    element = stretch * weights[:, None] * (np.pi / _NODES)
    squares = [float(np.sum(element * (a * p) ** 2)) for a, p in ((x, px), (y, py), (z, pz))]
    return float(np.sum(element)), np.array(squares)


def _wall(y: float, z: float, length: float) -> Part:
    _, _, angle = _quadrature()
    cosine, sine = np.cos(angle), np.sin(angle)
    element = np.sqrt((y * sine) ** 2 + (z * cosine) ** 2) * (np.pi / _NODES) * length
    area = float(np.sum(element))
    return area, np.array(
        [
            area * length * length / 12.0,
            float(np.sum(element * (y * cosine) ** 2)),
            float(np.sum(element * (z * sine) ** 2)),
        ]
    )


def _discs(y: float, z: float, length: float) -> Part:
    area = 2.0 * np.pi * y * z
    return area, np.array([length * length / 4.0, y * y / 4.0, z * z / 4.0]) * area


def _caps(x: float, y: float, z: float, length: float) -> Part:
    u, weights, angle = _quadrature()
    u, weights = 0.5 * (u + 1.0), 0.5 * weights  # one half, by symmetry
    across = np.sqrt(1.0 - u * u)[:, None]
    px = np.broadcast_to(u[:, None], (len(u), len(angle)))
    py, pz = across * np.cos(angle), across * np.sin(angle)
    stretch = np.sqrt((y * z * px) ** 2 + (x * z * py) ** 2 + (x * y * pz) ** 2)
    element = 2.0 * stretch * weights[:, None] * (np.pi / _NODES)
    along = (0.5 * length + x * px) ** 2
    return float(np.sum(element)), np.array(
        [
            float(np.sum(element * along)),
            float(np.sum(element * (y * py) ** 2)),
            float(np.sum(element * (z * pz) ** 2)),
        ]
    )

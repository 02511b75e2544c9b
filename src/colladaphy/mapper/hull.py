"""The convex hull of points in space, for geometries that are given as one.

The incremental algorithm: begin with a tetrahedron, and for each point outside of it replace the
faces that the point sees by a cone from the rim. Points are taken in an order of decreasing
distance from the middle, so that most of the others are found inside at once.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["convex_hull"]

Array = NDArray[Any]


def convex_hull(points: Array) -> tuple[Array, Array] | None:
    """Vertices (n, 3), a subset of `points`, and triangles (m, 3) counter-clockwise from outside.

    None where the points have no volume.
    """
    unique = np.unique(points, axis=0)
    if len(unique) < 4:
        return None
    low, high = unique.min(axis=0), unique.max(axis=0)
    scale = float(np.max(high - low))
    if not (np.isfinite(scale) and scale > 0):
        return None
    local = (unique - 0.5 * (low + high)) / scale
    start = _tetrahedron(local)
    if start is None:
        return None
    faces = _grow(local, start)
    used = np.unique(faces)
    return unique[used], np.searchsorted(used, faces)


_TOLERANCE = 1e-10


def _tetrahedron(points: Array) -> list[int] | None:
    first = int(np.argmin(points[:, 0]))
    second = int(np.argmax(np.linalg.norm(points - points[first], axis=1)))
    along = points[second] - points[first]
    across = np.linalg.norm(np.cross(points - points[first], along), axis=1)
    third = int(np.argmax(across))
    if across[third] <= _TOLERANCE:
        return None
    normal = np.cross(along, points[third] - points[first])
    heights = (points - points[first]) @ normal
    fourth = int(np.argmax(np.abs(heights)))
    if abs(heights[fourth]) <= _TOLERANCE * np.linalg.norm(normal):
        return None
    if heights[fourth] > 0:
        second, third = third, second
    return [first, second, third, fourth]


def _grow(points: Array, start: list[int]) -> Array:
    a, b, d, e = start
    faces = np.array([[a, b, d], [a, e, b], [b, e, d], [d, e, a]])
    normals, offsets = _planes(points, faces)
    order = np.argsort(-np.linalg.norm(points, axis=1), kind="stable")
    for index in order.tolist():
        if index in start:
            continue
        seen = normals @ points[index] - offsets > _TOLERANCE
        if not seen.any():
            continue
        rim = _rim(faces[seen])
        cone = np.column_stack([rim, np.full(len(rim), index)])
        cone_normals, cone_offsets = _planes(points, cone)
        faces = np.concatenate([faces[~seen], cone])
        normals = np.concatenate([normals[~seen], cone_normals])
        offsets = np.concatenate([offsets[~seen], cone_offsets])
    return faces


def _planes(points: Array, faces: Array) -> tuple[Array, Array]:
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    return normals, np.einsum("fi,fi->f", normals, corners[:, 0])


def _rim(faces: Array) -> Array:
    """The edges that only one of the faces has, in its direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    known = {(first, second) for first, second in edges.tolist()}
    return np.array([edge for edge in edges.tolist() if (edge[1], edge[0]) not in known])

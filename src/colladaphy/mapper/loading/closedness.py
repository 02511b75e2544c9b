"""Whether surfaces of triangles are closed, so that they enclose a volume.

Every edge has to be passed as often one way as the other; corners at the same place are one,
however many vertices a file has there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["are_closed"]

Array = NDArray[Any]


def are_closed(surfaces: Sequence[tuple[Array, Array]]) -> Array:
    """Which surfaces, of vertices (n, 3) and faces (m, 3), are closed."""
    count = len(surfaces)
    if not count:
        return np.zeros(0, np.bool_)
    points = np.concatenate([vertices for vertices, _ in surfaces])
    sizes = [len(vertices) for vertices, _ in surfaces]
    firsts = np.cumsum([0, *sizes[:-1]])
    faces = np.concatenate([corners + first for (_, corners), first in zip(
        surfaces, firsts.tolist(), strict=True)])  # fmt: skip
    owner = np.repeat(np.arange(count), sizes)
    places = _places(points, owner)
    corners = places[faces]
    start = corners.reshape(-1)
    end = np.roll(corners, -1, axis=1).reshape(-1)
    # Passed upward counts one, passed downward minus one; what is left of an edge is a rim.
    low, high = np.minimum(start, end), np.maximum(start, end)
    way = np.sign(end - start)
    key = low.astype(np.int64) * (int(places.max(initial=0)) + 1) + high
    _, edge = np.unique(key, return_inverse=True)
    edge = edge.reshape(-1)
    left = np.bincount(edge, way, minlength=int(edge.max(initial=-1)) + 1) != 0
    closed = np.ones(count, np.bool_)
    closed[owner[faces[:, 0]].repeat(3)[left[edge]]] = False
    return closed


def _places(points: Array, owner: Array) -> Array:
    """Numbers (n,) that are the same for vertices at the same place of the same surface."""
    order = np.lexsort((points[:, 2], points[:, 1], points[:, 0], owner))
    sorted_points, sorted_owner = points[order], owner[order]
    fresh = np.ones(len(points), np.bool_)
    fresh[1:] = np.any(sorted_points[1:] != sorted_points[:-1], axis=1)
    fresh[1:] |= sorted_owner[1:] != sorted_owner[:-1]
    made = np.empty(len(points), np.int64)
    made[order] = np.cumsum(fresh) - 1
    return made

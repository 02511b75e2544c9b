"""Polygons, fans and strips as triangles of vertex indices (COLLADA 1.5 §polylist … §tristrips)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["corner_layout", "triangulated"]

Array = NDArray[Any]


def corner_layout(rows: Any) -> tuple[Array, Array]:
    """How many indices a corner of primitives has (n,), and which is that of the vertex (n,)."""
    count = len(rows)
    inputs = rows.input
    stride = np.ones(count, np.int64)
    np.maximum.at(stride, inputs.owner, inputs.offset.astype(np.int64) + 1)
    offset = np.zeros(count, np.int64)
    vertex = np.array([semantic == "VERTEX" for semantic in inputs.semantic], np.bool_)
    offset[inputs.owner[vertex]] = inputs.offset[vertex]
    return stride, offset


def triangulated(rows: Any, name: str, points: list[Array]) -> list[Array]:
    """The triangles (m, 3) of each group of primitives; `points` are those of its mesh."""
    stride, offset = corner_layout(rows)
    lists: list[list[tuple[int, Array]]] = [[] for _ in range(len(rows))]
    _collect(lists, rows.p, rows.p.owner, stride, offset)
    if name == "polygons":
        _collect(lists, rows.ph.p, rows.ph.owner[rows.ph.p.owner], stride, offset)
    made = []
    for row, found in enumerate(lists):
        corners = [part for _, part in sorted(found, key=lambda entry: entry[0])]
        if name == "polylist":
            made.append(_polylist(corners, rows.vcount[row], points[row]))
        elif name == "tristrips":
            made.append(_joined([_strip(part) for part in corners]))
        elif name == "trifans":
            made.append(_joined([_fan(part) for part in corners]))
        else:
            made.append(_joined([_polygon(part, points[row]) for part in corners]))
    return made


def _collect(
    lists: list[list[tuple[int, Array]]], found: Any, owner: Array, stride: Array, offset: Array
) -> None:
    if not len(found):
        return
    values = found.value
    for place, (row, order) in enumerate(zip(owner.tolist(), found.ordinals.tolist(), strict=True)):
        corners = values[place][int(offset[row]) :: int(stride[row])].astype(np.int64)
        lists[row].append((order, corners))


def _polylist(lists: list[Array], sizes: Array, points: Array) -> Array:
    corners = np.concatenate(lists) if lists else np.zeros(0, dtype=np.int64)
    sizes = sizes.astype(np.int64)
    if len(sizes) and np.all(sizes == 3) and len(corners) == 3 * len(sizes):
        return np.asarray(corners.reshape(-1, 3))
    ends = np.cumsum(sizes)
    parts = [corners[end - size : end] for size, end in zip(sizes, ends, strict=True)]
    return _joined([_polygon(part, points) for part in parts])


def _joined(parts: list[Array]) -> Array:
    return np.concatenate(parts) if parts else np.zeros((0, 3), dtype=np.int64)


def _fan(corners: Array) -> Array:
    count = max(len(corners) - 2, 0)
    first = np.broadcast_to(corners[:1], (count,))
    return np.stack([first, corners[1 : count + 1], corners[2 : count + 2]], axis=1)


def _strip(corners: Array) -> Array:
    count = max(len(corners) - 2, 0)
    strip = np.stack([corners[:count], corners[1 : count + 1], corners[2 : count + 2]], axis=1)
    strip[1::2] = strip[1::2, ::-1]  # every other one is wound the other way
    return strip


def _polygon(corners: Array, points: Array) -> Array:
    """A polygon as triangles: a fan where it is convex, ears cut off where it is not."""
    if len(corners) <= 3 or len(points) == 0 or corners.max(initial=0) >= len(points):
        return _fan(corners)
    ring = points[corners]
    after = np.roll(ring, -1, axis=0)
    normal = np.cross(ring, after).sum(axis=0)
    turns = np.cross(after - ring, np.roll(after, -1, axis=0) - after) @ normal
    if np.all(turns >= 0):
        return _fan(corners)
    return _ears(corners, ring, normal)


def _ears(corners: Array, ring: Array, normal: Array) -> Array:
    left = list(range(len(corners)))
    triangles: list[list[int]] = []
    while len(left) > 3:
        for place in range(len(left)):
            a, b, d = left[place - 1], left[place], left[(place + 1) % len(left)]
            if _is_ear(ring, normal, a, b, d, left):
                break
        else:
            place, a, b, d = 0, left[-1], left[0], left[1]
        triangles.append([a, b, d])
        del left[place]
    triangles.append(left)
    return np.asarray(corners[np.array(triangles)])


def _is_ear(ring: Array, normal: Array, a: int, b: int, d: int, left: list[int]) -> bool:
    one, two, three = ring[a], ring[b], ring[d]
    if np.cross(two - one, three - two) @ normal <= 0:
        return False
    others = np.array([other for other in left if other not in (a, b, d)], np.int64)
    points = ring[others]
    sides = [
        np.cross(end - start, points - start) @ normal
        for start, end in ((one, two), (two, three), (three, one))
    ]
    return not bool(np.any(np.min(sides, axis=0) >= 0))

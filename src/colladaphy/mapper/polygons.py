"""Polygons of every kind as triangles of vertex indices (COLLADA 1.5 §triangles … §tristrips)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.document.nodes import text_of

__all__ = ["triangulate"]

Array = NDArray[Any]


def triangulate(group: etree._Element, name: str, points: Array) -> Array:
    """The triangles (m, 3) of a group of primitives."""
    stride, offset = 1, 0
    for given in group.iterchildren(c("input")):
        place = int(given.get("offset", "0"))
        stride = max(stride, place + 1)
        if given.get("semantic") == "VERTEX":
            offset = place
    lists = [_indices(p)[offset::stride] for p in _lists(group)]
    if name == "triangles":
        return _joined([corners[: len(corners) // 3 * 3].reshape(-1, 3) for corners in lists])
    if name == "polylist":
        counts = group.find(c("vcount"))
        sizes = _indices(counts) if counts is not None else np.zeros(0, dtype=np.int64)
        corners = np.concatenate(lists) if lists else np.zeros(0, dtype=np.int64)
        if len(sizes) and np.all(sizes == 3) and len(corners) == 3 * len(sizes):
            return corners.reshape(-1, 3)
        ends = np.cumsum(sizes)
        lists = [corners[end - size : end] for size, end in zip(sizes, ends, strict=True)]
    elif name == "tristrips":
        return _joined([_strip(corners) for corners in lists])
    elif name == "trifans":
        return _joined([_fan(corners) for corners in lists])
    return _joined([_polygon(corners, points) for corners in lists])


def _lists(group: etree._Element) -> Iterator[etree._Element]:
    """Every <p>, also of polygons with holes; not what an <extra> may hold by that name."""
    for child in group.iterchildren(c("p"), c("ph")):
        yield from child.iterchildren(c("p")) if child.tag == c("ph") else (child,)


def _indices(element: etree._Element) -> Array:
    return np.array(text_of(element).split(), dtype=np.int64)


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
    for other in left:
        if other in (a, b, d):
            continue
        point = ring[other]
        sides = [
            np.cross(end - start, point - start) @ normal
            for start, end in ((one, two), (two, three), (three, one))
        ]
        if min(sides) >= 0:
            return False
    return True

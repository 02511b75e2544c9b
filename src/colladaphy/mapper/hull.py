"""The convex hull of points in space, for geometries that are given as one.

Quickhull: begin with a tetrahedron; each face keeps the points in front of it, and the farthest of
them replaces the faces that it sees by a cone from their rim. Only the points of these faces are
looked at again, so that the time grows little faster than the number of points. Sums are taken in
one order, so that the bits are the same everywhere.
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
    hull = _Hull(points)
    hull.add([(a, b, d), (a, e, b), (b, e, d), (d, e, a)], np.delete(np.arange(len(points)), start))
    while hull.waiting:
        hull.take()
    return np.array(list(hull.faces.values()))


class _Hull:
    """Faces by number, each with the points in front of it."""

    def __init__(self, points: Array) -> None:
        self._points = points
        self.faces: dict[int, tuple[int, int, int]] = {}
        self.waiting: dict[int, Array] = {}
        """The points in front of faces, of those that have some; the farthest comes first."""
        self._planes: dict[int, tuple[float, float, float, float]] = {}
        self._edges: dict[tuple[int, int], int] = {}
        """The face on the left of each edge."""
        self._count = 0

    def add(self, faces: list[tuple[int, int, int]], loose: Array) -> None:
        """Add faces, and give each of the points to one that it is in front of, if there is one."""
        first = self._count
        self._count += len(faces)
        normals, offsets = _planes(self._points, np.array(faces))
        for number, (face, normal, offset) in enumerate(
            zip(faces, normals.tolist(), offsets.tolist(), strict=True), first
        ):
            one, two, three = face
            self.faces[number] = face
            self._planes[number] = (*normal, offset)
            self._edges[one, two] = self._edges[two, three] = self._edges[three, one] = number
        if not len(loose):
            return
        x, y, z = self._points[loose].T[:, :, None]
        heights = x * normals[:, 0] + y * normals[:, 1] + z * normals[:, 2] - offsets
        nearest = np.argmax(heights, axis=1)
        height = heights[np.arange(len(loose)), nearest]
        ahead = height > _TOLERANCE
        for face in np.unique(nearest[ahead]).tolist():
            mine = np.flatnonzero(ahead & (nearest == face))
            top = int(np.argmax(height[mine]))
            mine[0], mine[top] = mine[top], mine[0]
            self.waiting[first + face] = loose[mine]

    def take(self) -> None:
        """Take the farthest point in front of the face that waits the longest into the hull."""
        begin = next(iter(self.waiting))
        point = int(self.waiting[begin][0])
        x, y, z = self._points[point].tolist()
        seen, rim = {begin}, list[tuple[int, int]]()
        stack = [begin]
        while stack:
            one, two, three = self.faces[stack.pop()]
            for edge in ((one, two), (two, three), (three, one)):
                beyond = self._edges[edge[1], edge[0]]
                if beyond in seen:
                    continue
                a, b, c, d = self._planes[beyond]
                if a * x + b * y + c * z - d > _TOLERANCE:
                    seen.add(beyond)
                    stack.append(beyond)
        for number in sorted(seen):
            one, two, three = self.faces[number]
            for edge in ((one, two), (two, three), (three, one)):
                if self._edges[edge[1], edge[0]] not in seen:
                    rim.append(edge)
        loose = []
        for number in sorted(seen):
            one, two, three = self.faces.pop(number)
            del self._planes[number]
            for edge in ((one, two), (two, three), (three, one)):
                del self._edges[edge]
            if number in self.waiting:
                loose.append(self.waiting.pop(number))
        left = np.concatenate(loose)
        self.add([(*edge, point) for edge in rim], left[left != point])


def _planes(points: Array, faces: Array) -> tuple[Array, Array]:
    one, two, three = points[faces].transpose(1, 2, 0)
    (a, b, c), (d, e, f) = two - one, three - one
    normals = np.array([b * f - c * e, c * d - a * f, a * e - b * d])
    x, y, z = normals
    lengths = np.sqrt(x * x + y * y + z * z)
    normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    x, y, z = normals
    return normals.T, x * one[0] + y * one[1] + z * one[2]

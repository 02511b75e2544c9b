"""The surfaces of geometries, measured (COLLADA 1.5 §mesh, §convex_mesh).

Many are measured at once: most documents have few large ones or very many small ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import numbered, rows_among
from colladaphy.columns.spans import places_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.face_table import Faces, faces_of
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.source_table import sources_of

__all__ = ["Surfaces", "surfaces_of"]

Array = NDArray[Any]

_AT_ONCE = 1 << 20
"""Corners that are measured at once, so that the tables for it stay small."""


@dataclass(slots=True)
class Surfaces:
    """What is known of the faces of geometries (n,), equal points made one.

    Those that have faulty indices, numbers or none at all are left out.
    """

    geometries: Array
    """Their elements, in the order of the document."""
    closed: Array
    consistent: Array
    """Whether faces that share an edge are wound alike."""
    volumes: Array
    """With their signs; positive where they are wound outwards."""
    extents: Array
    """The largest sides of the boxes around them."""
    reaches: Array
    """How far their farthest points are from their origins."""
    dents: Array
    """How far they are from convex across their edges, if closed and wound outwards."""

    def rows_of(self, geometries: Array) -> Array:
        """The rows of geometries; -1 for those that are left out."""
        return rows_among(self.geometries, geometries)


def surfaces_of(context: Context) -> Surfaces:
    """The surfaces of all geometries that can be read."""
    return context.shared(_surfaces)


def _surfaces(context: Context) -> Surfaces:
    parts = [_measured(part) for part in _parts(context)]
    parts = [part for part in parts if part is not None] or [_NONE]
    columns = [np.concatenate([getattr(part, field.name) for part in parts])
               for field in fields(Surfaces)]  # fmt: skip
    return Surfaces(*columns)


_NONE = Surfaces(*([np.zeros(0, np.int64)] + 2 * [np.zeros(0, np.bool_)] + 4 * [np.zeros(0)]))


@dataclass(slots=True)
class _Part:
    """The faces of some geometries, with their points."""

    faces: Faces
    points: Array
    """(m, 3)."""
    counts: Array
    """(n,) how many of these each geometry has."""

    def take(self, good: Array) -> _Part:
        """Those of some geometries."""
        ends = np.cumsum(self.counts)
        points = self.points[places_of((ends - self.counts)[good], self.counts[good])]
        return _Part(self.faces.take(good), points, self.counts[good])


def _parts(context: Context) -> Iterator[_Part]:
    inputs, sources, faces = inputs_of(context), sources_of(context), faces_of(context)
    vertices = context.ordinals("vertices")
    around = context.ancestor(vertices, "geometry")
    # The last ones of a geometry count.
    at = context.places_in(around[::-1], faces.geometries)
    vertices = np.append(vertices[::-1], -1)[at].astype(np.int64)
    rows = np.append(inputs.sources, -1)[inputs.first(vertices, "POSITION")]
    good = (rows >= 0) & (faces.corner_counts > 0)
    good[good] = sources.is_readable(rows[good])
    good[good] = (sources.steps[rows[good]] >= 3) & (sources.counts[rows[good]] > 0)
    faces, rows = faces.take(np.flatnonzero(good)), rows[good]
    ends = np.cumsum(faces.corner_counts)
    begin = 0
    while begin < len(rows):
        before = int(ends[begin - 1]) if begin else 0
        end = int(np.searchsorted(ends, before + _AT_ONCE)) + 1
        mine = np.arange(begin, min(end, len(rows)))
        yield _Part(faces.take(mine), sources.items(rows[mine], 3), sources.counts[rows[mine]])
        begin = end


def _usable(part: _Part) -> _Part:
    """Those with numbers for points, with no corner beyond these, and three corners a face."""
    faces, every = part.faces, np.arange(len(part.counts))
    good = np.ones(len(every), np.bool_)
    good[np.repeat(every, part.counts)[~np.isfinite(part.points).all(axis=1)]] = False
    good[np.repeat(every, faces.size_counts)[faces.sizes < 3]] = False
    begin = np.cumsum(faces.corner_counts) - faces.corner_counts
    good &= np.maximum.reduceat(faces.corners, begin) < part.counts
    return part if good.all() else part.take(np.flatnonzero(good))


def _measured(part: _Part) -> Surfaces | None:
    part = _usable(part)
    count = len(part.counts)
    if not count:
        return None
    points, corners, home, first = _joined(part)
    sizes = part.faces.sizes
    starts = np.cumsum(sizes) - sizes
    owner = home[corners[starts]]
    """(k,) the geometry of each face."""
    triangles = _triangles(corners, starts, sizes)
    mine = np.repeat(owner, sizes - 2)
    """(m,) the geometry of each triangle."""
    edges = _Edges(triangles, mine, count)
    least, most = np.minimum.reduceat(points, first), np.maximum.reduceat(points, first)
    extents = (most - least).max(axis=1)
    counts = np.diff(np.append(first, len(points)))
    middles = np.add.reduceat(points, first) / counts[:, None]
    one, two, three = (points[triangles[:, k]] - middles[mine] for k in range(3))
    begin = np.searchsorted(mine, np.arange(count))
    volumes = np.add.reduceat(np.sum(np.cross(one, two) * three, axis=1), begin) / 6.0
    reaches = np.maximum.reduceat(np.linalg.norm(points, axis=1), first)
    dents = edges.dents(points, edges.consistent & (volumes > 0.0))
    return Surfaces(
        part.faces.geometries, edges.closed, edges.consistent, volumes, extents, reaches, dents
    )


def _joined(part: _Part) -> tuple[Array, Array, Array, Array]:
    """The different points of all, the corners as numbers of these, their geometries, the firsts.

    The points of a geometry stand together.
    """
    base = np.cumsum(part.counts) - part.counts
    points = part.points + 0.0
    home = np.repeat(np.arange(len(base)), part.counts)
    corners = part.faces.corners + np.repeat(base, part.faces.corner_counts)
    order = np.lexsort((points[:, 2], points[:, 1], points[:, 0], home))
    points, home = points[order], home[order]
    new = np.ones(len(points), np.bool_)
    new[1:] = (points[1:] != points[:-1]).any(axis=1) | (home[1:] != home[:-1])
    number = np.empty(len(points), np.int64)
    number[order] = np.cumsum(new) - 1
    home = home[new]
    return points[new], number[corners], home, np.searchsorted(home, np.arange(len(base)))


def _triangles(corners: Array, starts: Array, sizes: Array) -> Array:
    """The fans (m, 3) of faces."""
    faces = sizes - 2
    first = np.cumsum(faces) - faces
    number = np.arange(int(faces.sum())) - np.repeat(first, faces)
    begin = np.repeat(starts, faces)
    return np.stack(
        [corners[begin], corners[begin + number + 1], corners[begin + number + 2]], axis=1
    )


class _Edges:
    """The edges of triangles, those across faces included, and those that run beside them.

    What is across a face is there along both ways, so that it counts for nothing.
    """

    def __init__(self, triangles: Array, mine: Array, count: int) -> None:
        first, second, third = triangles.T
        self._from = np.concatenate([first, second, third])
        self._to = np.concatenate([second, third, first])
        self._opposite = np.concatenate([third, first, second])
        self._triangles, self._mine = triangles, np.tile(mine, 3)
        width = int(triangles.max()) + 1
        forward, backward = self._from * width + self._to, self._to * width + self._from
        self._beside = np.empty_like(forward)
        self._beside[np.argsort(backward)] = np.argsort(forward)
        self._even: Array = forward[self._beside] == backward
        self.consistent = np.ones(count, np.bool_)
        """Of which geometries as many run along one way as along the other."""
        self.consistent[self._mine[~self._even]] = False
        self.closed = self._closed(width)
        """Of which geometries all edges are there twice, or as many times as that."""

    def _closed(self, width: int) -> Array:
        made = np.ones(len(self.consistent), np.bool_)
        left = np.flatnonzero(~self.consistent[self._mine] & (self._from != self._to))
        one, other = self._from[left], self._to[left]
        first, which = numbered(np.minimum(one, other) * width + np.maximum(one, other))
        made[self._mine[left[first[np.bincount(which) % 2 == 1]]]] = False
        return made

    def dents(self, points: Array, wanted: Array) -> Array:
        """How far surfaces (n,) that are closed and wound outwards are from convex across edges."""
        made = np.zeros(len(wanted))
        if not wanted.any():
            return made
        one, two, three = (points[self._triangles[:, k]] for k in range(3))
        normals = np.cross(two - one, three - one)
        length = np.linalg.norm(normals, axis=1)
        sizes = np.zeros(len(wanted))
        count = len(self._triangles)
        np.maximum.at(sizes, self._mine[:count], length)
        owner = np.tile(np.arange(count), 3)
        good = self._even & wanted[self._mine] & (length[owner] > 1e-12 * sizes[self._mine])
        here, there = owner[good], self._opposite[self._beside[good]]
        heights = np.sum(normals[here] * (points[there] - one[here]), axis=1) / length[here]
        np.maximum.at(made, self._mine[here], heights)
        return made

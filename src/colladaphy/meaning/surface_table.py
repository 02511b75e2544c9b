"""The surfaces of geometries, measured (COLLADA 1.5 §mesh, §convex_mesh).

Many are measured at once: most documents have few large ones or very many small ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.meaning.arrays import sources_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.primitives import groups_of, miscounted

__all__ = ["Surface", "surface_of"]

Array = NDArray[Any]

_AT_ONCE = 1 << 20
"""Corners that are measured at once, so that the tables for it stay small."""


@dataclass(slots=True)
class Surface:
    """What is known of the faces of a geometry, equal points made one."""

    is_closed: bool
    is_consistent: bool
    """Whether faces that share an edge are wound alike."""
    volume: float
    """With its sign; positive where it is wound outwards."""
    extent: float
    """The largest side of the box around it."""
    reach: float
    """How far its farthest point is from the origin."""
    dent: float
    """How far it is from convex across its edges, if it is closed and wound outwards."""


def surface_of(context: Context, geometry: int) -> Surface | None:
    """The surface of a geometry; None where it has faulty indices, numbers or none at all."""
    return context.shared(_surfaces).get(geometry)


def _surfaces(context: Context) -> dict[int, Surface]:
    """The surfaces of all geometries that can be read."""
    found: dict[int, Surface] = {}
    waiting: list[_Faces] = []
    corners = 0
    for faces in _readable(context):
        waiting.append(faces)
        corners += len(faces.corners)
        if corners >= _AT_ONCE:
            found.update(_measured(waiting))
            waiting, corners = [], 0
    found.update(_measured(waiting))
    return found


@dataclass(slots=True)
class _Faces:
    """The faces of one geometry."""

    geometry: int
    points: Array
    """(n, 3)."""
    corners: Array
    """(m,) the points of all faces, one after the other."""
    sizes: Array
    """(k,) the corners of each face."""


def _readable(context: Context) -> Iterator[_Faces]:
    inputs, sources = inputs_of(context), sources_of(context)
    vertices = context.ordinals("vertices")
    at = dict(zip(context.ancestor(vertices, "geometry").tolist(), vertices.tolist(), strict=True))
    for geometry, rings in _rings(context).items():
        source = inputs.source(at[geometry], "POSITION") if geometry in at else -1
        points = None if source < 0 else sources.numbers(source)
        if points is None or points.shape[1] < 3:
            continue
        corners, sizes = rings[0]
        if len(rings) > 1:
            corners = np.concatenate([part for part, _ in rings])
            sizes = np.concatenate([part for _, part in rings])
        if len(corners) and len(points):
            yield _Faces(geometry, points[:, :3], corners, sizes)


def _usable(faces: list[_Faces]) -> list[_Faces]:
    """Those with numbers for points, with no corner beyond these, and three corners a face."""
    good = np.ones(len(faces), np.bool_)
    for parts, wrong in (
        ([each.points for each in faces], lambda points: ~np.isfinite(points).all(axis=1)),
        ([each.sizes for each in faces], lambda sizes: counted(sizes) < 3),
    ):
        owner = np.repeat(np.arange(len(faces)), [len(part) for part in parts])
        good[owner[wrong(np.concatenate(parts))]] = False
    lengths = np.array([len(each.corners) for each in faces])
    corners = counted(np.concatenate([each.corners for each in faces]))
    most = np.maximum.reduceat(corners, np.cumsum(lengths) - lengths)
    good &= most < [len(each.points) for each in faces]
    return [faces[row] for row in np.flatnonzero(good).tolist()]


def _rings(context: Context) -> dict[int, list[tuple[Array, Array]]]:
    """The corners, and the sizes, of the faces of each geometry."""
    inputs, groups = inputs_of(context), groups_of(context)
    elements = np.array([group.element for group in groups], np.int64)
    around = context.ancestor(elements, "geometry").tolist()
    # Of what is not counted right, nobody can tell the faces.
    faulty = miscounted(context)
    wrong = {at for group, at in zip(groups, around, strict=True) if group.element in faulty}
    found: dict[int, list[tuple[Array, Array]]] = {}
    for group, geometry in zip(groups, around, strict=True):
        row = inputs.named(group.element, "VERTEX")
        if geometry < 0 or geometry in wrong or row < 0 or group.name in ("lines", "linestrips"):
            continue
        made = found.setdefault(geometry, [])
        for _, values in group.parts:
            part = values[int(inputs.offsets[row]) :: group.stride]
            if group.name == "triangles":
                made.append((part[: len(part) // 3 * 3], np.full(len(part) // 3, 3)))
            elif group.name == "polylist":
                if group.vcount is not None and int(group.vcount[1].sum()) == len(part):
                    made.append((part, group.vcount[1]))
            elif group.name == "polygons":
                made.append((part, np.array([len(part)])))
            elif len(part) > 2:
                count = len(part) - 2
                first = np.broadcast_to(part[:1], (count,))
                if group.name == "tristrips":
                    first = part[:count]
                fan = np.stack([first, part[1:-1], part[2:]], axis=1)
                if group.name == "tristrips":
                    fan[1::2] = fan[1::2, ::-1]
                made.append((fan.reshape(-1), np.full(count, 3)))
    return {geometry: rings for geometry, rings in found.items() if rings}


def _measured(faces: list[_Faces]) -> Iterator[tuple[int, Surface]]:
    faces = _usable(faces) if faces else []
    if not faces:
        return
    points, corners, home, first = _joined(faces)
    sizes = counted(np.concatenate([each.sizes for each in faces]))
    starts = np.cumsum(sizes) - sizes
    owner = home[corners[starts]]
    """(k,) the geometry of each face."""
    triangles = _triangles(corners, starts, sizes)
    mine = np.repeat(owner, sizes - 2)
    """(m,) the geometry of each triangle."""
    edges = _Edges(triangles, mine, len(first))
    least, most = np.minimum.reduceat(points, first), np.maximum.reduceat(points, first)
    extents = (most - least).max(axis=1)
    counts = np.diff(np.append(first, len(points)))
    middles = np.add.reduceat(points, first) / counts[:, None]
    one, two, three = (points[triangles[:, k]] - middles[mine] for k in range(3))
    begin = np.searchsorted(mine, np.arange(len(faces)))
    volumes = np.add.reduceat(np.sum(np.cross(one, two) * three, axis=1), begin) / 6.0
    reaches = np.maximum.reduceat(np.linalg.norm(points, axis=1), first)
    dents = edges.dents(points, edges.consistent & (volumes > 0.0))
    columns = (edges.closed, edges.consistent, volumes, extents, reaches, dents)
    for each, *values in zip(faces, *(column.tolist() for column in columns), strict=True):
        yield each.geometry, Surface(*values)


def _joined(faces: list[_Faces]) -> tuple[Array, Array, Array, Array]:
    """The different points of all, the corners as numbers of these, their geometries, the firsts.

    The points of a geometry stand together.
    """
    counts = np.array([len(each.points) for each in faces])
    base = np.cumsum(counts) - counts
    points = np.concatenate([each.points for each in faces]) + 0.0
    home = np.repeat(np.arange(len(faces)), counts)
    corners = counted(np.concatenate([each.corners for each in faces]))
    corners += np.repeat(base, [len(each.corners) for each in faces])
    order = np.lexsort((points[:, 2], points[:, 1], points[:, 0], home))
    points, home = points[order], home[order]
    new = np.ones(len(points), np.bool_)
    new[1:] = (points[1:] != points[:-1]).any(axis=1) | (home[1:] != home[:-1])
    number = np.empty(len(points), np.int64)
    number[order] = np.cumsum(new) - 1
    home = home[new]
    return points[new], number[corners], home, np.searchsorted(home, np.arange(len(faces)))


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
        _, first, counts = np.unique(
            np.minimum(one, other) * width + np.maximum(one, other), return_index=True,
            return_counts=True,
        )  # fmt: skip
        made[self._mine[left[first[counts % 2 == 1]]]] = False
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

"""The faces of geometries, whatever primitives they are of (COLLADA 1.5 §triangles … §tristrips).

Fans and strips are taken apart into triangles; a hole in a polygon is a face of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among, numbered
from colladaphy.columns.spans import places_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.primitive_table import Primitives, primitives_of
from colladaphy.meaning.primitives import miscounted

__all__ = ["Faces", "faces_of"]

Array = NDArray[Any]


@dataclass(slots=True)
class Faces:
    """The faces of geometries, those of one behind those of another."""

    geometries: Array
    """(n,) their elements, ascending."""
    corners: Array
    """The points of all faces."""
    corner_counts: Array
    """(n,) how many corners the faces of each geometry have."""
    sizes: Array
    """The corners of each face."""
    size_counts: Array
    """(n,) how many faces each geometry has."""

    def take(self, rows: Array) -> Faces:
        """Those of some geometries, or in another order."""
        every = len(rows) == len(self.geometries)
        if every and bool(np.all(rows[1:] > rows[:-1])):
            return self
        corners, sizes = self.corner_counts, self.size_counts
        return Faces(
            self.geometries[rows],
            self.corners[places_of((np.cumsum(corners) - corners)[rows], corners[rows])],
            corners[rows],
            self.sizes[places_of((np.cumsum(sizes) - sizes)[rows], sizes[rows])],
            sizes[rows],
        )


def faces_of(context: Context) -> Faces:
    """The faces of all geometries whose primitives have what they say."""
    table = primitives_of(context)
    around = context.ancestor(table.elements, "geometry")
    # Of what is not counted right, nobody can tell the faces.
    wrong = around[sorted(miscounted(context))]
    good = (around >= 0) & ~are_among(around, wrong)
    inputs = inputs_of(context)
    rows = inputs.first(table.elements, "VERTEX")
    good &= rows >= 0
    offsets = np.append(inputs.offsets, 0)[rows]
    lists = np.flatnonzero(table.list_owners >= 0)
    lists = lists[good[table.list_owners[lists]]]
    parts = [part for part in _parts(table, lists, offsets) if len(part.geometries)]
    if not parts:
        none = np.zeros(0, np.int64)
        return Faces(none, none, none, none, none)
    every = Faces(*(np.concatenate(columns) for columns in zip(*map(_columns, parts), strict=True)))
    # Until here the geometries are rows of primitives, a list each.
    every.geometries = around[every.geometries]
    ordered = every.take(np.argsort(every.geometries, kind="stable"))
    return _merged(ordered)


def _columns(faces: Faces) -> tuple[Array, ...]:
    return (faces.geometries, faces.corners, faces.corner_counts, faces.sizes, faces.size_counts)


def _merged(faces: Faces) -> Faces:
    """The faces of lists, with the lists of a geometry made one."""
    first, _ = numbered(faces.geometries)
    return Faces(
        faces.geometries[first], faces.corners, np.add.reduceat(faces.corner_counts, first),
        faces.sizes, np.add.reduceat(faces.size_counts, first),
    )  # fmt: skip


def _parts(table: Primitives, lists: Array, offsets: Array) -> Iterator[Faces]:
    """The faces of some lists, by their primitives."""
    for names, make in (
        (("triangles",), _triangles), (("polylist",), _polylist), (("polygons",), _polygons),
        (("trifans",), _fans), (("tristrips",), _strips),
    ):  # fmt: skip
        mine = lists[table.kind(*names)[table.list_owners[lists]]]
        if not len(mine):
            continue
        owners = table.list_owners[mine]
        strides, starts = table.strides[owners], offsets[owners]
        counts = -(-(table.list_lengths[mine] - starts) // strides)
        counts = np.maximum(counts, 0)
        starts = starts + table.list_starts[mine]
        if names == ("triangles",):
            counts = counts // 3 * 3
        corners = table.indices
        if int(counts.sum()) < len(corners):
            corners = corners[places_of(starts, counts, strides)]
        yield make(table, owners, corners, counts)


def _triangles(table: Primitives, owners: Array, corners: Array, counts: Array) -> Faces:
    return Faces(owners, corners, counts, np.full(int(counts.sum()) // 3, 3), counts // 3)


def _polygons(table: Primitives, owners: Array, corners: Array, counts: Array) -> Faces:
    return Faces(owners, corners, counts, counts, np.ones(len(owners), np.int64))


def _polylist(table: Primitives, owners: Array, corners: Array, counts: Array) -> Faces:
    there = table.vcounts[owners] >= 0
    every = Faces(owners, corners, counts, np.zeros(0, np.int64), np.zeros(len(owners), np.int64))
    some = every.take(np.flatnonzero(there))
    some.sizes, some.size_counts = table.sizes_of(some.geometries)
    rows = np.repeat(np.arange(len(some.geometries)), some.size_counts)
    sums = np.bincount(rows, some.sizes, minlength=len(some.geometries))
    return some.take(np.flatnonzero(sums == some.corner_counts))


def _fans(table: Primitives, owners: Array, corners: Array, counts: Array) -> Faces:
    return _unfolded(owners, corners, counts, is_strip=False)


def _strips(table: Primitives, owners: Array, corners: Array, counts: Array) -> Faces:
    return _unfolded(owners, corners, counts, is_strip=True)


def _unfolded(owners: Array, corners: Array, counts: Array, *, is_strip: bool) -> Faces:
    """Triangles between the first corner and each edge, or each corner and the edge behind it."""
    starts = np.cumsum(counts) - counts
    faces = np.maximum(counts - 2, 0)
    second = places_of(starts + 1, faces)
    first = second - 1 if is_strip else np.repeat(starts, faces)
    made = np.stack([corners[first], corners[second], corners[second + 1]], axis=1)
    if is_strip:
        odd = (second - np.repeat(starts, faces)) % 2 == 0
        made[odd] = made[odd, ::-1]
    return Faces(owners, made.reshape(-1), 3 * faces, np.full(len(made), 3), faces)

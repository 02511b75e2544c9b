"""Polygons, fans and strips as triangles of vertex indices (COLLADA 1.5 §polylist … §tristrips)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.mapper.loading.ears import triangles_of

__all__ = ["corner_layout", "triangulated"]

Array = NDArray[Any]


def corner_layout(rows: Any) -> tuple[Array, Array]:
    """How many indices a corner of primitives has (n,), and which is that of the vertex (n,)."""
    count = len(rows)
    inputs = rows.input
    stride = np.ones(count, np.int64)
    offsets = counted(inputs.offset)
    np.maximum.at(stride, inputs.owner, offsets + 1)
    offset = np.zeros(count, np.int64)
    vertex = np.array([semantic == "VERTEX" for semantic in inputs.semantic], np.bool_)
    offset[inputs.owner[vertex]] = offsets[vertex]
    return stride, offset


def triangulated(rows: Any, name: str, points: list[Array]) -> list[Array]:
    """The triangles (m, 3) of each group of primitives; `points` are those of its mesh."""
    stride, offset = corner_layout(rows)
    lists: list[list[tuple[int, Array]]] = [[] for _ in range(len(rows))]
    _collect(lists, rows.p, rows.p.owner, stride, offset)
    holed: list[list[tuple[int, Array]]] = [[] for _ in range(len(rows))]
    if name == "polygons" and len(rows.ph):
        _collect(holed, rows.ph.p, rows.ph.owner[rows.ph.p.owner], stride, offset)
        holes = _holes(rows.ph, stride, offset)
        for row, found in enumerate(holed):
            lists[row] += [
                (order, _with_holes(part, holes.get(int(order), []), points[row]))
                for order, part in found
            ]
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
            made.append(_with_holed(corners, points[row]))
    return made


def _holes(outlines: Any, stride: Array, offset: Array) -> dict[int, list[Array]]:
    """The holes of polygons, by the element of the outline."""
    inner = outlines.h
    element = dict(zip(outlines.p.owner.tolist(), outlines.p.ordinals.tolist(), strict=True))
    made: dict[int, list[Array]] = {}
    for place, owner in enumerate(inner.owner.tolist()):
        row = int(outlines.owner[owner])
        corners = counted(inner.value[place][int(offset[row]) :: int(stride[row])])
        made.setdefault(element[owner], []).append(corners)
    return made


def _collect(
    lists: list[list[tuple[int, Array]]], found: Any, owner: Array, stride: Array, offset: Array
) -> None:
    if not len(found):
        return
    values = found.value
    for place, (row, order) in enumerate(zip(owner.tolist(), found.ordinals.tolist(), strict=True)):
        corners = counted(values[place][int(offset[row]) :: int(stride[row])])
        lists[row].append((order, corners))


def _polylist(lists: list[Array], sizes: Array, points: Array) -> Array:
    corners = np.concatenate(lists) if lists else np.zeros(0, dtype=np.int64)
    sizes = counted(sizes)
    if len(sizes) and np.all(sizes == 3) and len(corners) == 3 * len(sizes):
        return np.asarray(corners.reshape(-1, 3))
    return _all_polygons(corners, sizes, points)


def _with_holed(lists: list[Array], points: Array) -> Array:
    """Outlines of polygons (one dimension) as triangles, between those that are (m, 3) already."""
    plain = [part for part in lists if part.ndim == 1]
    sizes = np.array([len(part) for part in plain], np.int64)
    corners = np.concatenate(plain) if plain else np.zeros(0, np.int64)
    made = _all_polygons(corners, sizes, points)
    if len(plain) == len(lists):
        return made
    cut = iter(np.split(made, np.cumsum(np.maximum(sizes - 2, 0))))
    return _joined([part if part.ndim == 2 else next(cut) for part in lists])


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


def _all_polygons(corners: Array, sizes: Array, points: Array) -> Array:
    """Polygons one after the other as triangles: fans where they are convex, else ears cut off.

    All of one size are looked at together.
    """
    ends = np.cumsum(sizes)
    starts = ends - sizes
    sizes = np.maximum(np.minimum(ends, len(corners)) - starts, 0)  # of what is there
    counts = np.maximum(sizes - 2, 0)
    places = np.cumsum(counts) - counts
    made = np.empty((int(counts.sum()), 3), np.int64)
    for size in np.unique(sizes[sizes >= 3]).tolist():
        rows = np.flatnonzero(sizes == size)
        rings = corners[starts[rows][:, None] + np.arange(size)]
        first = np.broadcast_to(rings[:, :1], (len(rows), size - 2))
        fans = np.stack([first, rings[:, 1:-1], rings[:, 2:]], axis=2)
        for row in _not_convex(rings, points).tolist():
            fans[row] = _with_holes(rings[row], [], points)
        made[places[rows][:, None] + np.arange(size - 2)] = fans
    return made


def _not_convex(rings: Array, points: Array) -> Array:
    """The polygons (n, k) that turn both ways; none of what has corners that are not there."""
    there = np.flatnonzero(rings.max(axis=1) < len(points))
    if rings.shape[1] <= 3 or not len(there):
        return np.zeros(0, np.int64)
    ring = points[rings[there]]
    after = np.roll(ring, -1, axis=1)
    edge = after - ring
    normal = np.cross(ring, after).sum(axis=1)[:, None]
    turns = np.cross(edge, np.roll(edge, -1, axis=1)) * normal
    # Summed up one by one, so that it is the same on every machine.
    along = turns[..., 0] + turns[..., 1] + turns[..., 2]
    return np.asarray(there[~np.all(along >= 0, axis=1)])


def _with_holes(corners: Array, holes: list[Array], points: Array) -> Array:
    """A polygon with holes as triangles, whichever way these are wound."""
    every = np.concatenate([corners, *holes])
    if len(corners) < 3 or not len(points) or every.min() < 0 or every.max() >= len(points):
        return _fan(every[: max(3, len(corners))])
    ring = points[corners]
    normal = np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0)
    # As seen along the axis that it faces most, which keeps all turns.
    axis = int(np.argmax(np.abs(normal)))
    first, second = ((1, 2), (2, 0), (0, 1))[axis]
    flat = list(map(tuple, points[every][:, [first, second]].tolist()))
    ends = np.cumsum([len(corners), *(len(hole) for hole in holes)]).tolist()
    parts = [flat[start:end] for start, end in zip([0, *ends], ends, strict=False)]
    return np.asarray(every[np.array(triangles_of(parts[0], parts[1:]), np.int64)])

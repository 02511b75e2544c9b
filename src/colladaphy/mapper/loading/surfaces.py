"""Vertices and triangles of meshes, from their sources and primitives (COLLADA 1.5 §mesh).

What most meshes are, one source of positions and one list of triangles, is read for all of them at
once; other primitives are turned into triangles one by one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.links.pool import expanded
from colladaphy.mapper.loading.polygons import corner_layout, triangulated

__all__ = ["Surface", "read_surfaces"]

Array = NDArray[Any]

_PRIMITIVES = ("triangles", "polylist", "polygons", "trifans", "tristrips")
_NO_FACES = np.zeros((0, 3), np.int64)


@dataclass(slots=True)
class Surface:
    """The surface of one mesh, or why there is none."""

    vertices: Array
    """(n, 3)."""
    faces: Array
    """(m, 3)."""
    fault: str | None = None


def read_surfaces(meshes: Any) -> list[Surface]:
    """The surfaces of rows of mesh or convex_mesh."""
    count = len(meshes)
    vertices, faults = _vertices(meshes)
    faces: list[list[tuple[int, Array]]] = [[] for _ in range(count)]
    for name in _PRIMITIVES:
        rows = getattr(meshes, name)
        if not len(rows):
            continue
        if name == "triangles":
            made = _triangles(rows)
        else:
            made = triangulated(rows, name, [vertices[mesh] for mesh in rows.owner.tolist()])
        for mesh, order, found in zip(
            rows.owner.tolist(), rows.ordinals.tolist(), made, strict=True
        ):
            faces[mesh].append((order, found))
    surfaces = []
    for mesh in range(count):
        parts = [found for _, found in sorted(faces[mesh], key=lambda part: part[0])]
        corners = parts[0] if len(parts) == 1 else np.concatenate(parts) if parts else _NO_FACES
        fault = faults[mesh]
        points = vertices[mesh]
        if (
            fault is None
            and len(corners)
            and (int(corners.min()) < 0 or int(corners.max()) >= len(points))
        ):
            fault = "A face names a vertex that there is not."
        surfaces.append(Surface(points, corners, fault))
    return surfaces


# --- vertices


def _vertices(meshes: Any) -> tuple[list[Array], list[str | None]]:
    """The positions (n, 3) of each mesh, and why there are none."""
    count = len(meshes)
    faults: list[str | None] = ["The mesh has no source of positions."] * count
    found: list[Array] = [np.zeros((0, 3))] * count
    sources = meshes.source
    inputs = meshes.vertices.input
    rows = {f"#{id}": row for row, id in enumerate(sources.id)}
    owner = sources.owner.tolist()
    mesh_of = meshes.vertices.owner[inputs.owner].tolist()
    wanted = np.full(count, -1, np.int64)
    for mesh, semantic, source in zip(mesh_of, inputs.semantic, inputs.source, strict=True):
        if semantic == "POSITION":
            row = rows.get(source.strip(), -1)
            wanted[mesh] = row if row >= 0 and owner[row] == mesh else -1
    there = np.flatnonzero(wanted >= 0)
    points, broken = _source_rows(sources, wanted[there])
    for mesh, rows_of, fault in zip(there.tolist(), points, broken, strict=True):
        found[mesh], faults[mesh] = rows_of, fault
    return found, faults


def _source_rows(sources: Any, wanted: Array) -> tuple[list[Array], list[str | None]]:
    """The rows (n, 3) that the accessors of sources select from their arrays."""
    count = len(wanted)
    arrays, accessors = sources.float_array, sources.technique_common.accessor
    array_of = np.full(len(sources), -1, np.int64)
    array_of[arrays.owner] = np.arange(len(arrays))
    accessor_of = np.full(len(sources), -1, np.int64)
    accessor_of[sources.technique_common.owner[accessors.owner]] = np.arange(len(accessors))
    array, accessor = array_of[wanted], accessor_of[wanted]
    good = (array >= 0) & (accessor >= 0)
    ids = sources.id
    faults: list[str | None] = [
        None if fine else f"The source {ids[row]!r} has no numbers."
        for row, fine in zip(wanted.tolist(), good.tolist(), strict=True)
    ]
    mine = np.flatnonzero(good)
    numbers = arrays.select(np.unique(array[mine])) if len(mine) < len(arrays) else arrays
    place = np.searchsorted(np.unique(array[mine]), array[mine]) if len(mine) < len(arrays) else (
        array[mine])  # fmt: skip
    values = numbers.value if len(mine) else None
    result = [np.zeros((0, 3))] * count
    if values is None:
        return result, faults
    begin, end = values.offsets[place], values.offsets[place + 1]
    counts = counted(accessors.count[accessor[mine]])
    stride = counted(accessors.stride[accessor[mine]])
    offset = counted(accessors.offset[accessor[mine]])
    places = _named_places(accessors)[accessor[mine]]
    last = offset + (counts - 1) * stride + places.max(axis=1, initial=0)
    short = (stride < 1) | ((counts > 0) & (last >= end - begin))
    for at in np.flatnonzero(short).tolist():
        faults[mine[at]] = f"The source {ids[wanted[mine[at]]]!r} has fewer numbers than it says."
    fine = np.flatnonzero(~short)
    step, who = expanded(np.zeros(len(fine), np.int64), counts[fine])
    start = (begin + offset)[fine][who] + step * stride[fine][who]
    rows = values.values[start[:, None] + places[fine][who]]
    cuts = np.cumsum(counts[fine])
    for at, stop, size in zip(fine.tolist(), cuts.tolist(), counts[fine].tolist(), strict=True):
        result[mine[at]] = rows[stop - size : stop]
    return result, faults


def _named_places(accessors: Any) -> Array:
    """Which three numbers of a row the named params of accessors (n, 3) are."""
    params = accessors.param
    count = len(accessors)
    places = np.tile(np.arange(3), (count, 1))
    named = np.array([bool(name) for name in params.name], np.bool_)
    sizes = np.bincount(params.owner, minlength=count)
    names = np.bincount(params.owner[named], minlength=count)
    first = np.cumsum(sizes) - sizes
    for row in np.flatnonzero((names >= 3) & (sizes != 3)).tolist():
        mine = named[first[row] : first[row] + sizes[row]]
        places[row] = np.flatnonzero(mine)[:3]
    return places


# --- triangles


def _triangles(rows: Any) -> list[Array]:
    """The faces (m, 3) of each list of triangles."""
    stride, offset = corner_layout(rows)
    lists = rows.p
    if not len(lists):
        return [_NO_FACES] * len(rows)
    values = lists.value
    sizes = np.diff(values.offsets)
    owner = lists.owner
    mine_stride, mine_offset = stride[owner], offset[owner]
    corners = np.maximum(sizes - mine_offset + mine_stride - 1, 0) // mine_stride
    counts = corners // 3 * 3
    step, who = expanded(np.zeros(len(counts), np.int64), counts)
    indices = values.values[values.offsets[:-1][who] + mine_offset[who] + step * mine_stride[who]]
    faces = counted(indices).reshape(-1, 3)
    result = [_NO_FACES] * len(rows)
    stops = np.cumsum(counts) // 3
    for row, stop, size in zip(owner.tolist(), stops.tolist(), (counts // 3).tolist(), strict=True):
        result[row] = faces[stop - size : stop]
    return result

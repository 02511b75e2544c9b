"""Meshes as geometries: one source of positions, one list of triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy_schema.core_columns import (
    AccessorTypeRows,
    FloatArrayTypeRows,
    InputLocalOffsetTypeRows,
    InputLocalTypeRows,
    ParamTypeRows,
    PTypeRows,
    SourceTypeRows,
    SourceTypeTechniqueCommonRows,
)
from colladaphy_schema.geometry_columns import (
    ConvexMeshTypeRows,
    MeshTypeRows,
    TrianglesTypeRows,
    VerticesTypeRows,
)
from colladaphy_schema.geometry_library_columns import GeometryTypeRows
from colladaphy_schema.rows import Lists

if TYPE_CHECKING:
    from colladaphy.world import Mesh

__all__ = ["geometries_of"]

Array = NDArray[Any]


def geometries_of(meshes: Sequence[tuple[str, Mesh]], nothing: str | None) -> GeometryTypeRows:
    """The geometry of each mesh, its vertices and faces as they are stored, by its id.

    `nothing` is the id of one more, the convex hull of no points.
    """
    count = len(meshes)
    every = count + (nothing is not None)
    rows = GeometryTypeRows(every, np.zeros(every, np.int64))
    rows.id = [id for id, _ in meshes] + ([] if nothing is None else [nothing])
    convex = np.array([mesh.convex for _, mesh in meshes], dtype=np.bool_)
    if convex.any() or nothing is not None:
        there = np.flatnonzero(convex)
        hulls = ConvexMeshTypeRows(
            len(there) + every - count, np.append(there, np.arange(count, every))
        )
        _fill(hulls, [meshes[row] for row in there.tolist()])
        rows.convex_mesh = hulls
    if not convex.all():
        there = np.flatnonzero(~convex)
        plain = MeshTypeRows(len(there), there)
        _fill(plain, [meshes[row] for row in there.tolist()])
        rows.mesh = plain
    return rows


def _fill(rows: ConvexMeshTypeRows | MeshTypeRows, meshes: Sequence[tuple[str, Mesh]]) -> None:
    """Fill the first of the rows with the meshes."""
    if not meshes:
        return
    ids = [id for id, _ in meshes]
    points = _lists([mesh.vertices for _, mesh in meshes])
    corners = _lists([mesh.faces for _, mesh in meshes])
    rows.source = _sources(ids, points)
    rows.vertices = _vertices(ids)
    rows.triangles = _triangles(ids, corners)


def _lists(arrays: Sequence[Array]) -> Lists:
    ends = np.cumsum([array.size for array in arrays])
    return Lists(np.concatenate(arrays).reshape(-1), np.append(0, ends))


def _sources(ids: list[str], points: Lists) -> SourceTypeRows:
    count, numbers = len(ids), np.diff(points.offsets)
    rows = SourceTypeRows(count)
    rows.id = [f"{id}Positions" for id in ids]
    arrays = FloatArrayTypeRows(count)
    arrays.id = [f"{id}PositionsArray" for id in ids]
    arrays.count = numbers
    arrays.value = points
    rows.float_array = arrays
    rows.technique_common = common = SourceTypeTechniqueCommonRows(count)
    common.accessor = accessors = AccessorTypeRows(count)
    accessors.source = [f"#{id}PositionsArray" for id in ids]
    accessors.count = numbers // 3
    accessors.stride = np.full(count, 3)
    accessors.param = axes = ParamTypeRows(3 * count, np.repeat(np.arange(count), 3))
    axes.name = ["X", "Y", "Z"] * count
    axes.type = ["float"] * (3 * count)
    axes.value = [""] * (3 * count)
    return rows


def _vertices(ids: list[str]) -> VerticesTypeRows:
    rows = VerticesTypeRows(len(ids))
    rows.id = [f"{id}Vertices" for id in ids]
    rows.input = inputs = InputLocalTypeRows(len(ids))
    inputs.semantic = ["POSITION"] * len(ids)
    inputs.source = [f"#{id}Positions" for id in ids]
    return rows


def _triangles(ids: list[str], corners: Lists) -> TrianglesTypeRows:
    rows = TrianglesTypeRows(len(ids))
    rows.count = np.diff(corners.offsets) // 3
    rows.input = inputs = InputLocalOffsetTypeRows(len(ids))
    inputs.semantic = ["VERTEX"] * len(ids)
    inputs.source = [f"#{id}Vertices" for id in ids]
    inputs.offset = np.zeros(len(ids), np.int64)
    rows.p = faces = PTypeRows(len(ids))
    faces.value = corners
    return rows

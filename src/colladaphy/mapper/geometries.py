"""Geometries of a document as meshes, each read once (COLLADA 1.5 §mesh, §convex_mesh)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c, local_name
from colladaphy.document.nodes import text_of
from colladaphy.errors import DocumentError, WorldError
from colladaphy.mapper import rules
from colladaphy.mapper.polygons import triangulate
from colladaphy.mapper.shapes import ShapeError

if TYPE_CHECKING:
    from colladaphy.document import Document
    from colladaphy.world import World
    from colladaphy.world.meshes import Mesh

__all__ = ["Geometries"]

Array = NDArray[Any]

_OUR_ID = re.compile(r"(?:.*-)?Mesh(\d{1,18})\Z")
_POLYGONS = ("triangles", "polylist", "polygons", "trifans", "tristrips")


class Geometries:
    """The meshes of a World that is being loaded, by the geometry elements they come from."""

    def __init__(self, document: Document, world: World) -> None:
        self._document = document
        self._world = world
        self._known: dict[etree._Element, Mesh | ShapeError] = {}

    def mesh(self, instance: etree._Element, document: Document) -> Mesh:
        """The mesh of an instance_geometry; ShapeError where it is none."""
        try:
            target = document.resolve(instance.get("url", ""), instance, "geometry")
        except DocumentError as error:
            raise ShapeError(error.findings[0].message) from error
        known = self._known.get(target.element)
        if known is None:
            try:
                with np.errstate(all="ignore"):
                    known = self._read(target.document, target.element)
            except OverflowError:
                known = ShapeError("The mesh is too large for arithmetic.")
            except WorldError as error:
                known = ShapeError(error.findings[0].message, empty="volume" in str(error))
            except ShapeError as error:
                known = error
            self._known[target.element] = known
        if isinstance(known, ShapeError):
            raise known
        return known

    def _read(self, document: Document, geometry: etree._Element) -> Mesh:
        vertices, faces, convex, is_hull = self._surface(document, geometry, [])
        if is_hull:
            self._document.note(
                rules.HULL,
                geometry,
                f"The convex hull of geometry {geometry.get('id')!r} has {len(faces)} triangles.",
                file=document.file,
            )
        if not len(faces):
            raise ShapeError(f"The geometry {geometry.get('id')!r} has no faces.")
        return self._world.add_mesh(vertices, faces, convex=convex, id=self._wanted_id(geometry))

    def _wanted_id(self, geometry: etree._Element) -> int | None:
        """The id that a mesh had in the World that was stored, if it is free."""
        ours = _OUR_ID.match(geometry.get("id", ""))
        id = None if ours is None else int(ours.group(1))
        return None if id in self._world.meshes else id

    def _surface(
        self, document: Document, geometry: etree._Element, path: list[etree._Element]
    ) -> tuple[Array, Array, bool, bool]:
        """Vertices, faces, whether they are convex, and whether they are a computed hull."""
        if geometry in path:
            raise ShapeError(f"The geometry {geometry.get('id')!r} is a convex hull of itself.")
        for child in geometry:
            name = local_name(child.tag)
            if name == "mesh":
                return *_mesh_arrays(child), False, False
            if name != "convex_mesh":
                continue
            other = child.get("convex_hull_of")
            if other is None:
                vertices, faces = _mesh_arrays(child)
                if len(faces):
                    return vertices, faces, True, False
                return *_hull_of(vertices), True, True
            try:
                target = document.resolve(other, child, "geometry")
            except DocumentError as error:
                raise ShapeError(error.findings[0].message) from error
            vertices, _, _, _ = self._surface(target.document, target.element, [*path, geometry])
            return *_hull_of(vertices), True, True
        raise ShapeError(f"The geometry {geometry.get('id')!r} is not a mesh.")


def _hull_of(points: Array) -> tuple[Array, Array]:
    from colladaphy.mapper.hull import convex_hull

    hull = convex_hull(points)
    if hull is None:
        raise ShapeError("The convex hull has no volume.", empty=True)
    return hull


def _mesh_arrays(mesh: etree._Element) -> tuple[Array, Array]:
    """All vertices (n, 3) and all triangles (m, 3) of a mesh."""
    sources = {source.get("id", ""): source for source in mesh.iterchildren(c("source"))}
    vertices = mesh.find(c("vertices"))
    if vertices is None:
        raise ShapeError("The mesh has no vertices.")
    positions = None
    for given in vertices.iterchildren(c("input")):
        if given.get("semantic") == "POSITION":
            positions = sources.get(given.get("source", "").lstrip("#"))
    if positions is None:
        raise ShapeError("The mesh has no source of positions.")
    points = _source_rows(positions)
    faces = [
        triangulate(group, local_name(group.tag), points)
        for group in mesh
        if local_name(group.tag) in _POLYGONS
    ]
    if not faces:
        return points, np.zeros((0, 3), dtype=np.int64)
    corners = np.concatenate(faces)
    if len(corners) and (corners.min() < 0 or corners.max() >= len(points)):
        raise ShapeError("A face names a vertex that there is not.")
    return points, corners


def _source_rows(source: etree._Element) -> Array:
    """The rows (n, 3) that the accessor of a source selects from its array."""
    array = source.find(c("float_array"))
    accessor = source.find(f"{c('technique_common')}/{c('accessor')}")
    if array is None or accessor is None:
        raise ShapeError(f"The source {source.get('id')!r} has no numbers.")
    values = np.array(text_of(array).split(), dtype=np.float64)
    count = int(accessor.get("count", "0"))
    stride = int(accessor.get("stride", "1"))
    offset = int(accessor.get("offset", "0"))
    named = [place for place, parameter in enumerate(accessor.iterchildren(c("param")))
             if parameter.get("name")]  # fmt: skip
    places = named[:3] if len(named) >= 3 else [0, 1, 2]
    if stride < 1 or (count and offset + (count - 1) * stride + max(places) >= len(values)):
        raise ShapeError(f"The source {source.get('id')!r} has fewer numbers than it says.")
    starts = offset + stride * np.arange(count)
    return np.asarray(values[starts[:, None] + np.array(places)])

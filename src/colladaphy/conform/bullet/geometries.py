"""Geometries as Bullet reads them: one set of triangles of plain positions, or plain points.

It takes every three numbers of the positions' array for a point, whatever the accessor says; of
several sets of triangles the last; of polygons nothing. A hull is of a mesh of the same file that
has an id, as has every geometry (COLLADA 1.5 §mesh, §convex_mesh).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.markup import Names, children, first, numbers_text
from colladaphy.conform.bullet.solids import Floats, Integers, Solid, mesh_solid
from colladaphy.conform.bullet.triangles import triangles_of
from colladaphy.conform.downgrade.draft import Draft, local

__all__ = ["Geometries", "Surface"]


@dataclass(slots=True)
class Surface:
    """What a shape's geometry holds, and the url under which Bullet reads all of it."""

    url: str
    solid: Solid | None
    convex: bool


class Geometries:
    """The geometries of a document, and those that are made for Bullet."""

    def __init__(self, draft: Draft) -> None:
        self._draft = draft
        self._ids = Names(element.get("id", "") for element in draft.everything())
        self._last: etree._Element | None = None
        self._by_id: dict[str, etree._Element] = {}
        self._sources = {source.get("id", ""): source for source in draft.all("source")}
        self._known: dict[str, Surface | None] = {}
        for geometry in draft.all("geometry"):
            if not geometry.get("id"):
                # Bullet compares the id of every geometry when it looks for that of a hull.
                geometry.set("id", self._ids.new("geometry"))
            self._by_id.setdefault(geometry.get("id", ""), geometry)

    def surface(self, url: str) -> Surface | None:
        """The surface of a geometry, made readable for Bullet; None where there is none."""
        name = url.strip().removeprefix("#")
        if name not in self._known:
            geometry = self._by_id.get(name)
            self._known[name] = None if geometry is None else self._read(geometry)
        return self._known[name]

    def add(self, near: str, points: Floats, triangles: Integers, *, convex: bool) -> str:
        """A new geometry of these points and triangles; its url."""
        name = self._ids.new(near)
        make = self._draft.make
        geometry = make("geometry", attributes={"id": name})
        body = make("convex_mesh" if convex else "mesh")
        source = make("source", attributes={"id": self._ids.new(f"{name}-positions")})
        array_id = self._ids.new(f"{name}-positions-array")
        array = make("float_array", numbers_text(points.ravel()))
        array.set("id", array_id)
        array.set("count", str(points.size))
        accessor = make("accessor", attributes={"source": f"#{array_id}", "stride": "3"})
        accessor.set("count", str(len(points)))
        for axis in "XYZ":
            accessor.append(make("param", attributes={"name": axis, "type": "float"}))
        common = make("technique_common")
        common.append(accessor)
        source.extend([array, common])
        vertices = make("vertices", attributes={"id": self._ids.new(f"{name}-vertices")})
        position = make("input", attributes={"semantic": "POSITION"})
        position.set("source", f"#{source.get('id')}")
        vertices.append(position)
        faces = make("triangles", attributes={"count": str(len(triangles))})
        corner = make("input", attributes={"semantic": "VERTEX", "offset": "0"})
        corner.set("source", f"#{vertices.get('id')}")
        faces.append(corner)
        faces.append(make("p", " ".join(map(str, triangles.ravel().tolist()))))
        body.extend([source, vertices, faces] if len(triangles) else [source, vertices])
        geometry.append(body)
        self._put(geometry)
        self._by_id[name] = geometry
        return f"#{name}"

    def element(self, url: str) -> etree._Element:
        """The geometry of a url that `add` gave."""
        return self._by_id[url.removeprefix("#")]

    def _put(self, geometry: etree._Element) -> None:
        """Put a new geometry into the first library, before the extras there."""
        if self._last is not None:
            self._last.addnext(geometry)
        else:
            library = first(self._draft.root, "library_geometries")
            if library is None:
                library = self._draft.make("library_geometries")
                self._draft.root[0].addnext(library)
            others = children(library, "geometry")
            library.insert(library.index(others[-1]) + 1 if others else 0, geometry)
        self._last = geometry

    # -- reading ------------------------------------------------------------------------------

    def _read(self, geometry: etree._Element) -> Surface | None:
        name = geometry.get("id", "")
        mesh = first(geometry, "mesh")
        convex = first(geometry, "convex_mesh")
        content = convex if mesh is None else mesh
        if content is None:
            return None
        linked = self._linked(convex)
        holder = content if linked is None else linked
        points, plain = self._positions(holder)
        if points is None or not len(points) or not np.all(np.isfinite(points)):
            return None
        triangles = triangles_of(holder, len(points))
        solid = mesh_solid(points, triangles)
        url = f"#{name}"
        if convex is not None:
            if not plain or (linked is not None and not self._is_plain_hull(convex)):
                url = self._copy(geometry, points, triangles, convex=True)
        elif not len(triangles):
            url = self._copy(geometry, points, triangles, convex=True)
        elif not plain or not _is_one_set(content):
            url = self._copy(geometry, points, triangles, convex=False)
        is_convex = convex is not None or not len(triangles)
        return Surface(url, solid, is_convex)

    def _copy(
        self, geometry: etree._Element, points: Floats, triangles: Integers, *, convex: bool
    ) -> str:
        url = self.add(f"{geometry.get('id')}-bullet", points, triangles, convex=convex)
        message = f"Shapes use {url!r}, a plain copy of the geometry {geometry.get('id')!r}."
        self._draft.note(rules.GEOMETRY, geometry, message)
        return url

    def _linked(self, convex: etree._Element | None) -> etree._Element | None:
        """The mesh that a convex mesh is the hull of, through other hulls."""
        seen = set()
        content = convex
        while content is not None and content.get("convex_hull_of") is not None:
            name = content.get("convex_hull_of", "").strip().removeprefix("#")
            geometry = self._by_id.get(name)
            if geometry is None or name in seen:
                break
            seen.add(name)
            mesh = first(geometry, "mesh")
            content = first(geometry, "convex_mesh") if mesh is None else mesh
        return None if content is convex else content

    def _is_plain_hull(self, convex: etree._Element) -> bool:
        url = convex.get("convex_hull_of", "").strip()
        geometry = self._by_id.get(url[1:])
        return url.startswith("#") and geometry is not None and first(geometry, "mesh") is not None

    def _positions(self, content: etree._Element) -> tuple[Floats | None, bool]:
        """The points of a mesh, and whether Bullet would read the same."""
        for semantic in children(content, "vertices"):
            for local_input in children(semantic, "input"):
                if local_input.get("semantic") != "POSITION":
                    continue
                url = local_input.get("source", "").strip()
                source = self._sources.get(url.removeprefix("#"))
                if source is not None:
                    return _points(source)
        return None, False


def _points(source: etree._Element) -> tuple[Floats | None, bool]:
    array = first(source, "float_array")
    accessor = first(source, "technique_common", "accessor")
    if array is None:
        return None, False
    numbers = np.array((array.text or "").split(), dtype=np.float64)
    if accessor is None:
        return numbers[: len(numbers) // 3 * 3].reshape(-1, 3), len(numbers) % 3 == 0
    stride = int(accessor.get("stride", "1"))
    offset, count = int(accessor.get("offset", "0")), int(accessor.get("count", "0"))
    plain = (stride, offset, count * 3) == (3, 0, len(numbers))
    if stride < 3 or max(stride, offset) > 1 << 40:
        return None, False
    count = min(count, max(0, (len(numbers) - offset - 3) // stride + 1))
    rows = offset + stride * np.arange(count)[:, None] + np.arange(3)
    return numbers[rows], plain


def _is_one_set(mesh: etree._Element) -> bool:
    sets = [
        child
        for child in mesh
        if local(child) in ("triangles", "polylist", "polygons", "trifans", "tristrips")
    ]
    return len(sets) == 1 and local(sets[0]) == "triangles" and bool(children(sets[0], "p"))

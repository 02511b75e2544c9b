"""Bodies under a scaled or mirrored node: shapes, mass frames, attachments and geometries."""

from __future__ import annotations

import copy
from collections.abc import Iterator

import numpy as np
from lxml import etree

from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.conventions.clues import place_of
from colladaphy.conform.frames import Matrix
from colladaphy.conform.placing import put_place
from colladaphy.conform.shapes import GEOMETRIES
from colladaphy.conform.solids import are_usable, ellipsoid, numbers_of

__all__ = ["Scaling", "can_scale", "scale_body"]

_SIZES = {"box": "half_extents", "cylinder": "radius", "capsule": "radius", "sphere": "radius"}


def can_scale(context: Context, holders: list[etree._Element], factor: Matrix) -> str | None:
    """Why the shapes of a body (and of its instances) cannot be scaled; None where they can."""
    for shape in _shapes(holders):
        solid, own = _solid(shape), _in_shape(shape, factor)
        if solid is None or own is None:
            return "a shape cannot be read"
        name = local(solid)
        if name == "instance_geometry":
            if _mesh_of(context, solid.get("url", "")) is None:
                return f"the geometry {solid.get('url')!r} has no mesh here"
        elif name == "plane":
            if len(numbers_of(solid.find(NS + "equation"))) != 4:
                return "a plane has no equation"
        elif not numbers_of(solid.find(NS + _SIZES[name])):
            return f"a {name} has no size"
        elif name != "sphere" and not _is_diagonal(own):
            return f"a turned {name} scaled by {factor.tolist()} is none any more"
    return None


def _shapes(holders: list[etree._Element]) -> Iterator[etree._Element]:
    for holder in holders:
        for common in holder.iterchildren(NS + "technique_common"):
            yield from common.iterchildren(NS + "shape")


def _solid(shape: etree._Element) -> etree._Element | None:
    return next(shape.iterchildren(*(NS + name for name in GEOMETRIES)), None)


def _in_shape(shape: etree._Element, factor: Matrix) -> Matrix | None:
    """What the scale of the node is within the frame of a shape: a symmetric matrix (3, 3)."""
    place = place_of(shape)
    if place is None:
        return None
    turn = place[:3, :3]
    return np.asarray(turn.T @ np.diag(factor) @ turn, dtype=np.float64)


def _is_diagonal(matrix: Matrix) -> bool:
    rest = matrix - np.diag(np.diag(matrix))
    return bool(np.abs(rest).max() <= 1e-9 * np.abs(matrix).max())


def scale_body(
    scaling: Scaling, body: etree._Element, users: list[etree._Element], factor: Matrix
) -> None:
    """Scale the shapes and mass frames of a body, and those that its instances state."""
    for shape in list(_shapes([body, *users])):
        scaling.shape(shape, factor)
    for holder in (body, *users):
        for common in holder.iterchildren(NS + "technique_common"):
            for frame in common.iterchildren(NS + "mass_frame"):
                scaling.move(frame, factor, mirror=True)


class Scaling:
    """Scales what belongs to bodies; geometries are copied once for each scale."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self._copies: dict[tuple[str, bytes], str] = {}

    def move(self, holder: etree._Element, factor: Matrix, *, mirror: bool = False) -> None:
        """Scale where a frame is; with `mirror` its axes are mirrored, up to their signs."""
        place = place_of(holder)
        if place is None:
            return
        place = place.copy()
        place[:3, 3] *= factor
        if mirror and np.prod(factor) < 0.0:
            place[:3, :3] = np.diag(np.sign(factor)) @ place[:3, :3] @ np.diag((1.0, 1.0, -1.0))
        put_place(self.context, holder, place)

    def shape(self, shape: etree._Element, factor: Matrix) -> None:
        """Scale a shape that `can_scale` has agreed to."""
        solid, own = _solid(shape), _in_shape(shape, factor)
        assert solid is not None
        assert own is not None
        name, sizes = local(solid), np.abs(np.diag(own))
        if name == "instance_geometry":
            solid.set("url", self._geometry(solid.get("url", ""), own))
        elif name == "plane":
            equation = solid.find(NS + "equation")
            values = np.asarray(numbers_of(equation))
            assert equation is not None
            self.context.write(equation, [*np.linalg.solve(own.T, values[:3]), values[3]])
        elif name == "sphere" and np.ptp(np.abs(factor)) > 1e-6 * np.abs(factor).max():
            self._ellipsoid(shape, solid, np.abs(factor))
        else:
            which = {"box": [0, 1, 2], "cylinder": [0, 2], "capsule": [0, 1, 2], "sphere": [0]}
            self._write(solid, _SIZES[name], sizes[which[name]])
            self._write(solid, "height", sizes[1:2])
        self.move(shape, factor)

    def _write(self, solid: etree._Element, name: str, sizes: Matrix) -> None:
        element = solid.find(NS + name)
        values = numbers_of(element)
        if element is not None and len(values) == len(sizes):
            self.context.write(element, (np.asarray(values) * sizes).tolist())

    def _ellipsoid(self, shape: etree._Element, solid: etree._Element, sizes: Matrix) -> None:
        """A sphere that is no sphere any more; how it was turned does not matter."""
        radius = numbers_of(solid.find(NS + "radius"))[0]
        radii = " ".join(map(repr, (radius * sizes).tolist()))
        solid.addprevious(ellipsoid(self.context, radii))
        shape.remove(solid)
        place = place_of(shape)
        assert place is not None
        plain = np.eye(4)
        plain[:3, 3] = place[:3, 3]
        put_place(self.context, shape, plain)

    def scale_attachments(
        self,
        nodes: dict[etree._Element, etree._Element],
        factors: dict[etree._Element, Matrix],
    ) -> None:
        """Scale where constraints are attached to bodies, or to nodes, that were scaled."""
        if not factors:
            return
        of_body = {}
        for body, node in nodes.items():
            model = body.getparent()
            if node in factors and model is not None:
                of_body[f"{model.get('id')}/{body.get('sid')}"] = factors[node]
        for node, factor in factors.items():
            of_body[f"#{node.get('id')}"] = factor
        for end in self.context.all("ref_attachment", "attachment"):
            if (found := of_body.get(end.get("rigid_body", ""))) is not None:
                self.move(end, found)

    # -- geometries ---------------------------------------------------------------------------

    def _geometry(self, url: str, own: Matrix) -> str:
        """The url of a copy of a geometry whose positions are mapped by a matrix (3, 3)."""
        key = (url, np.round(own, 12).tobytes())
        if key not in self._copies:
            self._copies[key] = self._copy(url, own)
        return self._copies[key]

    def _copy(self, url: str, own: Matrix) -> str:
        old = self.context.by_url(url)
        assert old is not None
        twin = copy.deepcopy(old)
        twin.tail = None
        old.addnext(twin)
        self._rename(twin)
        hull = twin.find(NS + "convex_mesh")
        if hull is not None and hull.get("convex_hull_of"):
            hull.set("convex_hull_of", self._geometry(hull.get("convex_hull_of", ""), own))
            return f"#{twin.get('id')}"
        for source in _positions(self.context, twin):
            array, accessor = source.find(NS + "float_array"), source.find(f".//{NS}accessor")
            values = np.asarray(numbers_of(array))
            if array is None or accessor is None or not are_usable(values.tolist()):
                continue
            stride = max(1, int(accessor.get("stride", "1") or 1))
            start = int(accessor.get("offset", "0") or 0)
            rows = np.arange(start, len(values) - 2, stride)
            points = rows[:, None] + np.arange(3)
            values[points] = values[points] @ own.T
            self.context.write(array, values.tolist())
        if np.linalg.det(own) < 0.0:
            for p in twin.iter(NS + "p"):
                _reverse(p)
        return f"#{twin.get('id')}"

    def _rename(self, twin: etree._Element) -> None:
        """Give the elements of a copy ids of their own, and let its references lead to them."""
        new: dict[str, str] = {}
        for element in twin.iter(etree.Element):
            if name := element.get("id"):
                new[name] = self.context.new_id(f"{name}-scaled")
                element.set("id", new[name])
                self.context.ids[new[name]] = element
        for element in twin.iter(etree.Element):
            source = element.get("source", "").removeprefix("#")
            if source in new:
                element.set("source", f"#{new[source]}")


def _mesh_of(context: Context, url: str) -> etree._Element | None:
    """The mesh of a geometry of this document, or that of which it is the hull."""
    geometry = context.by_url(url) if url.startswith("#") else None
    for _ in range(8):
        if geometry is None or local(geometry) != "geometry":
            return None
        hull = geometry.find(NS + "convex_mesh")
        if hull is None or not hull.get("convex_hull_of"):
            mesh = geometry.find(NS + "mesh")
            return hull if mesh is None else mesh
        geometry = context.by_url(hull.get("convex_hull_of"))
    return None


def _positions(context: Context, geometry: etree._Element) -> list[etree._Element]:
    found = []
    for user in geometry.iterfind(f".//{NS}vertices/{NS}input"):
        source = context.by_url(user.get("source"))
        if user.get("semantic") == "POSITION" and source is not None and source not in found:
            found.append(source)
    return found


def _reverse(p: etree._Element) -> None:
    """Turn the corners of polygons round: a mirror turns outside in.

    Fans and strips stay: their order says more than one polygon.
    """
    primitive = p.getparent()
    kind = "" if primitive is None else local(primitive)
    if primitive is None or kind not in ("triangles", "polylist", "polygons") or len(p):
        return
    offsets = [int(user.get("offset", "0") or 0) for user in primitive.iter(NS + "input")]
    width = max(offsets, default=0) + 1
    words = (p.text or "").split()
    corners = [words[i : i + width] for i in range(0, len(words) - width + 1, width)]
    if kind == "polylist":
        counts = [int(word) for word in (primitive.findtext(NS + "vcount") or "").split()]
    else:
        counts = [3] * (len(corners) // 3) if kind == "triangles" else [len(corners)]
    turned: list[str] = []
    start = 0
    for count in counts:
        for corner in reversed(corners[start : start + count]):
            turned += corner
        start += count
    if start == len(corners):
        p.text = " ".join(turned)

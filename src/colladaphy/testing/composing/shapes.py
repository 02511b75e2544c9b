"""Shapes, the geometries that they instance, and materials."""

from __future__ import annotations

from hypothesis import strategies as st

from colladaphy.testing.composing.places import coordinates, draw_steps
from colladaphy.testing.making.scalars import several
from colladaphy.testing.markup import library, numbers, tag

__all__ = ["FORMS", "Geometries", "Materials", "draw_shapes", "lengths", "masses"]

FORMS = ("sphere", "box", "capsule", "cylinder", "plane", "mesh", "convex_mesh", "convex_hull_of")
"""What a shape can be."""

lengths = st.integers(1, 32).map(lambda number: number / 8)
masses = st.integers(1, 64).map(lambda number: number / 4)
_shares = st.integers(0, 8).map(lambda number: number / 8)
# The faces of a box whose corners are in the order of its three coordinates.
_SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


class Materials:
    """Materials in a library and those that stand where they are used."""

    def __init__(self, mark: str) -> None:
        self._mark = mark
        self._known: list[str] = []

    def use(self, draw: st.DrawFn) -> str:
        """An element that says of which material something is, or nothing."""
        form = draw(st.sampled_from(["none", "instance", "inline", "known"]))
        if form == "none":
            return ""
        if form == "inline":
            return tag("physics_material", _material_values(draw))
        if form == "known" and self._known:
            number = draw(st.integers(0, len(self._known) - 1))
        else:
            number = len(self._known)
            values = _material_values(draw)
            self._known.append(tag("physics_material", values, id=f"{self._mark}m{number}"))
        return tag("instance_physics_material", url=f"#{self._mark}m{number}")

    def text(self) -> str:
        """The library of materials."""
        return library("physics_materials", *self._known)


def _material_values(draw: st.DrawFn) -> str:
    dynamic = draw(_shares)
    values = tag("dynamic_friction", numbers([dynamic])) if draw(st.booleans()) else ""
    values += tag("restitution", numbers([draw(_shares)])) if draw(st.booleans()) else ""
    static = dynamic + draw(_shares)
    values += tag("static_friction", numbers([static])) if draw(st.booleans()) else ""
    return tag("technique_common", values)


class Geometries:
    """Closed surfaces, as meshes, convex meshes and hulls of meshes."""

    def __init__(self, mark: str) -> None:
        self._mark = mark
        self._known: list[tuple[str, str]] = []
        self._texts: list[str] = []

    def use(self, draw: st.DrawFn, form: str) -> str:
        """An instance of a geometry of a form: a new one or one that is there."""
        known = [id for id, kind in self._known if kind == form]
        id = draw(st.sampled_from([None, *known])) or self._new(draw, form)
        return tag("instance_geometry", url=f"#{id}")

    def _new(self, draw: st.DrawFn, form: str) -> str:
        id = f"{self._mark}g{len(self._known)}"
        if form == "convex_hull_of":
            inner = self._new(draw, "mesh")
            id = f"{self._mark}g{len(self._known)}"
            made = tag("convex_mesh", convex_hull_of=f"#{inner}")
        else:
            made = _mesh(draw, id, form)
        self._texts.append(tag("geometry", made, id=id))
        self._known.append((id, form))
        return id

    def text(self) -> str:
        """The library of geometries."""
        return library("geometries", *self._texts)


def _mesh(draw: st.DrawFn, id: str, form: str) -> str:
    """A box, whose vertices may be apart in their array and whose faces may have normals."""
    size = [draw(lengths) for _ in range(3)]
    middle = [draw(coordinates) for _ in range(3)]
    corners = [
        [at + sign * half for at, sign, half in zip(middle, (i, j, k), size, strict=True)]
        for i in (-1, 1)
        for j in (-1, 1)
        for k in (-1, 1)
    ]
    stride, before = draw(st.sampled_from([(3, 0), (4, 0), (3, 2), (5, 1)]))
    words = [9.0] * before + [
        value for corner in corners for value in (*corner, *[0.0] * (stride - 3))
    ]
    array = tag("float_array", numbers(words), id=f"{id}-array", count=len(words))
    axes = "".join(tag("param", name=axis, type="float") for axis in "XYZ")
    accessor = tag(
        "accessor", axes, source=f"#{id}-array", count=8, stride=stride,
        offset=before or None,
    )  # fmt: skip
    source = tag("source", array, tag("technique_common", accessor), id=f"{id}-points")
    position = tag("input", semantic="POSITION", source=f"#{id}-points")
    vertices = tag("vertices", position, id=f"{id}-vertices")
    again = draw(st.booleans())  # a second input, whose indices stand between the others
    return tag(form, source, vertices, _faces(draw, id, again))


def _faces(draw: st.DrawFn, id: str, again: bool) -> str:
    inputs = tag("input", semantic="VERTEX", source=f"#{id}-vertices", offset=0)
    if again:
        inputs += tag("input", semantic="NORMAL", source=f"#{id}-points", offset=1)

    def words(corners: tuple[int, ...]) -> str:
        return " ".join(f"{c} 0" if again else str(c) for c in corners)

    match draw(st.sampled_from(["triangles", "polylist", "polygons"])):
        case "triangles":
            three = [half for a, b, c, d in _SIDES for half in ((a, b, c), (a, c, d))]
            return tag("triangles", inputs, tag("p", " ".join(map(words, three))), count=12)
        case "polylist":
            counts = tag("vcount", " ".join(["4"] * 6))
            return tag("polylist", inputs, counts, tag("p", " ".join(map(words, _SIDES))), count=6)
        case _:
            return tag("polygons", inputs, *(tag("p", words(side)) for side in _SIDES), count=6)


def _shape(
    draw: st.DrawFn, geometries: Geometries, materials: Materials, forms: tuple[str, ...]
) -> str:
    """A shape of one of the forms, of which some say mass, density, material and place."""
    form = draw(st.sampled_from(forms))
    hollow = tag("hollow", "true") if draw(st.integers(0, 7)) == 7 else ""
    weight = draw(st.sampled_from(["mass", "density", "neither"])) if form != "plane" else ""
    heavy = "" if weight in ("neither", "") else tag(weight, numbers([draw(masses)]))
    material = materials.use(draw)
    return tag("shape", hollow, heavy, material, _form(draw, form, geometries), draw_steps(draw))


def _form(draw: st.DrawFn, form: str, geometries: Geometries) -> str:
    match form:
        case "sphere":
            return tag(form, tag("radius", numbers([draw(lengths)])))
        case "box":
            return tag(form, tag("half_extents", numbers([draw(lengths) for _ in range(3)])))
        case "capsule" | "cylinder":
            radius = draw(lengths)
            radii = [radius] * (3 if form == "capsule" else 2)
            if draw(st.integers(0, 3)) == 3:
                radii = [draw(lengths) for _ in radii]
            return tag(form, tag("height", numbers([draw(lengths)])), tag("radius", numbers(radii)))
        case "plane":
            x, y, z = draw(st.sampled_from([(0, 0, 1), (0, 3, 0), (0.6, 0, -0.8)]))
            return tag(form, tag("equation", numbers((x, y, z, draw(coordinates)))))
        case _:
            return geometries.use(draw, form)


def draw_shapes(
    draw: st.DrawFn, geometries: Geometries, materials: Materials, forms: tuple[str, ...]
) -> str:
    """One to three shapes."""
    return "".join(several(draw, 1, 3, lambda d: _shape(d, geometries, materials, forms)))

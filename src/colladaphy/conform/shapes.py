"""Shapes of rigid bodies: what older versions and producers wrote, in elements of 1.5."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform import shape_rules
from colladaphy.conform.context import (
    NS,
    Context,
    append,
    insert,
    local,
    remove,
    settle_notes,
)
from colladaphy.conform.solids import (
    SEGMENTS,
    Ring,
    add_solid,
    are_usable,
    ellipsoid,
    numbers_of,
    tapered_capsule,
    tapered_cylinder,
)

__all__ = [
    "GEOMETRIES",
    "TAPERED",
    "convert_tapered",
    "drop_empty_shapes",
    "extend_capsule_radii",
    "lift_inline_meshes",
    "mend_radii",
    "split_shapes",
]

TAPERED = ("tapered_cylinder", "tapered_capsule")
GEOMETRIES = ("instance_geometry", "plane", "box", "sphere", "cylinder", "capsule")


def _owner_name(shape: etree._Element) -> str:
    """A name for what is made out of a shape: that of its body."""
    for above in shape.iterancestors(NS + "rigid_body", NS + "instance_rigid_body"):
        return above.get("sid") or above.get("id") or above.get("body") or "body"
    return "body"


def _replace(context: Context, old: etree._Element, rings: list[Ring], what: str) -> str:
    wish = f"{_owner_name(old)}-{what}"
    name = add_solid(context, "".join(c if c.isalnum() or c in "-_." else "_" for c in wish), rings)
    new = context.make("instance_geometry", url=f"#{name}")
    parent = old.getparent()
    assert parent is not None
    insert(parent, parent.index(old), new)
    context.stash(old, "colladaphy-1.4" if what.startswith("tapered") else None)
    return name


def convert_tapered(context: Context) -> None:
    """Tapered cylinders and capsules, which 1.5 has not, become convex meshes."""
    for name, outline in (
        ("tapered_cylinder", tapered_cylinder),
        ("tapered_capsule", tapered_capsule),
    ):
        for solid in context.all(name) if context.wants(shape_rules.TAPERED) else []:
            upper = numbers_of(solid.find(NS + "radius1"))
            lower = numbers_of(solid.find(NS + "radius2"))
            height = numbers_of(solid.find(NS + "height"))
            if not upper or not lower or len(height) != 1 or local(_parent(solid)) != "shape":
                continue
            values = (*height, *upper, *lower)
            if not are_usable(values) or min(values) < 0:
                continue
            if name == "tapered_cylinder" and height[0] == 0:
                continue  # it has no volume, and is left to what mends shapes that are none
            message = (
                f"<{name}> of height {height[0]:g} and radii {upper[0]:g} above, {lower[0]:g} below"
                f" is now a convex mesh with {SEGMENTS} sides, #"
            )
            rings = outline(height[0], (upper * 2)[:2], (lower * 2)[:2])
            line = solid.getparent()
            context.note(shape_rules.TAPERED, line, message + _replace(context, solid, rings, name))


def extend_capsule_radii(context: Context) -> None:
    """A capsule's radius is three numbers in 1.5; 1.4 had two (along x and z), some write one."""
    for capsule in context.all("capsule"):
        radius = capsule.find(NS + "radius")
        values = numbers_of(radius)
        if (
            radius is None
            or len(values) not in (1, 2)
            or not context.wants(shape_rules.CAPSULE_RADIUS)
        ):
            continue
        words = settle_notes(radius).split()
        first, last = words[0], words[-1]
        before = " ".join(words)
        radius.text = f"{first} {first} {last}"
        message = f"capsule radius {before} (1.4) is {radius.text} in 1.5"
        if values[0] != values[-1]:
            message += "; the height of its caps is assumed to be the radius along x"
        context.note(shape_rules.CAPSULE_RADIUS, radius, message)


def mend_radii(context: Context) -> None:
    """Spheres with three radii, cylinders with one, boxes with one half extent."""
    for sphere in context.all("sphere"):
        if local(_parent(sphere)) == "shape":
            _mend_sphere(context, sphere)
    for solid, name, wanted in (("cylinder", "radius", 2), ("box", "half_extents", 3)):
        for element in context.all(solid):
            value = element.find(NS + name)
            if len(numbers_of(value)) == 1 and local(_parent(element)) == "shape":
                assert value is not None
                if not context.wants(shape_rules.SHAPE_SIZE):
                    continue
                one = settle_notes(value).strip()
                value.text = " ".join([one] * wanted)
                message = f"<{name}> of a {solid} was {one}, is now {value.text}"
                context.note(shape_rules.SHAPE_SIZE, value, message)


def _mend_sphere(context: Context, sphere: etree._Element) -> None:
    radius = sphere.find(NS + "radius")
    values = numbers_of(radius)
    if radius is None or len(values) < 2 or not context.wants(shape_rules.SPHERE_RADII):
        return
    before = " ".join(settle_notes(radius).split())
    if len(set(values)) == 1:
        radius.text = before.split()[0]
        message = f"sphere radius was {before}, is now {radius.text}"
        context.note(shape_rules.SPHERE_RADII, radius, message)
    elif len(values) == 3 and are_usable(values) and min(values) > 0:
        shape = _parent(sphere)
        _put_ellipsoid(context, sphere, before)
        message = f"sphere with the radii {before} is an ellipsoid: now a capsule without height"
        context.note(shape_rules.SPHERE_RADII, shape, message)


def _put_ellipsoid(context: Context, old: etree._Element, radii: str) -> None:
    """An ellipsoid, which 1.5 has no element for: a capsule of no height with three radii."""
    insert(_parent(old), _parent(old).index(old), ellipsoid(context, radii))
    context.stash(old)


def lift_inline_meshes(context: Context) -> None:
    """Meshes (and ellipsoids) that stand in a shape themselves become instances of geometries."""
    for shape in context.all("shape"):
        for mesh in list(shape.iterchildren(NS + "mesh", NS + "convex_mesh")):
            if context.wants(shape_rules.INLINE_MESH):
                _lift(context, shape, mesh)
        for solid in list(shape.iterchildren(NS + "ellipsoid")):
            size = numbers_of(solid.find(NS + "size"))
            if (
                len(size) == 3
                and are_usable(size)
                and min(size) > 0
                and context.wants(shape_rules.INLINE_MESH)
            ):
                _put_ellipsoid(context, solid, " ".join(repr(length / 2) for length in size))
                message = "an <ellipsoid> is no shape of 1.5: now a capsule without height"
                context.note(shape_rules.INLINE_MESH, shape, message)


def _lift(context: Context, shape: etree._Element, mesh: etree._Element) -> None:
    inner = mesh.find(NS + "instance_geometry")
    index = shape.index(mesh)
    if inner is not None:
        message = f"<{local(mesh)}> around <instance_geometry url={inner.get('url')!r}> was removed"
        mesh.remove(inner)
        insert(shape, index, inner)
        if len(mesh) or (mesh.text or "").strip() or mesh.attrib:
            context.stash(mesh)
        else:
            remove(mesh)
    else:
        geometry = context.make("geometry", id=context.new_id(f"{_owner_name(shape)}-mesh"))
        remove(mesh)
        geometry.append(mesh)
        append(context.library("geometries"), geometry)
        context.ids[geometry.get("id", "")] = geometry
        insert(shape, index, context.make("instance_geometry", url=f"#{geometry.get('id')}"))
        message = f"<{local(mesh)}> in <shape> is now the geometry #{geometry.get('id')}"
    context.note(shape_rules.INLINE_MESH, shape, message)


def split_shapes(context: Context) -> None:
    """A shape with several geometries becomes several shapes, where nothing is shared but these."""
    for shape in context.all("shape"):
        solids = list(shape.iterchildren(*(NS + name for name in GEOMETRIES)))
        parent = _parent(shape)
        if len(solids) < 2 or not context.wants(shape_rules.SHAPE_SPLIT):
            continue
        if shape.find(NS + "mass") is not None:
            continue  # whose mass it is cannot be known; the generic repair keeps the first
        for position, solid in enumerate(solids[1:], 1):
            twin = context.make("shape")
            for child in shape:
                name = local(child)
                if name in (
                    "hollow",
                    "density",
                    "instance_physics_material",
                    "translate",
                    "rotate",
                ):
                    twin.append(_copy(child))
            solid.tail = None
            twin.insert(_geometry_index(twin), solid)
            insert(parent, parent.index(shape) + position, twin)
        message = f"<shape> had {len(solids)} geometries; each has a shape of its own now"
        context.note(shape_rules.SHAPE_SPLIT, shape, message)


def _geometry_index(shape: etree._Element) -> int:
    names = [local(child) for child in shape]
    return next((i for i, n in enumerate(names) if n in ("translate", "rotate")), len(names))


def _copy(element: etree._Element) -> etree._Element:
    return etree.fromstring(etree.tostring(element, with_tail=False, encoding="UTF-8"))


def drop_empty_shapes(context: Context) -> None:
    """Empty shapes beside others say nothing (Bullet's converter writes one a compound)."""
    for shape in context.all("shape"):
        if len(shape) or (shape.text or "").strip() or shape.attrib:
            continue
        full = any(len(other) for other in _parent(shape).iterchildren(NS + "shape"))
        if full and context.wants(shape_rules.EMPTY_SHAPE):
            context.note(
                shape_rules.EMPTY_SHAPE, shape, "an empty <shape> beside others was removed"
            )
            remove(shape)


def _parent(element: etree._Element) -> etree._Element:
    parent = element.getparent()
    assert parent is not None
    return parent

"""Rigid bodies, constraints and their instances: what is missing, and transforms as matrices."""

from __future__ import annotations

import numpy as np
from lxml import etree

from colladaphy.conform import body_rules, shape_rules
from colladaphy.conform.context import CONFORM, NS, OWN_MAP, Context, append, insert, local, remove
from colladaphy.conform.frames import nearest_rotation, transform_of
from colladaphy.conform.lexical import name_from
from colladaphy.conform.placing import place_elements
from colladaphy.conform.shapes import GEOMETRIES, TAPERED
from colladaphy.conform.solids import are_usable

__all__ = [
    "assumed_shape",
    "body_targets",
    "complete_constraints",
    "give_shapes",
    "name_bodies",
    "wrap_bare_instances",
]

_NOTHING = "NoShape"
_MESHES = ("triangles", "polylist", "polygons", "trifans", "tristrips")


def name_bodies(context: Context) -> None:
    """Bodies and constraints without a sid get one from their name, their id or their model."""
    for model in context.all("physics_model"):
        taken: set[str] = set()
        unnamed = []
        for element in model.iterchildren(NS + "rigid_body", NS + "rigid_constraint"):
            if sid := element.get("sid"):
                taken.add(sid)
            elif context.wants(body_rules.MISSING_SID):
                unnamed.append(element)
        for element in unnamed:
            kind = local(element)
            base = element.get("name") or element.get("id") or ""
            base = base or f"{model.get('name') or model.get('id') or 'model'}-{kind}"
            sid = wish = name_from(base)
            number = 2
            while sid in taken:
                sid, number = f"{wish}-{number}", number + 1
            taken.add(sid)
            element.set("sid", sid)
            context.note(body_rules.MISSING_SID, element, f"<{kind}> had no sid; is now {sid!r}")


def wrap_bare_instances(context: Context) -> None:
    """Instances of bodies that stand in the scene itself get the instance of their model."""
    owners_of: dict[tuple[str, str], list[etree._Element]] = {}
    for model in context.all("physics_model"):
        for kind in ("rigid_body", "rigid_constraint"):
            for sid in {child.get("sid", "") for child in model.iterchildren(NS + kind)}:
                owners_of.setdefault((kind, sid), []).append(model)
    for scene in context.all("physics_scene"):
        wrappers: dict[str, etree._Element] = {}
        for kind, attribute in (("rigid_body", "body"), ("rigid_constraint", "constraint")):
            for bare in list(scene.iterchildren(NS + "instance_" + kind)):
                wanted = (bare.get(attribute) or "").rpartition("/")[2].lstrip("#")
                owners = owners_of.get((kind, wanted), [])
                if len(owners) != 1 or not context.wants(body_rules.BARE_INSTANCE):
                    continue
                model = owners[0]
                if not model.get("id"):
                    model.set("id", context.new_id(name_from(model.get("name") or "model")))
                name = model.get("id", "")
                if name not in wrappers:
                    wrappers[name] = context.make("instance_physics_model", url=f"#{name}")
                    insert(scene, scene.index(bare), wrappers[name])
                message = f"<{local(bare)}> stood in the scene; now in an instance of #{name}"
                context.note(body_rules.BARE_INSTANCE, bare, message)
                remove(bare)
                append(wrappers[name], bare)


def complete_constraints(context: Context) -> None:
    """A constraint with one attachment holds its body to the world."""
    for constraint in context.all("rigid_constraint"):
        for name, at in (("ref_attachment", 0), ("attachment", 1)):
            if constraint.find(NS + name) is None and context.wants(body_rules.MISSING_ATTACHMENT):
                first = [i for i, c in enumerate(constraint) if local(c) == "ref_attachment"]
                new = context.make(name, rigid_body="")
                insert(constraint, first[0] + 1 if at and first else 0, new)
                message = f"<rigid_constraint> had no <{name}>: it holds its body to the world"
                context.note(body_rules.MISSING_ATTACHMENT, constraint, message)


def give_shapes(context: Context) -> None:
    """A body without a shape gets the geometry of its visual node, or an empty hull.

    Both are marked as assumed: the hull of nothing only makes the document valid, and readers are
    to take the body for one without a shape, with its mass and inertia.
    """
    targets = body_targets(context)
    linked = set(targets.values())
    for body in context.all("rigid_body"):
        common = body.find(NS + "technique_common")
        shapes = [] if common is None else list(common.iterchildren(NS + "shape"))
        if any(_has_geometry(shape) for shape in shapes) or not context.wants(
            shape_rules.MISSING_SHAPE
        ):
            continue
        if common is None:
            common = context.make("technique_common")
            insert(body, 0, common)
        node = targets.get(body)
        found = [] if node is None else _visuals(context, node, linked)
        for shape in shapes:
            if len(shape) or (shape.text or "").strip():
                context.stash(shape)
            else:
                remove(shape)
        if found and node is not None:
            for url, matrix in found:
                append(common, assumed_shape(context, url, matrix))
            urls = ", ".join(url for url, _ in found)
            message = (
                f"rigid_body {body.get('sid')!r} had no shape; the geometry of its node "
                f"#{node.get('id')} is assumed to be its shape: {urls}"
            )
        else:
            append(common, assumed_shape(context))
            message = (
                f"rigid_body {body.get('sid')!r} had no shape and its node shows no geometry; "
                "an empty hull, marked as assumed, stands for it"
            )
        context.note(shape_rules.MISSING_SHAPE, body, message)


def _has_geometry(shape: etree._Element) -> bool:
    return any(local(child) in (*GEOMETRIES, *TAPERED) for child in shape)


def assumed_shape(
    context: Context, url: str | None = None, matrix: np.ndarray | None = None
) -> etree._Element:
    """A shape marked as assumed: the geometry of this url at this place, or an empty hull."""
    shape = context.make("shape")
    shape.append(context.make("instance_geometry", url=_nothing(context) if url is None else url))
    shape.extend(place_elements(context, np.eye(4) if matrix is None else matrix))
    extra, technique = context.make("extra"), context.make("technique", profile="colladaphy")
    assumed = etree.SubElement(technique, f"{{{CONFORM}}}assumed", nsmap=OWN_MAP)
    assumed.set("from", "nothing" if url is None else "visual")
    extra.append(technique)
    shape.append(extra)
    return shape


def _nothing(context: Context) -> str:
    """The url of a geometry without any points: the convex hull of nothing."""
    if context.nothing is None:
        geometry = context.make("geometry", id=context.new_id(_NOTHING))
        geometry.append(context.make("convex_mesh"))
        append(context.library("geometries"), geometry)
        context.ids[geometry.get("id", "")] = context.nothing = geometry
    return f"#{context.nothing.get('id')}"


def body_targets(context: Context) -> dict[etree._Element, etree._Element]:
    """The node that the first instance of every body targets."""
    found: dict[etree._Element, etree._Element] = {}
    bodies: dict[etree._Element, dict[str, etree._Element]] = {}
    for instance in context.all("instance_physics_model"):
        model = context.by_url(instance.get("url"))
        if model is None:
            continue
        if model not in bodies:
            bodies[model] = {b.get("sid", ""): b for b in model.iterchildren(NS + "rigid_body")}
        for user in instance.iterchildren(NS + "instance_rigid_body"):
            body = bodies[model].get(user.get("body", ""))
            node = context.by_url(user.get("target"))
            if body is not None and node is not None and local(node) == "node":
                found.setdefault(body, node)
    return found


def _visuals(
    context: Context, node: etree._Element, linked: set[etree._Element]
) -> list[tuple[str, np.ndarray]]:
    """Geometries shown below a node, and where; nodes of other bodies are theirs."""
    found: list[tuple[str, np.ndarray]] = []
    stack = [(node, np.eye(4))]
    while stack:
        current, place = stack.pop()
        for instance in current.iterchildren(NS + "instance_geometry"):
            geometry = context.by_url(instance.get("url"))
            if not are_usable(place.ravel().tolist()):
                continue
            rigid, exact = nearest_rotation(place)
            if geometry is not None and exact and _is_solid(geometry):
                found.append((instance.get("url", ""), rigid))
        below = [child for child in current.iterchildren(NS + "node") if child not in linked]
        stack.extend((child, place @ _matrix_of(child)) for child in reversed(below))
    return found


def _matrix_of(node: etree._Element) -> np.ndarray:
    try:
        return transform_of(node)
    except ValueError:
        return np.full((4, 4), np.nan)  # a malformed transform: nothing can be said of it


def _is_solid(geometry: etree._Element) -> bool:
    mesh = next(geometry.iterchildren(NS + "mesh", NS + "convex_mesh"), None)
    if mesh is None:
        return False
    return mesh.get("convex_hull_of") is not None or any(local(c) in _MESHES for c in mesh)

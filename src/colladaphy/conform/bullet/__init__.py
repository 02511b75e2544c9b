"""For Bullet: a valid COLLADA 1.5 document as the 1.4.1 document that its converter reads.

Bullet's converter has habits of its own (thesis 5.6): it takes a plane's equation, a cylinder's
height and all angles of limits otherwise than the standard, reads no parents of nodes, no
densities, and not every reference. What is written here is read by it with the meaning that the
1.5 document has. A document that was written for Bullet is marked as such, so that reading it
again can turn all of this back.
"""

from __future__ import annotations

import copy
from typing import cast

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.aside import set_aside
from colladaphy.conform.bullet.bodies import (
    drop_unreadable_shapes,
    fold,
    hide_kinematic,
    hold_still,
    moves,
    settle,
    to_radians,
    write_mass,
)
from colladaphy.conform.bullet.constraints import write_constraint, write_limits
from colladaphy.conform.bullet.flatten import Body, Level, flatten
from colladaphy.conform.bullet.geometries import Geometries
from colladaphy.conform.bullet.markup import Names, children, first, insert_all
from colladaphy.conform.bullet.nodes import Nodes
from colladaphy.conform.bullet.scenes import choose_scene, note_ignored, write_scene
from colladaphy.conform.bullet.shapes import geometry_of, write_shape
from colladaphy.conform.bullet.weights import Weights
from colladaphy.conform.downgrade import to_collada_1_4
from colladaphy.conform.downgrade.draft import Draft, detach, local, tag15
from colladaphy.conform.frames import nearest_rotation
from colladaphy.findings import Finding

__all__ = ["MARK", "for_bullet"]

_CONFORM = "urn:colladaphy:conform:1"
MARK = f"{{{_CONFORM}}}written_for"
"""The element that says for whose reading a document was written: ``Bullet``."""


def for_bullet(tree: etree._ElementTree) -> tuple[etree._ElementTree, list[Finding]]:
    """The 1.4.1 document that Bullet reads completely and with the meaning of a valid 1.5 `tree`.

    Returns a new tree, which is valid 1.4.1, and what was changed or cannot be said to Bullet;
    `tree` itself is not touched.
    """
    draft = Draft(copy.deepcopy(tree).getroot())
    # Numbers may be of any size; what comes out as no number is written as none.
    with np.errstate(all="ignore"):
        _rewrite(draft)
    _mark(draft)
    new, findings = to_collada_1_4(etree.ElementTree(draft.root))
    return new, draft.findings + findings


def _rewrite(draft: Draft) -> None:
    scene = choose_scene(draft)
    draft.changed()
    levels: list[Level] = []
    if scene is not None:
        write_scene(draft, scene)
        levels = flatten(draft, scene)
        draft.changed()
        note_ignored(draft, scene, _models_of(draft, levels))
    geometries = Geometries(draft)
    aside = _write_bodies(draft, levels, geometries)
    _write_everywhere(draft, geometries, levels)
    set_aside(draft, aside)


def _models_of(draft: Draft, levels: list[Level]) -> list[etree._Element]:
    urls = {level.instance.get("url", "").strip().removeprefix("#") for level in levels}
    return [model for model in draft.all("physics_model") if model.get("id") in urls]


def _write_bodies(
    draft: Draft, levels: list[Level], geometries: Geometries
) -> list[etree._Element]:
    """Write bodies and constraints; returns the instances that Bullet must not see."""
    nodes = Nodes(draft)
    weights = Weights(draft, geometries)
    all_levels = [level for top in levels for level in top.everything()]
    for level in all_levels:
        for body in list(level.bodies):
            fold(draft, body)
            if not drop_unreadable_shapes(draft, body, geometries, weights):
                message = f"The body {body.sid!r} has no shape that Bullet can read."
                draft.note(rules.NO_SHAPE, body.instance, message)
                body.is_aside = True
                continue
            _write_body(draft, body, weights)
    bodies = [body for level in all_levels for body in level.bodies]
    aside = [body.instance for body in bodies if body.is_aside]
    # Where every node stands must be known before the first of them is moved.
    places = [nodes.place(body) for body in bodies]
    for body, place in zip(bodies, places, strict=True):
        body.pose = nearest_rotation(place)[0]
    for level in all_levels:
        for constraint in level.constraints:
            kept = write_constraint(draft, constraint, nodes)
            if kept is None:
                detach(constraint.instance)
            elif not kept:
                aside.append(constraint.instance)
    for body, place in zip(bodies, places, strict=True):
        nodes.give(body, place)
    for top in levels:
        if "parent" in top.instance.attrib:
            # Every body's node now holds all of its transform.
            message = (
                f"Bullet ignores parent={top.instance.attrib.pop('parent')!r}; it is left out."
            )
            draft.note(rules.IGNORED, top.instance, message)
    return aside


def _write_body(draft: Draft, body: Body, weights: Weights) -> None:
    common = first(body.element, "technique_common")
    shapes = [] if common is None else children(common, "shape")
    if any(local(geometry_of(shape)) == "plane" for shape in shapes):
        hold_still(draft, body, "has a plane as shape")
    write_mass(draft, body, weights)
    settle(draft, body, weights)


def _write_everywhere(draft: Draft, geometries: Geometries, levels: list[Level]) -> None:
    """What must hold for models that no scene instances, too: one file has one convention."""
    draft.changed()
    all_levels = [level for top in levels for level in top.everything()]
    bodies = {body.element: body for level in all_levels for body in level.bodies}
    ids = Names(element.get("id", "") for element in draft.everything())
    for model in draft.all("physics_model"):
        if not model.get("id"):
            model.set("id", ids.new("physics_model"))
    for element in draft.all("rigid_body"):
        hide_kinematic(draft, element)
        body = bodies.get(element)
        for shape in element.iterfind(f"{tag15('technique_common')}/{tag15('shape')}"):
            write_shape(draft, shape, geometries, moves=body is not None and moves(body))
    changed = [element for element in draft.all("rigid_constraint") if write_limits(draft, element)]
    changed += [user for user in draft.all("instance_rigid_body") if to_radians(user)]
    if changed:
        message = f"Angles of {len(changed)} constraints and bodies are in radians."
        draft.note(rules.RADIANS, changed[0], message)


def _mark(draft: Draft) -> None:
    """Say for whom this was written, and forget whose meaning was turned into the standard's."""
    for old in list(draft.root.iter(f"{{{_CONFORM}}}convention", MARK)):
        technique = old.getparent()
        detach(old)
        holder = None if technique is None else technique.getparent()
        if technique is not None and holder is not None and not len(technique):
            detach(technique if len(holder) > 1 else holder)
    extra = draft.make("extra")
    technique = draft.make("technique", attributes={"profile": "colladaphy"})
    mark = etree.SubElement(technique, MARK, nsmap=cast("dict[str, str]", {None: _CONFORM}))
    mark.text = "Bullet"
    extra.append(technique)
    insert_all(draft.root, len(draft.root), [extra])

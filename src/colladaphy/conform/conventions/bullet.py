"""Bullet's COLLADA converter: what it writes, and what it leaves of the files that it edits.

It takes angles for radians and measures minus the angle of COLLADA about each axis, has planes
n·x = D and cylinders of half height, and no frame of mass but the node's origin. Bodies that it
loaded and saves again get a new node transform and new velocities; the rest stays as the tool
wrote it that made the file, the tool's name too. A joint to the world comes out with the same body
at both ends, both in the body's frame where it is now.
"""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
from lxml import etree

from colladaphy.conform import convention_rules
from colladaphy.conform.bodies import body_targets
from colladaphy.conform.bullet.aside import restore_instances, restore_primitives
from colladaphy.conform.context import NS, Context, digits_of, insert, local
from colladaphy.conform.conventions.clues import Clues, place_of
from colladaphy.conform.conventions.places import Places
from colladaphy.conform.conventions.units import to_degrees
from colladaphy.conform.frames import TRANSFORMS, nearest_rotation
from colladaphy.conform.placing import put_place
from colladaphy.conform.solids import numbers_of

__all__ = ["apply", "apply_rewritten", "is_whole", "recognise", "recognise_rewritten"]

_FREE_ANGLE = 180.0
_MODEL = "Bullet-PhysicsModel"
_DIGITS = 6
# Exporters of physics, none of which is known to have written a body that turns.
_TOOLS = ("blender", "illusoft", "chimera", "maya", "max", "feeling", "fcollada", "opencollada")


def recognise(clues: Clues) -> str | None:
    """Bullet's converter names itself or its model; our own writer notes for whom it wrote."""
    if clues.written_for == "bullet":
        return "it was written for Bullet by colladaphy"
    found = clues.tool("bulletcolladaconverter", "bullet physics")
    named = f"it has the model {_MODEL}" if _MODEL in clues.models else None
    return found or named


def is_whole(clues: Clues) -> bool:
    """Whether Bullet wrote all of a file, not only a model into another's."""
    alone = "bullet" in clues.tools.lower() and ";" not in clues.tools
    return alone or clues.written_for == "bullet"


def recognise_rewritten(clues: Clues) -> str | None:
    """A file of another tool that Bullet loaded and saved: its bodies move as Bullet writes it."""
    tool = clues.tool(*_TOOLS)
    if not clues.rewritten or tool is None:
        return None
    return f"{tool}, and {clues.rewritten} bodies turn, in the digits and steps that Bullet writes"


def apply(context: Context, *, whole: bool) -> None:
    """Radians, mirrored limits, planes n·x = D, halved cylinder heights.

    What Bullet edits keeps its shapes: only its own model has Bullet's meaning, unless the
    `whole` file was written for Bullet.
    """
    restore_instances(context)
    _attach_to_world(context)
    for limits in context.all("swing_cone_and_twist"):
        _angles(context, limits)
    for velocity in context.all("angular_velocity"):
        to_degrees(context, velocity)
    for plane in context.all("plane"):
        if whole or _in_model(plane):
            _plane(context, plane)
    for cylinder in context.all("cylinder"):
        if whole or _in_model(cylinder):
            _height(context, cylinder)
    restore_primitives(context)
    _centre(context, whole=whole)


def apply_rewritten(context: Context) -> None:
    """Angular velocities in radians; the limits of another tool come through as they were."""
    _attach_to_world(context)
    for velocity in context.all("angular_velocity"):
        to_degrees(context, velocity)


def _in_model(element: etree._Element) -> bool:
    return any(model.get("id") == _MODEL for model in element.iterancestors())


def _angles(context: Context, limits: etree._Element) -> None:
    """Bullet measures minus the angle: its limits from a to b are those from -b to -a."""
    low, high = limits.find(NS + "min"), limits.find(NS + "max")
    ends = [numbers_of(low), numbers_of(high)]
    if low is None or high is None or not all(len(values) == 3 for values in ends):
        return
    if not any(value and math.isfinite(value) for values in ends for value in values):
        return
    if not context.wants(convention_rules.ANGLE_UNIT):
        return
    mirrored = [[_angle_limit(0.0 - value) for value in values] for values in ends]
    before = [context.write(end, new) for end, new in ((low, mirrored[1]), (high, mirrored[0]))]
    message = (
        f"angular limits {before[0]} to {before[1]} were Bullet's, in radians and mirrored; they "
        f"are now {low.text} to {high.text} degrees"
    )
    context.note(convention_rules.ANGLE_UNIT, limits, message)


def _angle_limit(value: float) -> float:
    if math.isfinite(value) and abs(value) > _FREE_ANGLE:
        return math.copysign(math.inf, value)
    return math.degrees(value)


def _plane(context: Context, plane: etree._Element) -> None:
    equation = plane.find(NS + "equation")
    values = numbers_of(equation)
    if (
        equation is None
        or len(values) != 4
        or not values[3]
        or not context.wants(convention_rules.PLANE_SIGN)
    ):
        return
    length = math.sqrt(sum(value * value for value in values[:3]))
    # Bullet makes the normal a unit vector, but leaves the constant as it is.
    before = context.write(equation, [*values[:3], -values[3] * (length or 1.0)])
    message = f"plane {before} means n·x = D to Bullet; its equation is now {equation.text}"
    context.note(convention_rules.PLANE_SIGN, equation, message)


def _height(context: Context, solid: etree._Element) -> None:
    height = solid.find(NS + "height")
    values = numbers_of(height)
    if height is not None and len(values) == 1 and context.wants(convention_rules.HALF_HEIGHT):
        before = context.write(height, [2 * values[0]])
        message = f"<height> of a {local(solid)} was half of it, {before}; is now {height.text}"
        context.note(convention_rules.HALF_HEIGHT, height, message)


def _attach_to_world(context: Context) -> None:
    """A joint that has one body at both ends holds it to the world, where the body is now."""
    if not context.wants(convention_rules.WORLD_JOINT):
        return
    nodes, places = None, Places(context)
    for constraint in context.all("rigid_constraint"):
        first, second = constraint.find(NS + "ref_attachment"), constraint.find(NS + "attachment")
        name = "" if first is None else first.get("rigid_body", "")
        if not name or second is None or second.get("rigid_body") != name:
            continue
        if nodes is None:
            nodes = _nodes_by_address(context)
        place = places.of(nodes[name]) if name in nodes else None
        frame = place_of(second)
        if place is None or frame is None:
            continue
        second.set("rigid_body", "")
        put_place(context, second, nearest_rotation(place.shown @ frame)[0])
        message = f"both ends were {name!r}: the joint holds it to the world, where it is now"
        context.note(convention_rules.WORLD_JOINT, constraint, message)


def _nodes_by_address(context: Context) -> dict[str, etree._Element]:
    """The node of every body that has one, by the address that attachments have."""
    found = {}
    for body, node in body_targets(context).items():
        model = body.getparent()
        if model is not None:
            found[f"{model.get('id')}/{body.get('sid')}"] = node
    return found


def _centre(context: Context, *, whole: bool) -> None:
    """Bodies without a frame of mass have their centre at the node's origin."""
    bare = []
    for body in context.all("rigid_body"):
        common = body.find(NS + "technique_common")
        if common is None or common.find(NS + "mass_frame") is not None:
            continue
        placed = any(
            local(child) in TRANSFORMS or local(child) == "instance_geometry"
            for shape in common.iterchildren(NS + "shape")
            for child in shape
        )
        if placed and (whole or _in_model(body)):
            bare.append(common)
    if not bare or not context.wants(convention_rules.MASS_CENTRE):
        return
    message = f"the centre of mass of {len(bare)} bodies is their node's origin, as Bullet has it"
    context.note(convention_rules.MASS_CENTRE, bare[0], message)
    for common in bare:
        frame = context.make("mass_frame")
        frame.append(context.make("translate", "0 0 0"))
        before = [i for i, child in enumerate(common) if local(child) in ("dynamic", "mass")]
        insert(common, before[-1] + 1 if before else 0, frame)


def count_rewritten(context: Context) -> int:
    """How many bodies turn and look as Bullet writes those that it loaded; 0 if any does not.

    Bullet reads and writes documents of COLLADA 1.4 only.
    It writes the angular velocity before the velocity, one translate and one rotate at the end of
    the node, and no number with more than six digits.
    """
    found: Counter[bool] = Counter()
    if context.origin != "colladaphy-1.4":
        return 0
    for user in context.all("instance_rigid_body"):
        common = user.find(NS + "technique_common")
        velocity = None if common is None else common.find(NS + "angular_velocity")
        if common is None or not any(numbers_of(velocity)):
            continue
        node = context.by_url(user.get("target"))
        steps = [] if node is None else [child for child in node if local(child) in TRANSFORMS]
        names = [local(step) for step in steps if local(step) != "scale"]
        given = [c for c in common if local(c) in ("angular_velocity", "velocity")]
        plain = names == ["translate", "rotate"] and not any(
            step.get("sid") for step in steps if local(step) != "scale"
        )
        words = [word for e in (*given, *steps[-2:]) for word in (e.text or "").split()]
        short = all(digits_of(word) <= _DIGITS for word in words)
        axis = numbers_of(steps[-1])[:3] if plain else []
        unit = abs(float(np.linalg.norm(axis)) - 1) < 1e-5
        found[plain and short and unit and len(given) == 2] += 1
    return 0 if found[False] else found[True]

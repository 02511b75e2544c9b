"""Bodies: what an instance overrides is folded in, the mass is written out, frames are moved.

Bullet takes mass, dynamic and shapes from the rigid_body, velocities from the instance. The centre
of mass is the node's origin, and a transform inside a shape makes a compound shape, with the
inertia of a box; so a body with one shape has its node at the shape (COLLADA 1.5 §rigid_body,
§instance_rigid_body).
"""

from __future__ import annotations

import math

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.flatten import Body
from colladaphy.conform.bullet.geometries import Geometries
from colladaphy.conform.bullet.markup import (
    children,
    first,
    number_text,
    numbers_text,
    pose_steps,
    put_steps,
    steps_are_plain,
)
from colladaphy.conform.bullet.shapes import geometry_of, is_readable
from colladaphy.conform.bullet.weights import Weights
from colladaphy.conform.downgrade.draft import Draft, detach, local, tag15
from colladaphy.conform.frames import (
    Matrix,
    floats_of,
    inverse,
    transform_of,
    translation,
)

__all__ = ["FOREIGN", "fold", "hide_kinematic", "moves", "settle", "to_radians"]

FOREIGN = "urn:colladaphy:bullet:1"
_ORDER = (
    ("dynamic",),
    ("mass",),
    ("mass_frame",),
    ("inertia",),
    ("instance_physics_material", "physics_material"),
    ("shape",),
)


def _common(element: etree._Element) -> etree._Element:
    found = first(element, "technique_common")
    assert found is not None  # the schema asks for it
    return found


def fold(draft: Draft, body: Body) -> None:
    """Put what the instance says about the body into the rigid_body (thesis 3.3)."""
    own, instance = _common(body.element), _common(body.instance)
    for names in _ORDER:
        given = children(instance, *names)
        if not given:
            continue
        for child in children(own, *names):
            detach(child)
        for child in given:
            _insert_in_order(own, detach(child))
    dynamic = first(own, "dynamic")
    if dynamic is None:
        dynamic = draft.make("dynamic", "true")
        _insert_in_order(own, dynamic)
    dynamic.text = "false" if (dynamic.text or "true").strip() in ("false", "0") else "true"


def _insert_in_order(common: etree._Element, child: etree._Element) -> None:
    rank = {name: place for place, names in enumerate(_ORDER) for name in names}
    own = rank[local(child)]
    position = 0
    for index, other in enumerate(common):
        if isinstance(other.tag, str) and rank.get(local(other), -1) <= own:  # no comment
            position = index + 1
    common.insert(position, child)


def moves(body: Body) -> bool:
    """Whether the body is dynamic; `fold` has said so in the rigid_body."""
    dynamic = first(_common(body.element), "dynamic")
    return dynamic is not None and dynamic.text == "true"


def hold_still(draft: Draft, body: Body, why: str) -> None:
    """Make a body static, with a finding."""
    dynamic = first(_common(body.element), "dynamic")
    if dynamic is not None and dynamic.text == "true":
        dynamic.text = "false"
        draft.note(rules.MADE_STATIC, body.element, f"The body {body.sid!r} {why}.")


def drop_unreadable_shapes(
    draft: Draft, body: Body, geometries: Geometries, weights: Weights
) -> bool:
    """Leave out shapes that Bullet cannot read; whether one is left.

    What they weigh, and where, stays with the body.
    """
    common = _common(body.element)
    shapes = children(common, "shape")
    good = [shape for shape in shapes if is_readable(shape, geometries)]
    if not good:
        return False
    if len(good) < len(shapes) and moves(body):
        _keep_weight(draft, body, weights)
    for shape in shapes:
        if shape not in good:
            url = geometry_of(shape).get("url")
            message = f"The geometry {url!r} has no mesh in this file."
            draft.note(rules.SHAPE_LEFT_OUT, shape, message)
            draft.keep(shape)
    return True


def _keep_weight(draft: Draft, body: Body, weights: Weights) -> None:
    """Write out mass and centre of a body whose shapes say them, all of them."""
    common = _common(body.element)
    steps = pose_steps(draft, weights.center_of_mass(common))
    if first(common, "mass_frame") is None and steps:
        frame = draft.make("mass_frame")
        put_steps(frame, steps)
        _insert_in_order(common, frame)
    if math.isfinite(sum(weights.masses(common))):
        write_mass(draft, body, weights)


# -- mass -------------------------------------------------------------------------------------


def write_mass(draft: Draft, body: Body, weights: Weights) -> None:
    """Write out the mass of a moving body, where only its shapes say it."""
    common = _common(body.element)
    mass = first(common, "mass")
    if mass is None and moves(body):
        total = sum(weights.masses(common))
        if 0.0 < total < math.inf:
            _insert_in_order(common, draft.make("mass", number_text(total)))
            message = f"The body {body.sid!r} got the mass {number_text(total)} of its shapes."
            draft.note(rules.MASS, body.element, message)
        elif total == math.inf:
            hold_still(draft, body, "has infinite mass")
        else:
            message = f"The shapes of the body {body.sid!r} give it no mass."
            draft.note(rules.MASS_UNKNOWN, body.element, message)
    elif mass is not None and moves(body):
        value = floats_of(mass)[0]
        if value == math.inf:
            hold_still(draft, body, "has infinite mass")
        elif not value > 0.0:
            message = f"The body {body.sid!r} moves and has the mass {mass.text}."
            draft.note(rules.MASS_UNKNOWN, body.element, message)


# -- frames -----------------------------------------------------------------------------------


def settle(draft: Draft, body: Body, weights: Weights) -> None:
    """Choose where Bullet's body is in the rigid_body's frame, and move everything there."""
    common = _common(body.element)
    shapes = children(common, "shape")
    center = weights.center_of_mass(common)
    alone = transform_of(shapes[0])
    # Lengths that round to nothing, against the size of what is moved.
    tolerance = 1e-9 * max(1.0, float(np.max(np.abs(center[:3, 3]))))
    if len(shapes) == 1 and (
        not moves(body) or np.allclose(alone[:3, 3], center[:3, 3], rtol=0.0, atol=tolerance)
    ):
        body.inner = alone
        put_steps(shapes[0], [])
    else:
        if moves(body) and not np.allclose(center[:3, 3], 0.0, atol=tolerance):
            body.inner = translation(center[:3, 3].tolist())
        for shape in shapes:
            _move(draft, shape, body.inner)
    _move_mass_frame(draft, body, center)


def _move(draft: Draft, element: etree._Element, inner: Matrix) -> None:
    """Write the transforms of a shape, an attachment or a mass_frame relative to `inner`."""
    if np.array_equal(inner, np.eye(4)) and steps_are_plain(element):
        return
    put_steps(element, pose_steps(draft, inverse(inner) @ transform_of(element)))


def _move_mass_frame(draft: Draft, body: Body, center: Matrix) -> None:
    common = _common(body.element)
    frame = first(common, "mass_frame")
    if np.array_equal(body.inner, np.eye(4)):
        return
    if frame is None:
        turned = not np.allclose(body.inner[:3, :3], np.eye(3), rtol=0.0, atol=1e-15)
        if first(common, "inertia") is None or not turned:
            return
        # The inertia is about the axes of the rigid_body, which are not the node's any more.
        frame = draft.make("mass_frame")
        _insert_in_order(common, frame)
    put_steps(frame, pose_steps(draft, inverse(body.inner) @ center))


def move_attachment(draft: Draft, attachment: etree._Element, inner: Matrix) -> None:
    """Write the frame of an attachment relative to Bullet's body."""
    _move(draft, attachment, inner)


# -- the rest ---------------------------------------------------------------------------------


def to_radians(instance: etree._Element) -> bool:
    """Write the angular velocity in radians per second; whether there was one to change."""
    common = _common(instance)
    for element in children(common, "velocity", "angular_velocity"):
        if not floats_of(element):
            element.text = "0.0 0.0 0.0"
    velocity = first(common, "angular_velocity")
    values = floats_of(velocity)
    if velocity is None or not any(values):
        return False
    velocity.text = numbers_text(math.radians(value) for value in values)
    return True


def hide_kinematic(draft: Draft, element: etree._Element) -> None:
    """Rename elements called kinematic in the extras of a rigid_body."""
    for extra in children(element, "extra"):
        for technique in extra.iter(tag15("technique")):
            for child in list(technique):
                if local(child) == "kinematic":
                    message = f"<kinematic> in the profile {technique.get('profile')!r} is renamed."
                    draft.note(rules.KINEMATIC, child, message)
                    _rename(child)


def _rename(child: etree._Element) -> None:
    twin = etree.Element(f"{{{FOREIGN}}}foreign", name="kinematic")
    twin.text, twin.tail = child.text, child.tail
    twin.extend(list(child))
    for key, value in child.attrib.items():
        twin.set(key, value)
    parent = child.getparent()
    if parent is not None:
        parent.replace(child, twin)

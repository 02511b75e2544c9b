"""Constraints: all limits present and in radians, bodies by their plain sid (§rigid_constraint).

Bullet measures minus the angle of COLLADA about each axis, so that the angles from `lo` to `hi` are
to it those from `-hi` to `-lo`. With one axis free this says the same; with several, the order of
the turns differs, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.bodies import move_attachment
from colladaphy.conform.bullet.flatten import Body, Constraint, Level
from colladaphy.conform.bullet.markup import children, first, numbers_text, pose_steps, put_steps
from colladaphy.conform.bullet.nodes import Nodes
from colladaphy.conform.downgrade.draft import Draft, detach
from colladaphy.conform.frames import Matrix, floats_of, transform_of

__all__ = ["write_constraint", "write_limits"]

_FAR = 999_999.0
"""Bullet frees an axis with a linear limit beyond this."""


@dataclass
class End:
    """One end of a constraint: a body, or the world with the frame in which it is attached."""

    element: etree._Element
    body: Body | None
    frame: Matrix


def write_constraint(draft: Draft, constraint: Constraint, nodes: Nodes) -> bool | None:
    """Make Bullet read the constraint as it is meant.

    False where it has to be set aside, and None where it has to be left out.
    """
    element = constraint.element
    ends: list[End] = []
    for name in ("ref_attachment", "attachment"):
        attachment = first(element, name)
        others = [end.body for end in ends]
        end = None if attachment is None else _end(draft, constraint, attachment, nodes, others)
        if end is None:
            return None
        ends.append(end)
    reference, other = ends
    common = first(element, "technique_common")
    enabled = first(common, "enabled")
    shown = True
    if enabled is not None and (enabled.text or "true").strip() in ("false", "0"):
        message = f"The constraint {element.get('sid')!r} is not enabled; Bullet would apply it."
        draft.note(rules.CONSTRAINT_LEFT_OUT, constraint.instance, message)
        shown = False
    elif any(end.body is not None and end.body.is_aside for end in ends):
        message = f"The constraint {element.get('sid')!r} binds a body that Bullet cannot have."
        draft.note(rules.CONSTRAINT_LEFT_OUT, constraint.instance, message)
        shown = False
    if reference.body is None and other.body is None:
        message = f"The constraint {element.get('sid')!r} binds no body."
        draft.note(rules.CONSTRAINT_LEFT_OUT, constraint.instance, message)
        return None
    if first(common, "spring") is not None:
        message = f"The springs of the constraint {element.get('sid')!r} do nothing in Bullet."
        draft.note(rules.SPRING, element, message)
    if reference.body is None:
        _swap(draft, constraint, reference, other)
        reference, other = other, reference
    for end in (reference, other):
        if end.body is not None:
            end.element.set("rigid_body", end.body.instance.get("body", ""))
            move_attachment(draft, end.element, end.body.inner)
        else:
            end.element.set("rigid_body", "")
            put_steps(end.element, pose_steps(draft, end.frame))
    if other.body is None:
        _check_world(draft, constraint, reference, other)
    return shown


def _swap(draft: Draft, constraint: Constraint, world: End, body: End) -> None:
    """Let the body be the reference, as Bullet does it anyway when the reference is the world."""
    world.element.tag, body.element.tag = body.element.tag, world.element.tag
    world.element.addprevious(detach(body.element))
    for limits in constraint.element.iterfind(".//{*}limits/{*}*"):
        low, high = _limit(limits, "min"), _limit(limits, "max")
        _set(draft, limits, "min", [0.0 - value for value in high])
        _set(draft, limits, "max", [0.0 - value for value in low])
    message = f"The constraint {constraint.element.get('sid')!r} has its body as reference."
    draft.note(rules.SWAPPED, constraint.element, message)


def _check_world(draft: Draft, constraint: Constraint, reference: End, world: End) -> None:
    body = reference.body
    if body is None:
        return
    stands = body.pose @ body.inner @ transform_of(reference.element)
    if not np.allclose(stands, world.frame, rtol=1e-6, atol=1e-6):
        message = f"The frames of the constraint {constraint.element.get('sid')!r} differ at rest."
        draft.note(rules.WORLD_FRAME, constraint.element, message)


# -- references -------------------------------------------------------------------------------


def _end(
    draft: Draft,
    constraint: Constraint,
    attachment: etree._Element,
    nodes: Nodes,
    others: list[Body | None],
) -> End | None:
    """One end; a node means the body whose target it is, or the world beside that body itself."""
    reference = attachment.get("rigid_body", "").strip()
    frame = transform_of(attachment)
    if not reference:
        return End(attachment, None, frame)
    body = _body(constraint.level, reference)
    node = nodes.find(reference)
    if body is not None and not (node is not None and body in others):
        return End(attachment, body, frame)
    if node is not None:
        return End(attachment, None, nodes.world(node) @ frame)
    message = f"The constraint {constraint.element.get('sid')!r} binds {reference!r}, no body here."
    draft.note(rules.CONSTRAINT_LEFT_OUT, constraint.instance, message)
    return None


def _body(level: Level, reference: str) -> Body | None:
    """The body that a reference names: by its sid at the end of a path, its id or its node."""
    path = [part for part in reference.removeprefix("#").split("/") if part not in ("", ".")]
    if not path:
        return None
    for inner in level.everything():
        names = (inner.model.get("id"), inner.instance.get("sid"))
        if len(path) > 1 and inner is not level and path[-2] not in names:
            continue
        body = inner.body(path[-1]) or inner.body("#" + path[-1])
        if body is not None:
            return body
    return None


# -- limits -----------------------------------------------------------------------------------


def _limit(limits: etree._Element | None, name: str) -> list[float]:
    return floats_of(first(limits, name)) or [0.0, 0.0, 0.0]


def _set(draft: Draft, limits: etree._Element, name: str, values: list[float]) -> None:
    element = first(limits, name)
    if element is None:
        element = draft.make(name)
        limits.insert(0 if name == "min" else len(limits), element)
    element.text = numbers_text(values)


def write_limits(draft: Draft, element: etree._Element) -> bool:
    """Write every limit of a rigid_constraint; whether an angle changed its unit."""
    common = first(element, "technique_common")
    if common is None:
        return False
    limits = first(common, "limits")
    if limits is None:
        limits = draft.make("limits")
        before = children(common, "enabled", "interpenetrate")
        common.insert(common.index(before[-1]) + 1 if before else 0, limits)
    changed = False
    for position, name in enumerate(("swing_cone_and_twist", "linear")):
        part = first(limits, name)
        if part is None:
            part = draft.make(name)
            limits.insert(position, part)
        low, high = _limit(part, "min"), _limit(part, "max")
        angular = name != "linear"
        pairs = [_pair(draft, element, *pair, angular) for pair in zip(low, high, strict=True)]
        changed |= angular and any(pair not in ((0.0, 0.0), (1.0, 0.0)) for pair in pairs)
        _set(draft, part, "min", [pair[0] for pair in pairs])
        _set(draft, part, "max", [pair[1] for pair in pairs])
    return changed


def _pair(
    draft: Draft, element: etree._Element, low: float, high: float, angular: bool
) -> tuple[float, float]:
    """Both limits of one axis as Bullet wants them; free is 1 and 0, and angles are mirrored."""
    far_low, far_high = _far(low, angular), _far(high, angular)
    if low > high or (far_low and far_high):
        return 1.0, 0.0
    if far_low or far_high:
        axis = "angular" if angular else "linear"
        message = f"A {axis} axis of the constraint {element.get('sid')!r} has one limit."
        draft.note(rules.ONE_SIDED, element, message)
    if angular:
        return (
            -math.pi if far_high else 0.0 - math.radians(high),
            math.pi if far_low else 0.0 - math.radians(low),
        )
    return (-_FAR if far_low else low, _FAR if far_high else high)


def _far(value: float, angular: bool) -> bool:
    return math.isinf(value) if angular else abs(value) > _FAR

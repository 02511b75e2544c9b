"""Rigid constraints as joints (thesis 4.5, 5.3; COLLADA 1.5 §rigid_constraint).

A constraint binds the two bodies of the same instance of its physics model. Attachments are frames
in the rigid_body; in the World they are frames in the body, whose origin is the centre of mass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document.names import c, local_name
from colladaphy.document.nodes import pose_of_steps
from colladaphy.document.poses import IDENTITY, Pose, Vector
from colladaphy.errors import WorldError
from colladaphy.mapper import rules
from colladaphy.mapper.bodies import same_token, system_id
from colladaphy.mapper.numbers import DEGREE
from colladaphy.mapper.profile import boolean, numbers, pe_child, quaternion, vector
from colladaphy.mapper.staleness import Precision

if TYPE_CHECKING:
    from colladaphy.document import Document, Prefer
    from colladaphy.mapper.plans import Plan
    from colladaphy.world import World

__all__ = ["Attached", "ConstraintReader", "JointPlan"]

Attached = tuple["Plan | None", Pose]
Spring = tuple[float, float, float]
_NOTHING: Vector = (0.0, 0.0, 0.0)
# What a spring is where its elements say nothing (COLLADA 1.5 §spring).
_DEFAULT_SPRING: Spring = (1.0, 0.0, 0.0)


@dataclass(slots=True)
class Limits:
    """Lower and upper limits along, or about, three axes."""

    low: Vector = _NOTHING
    high: Vector = _NOTHING


@dataclass(slots=True)
class JointPlan:
    """What a joint will be."""

    element: etree._Element
    file: str | None
    bodies: tuple[int | None, int | None] = (None, None)
    frames: list[Pose] = field(default_factory=list)
    linear: Limits = field(default_factory=Limits)
    angular: Limits = field(default_factory=Limits)
    linear_spring: Spring | None = None
    angular_spring: Spring | None = None
    enabled: bool = True
    interpenetrate: bool = False
    uid: int = 0
    sid: int | None = None
    name: str | None = None


class ConstraintReader:
    """Reads constraints; what it cannot make a joint of is noted."""

    def __init__(self, document: Document, prefer: Prefer) -> None:
        self._document = document
        self._prefer = prefer

    def read(
        self,
        element: etree._Element,
        document: Document,
        attached: Sequence[Attached],
    ) -> JointPlan:
        """The joint of a constraint between two bodies, or nodes of the world (None, its pose)."""
        plan = JointPlan(element, document.file)
        plan.bodies = (_sid(attached[0][0]), _sid(attached[1][0]))
        steps = [element.find(c(name)) for name in ("ref_attachment", "attachment")]
        plan.frames = [
            self._frame(step, body, place)
            for step, (body, place) in zip(steps, attached, strict=True)
        ]
        common = element.find(c("technique_common"))
        if common is not None:
            _read_common(plan, common)
        plan.name = element.get("name")
        sid = element.get("sid", "")
        kept = pe_child(element, "joint")
        if kept is not None:
            plan.sid = system_id(sid, "Joint")
            if kept.get("sid") is not None:
                plan.sid = int(kept.get("sid", "0"))
            plan.uid = int(kept.get("uid", "0"))
            name = kept.get("name")
            if name is not None and same_token(name, plan.name):
                plan.name = name
            if self._prefer != "common":
                self._refine(plan, kept, element, document, attached)
        return plan

    @staticmethod
    def _frame(step: etree._Element | None, body: Plan | None, place: Pose) -> Pose:
        pose = IDENTITY if step is None else pose_of_steps(step)
        return place.then(pose) if body is None else body.origin.then(pose)

    def _refine(
        self,
        plan: JointPlan,
        kept: etree._Element,
        element: etree._Element,
        document: Document,
        attached: Sequence[Attached],
    ) -> None:
        precision = Precision((element,))
        for child in kept:
            name = local_name(child.tag)
            if name in ("frame1", "frame2"):
                place = int(name[-1]) - 1
                plan.frames[place] = self._exact_frame(
                    plan.frames[place], child, precision, element, document, attached[place][0]
                )
            elif name in ("linear_limits", "angular_limits"):
                limits = Limits(vector(child[0]), vector(child[1]))
                stated: Limits = getattr(plan, name.partition("_")[0])
                same = precision.same_each((*stated.low, *stated.high), (*limits.low, *limits.high))
                if self._decide(name, element, document, stated, limits, same=same):
                    setattr(plan, name.partition("_")[0], limits)
            elif name in ("linear_spring", "angular_spring"):
                a, b, d = (numbers(value)[0] for value in child)
                spring = getattr(plan, name)
                same = spring is not None and precision.same_each(spring, (a, b, d))
                same = same or any(abs(value) > 1e300 for value in (a, b, d))
                if self._decide(name, element, document, spring, (a, b, d), same=same):
                    setattr(plan, name, (a, b, d))

    def _exact_frame(
        self,
        stated: Pose,
        frame: etree._Element,
        precision: Precision,
        element: etree._Element,
        document: Document,
        body: Plan | None,
    ) -> Pose:
        """The frame of the pe profile, unless what it is in the common profile was edited."""
        exact = stated
        for child in frame:
            if local_name(child.tag) == "position":
                exact = Pose(vector(child), exact.orientation)
            elif local_name(child.tag) == "orientation":
                exact = Pose(exact.position, quaternion(child))
        outer = IDENTITY if body is None else body.origin.inverse()
        one, other = outer.then(stated), outer.then(exact)
        same = precision.same_turn(one.rotation, other.rotation)
        if all(map(math.isfinite, (*one.translation, *other.translation))):
            extent = max(map(abs, outer.translation))
            same &= precision.same_as_whole(one.translation, other.translation, extent)
        return exact if self._decide("frame", element, document, one, other, same=same) else stated

    def _decide(
        self,
        what: str,
        element: etree._Element,
        document: Document,
        stated: object,
        kept: object,
        *,
        same: bool,
    ) -> bool:
        if self._prefer == "profile" or same:
            return True
        message = (
            f"The {what.replace('_', ' ')} of {element.get('sid')!r} is {stated} in the common "
            f"profile, {kept} in the pe profile; the common one was edited and is taken."
        )
        self._document.note(rules.STALE, element, message, file=document.file)
        return False

    def create(self, world: World, plan: JointPlan) -> bool:
        """Create the joint; False, with a finding, where the World refuses it."""
        try:
            joint = world.attach_joint(
                None if plan.bodies[0] is None else world.body(plan.bodies[0]),
                None if plan.bodies[1] is None else world.body(plan.bodies[1]),
                frame1=(plan.frames[0].translation, plan.frames[0].rotation),
                frame2=(plan.frames[1].translation, plan.frames[1].rotation),
                linear_min=plan.linear.low,
                linear_max=plan.linear.high,
                angular_min=plan.angular.low,
                angular_max=plan.angular.high,
                linear_spring=plan.linear_spring,
                angular_spring=plan.angular_spring,
                enabled=plan.enabled,
                interpenetrate=plan.interpenetrate,
                uid=plan.uid,
                sid=plan.sid,
                name=plan.name,
            )
        except WorldError as error:
            message = f"{error.findings[0].message} The constraint is skipped."
            self._document.note(rules.CONSTRAINT_FAULTY, plan.element, message, file=plan.file)
            return False
        row = world.joint_table.find(joint.sid)
        # As they were stored, even where their length is not one.
        world.joint_table.raw("orientations")[row] = [frame.rotation for frame in plan.frames]
        return True


def _sid(plan: Plan | None) -> int | None:
    return None if plan is None else plan.part.sid


def _read_common(plan: JointPlan, common: etree._Element) -> None:
    for child in common:
        match local_name(child.tag):
            case "enabled":
                plan.enabled = boolean(child)
            case "interpenetrate":
                plan.interpenetrate = bool((child.text or "").strip()) and boolean(child)
            case "limits":
                for group in child:
                    if local_name(group.tag) == "linear":
                        plan.linear = _limits(group)
                    elif local_name(group.tag) == "swing_cone_and_twist":
                        limits = _limits(group)
                        plan.angular = Limits(_radians(limits.low), _radians(limits.high))
            case "spring":
                for group in child:
                    if local_name(group.tag) == "linear":
                        plan.linear_spring = _spring(group)
                    elif local_name(group.tag) == "angular":
                        stiffness, damping, target = _spring(group)
                        plan.angular_spring = (
                            _finite(stiffness / DEGREE),
                            _finite(damping / DEGREE),
                            target * DEGREE,
                        )


def _finite(value: float) -> float:
    return math.copysign(1.7e308, value) if math.isinf(value) else value


def _radians(degrees: Vector) -> Vector:
    x, y, z = degrees
    return x * DEGREE, y * DEGREE, z * DEGREE


def _limits(group: etree._Element) -> Limits:
    """min and max; an element that is missing or empty is zero, the default of the standard."""
    limits = Limits()
    for child in group:
        if (child.text or "").strip():
            if local_name(child.tag) == "min":
                limits.low = vector(child)
            elif local_name(child.tag) == "max":
                limits.high = vector(child)
    return limits


def _spring(group: etree._Element) -> Spring:
    values = dict(zip(("stiffness", "damping", "target_value"), _DEFAULT_SPRING, strict=True))
    for child in group:
        name = local_name(child.tag)
        if name in values and (child.text or "").strip():
            values[name] = numbers(child)[0]
    return values["stiffness"], values["damping"], values["target_value"]

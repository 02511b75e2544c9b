"""Where an instance is and how it moves: its node, its velocities, and the pe profile's motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from colladaphy.document.names import c, local_name
from colladaphy.document.poses import IDENTITY, Pose, Vector, rotate_vector, unit_quaternion
from colladaphy.mapper.numbers import DEGREE
from colladaphy.mapper.planes import plane_pose
from colladaphy.mapper.profile import pe_child, quaternion, vector
from colladaphy.mapper.shapes import move_plane
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from lxml import etree

    from colladaphy.mapper.bodies import BodyInstance, BodyReader
    from colladaphy.mapper.plans import Plan
    from colladaphy.mapper.profile import ProfileBody
    from colladaphy.mapper.staleness import Precision

__all__ = ["read_motion"]


def read_motion(
    reader: BodyReader,
    plan: Plan,
    instance: BodyInstance,
    profile: ProfileBody | None,
    precision: Precision,
) -> None:
    """Complete a plan with pose, velocities and forces of its instance."""
    _velocities(plan, instance.element)
    kept = pe_child(instance.element, "motion")
    if kept is not None and reader.prefer == "common":
        kept = None
    if plan.part.kind is Kind.PLANE:
        _place_plane(reader, plan, instance, profile, kept)
    elif kept is not None:
        _pose(reader, plan, instance, kept, precision)
    if kept is not None:
        _exact_velocities(reader, plan, instance, kept, precision)


def _velocities(plan: Plan, element: etree._Element) -> None:
    common = element.find(c("technique_common"))
    for child in () if common is None else common:
        name = local_name(child.tag)
        if name == "velocity" and (child.text or "").strip():
            plan.linear_velocity = vector(child)
        elif name == "angular_velocity" and (child.text or "").strip():
            x, y, z = vector(child)
            plan.angular_velocity = (x * DEGREE, y * DEGREE, z * DEGREE)


def _decide(
    reader: BodyReader,
    what: str,
    instance: BodyInstance,
    stated: object,
    kept: object,
    *,
    same: bool,
) -> bool:
    if reader.prefer == "profile" or same:
        return True
    reader.stale(what, instance.element, instance.document, stated, kept)
    return False


def _pose(
    reader: BodyReader,
    plan: Plan,
    instance: BodyInstance,
    motion: etree._Element,
    precision: Precision,
) -> None:
    pose = plan.part.pose
    for child in motion:
        name = local_name(child.tag)
        if name == "position":
            kept = vector(child)
            same = precision.same_each(pose.translation, kept)
            if _decide(reader, name, instance, pose.translation, kept, same=same):
                pose = Pose(kept, pose.orientation)
        elif name == "orientation":
            turn = quaternion(child)
            same = precision.same_turn(pose.rotation, turn)
            if _decide(reader, name, instance, pose.rotation, turn, same=same):
                pose = Pose(pose.position, turn)
    plan.part.pose = pose


def _exact_velocities(
    reader: BodyReader,
    plan: Plan,
    instance: BodyInstance,
    motion: etree._Element,
    precision: Precision,
) -> None:
    plan.sleeping = motion.get("sleeping") in ("true", "1")
    for child in motion:
        name = local_name(child.tag)
        if name == "force":
            plan.force = vector(child)
        elif name == "torque":
            plan.torque = vector(child)
        elif name in ("linear_velocity", "angular_velocity"):
            kept = vector(child)
            stated: Vector = getattr(plan, name)
            same = precision.same_each(stated, kept)
            if _decide(reader, name.replace("_", " "), instance, stated, kept, same=same):
                setattr(plan, name, kept)


def _place_plane(
    reader: BodyReader,
    plan: Plan,
    instance: BodyInstance,
    profile: ProfileBody | None,
    motion: etree._Element | None,
) -> None:
    """A plane is where its equation says; anchor and orientation are the pe profile's."""
    part = plan.part
    local = part.dimensions
    part.dimensions = move_plane(instance.pose, local)
    part.pose = plane_pose(part.dimensions)
    plan.origin = part.pose.inverse().then(instance.pose)
    kept = None if profile is None else profile.part
    if kept is None or reader.prefer == "common":
        return
    if kept.anchor is not None and kept.dimensions == local:
        anchor = kept.anchor if instance.pose == IDENTITY else instance.pose.point(kept.anchor)
        part.pose = Pose(anchor, part.pose.orientation)
    for child in () if motion is None else motion:
        if local_name(child.tag) == "orientation":
            turn = quaternion(child)
            normal = rotate_vector(unit_quaternion(turn), (0.0, 0.0, 1.0))
            if all(abs(a - b) <= 1e-6 for a, b in zip(normal, part.dimensions[:3], strict=True)):
                part.pose = Pose(part.pose.position, turn)
    plan.origin = part.pose.inverse().then(instance.pose)

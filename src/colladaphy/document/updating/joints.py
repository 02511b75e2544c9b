"""Attachments of joints in the frames of rigid bodies."""

from __future__ import annotations

from lxml import etree

from colladaphy.document.updating.elements import child, drop, put, put_first
from colladaphy.document.updating.nodes import transforms_of
from colladaphy.links.names import c
from colladaphy.links.poses import Poses
from colladaphy.mapper import Loaded
from colladaphy.world import World

__all__ = ["add_frame", "gone_for_good", "joint_sids", "release_kinematics"]


def add_frame(attachment: etree._Element, frame: Poses | None) -> None:
    """Let an attachment in a body's frame be one in that of its rigid_body."""
    if frame is not None:
        put_first(attachment, transforms_of(frame, {})[0], "asset")


def joint_sids(loaded: Loaded) -> dict[int, int]:
    """The rows of the joints that the World took, by system id."""
    known = set(loaded.world.joint_table.column("sids").tolist())
    return {sid: row for row, sid in enumerate(loaded.joints.sids.tolist()) if sid in known}


def gone_for_good(loaded: Loaded, world: World, gone: set[int]) -> list[str]:
    """The names of kinematic joints that are gone, though both of the links are there.

    The kinematics would make them again.
    """
    table = loaded.world.joint_table
    driven = gone & set(loaded.driven.tolist())
    there = {0, *(body.sid for body in world.bodies)} if driven else set()
    ends = dict(zip(table.column("sids").tolist(), table.column("bodies").tolist(), strict=True))
    names = {joint.sid: joint.name for joint in loaded.world.joints} if driven else {}
    return [names[sid] or f"Joint{sid}" for sid in sorted(driven) if there.issuperset(ends[sid])]


def release_kinematics(root: etree._Element) -> None:
    """Take the kinematics out of effect, and keep what put them into it in an extra.

    All other joints of theirs are rigid_constraints by now.
    """
    scene = child(root, "scene")
    if scene is None:
        return
    for instance in list(scene.iterchildren(c("instance_kinematics_scene"))):
        extra = etree.Element(c("extra"))
        drop(instance)
        etree.SubElement(extra, c("technique"), profile="colladaphy").append(instance)
        put(scene, extra, ("instance_physics_scene", "instance_visual_scene"))

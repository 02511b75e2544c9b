"""Attachments of joints in the frames of rigid bodies."""

from __future__ import annotations

from lxml import etree

from colladaphy.document.updating.elements import put_first
from colladaphy.document.updating.nodes import transforms_of
from colladaphy.links.poses import Poses
from colladaphy.mapper import Loaded

__all__ = ["add_frame", "joint_sids"]


def add_frame(attachment: etree._Element, frame: Poses | None) -> None:
    """Let an attachment in a body's frame be one in that of its rigid_body."""
    if frame is not None:
        put_first(attachment, transforms_of(frame, {})[0], "asset")


def joint_sids(loaded: Loaded) -> dict[int, int]:
    """The rows of the joints that the World took, by system id."""
    known = set(loaded.world.joint_table.column("sids").tolist())
    return {sid: row for row, sid in enumerate(loaded.joints.sids.tolist()) if sid in known}

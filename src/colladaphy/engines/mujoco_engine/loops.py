"""Joints that close loops, as equality constraints between sites."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from colladaphy.world import JointKind, rotations

if TYPE_CHECKING:
    from colladaphy.world import Joint

__all__ = ["can_close", "close"]


def can_close(joint: Joint) -> bool:
    """True for fixed joints, and for ball and hinge joints without limits, springs and motors."""
    if joint.motor[1]:
        return False
    if any(joint.linear_spring[:2]) or any(joint.angular_spring[:2]):
        return False
    if np.any(joint.linear_min) or np.any(joint.linear_max):
        return False
    low, high = joint.angular_min, joint.angular_max
    locked = low == high
    free = np.isneginf(low) & np.isposinf(high)
    kinds = (JointKind.FIXED, JointKind.HINGE, JointKind.BALL)
    return joint.kind in kinds and bool(np.all(free | (locked & (low == 0.0))))


def close(spec: Any, joint: Joint, bodies: dict[int, Any], solref: list[float]) -> None:
    """Hold the frames of `joint` together: wholly, in a point, or in two points of its axis."""
    frames = []
    for body, (position, orientation) in (
        (joint.body1, joint.frame1),
        (joint.body2, joint.frame2),
    ):
        turn = rotations.normalize(orientation)
        frames.append((bodies[body.sid if body else 0], position, turn))
    points = [np.zeros(3)]
    if joint.kind is JointKind.HINGE:
        axis = np.where(joint.angular_min != joint.angular_max, 1.0, 0.0)
        points.append(axis)
    weld = joint.kind is JointKind.FIXED
    for number, point in enumerate(points):
        names = [f"loop{joint.sid}.{number}.{side}" for side in (1, 2)]
        for name, (body, position, turn) in zip(names, frames, strict=True):
            site = body.add_site()
            site.name = name
            site.pos = position + rotations.rotate(turn, point)
            site.quat = turn
        equality = spec.add_equality()
        kinds = mujoco.mjtEq
        equality.type = kinds.mjEQ_WELD if weld else kinds.mjEQ_CONNECT
        equality.objtype = mujoco.mjtObj.mjOBJ_SITE
        equality.name1, equality.name2 = names
        equality.solref = solref
        if weld:
            equality.data[10] = 1.0  # torque counts as much as force

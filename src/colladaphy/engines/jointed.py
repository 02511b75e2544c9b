"""How joints find their bodies: apart, moving against them, or with limits that cannot be kept."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.frames import ORIGIN, Pose
from colladaphy.engines.rules import (
    JOINT_DISPLACED,
    JOINT_LIMITS,
    JOINT_MOTOR,
    JOINT_OUTSIDE,
    JOINT_VELOCITY,
)
from colladaphy.world import JointKind, coordinates, rotations

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import Body, Joint, World

__all__ = [
    "angles_of",
    "crossed",
    "fastest",
    "joint_findings",
    "misfit",
    "mismatch",
    "motor_findings",
    "relative",
]

Floats = NDArray[np.float64]

_UNITS = np.eye(3)
_NEAR = 1e-6
"""Lengths against those of the joint, angles, and speeds against the scene's, that are zero."""


def fastest(world: World) -> tuple[float, float]:
    """The largest component of a linear and of an angular velocity of what can move."""
    moving = ~world.fixed
    return (
        float(np.abs(world.linear_velocities[moving]).max(initial=0.0)),
        float(np.abs(world.angular_velocities[moving]).max(initial=0.0)),
    )


def crossed(joint: Joint) -> bool:
    """True if a lower limit is above the upper one."""
    return bool(
        np.any(joint.linear_min > joint.linear_max) or np.any(joint.angular_min > joint.angular_max)
    )


def relative(joint: Joint, one: Pose, two: Pose) -> tuple[Floats, Floats]:
    """Shift (3,) and turn (4,) of frame 2 in frame 1, the bodies being at `one` and `two`."""
    pose = (one @ Pose.of(*joint.frame1)).inverse() @ (two @ Pose.of(*joint.frame2))
    return pose.position, pose.orientation


def angles_of(joint: Joint, turn: Floats) -> Floats:
    """Turns (3,) about x, the new y, the new z; within the limits where a full turn helps."""
    return coordinates.angles_of(np.stack([joint.angular_min, joint.angular_max]), turn)


def misfit(joint: Joint, one: Pose, two: Pose) -> tuple[float, float]:
    """How far (length, radians) the bodies are from where the locked axes hold them."""
    shift, turn = relative(joint, one, two)
    low, high = joint.linear_min, joint.linear_max
    off = float(np.linalg.norm(np.where(low == high, shift - low, 0.0)))
    low, high = joint.angular_min, joint.angular_max
    if np.all(low != high):
        return off, 0.0
    angles = np.where(low == high, low, angles_of(joint, turn))
    nearest = np.array(rotations.IDENTITY)
    for i in range(3):
        nearest = rotations.multiply(nearest, rotations.from_axis_angle(_UNITS[i], angles[i]))
    apart = rotations.multiply(rotations.conjugate(nearest), turn)
    return off, float(rotations.to_axis_angle(apart)[1])


def mismatch(joint: Joint, one: Pose, two: Pose) -> tuple[float, float]:
    """Speeds (of a length, of an angle) along locked axes, at which the bodies leave the joint."""
    outer = one @ Pose.of(*joint.frame1)
    point = (two @ Pose.of(*joint.frame2)).position
    (linear1, angular1), (linear2, angular2) = _motion(joint.body1), _motion(joint.body2)
    arms = (point - one.position, point - two.position)
    drift = linear2 + np.cross(angular2, arms[1]) - linear1 - np.cross(angular1, arms[0])
    spin = rotations.unrotate(outer.orientation, angular2 - angular1)
    drift = rotations.unrotate(outer.orientation, drift)
    locked = joint.linear_min == joint.linear_max
    turning = np.flatnonzero(joint.angular_min != joint.angular_max)
    if len(turning):
        angles = angles_of(joint, relative(joint, one, two)[1])
        axes = coordinates.turned_axes(angles)[turning]
        base = np.linalg.qr(axes.T)[0]
        spin = spin - base @ (base.T @ spin) if len(turning) < 3 else np.zeros(3)
    return float(np.linalg.norm(drift[locked])), float(np.linalg.norm(spin))


def _motion(body: Body | None) -> tuple[Floats, Floats]:
    if body is None or body.fixed:
        return np.zeros(3), np.zeros(3)
    return body.linear_velocity, body.angular_velocity


def motor_findings(joint: Joint) -> Iterator[Finding]:
    """That a motor has no single axis to drive."""
    if joint.motor[1] and joint.kind not in (JointKind.HINGE, JointKind.SLIDER):
        kind = joint.kind.name.lower()
        yield JOINT_MOTOR.at(message=f"{joint!r} has a motor, but is a {kind} joint.")


def joint_findings(
    joint: Joint, speeds: tuple[float, float], *, closing: bool = False
) -> Iterator[Finding]:
    """What is wrong between `joint` and its bodies, given the `fastest` speeds of the World.

    `closing`: a joint that closes a loop, whose bodies are not put where it holds them.
    """
    if crossed(joint):
        yield JOINT_LIMITS.at(message=f"{joint!r} has a lower limit above the upper one.")
        return
    one, two = (
        ORIGIN if body is None else Pose.of(body.position, body.orientation)
        for body in (joint.body1, joint.body2)
    )
    off, angle = misfit(joint, one, two)
    arms = [float(np.abs(joint.frame1[0]).max()), float(np.abs(joint.frame2[0]).max())]
    reach = max(float(np.abs(one.position).max()), float(np.abs(two.position).max()), *arms)
    if not closing and (off > _NEAR * (1.0 + reach) or angle > _NEAR):
        message = f"{joint!r}: its frames are {off:g} and {angle:g} rad apart."
        yield JOINT_DISPLACED.at(message=message)
    elif beyond := _beyond(joint, one, two, reach):
        yield JOINT_OUTSIDE.at(message=f"{joint!r} starts outside of its limits, {beyond}.")
    drift, spin = mismatch(joint, one, two)
    linear, angular = speeds
    arm = max(arms)
    if drift > _NEAR * (linear + angular * arm) or spin > _NEAR * (angular + linear / (arm or 1.0)):
        message = (
            f"{joint!r}: its bodies move against it, at {drift:g} and {spin:g} rad a unit of time."
        )
        yield JOINT_VELOCITY.at(message=message)


def _beyond(joint: Joint, one: Pose, two: Pose, reach: float) -> str:
    shift, turn = relative(joint, one, two)
    free = bool(np.all(np.isinf(joint.angular_min) & np.isinf(joint.angular_max)))
    angles = np.zeros(3) if free else angles_of(joint, turn)
    for values, low, high, slack, unit in (
        (shift, joint.linear_min, joint.linear_max, _NEAR * (1.0 + reach), ""),
        (angles, joint.angular_min, joint.angular_max, _NEAR, " rad"),
    ):
        past = np.where(low != high, np.maximum(low - values, values - high), 0.0)
        if np.max(past) > slack:
            return f"by {float(np.max(past)):g}{unit}"
    return ""

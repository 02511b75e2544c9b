"""The axes of a joint: what is locked and what moves, and coordinates from poses.

A joint puts frame 2 where frame 1 is, shifted along the axes of frame 1 and then turned about x,
then the new y, then the new z (three free turns are a ball).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.frames import Pose
from colladaphy.engines.jointed import angles_of, relative
from colladaphy.world import rotations

if TYPE_CHECKING:
    from colladaphy.engines.mujoco_engine.forest import Link
    from colladaphy.world import Joint

__all__ = ["Freedom", "Hanging", "coordinates", "hang"]

Floats = NDArray[np.float64]
_UNITS = np.eye(3)


@dataclass(frozen=True, slots=True)
class Freedom:
    """One degree of freedom of a hanging body (three for a ball), in the order of MuJoCo."""

    kind: str
    """"slide", "hinge" or "ball"."""
    index: int
    """Axis 0, 1, 2 of frame 1; 0 for a ball."""
    axis: Floats
    """Direction (3,) in the child's body frame, at zero."""


@dataclass(frozen=True, slots=True)
class Hanging:
    """How a child hangs on its parent."""

    zero: Pose
    """The child in the parent's body frame with all coordinates zero."""
    anchor: Floats
    """The point (3,) of the child, at zero, about which it turns."""
    freedoms: tuple[Freedom, ...]


def hang(joint: Joint, link: Link) -> Hanging:
    """How the child of `link` hangs on its parent by `joint`."""
    frame1, frame2 = Pose.of(*joint.frame1), Pose.of(*joint.frame2)
    low, high = joint.linear_min, joint.linear_max
    slides = [i for i in range(3) if low[i] != high[i]]
    shift = np.where(low == high, low, 0.0)
    low, high = joint.angular_min, joint.angular_max
    turning = [i for i in range(3) if low[i] != high[i]]
    locked = np.where(low == high, low, 0.0)
    ball = len(turning) == 3 and bool(np.all(np.isinf(low) & np.isinf(high)))
    turns = [rotations.from_axis_angle(_UNITS[i], locked[i]) for i in range(3)]
    whole = rotations.multiply(turns[0], rotations.multiply(turns[1], turns[2]))
    between = Pose.of(shift, whole)  # frame 2 in frame 1 at zero
    if link.reverse:
        own, zero = frame1, frame2 @ between.inverse() @ frame1.inverse()
        anchor = own.position + rotations.rotate(own.orientation, shift)
        # Frame 2 is at rest: z, then y, then x turn backwards, and last comes the shift.
        hinges = [(i, -_after(turns[:i][::-1], _UNITS[i], back=True)) for i in (2, 1, 0)]
        shifts = [(i, -_UNITS[i]) for i in (2, 1, 0)]
    else:
        own, zero = frame2, frame1 @ between @ frame2.inverse()
        anchor = own.position
        hinges = [(i, _after(turns[i + 1 :], _UNITS[i])) for i in (0, 1, 2)]
        shifts = [(i, rotations.unrotate(whole, _UNITS[i])) for i in (0, 1, 2)]
    sliding = [
        Freedom("slide", i, rotations.rotate(own.orientation, axis))
        for i, axis in shifts
        if i in slides
    ]
    spinning = [
        Freedom("hinge", i, rotations.rotate(own.orientation, axis))
        for i, axis in hinges
        if i in turning
    ]
    if ball:
        spinning = [Freedom("ball", 0, np.array([0.0, 0.0, 1.0]))]
    both = [*spinning, *sliding] if link.reverse else [*sliding, *spinning]
    return Hanging(zero, anchor, tuple(both))


def _after(turns: list[Floats], axis: Floats, *, back: bool = False) -> Floats:
    """`axis` as seen after the locked `turns` that follow it, in their order."""
    for turn in turns:
        axis = rotations.rotate(turn, axis) if back else rotations.unrotate(turn, axis)
    return axis


def coordinates(joint: Joint, link: Link, hanging: Hanging, one: Pose, two: Pose) -> list[float]:
    """The coordinates of the freedoms of `hanging` that come closest to the poses."""
    shift, turn = relative(joint, one, two)
    angles = angles_of(joint, turn)
    values: list[float] = []
    for freedom in hanging.freedoms:
        if freedom.kind == "slide":
            values.append(float(shift[freedom.index]))
        elif freedom.kind == "hinge":
            values.append(float(angles[freedom.index]))
        else:
            values.extend(_ball(joint, link, turn).tolist())
    return values


def _ball(joint: Joint, link: Link, turn: Floats) -> Floats:
    """The turn of a ball as MuJoCo has it, in the child's body frame."""
    frame = joint.frame1 if link.reverse else joint.frame2
    own = rotations.normalize(frame[1])
    turned = rotations.conjugate(turn) if link.reverse else turn
    return np.concatenate([turned[:1], rotations.rotate(own, turned[1:])])

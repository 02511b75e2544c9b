"""What a joint amounts to in a plane: what pymunk's constraints can do, or why they can't."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.jointed import motor_findings
from colladaphy.engines.planar import LARGEST, TOLERANCE
from colladaphy.engines.plane import Frame
from colladaphy.engines.rules import JOINT_INERT, JOINT_LIMITS, JOINT_MOTOR, NOT_PLANAR, SIZE
from colladaphy.findings import Finding
from colladaphy.world import JointKind, rotations

if TYPE_CHECKING:
    from colladaphy.world import Joint

__all__ = ["Flat", "Link", "Rail", "plan"]

Floats = NDArray[np.float64]
Flat = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Rail:
    """A line, at load; points relative to the centres of the bodies."""

    base: Flat
    along: Flat
    """Unit vector."""
    limits: tuple[float, float]
    """How far from the base the point may be."""
    arm: Flat
    """The point, of the second body."""


@dataclass(slots=True)
class Link:
    """A joint in the plane. Anchors are relative to the centres of the bodies, at load."""

    first: int
    """System id of the reference body, 0 for the world."""
    second: int
    collide: bool
    pivot: tuple[Flat, Flat] | None = None
    """Points of the two bodies that stay together."""
    rail: Rail | None = None
    """A straight line of the first body on which a point of the second stays."""
    phase: float | None = None
    """The angle of the second body against the first, which is zero at load, where locked."""
    turn: tuple[float, float] | None = None
    """Limits of that angle."""
    spring: tuple[Flat, Flat, float, float] | None = None
    """Points that are pulled together, with stiffness and damping."""
    torsion: tuple[float, float, float] | None = None
    """Angle at rest, stiffness, damping."""
    motor: tuple[float, float] | None = None
    """Angular speed of the second body against the first, and the most torque for it."""
    findings: list[Finding] = field(default_factory=list)

    @property
    def is_inert(self) -> bool:
        """True if it binds what cannot move."""
        return any(finding.code == JOINT_INERT.code for finding in self.findings)


def plan(joint: Joint, frame: Frame, size: float) -> Link:
    """The constraints of `joint` in the plane; its findings say what cannot be done."""
    first, second = joint.body1, joint.body2
    link = Link(first.sid if first else 0, second.sid if second else 0, not joint.interpenetrate)
    if all(body is None or body.fixed for body in (first, second)):
        link.findings.append(JOINT_INERT.at(message=f"{joint!r} binds bodies that cannot move."))
        return link
    if _beyond(joint):
        link.findings.append(SIZE.at(message=f"{joint!r} has numbers out of the engine's range."))
        return link
    points, turns, centers = [], [], []
    for body, (position, orientation) in ((first, joint.frame1), (second, joint.frame2)):
        center = np.zeros(3) if body is None else body.position
        own = np.array(rotations.IDENTITY) if body is None else body.orientation
        points.append(rotations.rotate(own, position))
        turns.append(rotations.multiply(own, orientation))
        centers.append(center)
    _Planner(joint, frame, size, link, points, turns, centers).run()
    return link


def _beyond(joint: Joint) -> bool:
    numbers = np.concatenate([
        joint.frame1[0], joint.frame2[0], joint.linear_spring, joint.angular_spring, joint.motor,
        joint.linear_min, joint.linear_max, joint.angular_min, joint.angular_max,
    ])  # fmt: skip
    return bool(np.any(np.abs(numbers[np.isfinite(numbers)]) > LARGEST))


class _Planner:
    def __init__(
        self,
        joint: Joint,
        frame: Frame,
        size: float,
        link: Link,
        points: list[Floats],
        turns: list[Floats],
        centers: list[Floats],
    ) -> None:
        self.joint, self.frame, self.size, self.link = joint, frame, size, link
        self.points = points  # relative to the centres of the bodies, in world axes
        self.axes = rotations.to_matrix(turns[0]).T
        self.heights = frame.height(self.axes)
        self.along = np.abs(self.heights) >= 1.0 - 4 * TOLERANCE**2
        self.across = np.abs(self.heights) <= 2 * TOLERANCE
        self.relative = rotations.multiply(rotations.conjugate(turns[0]), turns[1])
        shift = centers[1] + points[1] - centers[0] - points[0]
        self.shift = np.array([float(axis @ shift) for axis in self.axes])

    def run(self) -> None:
        self._linear()
        self._angular()
        self._motor()

    def _motor(self) -> None:
        joint, (speed, strength) = self.joint, self.joint.motor
        if not strength:
            return
        self.link.findings.extend(motor_findings(joint))
        turning = np.flatnonzero(joint.angular_min != joint.angular_max)
        if joint.kind is JointKind.SLIDER:
            message = f"{joint!r}: pymunk drives hinges, no sliders."
            self.link.findings.append(JOINT_MOTOR.at(message=message))
        elif joint.kind is JointKind.HINGE and not self.along[turning[0]]:
            self._refuse("its motor would turn the bodies out of the plane")
        elif joint.kind is JointKind.HINGE:
            self.link.motor = (speed if self.heights[turning[0]] > 0 else -speed, strength)

    def _refuse(self, message: str) -> None:
        self.link.findings.append(NOT_PLANAR.at(message=f"{self.joint!r}: {message}."))

    def _flat(self, vector: Floats) -> Flat:
        u, v = self.frame.flat(vector).tolist()
        return u, v

    def _linear(self) -> None:
        joint, link = self.joint, self.link
        low, high = joint.linear_min, joint.linear_max
        open_ = low != high
        free = np.isinf(low) & np.isinf(high) & open_
        if not free.all() and np.any(open_ & ~self.along & ~self.across):
            self._refuse("an axis along which it slides is neither in the plane nor across it")
            return
        for axis in np.flatnonzero(self.along & open_).tolist():
            off = float(self.shift[axis])
            slack = TOLERANCE * self.size
            if not low[axis] - slack <= off <= high[axis] + slack:
                self._refuse("its limits would push the bodies out of the plane")
        stiffness, damping, target = joint.linear_spring
        inside = [axis for axis in range(3) if open_[axis] and not self.along[axis]]
        held = np.where(open_, 0.0, low)
        base = self.points[0] + held @ self.axes
        if (stiffness or damping) and open_.any():
            across = np.flatnonzero(self.along & open_)
            if (
                len(across)
                and stiffness
                and abs(target - float(self.shift[across[0]])) > (TOLERANCE * self.size)
            ):
                self._refuse("its spring would pull the bodies out of the plane")
            if inside:
                pull = base + sum((target * self.axes[axis] for axis in inside), np.zeros(3))
                link.spring = (self._flat(pull), self._flat(self.points[1]), stiffness, damping)
        if not inside:
            link.pivot = (self._flat(base), self._flat(self.points[1]))
        elif len(inside) == 1:
            axis = inside[0]
            u, v = self._flat(self.axes[axis])
            length = math.hypot(u, v)
            link.rail = Rail(
                self._flat(base),
                (u / length, v / length),
                (float(low[axis]), float(high[axis])),
                self._flat(self.points[1]),
            )
        elif not all(free[axis] for axis in inside):
            link.findings.append(
                JOINT_LIMITS.at(message=f"{joint!r} has limits along two directions of the plane.")
            )

    def _angular(self) -> None:
        joint, link = self.joint, self.link
        low, high = joint.angular_min, joint.angular_max
        open_ = low != high
        stiffness, damping, target = joint.angular_spring
        if open_.all() and np.all(np.isinf(low) & np.isinf(high)):
            if stiffness and target:
                self._refuse("its angular spring would turn the bodies out of the plane")
            elif stiffness or damping:
                self._torsion(self._angle(), 0.0)
            return
        if np.any(open_ & ~self.along & ~self.across):
            self._refuse("an axis about which it turns is neither in the plane nor across it")
            return
        turning = [axis for axis in range(3) if open_[axis] and self.along[axis]]
        for axis in np.flatnonzero(open_ & self.across).tolist():
            if not low[axis] - TOLERANCE <= 0.0 <= high[axis] + TOLERANCE:
                self._refuse("its limits would turn the bodies out of the plane")
            if stiffness and target:
                self._refuse("its angular spring would turn the bodies out of the plane")
        if np.any(~open_ & ~self.along & (np.abs(low) > TOLERANCE)):
            self._refuse("it holds the bodies turned out of the plane")
            return
        axis = int(np.argmax(np.abs(self.heights)))
        now = self._angle()
        if now is None:
            self._refuse("its frames are turned against each other out of the plane")
            return
        if not turning:
            held = float(low[axis]) if self.along[axis] else 0.0
            sign = 1.0 if self.heights[axis] > 0 else -1.0
            link.phase = sign * held - now
            link.phase = math.remainder(link.phase, 2 * math.pi)
            return
        sign = 1.0 if self.heights[axis] > 0 else -1.0
        limits = sorted((sign * float(low[axis]), sign * float(high[axis])))
        if not (math.isinf(limits[0]) and math.isinf(limits[1])):
            now = _turned_into(now, limits[0], limits[1])
            link.turn = (limits[0] - now, limits[1] - now)
        if stiffness or damping:
            self._torsion(now, sign * target)

    def _torsion(self, now: float | None, target: float) -> None:
        stiffness, damping = self.joint.angular_spring[:2]
        self.link.torsion = (target - (now or 0.0), stiffness, damping)

    def _angle(self) -> float | None:
        """The turn of frame 2 against frame 1 about the plane's normal, None if about another."""
        w = float(self.relative[0])
        vector = self.relative[1:] @ self.axes  # in world axes
        up = float(self.frame.height(vector))
        rest = vector - up * self.frame.normal
        if float(np.max(np.abs(rest))) > 2 * TOLERANCE:
            return None
        return 2.0 * math.atan2(math.copysign(1.0, w) * up, abs(w))


def _turned_into(angle: float, low: float, high: float) -> float:
    """The angle, full turns added, that is the nearest to the limits."""
    full = 2 * math.pi

    def miss(value: float) -> float:
        return max(low - value, value - high, 0.0)

    return min((angle, angle + full, angle - full), key=miss)

"""Creators of joints."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations, values
from colladaphy.world.body import Body
from colladaphy.world.columns import JointColumns
from colladaphy.world.creating import names_of, new_system_ids
from colladaphy.world.joints import (
    FREE,
    LOCKED,
    Frame,
    Joint,
    Limits,
    Spring,
    limits,
    prepare_joints,
    spring,
)
from colladaphy.world.rules import BODY_GONE, JOINT_BODIES, JOINT_VALUE, SYSTEM_ID, refuse
from colladaphy.world.uniting import Uniting

__all__ = ["Attaching"]

Floats = NDArray[np.float64]


class Attaching(Uniting):
    """Binds bodies by joints. A body of None is the world; a member stands for its union."""

    def attach_fixed_joint(
        self,
        body1: Body | None,
        body2: Body | None,
        anchor1: ArrayLike | None = None,
        anchor2: ArrayLike | None = None,
        **options: Any,
    ) -> Joint:
        """Hold two bodies as they lie to each other.

        Anchors are points relative to each body. By default the joint is at the centre of body 2;
        one anchor determines the other. `options` are those of `attach_joint`.
        """
        return self._attach_along(body1, body2, anchor1, anchor2, None, {}, options)

    def attach_hinge_joint(
        self,
        body1: Body | None,
        body2: Body | None,
        anchor1: ArrayLike | None = None,
        anchor2: ArrayLike | None = None,
        *,
        axis: ArrayLike,
        limits: tuple[float, float] = (-np.inf, np.inf),
        **options: Any,
    ) -> Joint:
        """Let body 2 turn about `axis` (3,), given in the frame of body 1, within `limits`."""
        given = {"angular_min": (0.0, 0.0, limits[0]), "angular_max": (0.0, 0.0, limits[1])}
        return self._attach_along(body1, body2, anchor1, anchor2, axis, given, options)

    def attach_slider_joint(
        self,
        body1: Body | None,
        body2: Body | None,
        anchor1: ArrayLike | None = None,
        anchor2: ArrayLike | None = None,
        *,
        axis: ArrayLike,
        limits: tuple[float, float] = (-np.inf, np.inf),
        **options: Any,
    ) -> Joint:
        """Let body 2 slide along `axis` (3,), given in the frame of body 1, within `limits`."""
        given = {"linear_min": (0.0, 0.0, limits[0]), "linear_max": (0.0, 0.0, limits[1])}
        return self._attach_along(body1, body2, anchor1, anchor2, axis, given, options)

    def attach_ball_joint(
        self,
        body1: Body | None,
        body2: Body | None,
        anchor1: ArrayLike | None = None,
        anchor2: ArrayLike | None = None,
        **options: Any,
    ) -> Joint:
        """Let body 2 turn about a point in any direction."""
        given = {"angular_min": tuple(-value for value in FREE), "angular_max": FREE}
        return self._attach_along(body1, body2, anchor1, anchor2, None, given, options)

    def attach_joint(
        self,
        body1: Body | None,
        body2: Body | None,
        *,
        frame1: Frame = (LOCKED, rotations.IDENTITY),
        frame2: Frame = (LOCKED, rotations.IDENTITY),
        linear_min: Limits = LOCKED,
        linear_max: Limits = LOCKED,
        angular_min: Limits = LOCKED,
        angular_max: Limits = LOCKED,
        linear_spring: Spring | None = None,
        angular_spring: Spring | None = None,
        enabled: bool = True,
        interpenetrate: bool = False,
        uid: int = 0,
        sid: int | None = None,
        name: str | None = None,
    ) -> Joint:
        """Bind two bodies with six degrees of freedom, each locked, limited or free.

        Everything is stored as it is given; see `colladaphy.world.joints` for what it means.
        """
        roots, frames = [], []
        for body, frame in ((body1, frame1), (body2, frame2)):
            point = values.vector("position of the frame", frame[0])
            turn = values.quaternion(frame[1])
            root = self._joint_root(body)
            if body is not None and root != body.sid:
                point, turn = self._in_root(body.sid, root, point, turn)
            roots.append(root)
            frames.append((point, turn))
        if roots[0] == roots[1]:
            raise refuse(JOINT_BODIES, f"{body1!r} and {body2!r} are the same body, or of one.")
        number = self.next_joint_sid if sid is None else sid
        if not 0 < number < 2**63 - 1 or self.joint_table.find(number) >= 0:
            raise refuse(SYSTEM_ID, f"The system id {number} is in use, or out of range.")
        row = {
            "uids": values.user_id(uid),
            "bodies": roots,
            "positions": [frame[0] for frame in frames],
            "orientations": [frame[1] for frame in frames],
            "linear_limits": limits("linear", linear_min, linear_max),
            "angular_limits": limits("angular", angular_min, angular_max),
            "linear_springs": spring("linear", linear_spring),
            "angular_springs": spring("angular", angular_spring),
            "enabled": bool(enabled),
            "interpenetrate": bool(interpenetrate),
        }
        self.next_joint_sid = max(self.next_joint_sid, number + 1)
        self.joint_table.append(number, row)
        for root in roots:
            if root:
                self.joints_of.setdefault(root, []).append(number)
        if name is not None:
            self.joint_names[number] = str(name)
        return Joint(cast("Any", self), number)

    def extend_joints(self, columns: JointColumns) -> NDArray[np.int64]:
        """Create many joints at once, stored as they are given; returns their system ids (n,).

        Bodies are top-level ones. Either all are created or, on WorldError, none.
        """
        filled = prepare_joints(columns)
        bodies = filled["bodies"]
        count = len(bodies)
        outside = np.flatnonzero((bodies != 0) & (self.top.find_all(bodies) < 0).reshape(-1, 2))
        if len(outside):
            sid = bodies.reshape(-1)[outside[0]]
            raise refuse(JOINT_BODIES, f"There is no top-level body with the system id {sid}.")
        sids = new_system_ids(
            columns.sids, count, self.next_joint_sid, lambda sid: self.joint_table.find(sid) >= 0
        )
        names = names_of(sids, columns.names)
        self.joint_table.extend(sids, filled)
        self.joint_names.update(names)
        for body, joint in zip(
            bodies.reshape(-1).tolist(), np.repeat(sids, 2).tolist(), strict=True
        ):
            if body:
                self.joints_of.setdefault(body, []).append(joint)
        if count:
            self.next_joint_sid = max(self.next_joint_sid, int(sids.max()) + 1)
        return sids

    def destroy_joint(self, joint: Joint) -> None:
        """Remove a joint; the bodies stay."""
        if joint.world is not self:
            raise refuse(BODY_GONE, f"{joint!r} belongs to another World.")
        self.remove_joint(joint.sid)

    def remove_joint(self, sid: int) -> None:
        """Remove the joint of a system id."""
        row = self.joint_table.find(sid)
        if row < 0:
            raise refuse(BODY_GONE, f"There is no joint with the system id {sid}.")
        for body in self.joint_table.raw("bodies")[row].tolist():
            if body:
                self.joints_of[body].remove(sid)
                if not self.joints_of[body]:
                    del self.joints_of[body]
        self.joint_table.remove(row)
        self.joint_names.pop(sid, None)

    def _joint_root(self, body: Body | None) -> int:
        if body is None:
            return 0
        self.check_own(body)
        return self.root_of(body.sid)

    def _in_root(self, sid: int, root: int, point: Floats, turn: Floats) -> tuple[Floats, Floats]:
        """A frame of a member in the frame of its outermost union."""
        while sid != root:
            row = self.inner.find(sid)
            own = self.inner.raw("orientations")[row]
            point = self.inner.raw("positions")[row] + rotations.rotate(own, point)
            turn = rotations.multiply(own, turn)
            sid = int(self.inner.raw("parents")[row])
        return point, turn

    def _attach_along(
        self,
        body1: Body | None,
        body2: Body | None,
        anchor1: ArrayLike | None,
        anchor2: ArrayLike | None,
        axis: ArrayLike | None,
        given: dict[str, Any],
        options: dict[str, Any],
    ) -> Joint:
        """A joint whose frames coincide now (or whose anchors shall), z along `axis`."""
        origin1, turn1 = self._pose_or_world(body1)
        origin2, turn2 = self._pose_or_world(body2)
        if anchor1 is None:
            point = origin2 + rotations.rotate(turn2, (0, 0, 0) if anchor2 is None else anchor2)
            anchor1 = rotations.unrotate(turn1, point - origin1)
        if anchor2 is None:
            point = origin1 + rotations.rotate(turn1, anchor1)
            anchor2 = rotations.unrotate(turn2, point - origin2)
        frame = np.array(rotations.IDENTITY)
        if axis is not None:
            direction = values.vector("axis", axis)
            if not np.any(direction):
                raise refuse(JOINT_VALUE, "The axis of the joint has length zero.")
            frame = rotations.between((0.0, 0.0, 1.0), direction)
        across = rotations.multiply(rotations.conjugate(rotations.normalize(turn2)), turn1)
        return self.attach_joint(
            body1,
            body2,
            frame1=(anchor1, frame),
            frame2=(anchor2, rotations.multiply(across, frame)),
            **{**given, **options},
        )

    def _pose_or_world(self, body: Body | None) -> tuple[Floats, Floats]:
        if body is None:
            return np.zeros(3), np.array(rotations.IDENTITY)
        self.check_own(body)
        return self.pose_of(body.sid)

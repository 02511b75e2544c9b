"""Unions: made of bodies, undone never, and moved member by member."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import planes, rotations, values
from colladaphy.world.body import Body
from colladaphy.world.columns import MEMBER_FIELDS
from colladaphy.world.creating import Creating
from colladaphy.world.kinds import Kind
from colladaphy.world.rules import JOINT_BODIES, NUMBER, UNION_MEMBERS, refuse
from colladaphy.world.unions import Part, Sum, add_up, shared_motion, steiner

__all__ = ["Uniting"]

Floats = NDArray[np.float64]


class Uniting(Creating):
    """Joins bodies to unions."""

    def create_union(
        self,
        uid: int,
        members: Sequence[Body],
        *,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        mass: float | None = None,
        inertia: ArrayLike | None = None,
        fixed: bool | None = None,
        linear_velocity: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        sid: int | None = None,
        name: str | None = None,
        members_are_local: bool = False,
    ) -> Body:
        """Join top-level bodies to one body; a nested union counts as one body (thesis 2.1).

        By pe's rules, the centre of mass becomes the position, the orientation starts as
        identity, masses add up, inertias by the parallel-axis theorem; a fixed member fixes the
        union and a plane makes it infinite. Momentum is kept. Members keep their place in the
        world. Each of these values can be given instead, and is then stored as it is.

        `members_are_local` says that the poses of the members are already relative to the union:
        they are stored as they are. Joints at members go over to the union.
        """
        self._check_members(members)
        with np.errstate(all="ignore"):
            row, moved = self._union_row(
                members, position, orientation, mass, inertia, fixed, linear_velocity,
                angular_velocity, members_are_local,
            )  # fmt: skip
            carried = self._carried_joints(members, moved)
        row["uids"] = values.user_id(uid)
        sid = self.claim_sid(sid)
        for body, member in zip(members, moved, strict=True):
            self.top.remove(self.top.find(body.sid))
            self.inner.append(body.sid, {**member, "parents": sid})
        self.top.append(sid, row)
        self.children[sid] = tuple(body.sid for body in members)
        if name is not None:
            self.names[sid] = str(name)
        self._take_over_joints(sid, members, carried)
        return self.handle(sid)

    def _union_row(
        self,
        members: Sequence[Body],
        position: ArrayLike | None,
        orientation: ArrayLike | None,
        mass: float | None,
        inertia: ArrayLike | None,
        fixed: bool | None,
        linear_velocity: ArrayLike | None,
        angular_velocity: ArrayLike | None,
        members_are_local: bool,
    ) -> tuple[dict[str, Any], list[dict[str, Any]]]:
        """The row of a union to be, and those of its members; nothing is changed yet."""
        parts = [self._part(body.sid) for body in members]
        total = add_up(parts)
        turn = (
            np.array(rotations.IDENTITY) if orientation is None else values.quaternion(orientation)
        )
        if position is not None:
            center = values.vector("position", position)
        else:
            center = np.zeros(3) if members_are_local else total.center
        if inertia is None:
            total = _about(total, center if not members_are_local else np.zeros(3))
            if not members_are_local:
                total.inertia = rotations.rotate_tensor(rotations.conjugate(turn), total.inertia)
        linear, angular = np.zeros(3), np.zeros(3)
        if linear_velocity is None or angular_velocity is None:
            linear, angular = shared_motion(parts, add_up(parts))
        if linear_velocity is not None:
            linear = values.vector("linear velocity", linear_velocity)
        if angular_velocity is not None:
            angular = values.vector("angular velocity", angular_velocity)
        infinite = any(part.infinite for part in parts)
        fixes = any(body.fixed for body in members) if fixed is None else bool(fixed)
        row = {
            "kinds": Kind.UNION,
            "positions": center,
            "orientations": turn,
            "masses": values.mass(total.mass if mass is None else mass),
            "inertias": values.inertia(total.inertia if inertia is None else inertia),
            "material_ids": -1,
            "mesh_ids": -1,
            "linear_velocities": linear,
            "angular_velocities": angular,
            "fixed": infinite or fixes,
        }
        moved = [self._rebase(body.sid, center, turn, members_are_local) for body in members]
        _check_finite(row, *moved)
        return row, moved

    def _check_members(self, members: Sequence[Body]) -> None:
        if not members:
            raise refuse(UNION_MEMBERS, "A union needs at least one member.")
        for body in members:
            self.check_own(body)
            if self.parent_of(body.sid) is not None:
                raise refuse(UNION_MEMBERS, f"{body!r} is a member of a union already.")
        sids = {body.sid for body in members}
        if len(sids) < len(members):
            raise refuse(UNION_MEMBERS, "The same body is given twice.")
        for sid in sids:
            for joint in self.joints_of.get(sid, ()):
                pair = self.joint_table.raw("bodies")[self.joint_table.find(joint)].tolist()
                if pair[0] in sids and pair[1] in sids:
                    raise refuse(JOINT_BODIES, f"Joint {joint} binds two of the members.")

    def _part(self, sid: int) -> Part:
        """A body as its union, or its union-to-be, sees it."""
        table, row = self.locate(sid)
        still = table is self.inner
        return Part(
            np.array(table.raw("positions")[row]),
            np.array(table.raw("orientations")[row]),
            float(table.raw("masses")[row]),
            np.array(table.raw("inertias")[row]),
            self.is_infinite(sid),
            np.zeros(3) if still else np.array(table.raw("linear_velocities")[row]),
            np.zeros(3) if still else np.array(table.raw("angular_velocities")[row]),
        )

    def _rebase(self, sid: int, center: Floats, turn: Floats, local: bool) -> dict[str, Any]:
        row = self.top.values(self.top.find(sid))
        row = {key: row[key] for key in MEMBER_FIELDS if key != "parents"}
        if not local:
            offset = row["positions"] - center
            if not np.array_equal(turn, rotations.IDENTITY):
                offset = rotations.unrotate(turn, offset)
                back = rotations.conjugate(rotations.normalize(turn))
                row["orientations"] = rotations.multiply(back, row["orientations"])
            row["positions"] = offset
            if row["kinds"] == Kind.PLANE:
                row["dimensions"] = planes.agreeing(row["dimensions"], offset, row["orientations"])
        return row

    def _carried_joints(
        self, members: Sequence[Body], moved: Sequence[dict[str, Any]]
    ) -> list[tuple[int, int, Floats, Floats]]:
        """The joints at the members: system id, side, and the frame relative to the union."""
        carried = []
        for body, row in zip(members, moved, strict=True):
            for joint in self.joints_of.get(body.sid, ()):
                place = self.joint_table.find(joint)
                side = int(self.joint_table.raw("bodies")[place][1] == body.sid)
                point = self.joint_table.raw("positions")[place][side]
                turn = self.joint_table.raw("orientations")[place][side]
                point = row["positions"] + rotations.rotate(row["orientations"], point)
                turn = rotations.multiply(row["orientations"], turn)
                _check_finite({"positions": point, "orientations": turn})
                carried.append((joint, side, point, turn))
        return carried

    def _take_over_joints(
        self, sid: int, members: Sequence[Body], carried: list[tuple[int, int, Floats, Floats]]
    ) -> None:
        for body in members:
            joints = self.joints_of.pop(body.sid, [])
            if joints:
                self.joints_of.setdefault(sid, []).extend(joints)
        for joint, side, point, turn in carried:
            place = self.joint_table.find(joint)
            self.joint_table.raw("bodies")[place][side] = sid
            self.joint_table.raw("positions")[place][side] = point
            self.joint_table.raw("orientations")[place][side] = turn

    def place(self, sid: int, position: Floats | None, orientation: Floats | None) -> None:
        """Move a body to a pose in the world frame.

        A member is moved within its union, whose mass, centre and inertia follow.
        """
        table, row = self.locate(sid)
        if table is self.top:
            if position is not None:
                table.raw("positions")[row] = position
            if orientation is not None:
                table.raw("orientations")[row] = orientation
            return
        parent = int(table.raw("parents")[row])
        origin, turn = self.pose_of(parent)
        if position is not None:
            table.raw("positions")[row] = rotations.unrotate(turn, position - origin)
        if orientation is not None:
            back = rotations.conjugate(rotations.normalize(turn))
            table.raw("orientations")[row] = rotations.multiply(back, orientation)
        self._add_up_again(parent)

    def _add_up_again(self, sid: int) -> None:
        total = add_up([self._part(member) for member in self.children[sid]])
        for member in self.children[sid]:
            table, row = self.locate(member)
            table.raw("positions")[row] -= total.center
        table, row = self.locate(sid)
        turn = table.raw("orientations")[row]
        table.raw("positions")[row] += rotations.rotate(turn, total.center)
        table.raw("masses")[row] = total.mass
        table.raw("inertias")[row] = total.inertia
        if table is self.inner:
            self._add_up_again(int(table.raw("parents")[row]))
        for joint in self.joints_of.get(sid, ()):
            place = self.joint_table.find(joint)
            side = int(self.joint_table.raw("bodies")[place][1] == sid)
            self.joint_table.raw("positions")[place][side] -= total.center


def _about(total: Sum, point: Floats) -> Sum:
    """The same with the inertia about `point` instead of the centre of mass."""
    if total.mass == 0 or np.array_equal(point, total.center):
        return total
    return Sum(total.mass, point, total.inertia + steiner(total.mass, total.center - point))


def _check_finite(*rows: dict[str, Any]) -> None:
    for row in rows:
        for name in ("positions", "orientations", "linear_velocities", "angular_velocities"):
            if name in row and not np.all(np.isfinite(row[name])):
                raise refuse(NUMBER, f"The {name} in the union are out of the range of numbers.")

"""Unions: made of bodies, undone never, and moved member by member."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import planes, rotations, values
from colladaphy.world.columns import MEMBER_FIELDS
from colladaphy.world.kinds import Kind
from colladaphy.world.rules import JOINT_BODIES, NUMBER, UNION_MEMBERS, refuse
from colladaphy.world.storage import Storage
from colladaphy.world.unions import Part, Sum, add_up, shared_motion, steiner

__all__ = ["UnionOptions", "add_up_again", "create_union", "place"]

Floats = NDArray[np.float64]


class UnionOptions(TypedDict, total=False):
    """What can be given of a union instead of what its members amount to."""

    position: ArrayLike | None
    orientation: ArrayLike | None
    mass: float | None
    inertia: ArrayLike | None
    fixed: bool | None
    linear_velocity: ArrayLike | None
    angular_velocity: ArrayLike | None
    sid: int | None
    name: str | None
    members_are_local: bool


def create_union(
    storage: Storage,
    uid: int,
    members: Sequence[int],
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
) -> int:
    """Join the bodies of some system ids, see `World.create_union`; returns that of the union."""
    _check_members(storage, members)
    local = values.flag("flag members_are_local", members_are_local)
    number = values.new_system_id(sid, storage.next_body_sid, storage.__contains__)
    if name is not None:
        name = values.text("name", name)
    with np.errstate(all="ignore"):
        row, center, turn = _union_row(
            storage, members, position, orientation, mass, inertia, fixed, linear_velocity,
            angular_velocity, local,
        )  # fmt: skip
        moved = [_rebase(storage, member, center, turn, local) for member in members]
        _check_finite(row, *moved)
        carried = _carried_joints(storage, members, moved)
    row["uids"] = values.user_id(uid)
    storage.next_body_sid = max(storage.next_body_sid, number + 1)
    for member, values_inside in zip(members, moved, strict=True):
        storage.top.remove(storage.top.find(member))
        storage.inner.append(member, {**values_inside, "parents": number})
    storage.top.append(number, row)
    storage.children[number] = tuple(members)
    if name is not None:
        storage.names[number] = name
    _take_over_joints(storage, number, members, carried)
    return number


def _union_row(
    storage: Storage,
    members: Sequence[int],
    position: ArrayLike | None,
    orientation: ArrayLike | None,
    mass: float | None,
    inertia: ArrayLike | None,
    fixed: bool | None,
    linear_velocity: ArrayLike | None,
    angular_velocity: ArrayLike | None,
    local: bool,
) -> tuple[dict[str, Any], Floats, Floats]:
    """The row of a union to be, its position and its orientation; nothing is changed yet."""
    parts = [_part(storage, member) for member in members]
    total = whole = add_up(parts)
    turn = values.quaternion(rotations.IDENTITY if orientation is None else orientation)
    if position is not None:
        center = values.vector("position", position)
    else:
        center = np.zeros(3) if local else total.center
    if inertia is None:
        total = _about(total, np.zeros(3) if local else center)
        if not local:
            total.inertia = rotations.rotate_tensor(rotations.conjugate(turn), total.inertia)
    linear, angular = np.zeros(3), np.zeros(3)
    if linear_velocity is None or angular_velocity is None:
        linear, angular = shared_motion(parts, whole)
    if linear_velocity is not None:
        linear = values.vector("linear velocity", linear_velocity)
    if angular_velocity is not None:
        angular = values.vector("angular velocity", angular_velocity)
    fixes = storage.top.raw("fixed")[[storage.top.find(member) for member in members]].any()
    row = {
        "kinds": int(Kind.UNION),
        "positions": center,
        "orientations": turn,
        "masses": values.mass(total.mass if mass is None else mass),
        "inertias": values.inertia(total.inertia if inertia is None else inertia),
        "material_ids": -1,
        "mesh_ids": -1,
        "linear_velocities": linear,
        "angular_velocities": angular,
        "fixed": any(part.infinite for part in parts)
        or (fixes if fixed is None else values.flag("flag fixed", fixed)),
    }
    return row, center, turn


def _check_members(storage: Storage, members: Sequence[int]) -> None:
    if not members:
        raise refuse(UNION_MEMBERS, "A union needs at least one member.")
    for sid in members:
        if storage.parent_of(sid) is not None:
            raise refuse(UNION_MEMBERS, f"Body {sid} is a member of a union already.")
    sids = set(members)
    if len(sids) < len(members):
        raise refuse(UNION_MEMBERS, "The same body is given twice.")
    for sid in sids:
        for joint in storage.joints_of.get(sid, ()):
            row = storage.joint_table.find(joint)
            if sids.issuperset(storage.joint_table.raw("bodies")[row].tolist()):
                raise refuse(JOINT_BODIES, f"Joint {joint} binds two of the members.")


def _part(storage: Storage, sid: int) -> Part:
    """A body as its union, or its union-to-be, sees it."""
    table, row = storage.locate(sid)
    still = table is storage.inner
    return Part(
        np.array(table.raw("positions")[row]),
        np.array(table.raw("orientations")[row]),
        float(table.raw("masses")[row]),
        np.array(table.raw("inertias")[row]),
        storage.is_infinite(sid),
        np.zeros(3) if still else np.array(table.raw("linear_velocities")[row]),
        np.zeros(3) if still else np.array(table.raw("angular_velocities")[row]),
    )


def _rebase(
    storage: Storage, sid: int, center: Floats, turn: Floats, local: bool
) -> dict[str, Any]:
    """The row of a body as a member of a union at a pose."""
    row = storage.top.values(storage.top.find(sid))
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


Carried = list[tuple[int, int, Floats, Floats]]


def _carried_joints(
    storage: Storage, members: Sequence[int], moved: Sequence[dict[str, Any]]
) -> Carried:
    """The joints at the members: system id, side, and the frame relative to the union."""
    carried: Carried = []
    table = storage.joint_table
    for sid, row in zip(members, moved, strict=True):
        for joint in storage.joints_of.get(sid, ()):
            place = table.find(joint)
            side = int(table.raw("bodies")[place][1] == sid)
            point = rotations.rotate(row["orientations"], table.raw("positions")[place][side])
            point = row["positions"] + point
            turn = rotations.multiply(row["orientations"], table.raw("orientations")[place][side])
            _check_finite({"positions": point, "orientations": turn})
            carried.append((joint, side, point, turn))
    return carried


def _take_over_joints(storage: Storage, sid: int, members: Sequence[int], carried: Carried) -> None:
    for member in members:
        joints = storage.joints_of.pop(member, [])
        if joints:
            storage.joints_of.setdefault(sid, []).extend(joints)
    table = storage.joint_table
    for joint, side, point, turn in carried:
        place = table.find(joint)
        table.raw("bodies")[place][side] = sid
        table.raw("positions")[place][side] = point
        table.raw("orientations")[place][side] = turn


def place(
    storage: Storage, sid: int, position: Floats | None, orientation: ArrayLike | None
) -> None:
    """Move a body to a pose in the world frame.

    A member is moved within its union, whose mass, centre and inertia follow.
    """
    table, row = storage.locate(sid)
    if table is storage.top:
        if position is not None:
            table.raw("positions")[row] = position
        if orientation is not None:
            table.raw("orientations")[row] = orientation
        return
    parent = int(table.raw("parents")[row])
    origin, turn = storage.pose_of(parent)
    if position is not None:
        table.raw("positions")[row] = rotations.unrotate(turn, position - origin)
    if orientation is not None:
        back = rotations.conjugate(rotations.normalize(turn))
        table.raw("orientations")[row] = rotations.multiply(back, orientation)
    add_up_again(storage, parent)


def add_up_again(storage: Storage, sid: int) -> None:
    """Make a union the sum of its members as they are now, and those above it.

    Members and joints stay where they are in the world, and every point keeps its velocity.
    """
    total = add_up([_part(storage, member) for member in storage.children[sid]])
    for member in storage.children[sid]:
        table, row = storage.locate(member)
        table.raw("positions")[row] -= total.center
    table, row = storage.locate(sid)
    turn = table.raw("orientations")[row]
    shift = rotations.rotate(turn, total.center)
    table.raw("positions")[row] += shift
    if table is storage.top:
        spin = table.raw("angular_velocities")[row]
        table.raw("linear_velocities")[row] += np.cross(spin, shift)
    table.raw("masses")[row] = total.mass
    table.raw("inertias")[row] = total.inertia
    if table is storage.inner:
        add_up_again(storage, int(table.raw("parents")[row]))
    joints = storage.joint_table
    for joint in storage.joints_of.get(sid, ()):
        place = joints.find(joint)
        side = int(joints.raw("bodies")[place][1] == sid)
        joints.raw("positions")[place][side] -= total.center


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

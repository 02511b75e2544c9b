"""What a World holds of bodies and joints, and how a single one is found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import planes, rotations
from colladaphy.world.columns import BODY_FIELDS, JOINT_FIELDS, MEMBER_FIELDS
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import Materials
from colladaphy.world.meshes import Mesh
from colladaphy.world.rules import BODY_GONE, refuse
from colladaphy.world.table import Table

__all__ = ["EngineState", "HasStorage", "Storage"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class EngineState:
    """What an engine needs beyond the World to go on exactly; opaque to everybody else."""

    engine: str
    version: str
    data: bytes


class Storage:
    """The bodies, joints, materials and meshes of one World, by system ids."""

    def __init__(self) -> None:
        self.top = Table(BODY_FIELDS)
        """The bodies that are not members of a union."""
        self.inner = Table(MEMBER_FIELDS)
        """The members of unions, their poses relative to the union."""
        self.joint_table = Table(JOINT_FIELDS)
        """The joints."""
        self.materials = Materials()
        self.meshes: dict[int, Mesh] = {}
        """Meshes by id, each shared between any number of bodies."""
        self.names: dict[int, str] = {}
        """Names of bodies by system id, of those that have one."""
        self.joint_names: dict[int, str] = {}
        """Names of joints by system id, of those that have one."""
        self.children: dict[int, tuple[int, ...]] = {}
        """System ids of the members of each union, by that of the union, in their order."""
        self.joints_of: dict[int, list[int]] = {}
        """System ids of the joints at a body, by that of the body."""
        self.next_body_sid = 1
        """The system id that the next body gets: a counter, so that none is used twice."""
        self.next_joint_sid = 1

    def __contains__(self, sid: int) -> bool:
        return self.top.find(sid) >= 0 or self.inner.find(sid) >= 0

    def locate(self, sid: int) -> tuple[Table, int]:
        """The table and the row that hold a body; WorldError if there is none."""
        row = self.top.find(sid)
        if row >= 0:
            return self.top, row
        row = self.inner.find(sid)
        if row >= 0:
            return self.inner, row
        raise refuse(BODY_GONE, f"There is no body with the system id {sid}.")

    def locate_joint(self, sid: int) -> int:
        """The row that holds a joint; WorldError if there is none."""
        row = self.joint_table.find(sid)
        if row < 0:
            raise refuse(BODY_GONE, f"There is no joint with the system id {sid}.")
        return row

    def parent_of(self, sid: int) -> int | None:
        """The system id of the union that a body is a member of, or None."""
        table, row = self.locate(sid)
        return int(table.raw("parents")[row]) if table is self.inner else None

    def root_of(self, sid: int) -> int:
        """The system id of the outermost union of a body, or its own."""
        while (parent := self.parent_of(sid)) is not None:
            sid = parent
        return sid

    def is_infinite(self, sid: int) -> bool:
        """True for planes and for unions that hold one."""
        table, row = self.locate(sid)
        kind = int(table.raw("kinds")[row])
        if kind == Kind.UNION:
            return any(self.is_infinite(member) for member in self.children[sid])
        return kind == Kind.PLANE

    def pose_of(self, sid: int) -> tuple[Floats, Floats]:
        """Position (3,) and orientation (4,) of a body in the world frame, copied."""
        table, row = self.locate(sid)
        position = table.raw("positions")[row].copy()
        orientation = table.raw("orientations")[row].copy()
        if table is self.inner:
            origin, turn = self.pose_of(int(table.raw("parents")[row]))
            position = origin + rotations.rotate(turn, position)
            orientation = rotations.multiply(turn, orientation)
        return position, orientation

    def velocity_of(self, sid: int) -> tuple[Floats, Floats]:
        """Linear (3,) and angular velocity (3,) of a body, copied."""
        root = self.root_of(sid)
        row = self.top.find(root)
        linear = self.top.raw("linear_velocities")[row].copy()
        angular = self.top.raw("angular_velocities")[row].copy()
        if root != sid:
            arm = self.pose_of(sid)[0] - self.top.raw("positions")[row]
            linear = linear + np.cross(angular, arm)
        return linear, angular

    def dimensions_of(self, table: Table) -> NDArray[Any]:
        """The dimensions of all rows (n, 4), read-only; planes that were moved have followed."""
        view = table.column("dimensions")
        rows = np.flatnonzero(table.column("kinds") == Kind.PLANE)
        if len(rows):
            poses = table.column("positions")[rows], table.column("orientations")[rows]
            view[rows] = planes.agreeing(view[rows], *poses)
        view.flags.writeable = False
        return view

    def destroy(self, sid: int) -> None:
        """Remove a body and its members."""
        for member in self.children.pop(sid, ()):
            self.destroy(member)
        table, row = self.locate(sid)
        table.remove(row)
        self.names.pop(sid, None)

    def destroy_joint(self, sid: int) -> None:
        """Remove a joint."""
        row = self.locate_joint(sid)
        for body in self.joint_table.raw("bodies")[row].tolist():
            if body:
                self.joints_of[body].remove(sid)
                if not self.joints_of[body]:
                    del self.joints_of[body]
        self.joint_table.remove(row)
        self.joint_names.pop(sid, None)


class HasStorage(Protocol):
    """A World, as far as the functions that are its methods need it."""

    _storage: Storage

"""What a World holds, and how a single body is found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations, values
from colladaphy.world.body import Body
from colladaphy.world.columns import BODY_FIELDS, MEMBER_FIELDS
from colladaphy.world.joints import JOINT_FIELDS
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import Materials
from colladaphy.world.meshes import Mesh
from colladaphy.world.rules import BODY_GONE, refuse
from colladaphy.world.table import Table

if TYPE_CHECKING:
    from colladaphy.world.world import World

__all__ = ["Core", "EngineState"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class EngineState:
    """What an engine needs beyond the World to go on exactly; opaque to everybody else."""

    engine: str
    version: str
    data: bytes


class Core:
    """The storage of a World; the classes that build on it add what can be done with it."""

    def __init__(
        self,
        gravity: ArrayLike = (0.0, 0.0, 0.0),
        *,
        unit: tuple[str, float] = ("meter", 1.0),
        up_axis: str = "Z_UP",
        time_step: float | None = None,
        name: str | None = None,
    ) -> None:
        self.gravity = gravity
        self.unit_name = str(unit[0])
        self.unit_meter = values.positive("size of the unit", unit[1])
        self.up_axis = up_axis
        self.time_step = time_step
        self.name = name
        self.time = 0.0
        """The clock, in seconds."""
        self.step_count = 0
        """How many steps engines have done."""
        self.engine_state: EngineState | None = None
        self.materials = Materials()
        self.meshes: dict[int, Mesh] = {}
        """Meshes by id, each shared between any number of bodies."""
        self.names: dict[int, str] = {}
        """Names of bodies by system id, of those that have one."""
        self.children: dict[int, tuple[int, ...]] = {}
        """System ids of the members of each union, by that of the union, in their order."""
        self.joint_table = Table(JOINT_FIELDS)
        """Storage of the joints."""
        self.joint_names: dict[int, str] = {}
        """Names of joints by system id, of those that have one."""
        self.next_body_sid = 1
        """The system id that the next body gets: a counter, so that none is used twice."""
        self.next_joint_sid = 1
        self.top = Table(BODY_FIELDS)
        """Storage of the bodies that are not members of a union."""
        self.inner = Table(MEMBER_FIELDS)
        """Storage of the members of unions."""
        self.joints_of: dict[int, list[int]] = {}
        """System ids of the joints at a body, by that of the body."""

    @property
    def gravity(self) -> Floats:
        """Acceleration (3,) of every body that is not fixed; writable."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: ArrayLike) -> None:
        self._gravity = values.vector("gravity", value)

    def handle(self, sid: int) -> Body:
        """A handle to a body, unchecked."""
        return Body(cast("World", self), sid)

    def __contains__(self, sid: object) -> bool:
        """True if `sid` is the system id of a body, member or not."""
        return isinstance(sid, int) and (self.top.find(sid) >= 0 or self.inner.find(sid) >= 0)

    def locate(self, sid: int) -> tuple[Table, int]:
        """The table and the row that hold a body; WorldError if there is none."""
        row = self.top.find(sid)
        if row >= 0:
            return self.top, row
        row = self.inner.find(sid)
        if row >= 0:
            return self.inner, row
        raise refuse(BODY_GONE, f"There is no body with the system id {sid}.")

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

    def check_own(self, body: Body) -> None:
        """Raise WorldError unless `body` is alive in this World."""
        if body.world is not self:
            raise refuse(BODY_GONE, f"{body!r} belongs to another World.")
        self.locate(body.sid)

    def pose_of(self, sid: int) -> tuple[Floats, Floats]:
        """Position (3,) and orientation (4,) of a body in the world frame, copied."""
        table, row = self.locate(sid)
        position = np.array(table.raw("positions")[row])
        orientation = np.array(table.raw("orientations")[row])
        if table is self.inner:
            origin, turn = self.pose_of(int(table.raw("parents")[row]))
            position = origin + rotations.rotate(turn, position)
            orientation = rotations.multiply(turn, orientation)
        return position, orientation

    def velocity_of(self, sid: int) -> tuple[Floats, Floats]:
        """Linear (3,) and angular velocity (3,) of a body, copied."""
        root = self.root_of(sid)
        row = self.top.find(root)
        linear = np.array(self.top.raw("linear_velocities")[row])
        angular = np.array(self.top.raw("angular_velocities")[row])
        if root != sid:
            arm = self.pose_of(sid)[0] - self.top.raw("positions")[row]
            linear = linear + np.cross(angular, arm)
        return linear, angular

"""Joints: what two bodies may do against each other (thesis 2.2, 4.5; COLLADA <rigid_constraint>).

A joint binds a frame of `body1` (the reference) to a frame of `body2`. With frame 1 at rest, the
origin of frame 2 may move along the axes of frame 1 within the linear limits, and frame 2 may turn
about them within the angular limits (radians; x and y swing, z twists). Equal limits lock an axis,
±inf free it. Springs (stiffness, damping, target) pull along what is free; stiffness and damping
zero is no spring.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations, values
from colladaphy.world.columns import JOINT_FIELDS, JointColumns
from colladaphy.world.kinds import JointKind
from colladaphy.world.rules import (
    ARGUMENT,
    BODY_GONE,
    COLUMNS,
    JOINT_BODIES,
    JOINT_VALUE,
    NUMBER,
    refuse,
)

if TYPE_CHECKING:
    from colladaphy.world.body import Body
    from colladaphy.world.world import World

__all__ = ["FREE", "JOINT_FIELDS", "LOCKED", "Frame", "Joint", "Joints", "Limits", "Spring"]

Floats = NDArray[np.float64]
Frame = tuple[ArrayLike, ArrayLike]
"""Position (3,) and orientation (4,), relative to a body, or to the world."""
Limits = ArrayLike
"""Three numbers, one an axis, ±inf for free."""
Spring = tuple[float, float, float]
"""Stiffness, damping, target (a length or an angle in radians)."""

LOCKED: Final = (0.0, 0.0, 0.0)
FREE: Final = (np.inf, np.inf, np.inf)


class Joint:
    """One joint of a World: a view of its row, alive until it is destroyed."""

    __slots__ = ("sid", "world")

    def __init__(self, world: World, sid: int) -> None:
        self.world = world
        self.sid = sid
        """System id, unique among the joints of the World."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Joint) and other.sid == self.sid and other.world is self.world

    def __hash__(self) -> int:
        return hash((id(self.world), -self.sid))

    def __repr__(self) -> str:
        if self.world.joint_table.find(self.sid) < 0:
            return f"<joint {self.sid}, destroyed>"
        name = f" {self.name!r}" if self.name else ""
        return f"<{self.kind.name.lower()} joint {self.sid}{name} of {self.body1}, {self.body2}>"

    def _row(self) -> int:
        row = self.world.joint_table.find(self.sid)
        if row < 0:
            raise refuse(BODY_GONE, f"There is no joint with the system id {self.sid}.")
        return row

    def _get(self, column: str) -> Any:
        return self.world.joint_table.raw(column)[self._row()]

    def _set(self, column: str, value: Any) -> None:
        self.world.joint_table.raw(column)[self._row()] = value

    @property
    def uid(self) -> int:
        """User id, not necessarily unique."""
        return int(self._get("uids"))

    @uid.setter
    def uid(self, value: int) -> None:
        self._set("uids", values.user_id(value))

    @property
    def name(self) -> str | None:
        """The name, if it has one."""
        self._row()
        return self.world.joint_names.get(self.sid)

    @name.setter
    def name(self, value: str | None) -> None:
        self._row()
        if value is None:
            self.world.joint_names.pop(self.sid, None)
        else:
            self.world.joint_names[self.sid] = str(value)

    @property
    def body1(self) -> Body | None:
        """The reference body (COLLADA's ref_attachment), None for the world."""
        return self.world.body_or_none(int(self._get("bodies")[0]))

    @property
    def body2(self) -> Body | None:
        """The other body (COLLADA's attachment), None for the world."""
        return self.world.body_or_none(int(self._get("bodies")[1]))

    def _frame(self, side: int) -> tuple[Floats, Floats]:
        return np.array(self._get("positions")[side]), np.array(self._get("orientations")[side])

    @property
    def frame1(self) -> tuple[Floats, Floats]:
        """Position (3,) and orientation (4,) of the joint in body 1."""
        return self._frame(0)

    @property
    def frame2(self) -> tuple[Floats, Floats]:
        """Position (3,) and orientation (4,) of the joint in body 2."""
        return self._frame(1)

    @property
    def linear_min(self) -> Floats:
        """Lower limits of displacement along the axes of frame 1 (3,)."""
        return np.array(self._get("linear_limits")[0])

    @property
    def linear_max(self) -> Floats:
        """Upper limits of displacement along the axes of frame 1 (3,)."""
        return np.array(self._get("linear_limits")[1])

    @property
    def angular_min(self) -> Floats:
        """Lower limits of rotation about the axes of frame 1 (3,), radians."""
        return np.array(self._get("angular_limits")[0])

    @property
    def angular_max(self) -> Floats:
        """Upper limits of rotation about the axes of frame 1 (3,), radians."""
        return np.array(self._get("angular_limits")[1])

    @property
    def linear_spring(self) -> Spring:
        """Stiffness (force/length), damping, target (length)."""
        stiffness, damping, target = self._get("linear_springs").tolist()
        return stiffness, damping, target

    @property
    def angular_spring(self) -> Spring:
        """Stiffness (torque/radian), damping, target (radians)."""
        stiffness, damping, target = self._get("angular_springs").tolist()
        return stiffness, damping, target

    @property
    def enabled(self) -> bool:
        """False if the joint does nothing at present."""
        return bool(self._get("enabled"))

    @enabled.setter
    def enabled(self, value: bool) -> None:
        self._set("enabled", bool(value))

    @property
    def interpenetrate(self) -> bool:
        """True if the two bodies do not collide with each other."""
        return bool(self._get("interpenetrate"))

    @interpenetrate.setter
    def interpenetrate(self, value: bool) -> None:
        self._set("interpenetrate", bool(value))

    @property
    def kind(self) -> JointKind:
        """What the limits amount to."""
        linear, angular = self._get("linear_limits"), self._get("angular_limits")
        shifts = int(np.count_nonzero(linear[0] != linear[1]))
        turns = int(np.count_nonzero(angular[0] != angular[1]))
        known = {
            (0, 0): JointKind.FIXED,
            (0, 1): JointKind.HINGE,
            (1, 0): JointKind.SLIDER,
            (0, 3): JointKind.BALL,
        }
        return known.get((shifts, turns), JointKind.GENERAL)


class Joints(Sequence[Joint]):
    """The joints of a World in the order of their system ids."""

    def __init__(self, world: World) -> None:
        self._world = world

    def __len__(self) -> int:
        return len(self._world.joint_table)

    def __getitem__(self, index: Any) -> Any:
        sids = self._world.joint_table.column("sids")[index]
        if isinstance(index, slice):
            return [Joint(self._world, sid) for sid in sids.tolist()]
        return Joint(self._world, int(sids))

    def __iter__(self) -> Iterator[Joint]:
        for sid in self._world.joint_table.column("sids").tolist():
            yield Joint(self._world, sid)

    @property
    def names(self) -> dict[int, str]:
        """Names by system id, of the joints that have one."""
        return self._world.joint_names

    def columns(self) -> dict[str, NDArray[Any]]:
        """All columns by name (``sids`` and those of `JOINT_FIELDS`), writable views."""
        return {name: self._world.joint_table.column(name) for name in ("sids", *JOINT_FIELDS)}


def limits(what: str, low: Limits, high: Limits) -> Floats:
    """Lower and upper limits as (2, 3)."""
    try:
        array = np.array([low, high], dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise refuse(JOINT_VALUE, f"The {what} limits are {low!r} and {high!r}.") from error
    if array.shape != (2, 3) or np.any(np.isnan(array)):
        raise refuse(JOINT_VALUE, f"The {what} limits are {low!r} and {high!r}.")
    return array


def spring(what: str, value: Spring | None) -> Floats:
    """Stiffness, damping and target as (3,); None is no spring."""
    if value is None:
        return np.zeros(3)
    array = np.array(value, dtype=np.float64)
    if array.shape != (3,) or not np.all(np.isfinite(array)):
        raise refuse(JOINT_VALUE, f"The {what} spring is {value!r}.")
    return array


def prepare_joints(columns: JointColumns) -> dict[str, NDArray[Any]]:
    """Check columns of joints (all but the system ids and names), and complete them."""
    if not isinstance(columns, JointColumns):
        raise refuse(ARGUMENT, f"Joints are JointColumns, not {type(columns).__name__}.")
    try:
        count = len(columns.bodies)
    except TypeError as error:
        raise refuse(COLUMNS, "The column bodies has two numbers a joint.") from error
    filled: dict[str, NDArray[Any]] = {}
    for name, (dtype, shape) in JOINT_FIELDS.items():
        given = getattr(columns, name)
        if given is not None:
            filled[name] = values.column(name, given, dtype, (count, *shape))
    filled.setdefault("enabled", np.ones(count, dtype=np.bool_))
    filled.setdefault("orientations", np.tile(rotations.IDENTITY, (count, 2, 1)))
    if np.any(filled["bodies"][:, 0] == filled["bodies"][:, 1]):
        raise refuse(JOINT_BODIES, "A joint binds a body to itself.")
    for name in ("positions", "orientations"):
        if name in filled and not np.all(np.isfinite(filled[name])):
            raise refuse(NUMBER, f"The column {name} holds numbers that are not finite.")
    if not np.all(np.any(filled["orientations"] != 0, axis=2)):
        raise refuse(NUMBER, "An orientation is a quaternion of length zero.")
    for name in ("linear_limits", "angular_limits"):
        if name in filled and np.any(np.isnan(filled[name])):
            raise refuse(JOINT_VALUE, f"The column {name} holds what is not a number.")
    for name in ("linear_springs", "angular_springs"):
        if name in filled and not np.all(np.isfinite(filled[name])):
            raise refuse(JOINT_VALUE, f"The column {name} holds numbers that are not finite.")
    return filled

"""Light handles to the joints of a World, and the methods of `World` that make them."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import coordinates, values
from colladaphy.world.attaching import (
    AT_CENTRE,
    FREE,
    Frame,
    JointOptions,
    Limits,
    Motor,
    Spring,
    attach,
    attach_along,
    limits_of,
    motor_of,
    one_axis,
    spring_of,
)
from colladaphy.world.belonging import sid_or_world
from colladaphy.world.body import Body
from colladaphy.world.columns import JOINT_FIELDS
from colladaphy.world.handles import Handles
from colladaphy.world.kinds import JointKind
from colladaphy.world.rules import JOINT_VALUE, refuse
from colladaphy.world.storage import HasStorage, Storage

__all__ = [
    "JOINT_FIELDS",
    "Joint",
    "Joints",
    "attach_ball_joint",
    "attach_fixed_joint",
    "attach_hinge_joint",
    "attach_joint",
    "attach_slider_joint",
]

Floats = NDArray[np.float64]


class Joint:
    """One joint of a World: a view of its row, alive until it is destroyed.

    Arrays that are returned are read-only copies. See `colladaphy.world.attaching` for what the
    frames, limits and springs mean.
    """

    __slots__ = ("_storage", "sid")

    def __init__(self, storage: Storage, sid: int) -> None:
        self._storage = storage
        self.sid = sid
        """System id, unique among the joints of the World."""

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Joint) and other.sid == self.sid and other._storage is self._storage
        )

    def __hash__(self) -> int:
        return hash((id(self._storage), -self.sid))

    def __repr__(self) -> str:
        if self._storage.joint_table.find(self.sid) < 0:
            return f"<joint {self.sid}, destroyed>"
        name = f" {self.name!r}" if self.name else ""
        return f"<{self.kind.name.lower()} joint {self.sid}{name} of {self.body1}, {self.body2}>"

    def _get(self, column: str) -> Any:
        return self._storage.joint_table.raw(column)[self._storage.locate_joint(self.sid)]

    def _set(self, column: str, value: Any) -> None:
        self._storage.joint_table.raw(column)[self._storage.locate_joint(self.sid)] = value

    def _copy(self, column: str, side: int) -> Floats:
        copied: Floats = self._get(column)[side].copy()
        copied.flags.writeable = False
        return copied

    def _set_limits(self, what: str, side: int, value: Limits) -> None:
        pair: list[Limits] = list(self._get(f"{what}_limits"))
        pair[side] = value
        self._set(f"{what}_limits", limits_of(what, *pair))

    def _body(self, side: int) -> Body | None:
        sid = int(self._get("bodies")[side])
        return Body(self._storage, sid) if sid else None

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
        self._storage.locate_joint(self.sid)
        return self._storage.joint_names.get(self.sid)

    @name.setter
    def name(self, value: str | None) -> None:
        self._storage.locate_joint(self.sid)
        if value is None:
            self._storage.joint_names.pop(self.sid, None)
        else:
            self._storage.joint_names[self.sid] = values.text("name", value)

    @property
    def body1(self) -> Body | None:
        """The reference body (COLLADA's ref_attachment), None for the world."""
        return self._body(0)

    @property
    def body2(self) -> Body | None:
        """The other body (COLLADA's attachment), None for the world."""
        return self._body(1)

    @property
    def frame1(self) -> tuple[Floats, Floats]:
        """Position (3,) and orientation (4,) of the joint in body 1."""
        return self._copy("positions", 0), self._copy("orientations", 0)

    @property
    def frame2(self) -> tuple[Floats, Floats]:
        """Position (3,) and orientation (4,) of the joint in body 2."""
        return self._copy("positions", 1), self._copy("orientations", 1)

    @property
    def linear_min(self) -> Floats:
        """Lower limits of displacement along the axes of frame 1 (3,)."""
        return self._copy("linear_limits", 0)

    @linear_min.setter
    def linear_min(self, value: Limits) -> None:
        self._set_limits("linear", 0, value)

    @property
    def linear_max(self) -> Floats:
        """Upper limits of displacement along the axes of frame 1 (3,)."""
        return self._copy("linear_limits", 1)

    @linear_max.setter
    def linear_max(self, value: Limits) -> None:
        self._set_limits("linear", 1, value)

    @property
    def angular_min(self) -> Floats:
        """Lower limits of rotation about the axes of frame 1 (3,), radians."""
        return self._copy("angular_limits", 0)

    @angular_min.setter
    def angular_min(self, value: Limits) -> None:
        self._set_limits("angular", 0, value)

    @property
    def angular_max(self) -> Floats:
        """Upper limits of rotation about the axes of frame 1 (3,), radians."""
        return self._copy("angular_limits", 1)

    @angular_max.setter
    def angular_max(self, value: Limits) -> None:
        self._set_limits("angular", 1, value)

    @property
    def linear_spring(self) -> Spring:
        """Stiffness (force/length), damping, target (length)."""
        stiffness, damping, target = self._get("linear_springs").tolist()
        return stiffness, damping, target

    @linear_spring.setter
    def linear_spring(self, value: Spring | None) -> None:
        self._set("linear_springs", spring_of("linear", value))

    @property
    def angular_spring(self) -> Spring:
        """Stiffness (torque/radian), damping, target (radians)."""
        stiffness, damping, target = self._get("angular_springs").tolist()
        return stiffness, damping, target

    @angular_spring.setter
    def angular_spring(self, value: Spring | None) -> None:
        self._set("angular_springs", spring_of("angular", value))

    @property
    def motor(self) -> Motor:
        """Speed at which the only free axis is driven, and the most force or torque for it.

        (0, 0) is no motor; None sets that.
        """
        speed, strength = self._get("motors").tolist()
        return speed, strength

    @motor.setter
    def motor(self, value: Motor | None) -> None:
        if value is not None and self.kind not in (JointKind.HINGE, JointKind.SLIDER):
            raise refuse(JOINT_VALUE, f"{self!r} has no single axis that a motor could drive.")
        self._set("motors", motor_of(value))

    @property
    def coordinates(self) -> Floats:
        """Where the bodies stand to each other along the axes that are not locked (k,).

        First displacements along x, y, z of frame 1, then turns about x, the new y, the new z in
        radians: one number of a hinge or slider. A ball has its rotation vector.
        """
        found = coordinates.coordinates(self._storage, self._storage.locate_joint(self.sid))
        found.flags.writeable = False
        return found

    @property
    def speed(self) -> Floats:
        """How fast the coordinates change (k,); of a ball the angular velocity in frame 1."""
        found = coordinates.speeds(self._storage, self._storage.locate_joint(self.sid))
        found.flags.writeable = False
        return found

    @property
    def enabled(self) -> bool:
        """False if the joint does nothing at present."""
        return bool(self._get("enabled"))

    @enabled.setter
    def enabled(self, value: bool) -> None:
        self._set("enabled", values.flag("flag enabled", value))

    @property
    def interpenetrate(self) -> bool:
        """True if the two bodies do not collide with each other."""
        return bool(self._get("interpenetrate"))

    @interpenetrate.setter
    def interpenetrate(self, value: bool) -> None:
        self._set("interpenetrate", values.flag("flag interpenetrate", value))

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


class Joints(Handles[Joint]):
    """The joints of a World in the order of their system ids."""

    def __init__(self, storage: Storage) -> None:
        super().__init__(storage, storage.joint_table, Joint, "joints")

    def columns(self) -> dict[str, NDArray[Any]]:
        """All columns by name (``sids`` and those of `JOINT_FIELDS`), writable views."""
        return {name: self._table.column(name) for name in ("sids", *JOINT_FIELDS)}


def attach_fixed_joint(
    self: HasStorage, body1: Body | None, body2: Body | None,
    anchor1: ArrayLike | None = None, anchor2: ArrayLike | None = None,
    **options: Unpack[JointOptions],
) -> Joint:  # fmt: skip
    """Hold two bodies as they lie to each other.

    Anchors are points relative to each body. By default the joint is at the centre of body 2;
    one anchor determines the other. `options` are those of `attach_joint`.
    """
    return _along(self._storage, body1, body2, anchor1, anchor2, None, options)


def attach_hinge_joint(
    self: HasStorage, body1: Body | None, body2: Body | None,
    anchor1: ArrayLike | None = None, anchor2: ArrayLike | None = None, *,
    axis: ArrayLike, limits: tuple[float, float] = (-np.inf, np.inf),
    **options: Unpack[JointOptions],
) -> Joint:  # fmt: skip
    """Let body 2 turn about `axis` (3,), given in the frame of body 1, within `limits`."""
    low, high = one_axis(axis, limits)
    given: JointOptions = {"angular_min": low, "angular_max": high, **options}
    return _along(self._storage, body1, body2, anchor1, anchor2, axis, given)


def attach_slider_joint(
    self: HasStorage, body1: Body | None, body2: Body | None,
    anchor1: ArrayLike | None = None, anchor2: ArrayLike | None = None, *,
    axis: ArrayLike, limits: tuple[float, float] = (-np.inf, np.inf),
    **options: Unpack[JointOptions],
) -> Joint:  # fmt: skip
    """Let body 2 slide along `axis` (3,), given in the frame of body 1, within `limits`."""
    low, high = one_axis(axis, limits)
    given: JointOptions = {"linear_min": low, "linear_max": high, **options}
    return _along(self._storage, body1, body2, anchor1, anchor2, axis, given)


def attach_ball_joint(
    self: HasStorage, body1: Body | None, body2: Body | None,
    anchor1: ArrayLike | None = None, anchor2: ArrayLike | None = None,
    **options: Unpack[JointOptions],
) -> Joint:  # fmt: skip
    """Let body 2 turn about a point in any direction."""
    low = tuple(-value for value in FREE)
    given: JointOptions = {"angular_min": low, "angular_max": FREE, **options}
    return _along(self._storage, body1, body2, anchor1, anchor2, None, given)


def attach_joint(
    self: HasStorage, body1: Body | None, body2: Body | None, *,
    frame1: Frame = AT_CENTRE, frame2: Frame = AT_CENTRE,
    **options: Unpack[JointOptions],
) -> Joint:  # fmt: skip
    """Bind two bodies with six degrees of freedom, each locked, limited or free.

    Everything is stored as it is given; see `colladaphy.world.attaching` for what it means.
    """
    sids = sid_or_world(self._storage, body1), sid_or_world(self._storage, body2)
    made = attach(self._storage, *sids, frame1=frame1, frame2=frame2, **options)
    return Joint(self._storage, made)


def _along(
    storage: Storage, body1: Body | None, body2: Body | None, anchor1: ArrayLike | None,
    anchor2: ArrayLike | None, axis: ArrayLike | None, options: JointOptions,
) -> Joint:  # fmt: skip
    sids = sid_or_world(storage, body1), sid_or_world(storage, body2)
    return Joint(storage, attach_along(storage, *sids, anchor1, anchor2, axis, **options))

"""Joints: what two bodies may do against each other (thesis 2.2, 4.5; COLLADA <rigid_constraint>).

A joint binds a frame of `body1` (the reference) to a frame of `body2`. With frame 1 at rest, the
origin of frame 2 may move along the axes of frame 1 within the linear limits, and frame 2 may turn
about them within the angular limits (radians; x and y swing, z twists). Equal limits lock an axis,
±inf free it. Springs (stiffness, damping, target) pull along what is free; stiffness and damping
zero is no spring. A motor (speed, strength) drives the only free axis of a hinge or slider at a
speed, with a force or torque of at most its strength.
"""

from __future__ import annotations

from typing import Any, Final, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations, values
from colladaphy.world.columns import JOINT_FIELDS, JointColumns
from colladaphy.world.rules import (
    ARGUMENT,
    COLUMNS,
    JOINT_BODIES,
    JOINT_VALUE,
    NUMBER,
    refuse,
)
from colladaphy.world.storage import Storage

__all__ = [
    "AT_CENTRE",
    "FREE",
    "LOCKED",
    "Frame",
    "JointOptions",
    "Limits",
    "Motor",
    "Spring",
    "attach",
    "attach_along",
    "extend_joints",
    "limits_of",
    "motor_of",
    "one_axis",
    "spring_of",
]

Floats = NDArray[np.float64]
Frame = tuple[ArrayLike, ArrayLike]
"""Position (3,) and orientation (4,), relative to a body, or to the world."""
Limits = ArrayLike
"""Three numbers, one an axis, ±inf for free."""
Spring = tuple[float, float, float]
"""Stiffness, damping, target (a length or an angle in radians)."""

Motor = tuple[float, float]
"""Speed (of a length or an angle) and greatest force or torque."""

LOCKED: Final = (0.0, 0.0, 0.0)
FREE: Final = (np.inf, np.inf, np.inf)
AT_CENTRE: Final = (LOCKED, rotations.IDENTITY)


class JointOptions(TypedDict, total=False):
    """What can be said of any joint; values are stored as they are given."""

    linear_min: Limits
    linear_max: Limits
    angular_min: Limits
    angular_max: Limits
    linear_spring: Spring | None
    angular_spring: Spring | None
    motor: Motor | None
    enabled: bool
    interpenetrate: bool
    uid: int
    sid: int | None
    name: str | None


def attach(
    storage: Storage,
    body1: int,
    body2: int,
    *,
    frame1: Frame = AT_CENTRE,
    frame2: Frame = AT_CENTRE,
    linear_min: Limits = LOCKED,
    linear_max: Limits = LOCKED,
    angular_min: Limits = LOCKED,
    angular_max: Limits = LOCKED,
    linear_spring: Spring | None = None,
    angular_spring: Spring | None = None,
    motor: Motor | None = None,
    enabled: bool = True,
    interpenetrate: bool = False,
    uid: int = 0,
    sid: int | None = None,
    name: str | None = None,
) -> int:
    """Bind the bodies of two system ids (0 is the world); returns that of the joint."""
    roots, points, turns = [], [], []
    for body, frame in ((body1, frame1), (body2, frame2)):
        if not isinstance(frame, (tuple, list)) or len(frame) != 2:
            raise refuse(ARGUMENT, f"The frame {frame!r} is not a position and an orientation.")
        point = values.vector("position of the frame", frame[0])
        root, point, turn = _in_root(storage, body, point, values.quaternion(frame[1]))
        roots.append(root)
        points.append(point)
        turns.append(turn)
    if roots[0] == roots[1]:
        raise refuse(JOINT_BODIES, "The two bodies are the same body, or members of one.")
    number = values.new_system_id(
        sid, storage.next_joint_sid, lambda sid: storage.joint_table.find(sid) >= 0
    )
    row = {
        "uids": values.user_id(uid),
        "bodies": roots,
        "positions": points,
        "orientations": turns,
        "linear_limits": limits_of("linear", linear_min, linear_max),
        "angular_limits": limits_of("angular", angular_min, angular_max),
        "linear_springs": spring_of("linear", linear_spring),
        "angular_springs": spring_of("angular", angular_spring),
        "motors": motor_of(motor),
        "enabled": values.flag("flag enabled", enabled),
        "interpenetrate": values.flag("flag interpenetrate", interpenetrate),
    }
    name = None if name is None else values.text("name", name)
    storage.next_joint_sid = max(storage.next_joint_sid, number + 1)
    storage.joint_table.append(number, row)
    for root in roots:
        if root:
            storage.joints_of.setdefault(root, []).append(number)
    if name is not None:
        storage.joint_names[number] = name
    return number


def _in_root(storage: Storage, sid: int, point: Floats, turn: Floats) -> tuple[int, Floats, Floats]:
    """The outermost union of a body, and a frame of the body as one of that."""
    while sid and (parent := storage.parent_of(sid)) is not None:
        row = storage.inner.find(sid)
        own = storage.inner.raw("orientations")[row]
        point = storage.inner.raw("positions")[row] + rotations.rotate(own, point)
        turn = rotations.multiply(own, turn)
        sid = parent
    return sid, point, turn


def attach_along(
    storage: Storage,
    body1: int,
    body2: int,
    anchor1: ArrayLike | None,
    anchor2: ArrayLike | None,
    axis: ArrayLike | None = None,
    **options: Unpack[JointOptions],
) -> int:
    """A joint whose frames coincide now (or whose anchors shall), z along `axis`."""
    origin1, turn1 = _pose_or_world(storage, body1)
    origin2, turn2 = _pose_or_world(storage, body2)
    if anchor1 is None:
        second = values.vector("anchor", LOCKED if anchor2 is None else anchor2)
        point = origin2 + rotations.rotate(turn2, second)
        first = rotations.unrotate(turn1, point - origin1)
    else:
        first = values.vector("anchor", anchor1)
    if anchor2 is None:
        point = origin1 + rotations.rotate(turn1, first)
        anchor2 = rotations.unrotate(turn2, point - origin2)
    frame = np.array(rotations.IDENTITY)
    if axis is not None:
        direction = values.vector("axis", axis, rule=JOINT_VALUE)
        if not np.any(direction):
            raise refuse(JOINT_VALUE, "The axis of the joint has length zero.")
        frame = rotations.between((0.0, 0.0, 1.0), direction)
    across = rotations.multiply(rotations.conjugate(rotations.normalize(turn2)), turn1)
    return attach(
        storage,
        body1,
        body2,
        frame1=(first, frame),
        frame2=(anchor2, rotations.multiply(across, frame)),
        **options,
    )


def one_axis(axis: ArrayLike, limits: tuple[float, float]) -> tuple[Limits, Limits]:
    """Lower and upper limits that leave the third axis, z, a range; the axis is needed."""
    if axis is None:
        raise refuse(JOINT_VALUE, "The joint needs an axis.")
    try:
        low, high = limits
    except (TypeError, ValueError) as error:
        raise refuse(JOINT_VALUE, f"The limits are {limits!r}, not a pair.") from error
    return (0.0, 0.0, low), (0.0, 0.0, high)


def _pose_or_world(storage: Storage, sid: int) -> tuple[Floats, Floats]:
    return storage.pose_of(sid) if sid else (np.zeros(3), np.array(rotations.IDENTITY))


def limits_of(what: str, low: Limits, high: Limits) -> Floats:
    """Lower and upper limits as (2, 3)."""
    pair = values.array(low), values.array(high)
    if any(numbers is None or numbers.shape != (3,) or np.isnan(numbers).any() for numbers in pair):
        raise refuse(JOINT_VALUE, f"The {what} limits are {low!r} and {high!r}.")
    return np.array(pair, dtype=np.float64)


def spring_of(what: str, value: Spring | None) -> Floats:
    """Stiffness, damping and target as (3,); None is no spring."""
    if value is None:
        return np.zeros(3)
    return values.vector(f"{what} spring", value, rule=JOINT_VALUE)


def motor_of(value: Motor | None) -> Floats:
    """Speed and strength as (2,); None is no motor."""
    if value is None:
        return np.zeros(2)
    numbers = values.vector("motor", value, 2, JOINT_VALUE)
    if numbers[1] < 0:
        raise refuse(JOINT_VALUE, f"The strength of the motor is {value[1]!r}.")
    return numbers


def extend_joints(storage: Storage, columns: JointColumns) -> NDArray[np.int64]:
    """Add many joints, all or, on WorldError, none; returns their system ids (n,)."""
    filled = _prepare(columns)
    bodies = filled["bodies"]
    missing = bodies[(bodies != 0) & (storage.top.find_all(bodies) < 0)]
    if len(missing):
        raise refuse(JOINT_BODIES, f"There is no top-level body with the system id {missing[0]}.")
    table = storage.joint_table
    sids = values.new_system_ids(
        columns.sids, len(bodies), storage.next_joint_sid, lambda sid: table.find(sid) >= 0
    )
    names = values.names(sids, columns.names)
    table.extend(sids, filled)
    storage.joint_names.update(names)
    for body, joint in zip(bodies.ravel().tolist(), np.repeat(sids, 2).tolist(), strict=True):
        if body:
            storage.joints_of.setdefault(body, []).append(joint)
    if len(sids):
        storage.next_joint_sid = max(storage.next_joint_sid, int(sids.max()) + 1)
    return sids


def _prepare(columns: JointColumns) -> dict[str, NDArray[Any]]:
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
    for name, rule in (
        ("positions", NUMBER),
        ("orientations", NUMBER),
        ("linear_springs", JOINT_VALUE),
        ("angular_springs", JOINT_VALUE),
        ("motors", JOINT_VALUE),
    ):
        if name in filled and not np.all(np.isfinite(filled[name])):
            raise refuse(rule, f"The column {name} holds numbers that are not finite.")
    if not np.all(np.any(filled["orientations"] != 0, axis=2)):
        raise refuse(NUMBER, "An orientation is a quaternion of length zero.")
    if "motors" in filled and np.any(filled["motors"][:, 1] < 0):
        raise refuse(JOINT_VALUE, "The column motors holds a strength that is negative.")
    for name in ("linear_limits", "angular_limits"):
        if name in filled and np.any(np.isnan(filled[name])):
            raise refuse(JOINT_VALUE, f"The column {name} holds what is not a number.")
    return filled

"""Where the two bodies of a joint stand to each other, along what the joint leaves free."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import rotations
from colladaphy.world.storage import Storage

__all__ = ["angles_of", "coordinates", "speeds", "turned_axes"]

Floats = NDArray[np.float64]

_UNITS = np.eye(3)


def angles_of(limits: Floats, turn: Floats) -> Floats:
    """Turns (3,) about x, the new y, the new z, that make a rotation (4,) of frame 2 in frame 1.

    `limits` (2, 3) are the joint's; angles are within them where a full turn helps.
    """
    low, high = limits
    moving = np.flatnonzero(low != high)
    angles = np.zeros(3)
    if len(moving) == 1 and not np.any(np.where(low == high, low, 0.0)):
        i = int(moving[0])
        angles[i] = 2.0 * np.arctan2(turn[1 + i], turn[0])
    else:
        m = rotations.to_matrix(turn)
        angles[0] = np.arctan2(-m[1, 2], m[2, 2])
        angles[1] = np.arctan2(m[0, 2], np.hypot(m[1, 2], m[2, 2]))
        angles[2] = np.arctan2(-m[0, 1], m[0, 0])
    full = 2.0 * np.pi
    for i in moving.tolist():
        angle = float(np.remainder(angles[i] + np.pi, full) - np.pi)
        candidates = (angle, angle + full, angle - full)
        angles[i] = next((a for a in candidates if low[i] <= a <= high[i]), angle)
    return angles


def turned_axes(angles: Floats) -> Floats:
    """The axes (3, 3), in frame 1, about which x, the new y and the new z turn."""
    turn, axes = np.array(rotations.IDENTITY), []
    for i in range(3):
        axes.append(rotations.rotate(turn, _UNITS[i]))
        turn = rotations.multiply(turn, rotations.from_axis_angle(_UNITS[i], angles[i]))
    return np.array(axes)


def coordinates(storage: Storage, row: int) -> Floats:
    """Displacements, then turns (k,), along and about the axes of a joint that are not locked."""
    shift, turn, _ = _relative(storage, row)
    linear, angular = _limits(storage, row)
    return np.concatenate([shift[_free(linear)], _turns(angular, turn)])


def speeds(storage: Storage, row: int) -> Floats:
    """How fast these coordinates change (k,); of a ball the angular velocity in frame 1."""
    _, turn, base = _relative(storage, row)
    point = _ends(storage, row)[1][0]
    drift, spin = np.zeros(3), np.zeros(3)
    for sid, sign in zip(_bodies(storage, row), (-1.0, 1.0), strict=True):
        if sid and not storage.top.raw("fixed")[storage.top.find(sid)]:
            linear, angular = storage.velocity_of(sid)
            drift += sign * (linear + np.cross(angular, point - storage.pose_of(sid)[0]))
            spin += sign * angular
    drift, spin = rotations.unrotate(base, drift), rotations.unrotate(base, spin)
    linear, angular = _limits(storage, row)
    moving = _free(angular)
    rates = spin[moving]
    if moving.any() and not _is_ball(angular):
        axes = turned_axes(angles_of(angular, turn))[moving]
        rates = np.asarray(np.linalg.lstsq(axes.T, spin, rcond=None)[0], dtype=np.float64)
    return np.concatenate([drift[_free(linear)], rates])


def _turns(limits: Floats, turn: Floats) -> Floats:
    if _is_ball(limits):
        axis, angle = rotations.to_axis_angle(turn)
        return np.asarray(axis * angle)
    return angles_of(limits, turn)[_free(limits)]


def _free(limits: Floats) -> NDArray[np.bool_]:
    return np.asarray(limits[0] != limits[1])


def _is_ball(limits: Floats) -> bool:
    return bool(np.all(np.isneginf(limits[0]) & np.isposinf(limits[1])))


def _limits(storage: Storage, row: int) -> tuple[Floats, Floats]:
    table = storage.joint_table
    return table.raw("linear_limits")[row], table.raw("angular_limits")[row]


def _bodies(storage: Storage, row: int) -> Any:
    return storage.joint_table.raw("bodies")[row].tolist()


def _ends(storage: Storage, row: int) -> list[tuple[Floats, Floats]]:
    """Origin and orientation of both frames in the world."""
    table = storage.joint_table
    ends = []
    for side, sid in enumerate(_bodies(storage, row)):
        origin, turn = storage.pose_of(sid) if sid else (np.zeros(3), np.array(rotations.IDENTITY))
        point = origin + rotations.rotate(turn, table.raw("positions")[row][side])
        ends.append((point, rotations.multiply(turn, table.raw("orientations")[row][side])))
    return ends


def _relative(storage: Storage, row: int) -> tuple[Floats, Floats, Floats]:
    """Shift (3,) and turn (4,) of frame 2 in frame 1, and the orientation (4,) of frame 1."""
    (origin1, turn1), (origin2, turn2) = _ends(storage, row)
    base = rotations.normalize(turn1)
    shift = rotations.unrotate(base, origin2 - origin1)
    turn = rotations.multiply(rotations.conjugate(base), rotations.normalize(turn2))
    return shift, turn, base

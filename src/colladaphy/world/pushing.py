"""What a force or an impulse at a point does to a body, and how fast a point of it is.

Points, forces and impulses are in the world frame. A member of a union stands for its union.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations, values
from colladaphy.world.rules import INERTIA, MASS, refuse
from colladaphy.world.storage import Storage

__all__ = ["push", "strike", "velocity_at"]

Floats = NDArray[np.float64]

_NOTHING = 1e-9
"""What is lost of an angular momentum by rounding, against all of it."""


def _arm(storage: Storage, sid: int, at: ArrayLike | None) -> tuple[int, Floats]:
    """The row of the outermost union of a body, and a point of it from that one's centre."""
    row = storage.top.find(storage.root_of(sid))
    point = storage.pose_of(sid)[0] if at is None else values.vector("point", at)
    return row, point - storage.top.raw("positions")[row]


def push(storage: Storage, sid: int, force: ArrayLike, at: ArrayLike | None) -> None:
    """Add to force and torque of the next step. What is fixed bears it."""
    vector = values.vector("force", force)
    row, arm = _arm(storage, sid, at)
    top = storage.top
    if top.raw("fixed")[row]:
        return
    top.raw("forces")[row] += vector
    top.raw("torques")[row] += np.cross(arm, vector)


def strike(storage: Storage, sid: int, impulse: ArrayLike, at: ArrayLike | None) -> None:
    """Change the velocities at once: Δv = J/m, Δω = I⁻¹(r × J). What is fixed bears it."""
    vector = values.vector("impulse", impulse)
    row, arm = _arm(storage, sid, at)
    top = storage.top
    if top.raw("fixed")[row]:
        return
    mass, inertia = float(top.raw("masses")[row]), top.raw("inertias")[row]
    if mass == 0.0 and np.any(vector):
        raise refuse(MASS, f"The body {int(top.raw('sids')[row])} has no mass to be struck.")
    spin = np.zeros(3)
    turning = np.cross(arm, vector)
    if np.any(turning):
        turn = rotations.normalize(top.raw("orientations")[row])
        local = rotations.unrotate(turn, turning)
        answer = np.linalg.pinv(inertia) @ local
        missing = np.linalg.norm(inertia @ answer - local)
        # Points, and points on a line, have no inertia about it.
        if missing > _NOTHING * np.linalg.norm(vector) * np.linalg.norm(arm):
            what = f"The body {int(top.raw('sids')[row])} has no inertia about {turning.tolist()}."
            raise refuse(INERTIA, what)
        spin = rotations.rotate(turn, answer)
    if np.any(vector):
        top.raw("linear_velocities")[row] += vector / mass
    top.raw("angular_velocities")[row] += spin
    top.raw("sleeping")[row] = False


def velocity_at(storage: Storage, sid: int, point: ArrayLike) -> Floats:
    """The velocity v + ω × r (3,) of the point of the body that is at `point` now."""
    row, arm = _arm(storage, sid, point)
    top = storage.top
    linear, angular = top.raw("linear_velocities")[row], top.raw("angular_velocities")[row]
    return np.asarray(linear + np.cross(angular, arm))

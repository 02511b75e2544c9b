"""The state of all bodies of a space at once, by pymunk's batch functions where they do.

pymunk calls them experimental: what they give is compared with the bodies themselves at the start,
and one body after the other is asked if there is any difference.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pymunk
from numpy.typing import NDArray

__all__ = ["Batch"]

Floats = NDArray[np.float64]

try:
    from pymunk import batch

    _STATE: Any = (
        batch.BodyFields.BODY_ID | batch.BodyFields.POSITION | batch.BodyFields.ANGLE
        | batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
    )  # fmt: skip
    _PUSH: Any = batch.BodyFields.FORCE | batch.BodyFields.TORQUE
    _WITH_ID: Any = batch.BodyFields.BODY_ID | _PUSH
except (ImportError, AttributeError):  # another version of pymunk
    batch = None  # type: ignore[assignment,unused-ignore]

_STATE_WIDTH: Final = 6
_PUSH_WIDTH: Final = 3


class Batch:
    """Reads and pushes the moving bodies of a space, in their order."""

    def __init__(self, space: pymunk.Space, bodies: list[pymunk.Body]) -> None:
        self._space = space
        self._bodies = bodies
        ids = np.array([body.id for body in bodies], dtype=np.int64)
        self._order = np.argsort(ids)
        self._ids = ids[self._order]
        self._buffer: Any = None
        self._pushed: Any = None  # where all bodies' forces are, once they have been asked for
        if batch is not None and bodies:
            self._buffer = batch.Buffer()
            try:
                same = np.array_equal(self._fast_state(), self._slow_state(), equal_nan=True)
            except Exception:  # whatever another version of it does
                same = False
            if not same:
                self._buffer = None

    def state(self) -> Floats:
        """Position, angle, velocity and angular velocity (n, 6)."""
        return self._slow_state() if self._buffer is None else self._fast_state()

    def push(self, forces: Floats, torques: Floats) -> None:
        """Set forces (n, 2) and torques (n,); wakes every body."""
        if self._buffer is None:
            for body, force, torque in zip(
                self._bodies, forces.tolist(), torques.tolist(), strict=True
            ):
                body.force, body.torque = tuple(force), torque
            return
        if self._pushed is None:  # the order of the bodies of a space stays as it is
            buffer = batch.Buffer()
            self._pushed = buffer, *self._get(buffer, _WITH_ID, _PUSH_WIDTH)
        buffer, places, values = self._pushed
        values[places, :2], values[places, 2] = forces, torques
        batch.set_space_bodies(self._space, _PUSH, buffer)

    def _get(self, buffer: Any, fields: Any, width: int) -> tuple[NDArray[np.int64], Floats]:
        """Rows of the moving bodies, and the values (m, width) of all bodies, to be written to."""
        buffer.clear()
        batch.get_space_bodies(self._space, fields, buffer)
        found = np.frombuffer(buffer.int_buf(), dtype=np.int64)
        values = np.frombuffer(buffer.float_buf(), dtype=np.float64).reshape(-1, width)
        rows = np.argsort(found, kind="stable")
        rows = rows[np.searchsorted(found[rows], self._ids)]
        places = np.empty_like(rows)
        places[self._order] = rows
        return places, values

    def _fast_state(self) -> Floats:
        places, values = self._get(self._buffer, _STATE, _STATE_WIDTH)
        return np.array(values[places])

    def _slow_state(self) -> Floats:
        rows = [
            (*body.position, body.angle, *body.velocity, body.angular_velocity)
            for body in self._bodies
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, _STATE_WIDTH)

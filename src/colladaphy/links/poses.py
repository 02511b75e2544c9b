"""Poses by column: a position and an orientation a row, and how they compose.

A row that is not moved, or not turned, says so by a mask, so that what a document states alone
keeps its bits: to compose with it changes nothing, not even the sign of a zero. Quaternions are in
the order w, x, y, z; sums and products are taken in one fixed order, row by row the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import reduce
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "DEGREE",
    "Poses",
    "quaternion_product",
    "quaternions_of_turns",
    "reach",
    "rotate_vectors",
    "unit_quaternions",
]

Array = NDArray[Any]
Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]

DEGREE: Final = math.pi / 180.0
_LARGE: Final = 2.0**1020
_SCALE: Final = 16.0
NO_TURN: Final = (1.0, 0.0, 0.0, 0.0)


@dataclass(slots=True)
class Poses:
    """Where things stand in the frames of their parents; n rows."""

    positions: Floats
    """(n, 3), zero where not moved."""
    moved: Bools
    """(n,) whether a position is given."""
    orientations: Floats
    """(n, 4), the identity where not turned."""
    turned: Bools
    """(n,) whether an orientation is given."""

    @classmethod
    def none(cls, count: int) -> Poses:
        """Rows that are neither moved nor turned."""
        return cls.of(count)

    @classmethod
    def of(
        cls,
        count: int,
        positions: Array | None = None,
        orientations: Array | None = None,
        *,
        moved: Array | None = None,
        turned: Array | None = None,
    ) -> Poses:
        """Rows of the given columns; what is None, or masked out, is not given."""
        place, turn = np.zeros((count, 3)), np.zeros((count, 4))
        turn[:, 0] = 1.0
        is_moved, is_turned = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        if positions is not None:
            is_moved[...] = True if moved is None else moved
            np.copyto(place, positions, where=is_moved[:, None])
        if orientations is not None:
            is_turned[...] = True if turned is None else turned
            np.copyto(turn, orientations, where=is_turned[:, None])
        return cls(place, is_moved, turn, is_turned)

    def __len__(self) -> int:
        return len(self.moved)

    def take(self, rows: Array) -> Poses:
        """Some of the rows (numbers or a mask), in that order."""
        if rows.dtype == np.bool_:
            rows = np.flatnonzero(rows)
        return Poses(self.positions.take(rows, axis=0), self.moved.take(rows),
                     self.orientations.take(rows, axis=0), self.turned.take(rows))  # fmt: skip

    def put(self, rows: Array, other: Poses) -> None:
        """Replace some of the rows (numbers or a mask)."""
        self.positions[rows] = other.positions
        self.moved[rows] = other.moved
        self.orientations[rows] = other.orientations
        self.turned[rows] = other.turned

    @classmethod
    def joined(cls, parts: Iterable[Poses]) -> Poses:
        """The rows of several, one after the other."""
        listed = list(parts)
        if len(listed) == 1:
            return listed[0]
        return cls(*(np.concatenate([getattr(part, name) for part in listed]) if listed
                     else np.zeros(shape, dtype)
                     for name, shape, dtype in (("positions", (0, 3), float),
                                                ("moved", (0,), bool),
                                                ("orientations", (0, 4), float),
                                                ("turned", (0,), bool))))  # fmt: skip

    def turns_only(self) -> Poses:
        """The same orientations, not moved."""
        return Poses.of(len(self), None, self.orientations, turned=self.turned)

    def places_only(self) -> Poses:
        """The same positions, not turned."""
        return Poses.of(len(self), self.positions, moved=self.moved)

    def then(self, inner: Poses) -> Poses:
        """The poses, in these poses' parents, of what stands at `inner` in their frames."""
        if not (inner.moved.any() or inner.turned.any()):
            return self
        if not (self.moved.any() or self.turned.any()):
            return inner
        turned = self.turned | inner.turned
        both = self.turned & inner.turned
        if both.all():
            orientations = quaternion_product(self.orientations, inner.orientations)
        else:
            orientations = np.where(inner.turned[:, None], inner.orientations, self.orientations)
            if both.any():
                orientations[both] = quaternion_product(
                    self.orientations[both], inner.orientations[both]
                )
        moved = self.moved | inner.moved
        shifts = inner.moved
        across = shifts & self.turned
        local = inner.positions
        if across.all():
            local = rotate_vectors(self.orientations, local)
        elif across.any():
            local = local.copy()
            local[across] = rotate_vectors(self.orientations[across], local[across])
        sums = self.moved & shifts
        if sums.all():
            positions = self.positions + local
        else:
            positions = np.where(shifts[:, None], local, self.positions)
            positions[sums] = self.positions[sums] + local[sums]
        return Poses(positions, moved, orientations, turned)

    def inverse(self) -> Poses:
        """The poses that undo these."""
        orientations = self.orientations * _CONJUGATE
        orientations[~self.turned] = NO_TURN
        back = -self.positions
        back[~self.moved] = 0.0
        across = self.moved & self.turned
        if across.any():
            back[across] = rotate_vectors(orientations[across], back[across])
        return Poses(back, self.moved, orientations, self.turned)

    def points(self, local: Floats) -> Floats:
        """Points (n, 3) of these frames, in the parents'."""
        return self.then(Poses.of(len(self), local)).positions

    def is_identity(self) -> Bools:
        """Which rows are neither moved nor turned (n,)."""
        return ~(self.moved | self.turned)


_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def quaternion_product(a: Floats, b: Floats) -> Floats:
    """The rotations (n, 4) that turn by `b` first and by `a` after."""
    aw, ax, ay, az = a.T
    bw, bx, by, bz = b.T
    made = np.empty_like(a)
    made[:, 0] = aw * bw - ax * bx - ay * by - az * bz
    made[:, 1] = aw * bx + ax * bw + ay * bz - az * by
    made[:, 2] = aw * by - ax * bz + ay * bw + az * bx
    made[:, 3] = aw * bz + ax * by - ay * bx + az * bw
    return made


def rotate_vectors(q: Floats, v: Floats) -> Floats:
    """Vectors (n, 3) turned by unit quaternions (n, 4)."""
    if not len(v) or not float(np.abs(v).max()) > _LARGE:
        return _turned(q, v)
    with np.errstate(over="ignore", invalid="ignore"):
        made = _turned(q, v)
        # On the way there are numbers twice as large as what comes out.
        lost = np.flatnonzero(~np.isfinite(made).all(axis=1) & np.isfinite(v).all(axis=1))
        made[lost] = _turned(q[lost], v[lost] / _SCALE) * _SCALE
    return made


def _turned(q: Floats, v: Floats) -> Floats:
    w, x, y, z = q.T
    vx, vy, vz = v.T
    tx = 2.0 * (y * vz - z * vy)
    ty = 2.0 * (z * vx - x * vz)
    tz = 2.0 * (x * vy - y * vx)
    made = np.empty_like(v)
    made[:, 0] = vx + w * tx + y * tz - z * ty
    made[:, 1] = vy + w * ty + z * tx - x * tz
    made[:, 2] = vz + w * tz + x * ty - y * tx
    return made


def reach(vectors: Array) -> Floats:
    """The largest magnitude (n,) of the numbers of each vector (n, m); not a number if any is."""
    # By columns, as numpy takes a call for each row of few numbers.
    return np.asarray(reduce(np.maximum, np.abs(vectors).T))


def unit_quaternions(q: Floats) -> Floats:
    """The quaternions (n, 4) at length one; one of no length is no rotation."""
    with np.errstate(all="ignore"):
        largest = reach(q)
        usable = (largest > 0.0) & (largest < np.inf)
        scaled = q / largest[:, None]
        w, x, y, z = scaled.T
        made = scaled / np.sqrt(w * w + x * x + y * y + z * z)[:, None]
    made[~usable] = NO_TURN
    return np.asarray(made)


def quaternions_of_turns(turns: Floats, *, exact: bool = True) -> tuple[Floats, Bools]:
    """Quaternions (n, 4) of axes and degrees (n, 4), and which of them turn at all.

    Axes need not have unit length; one of no length turns nothing. If not `exact`, the last bits
    may differ from machine to machine, and it takes less time.
    """
    with np.errstate(all="ignore"):
        x, y, z, degrees = turns.T
        length = np.sqrt(x * x + y * y + z * z)
        usable = (degrees != 0.0) & np.isfinite(degrees)
        far = usable & ~((length > 1e-150) & (length < 1e150))
        axes = turns[:, :3]
        if far.any():
            largest = reach(axes)
            usable &= ~far | ((largest > 0.0) & (largest < np.inf))
            axes = axes.copy()
            axes[far] /= largest[far, None]
            x, y, z = axes.T
            length = np.sqrt(x * x + y * y + z * z)
        half = np.where(usable, np.fmod(degrees, 720.0) * DEGREE * 0.5, 0.0)
        made = np.empty((len(turns), 4))
        if exact:
            # One by one, as numpy's sines and cosines differ from machine to machine.
            listed = half.tolist()
            sines = np.array([math.sin(angle) for angle in listed])
            made[:, 0] = [math.cos(angle) for angle in listed]
        else:
            sines = np.sin(half)
            np.cos(half, out=made[:, 0])
        scale = sines / length
        made[:, 1:] = axes * scale[:, None]
    made[~usable] = NO_TURN
    return made, usable

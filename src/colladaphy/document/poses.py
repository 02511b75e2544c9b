"""Poses: a position and an orientation, and how they compose.

Plain tuples and scalar arithmetic, so that a pose that a document states alone keeps its bits: to
compose with the identity changes nothing, not even the sign of a zero. Quaternions are in the
order w, x, y, z. Affine transforms that are no poses (scale, skew, a matrix) are 4x4 nested
tuples; `rigid_part` gives the pose nearest to one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

__all__ = [
    "DEGREE",
    "IDENTITY",
    "Matrix",
    "Pose",
    "Quaternion",
    "Vector",
    "matrix_of",
    "multiply_matrices",
    "quaternion_from_axis_angle",
    "quaternion_from_matrix",
    "quaternion_product",
    "rigid_part",
    "rotate_vector",
    "unit_quaternion",
]

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Matrix = tuple[tuple[float, float, float, float], ...]

DEGREE = math.pi / 180.0
NO_ROTATION: Quaternion = (1.0, 0.0, 0.0, 0.0)
ORIGIN: Vector = (0.0, 0.0, 0.0)


class Pose(NamedTuple):
    """Where something stands in its parent's frame; None where it is not moved or not turned."""

    position: Vector | None = None
    orientation: Quaternion | None = None

    @property
    def translation(self) -> Vector:
        """The position, the origin where none is given."""
        return ORIGIN if self.position is None else self.position

    @property
    def rotation(self) -> Quaternion:
        """The orientation, the identity where none is given."""
        return NO_ROTATION if self.orientation is None else self.orientation

    def then(self, inner: Pose) -> Pose:
        """The pose, in this one's parent, of what stands at `inner` in this one's frame."""
        if inner.orientation is None:
            orientation = self.orientation
        elif self.orientation is None:
            orientation = inner.orientation
        else:
            orientation = quaternion_product(self.orientation, inner.orientation)
        if inner.position is None:
            return Pose(self.position, orientation)
        moved = inner.position
        if self.orientation is not None:
            moved = rotate_vector(self.orientation, moved)
        if self.position is not None:
            x, y, z = self.position
            moved = (x + moved[0], y + moved[1], z + moved[2])
        return Pose(moved, orientation)

    def inverse(self) -> Pose:
        """The pose that undoes this one."""
        orientation = None
        if self.orientation is not None:
            w, x, y, z = self.orientation
            orientation = (w, -x, -y, -z)
        if self.position is None:
            return Pose(None, orientation)
        back = (-self.position[0], -self.position[1], -self.position[2])
        if orientation is not None:
            back = rotate_vector(orientation, back)
        return Pose(back, orientation)

    def point(self, local: Vector) -> Vector:
        """The point `local` of this frame, in the parent's."""
        return self.then(Pose(local)).translation


IDENTITY = Pose()


def quaternion_from_axis_angle(x: float, y: float, z: float, degrees: float) -> Quaternion | None:
    """The quaternion of `<rotate>x y z degrees</rotate>`; None where it turns nothing.

    The axis need not have unit length; one of no length turns nothing.
    """
    if degrees == 0.0:
        return None
    length = math.sqrt(x * x + y * y + z * z)
    if not 1e-150 < length < 1e150:
        largest = max(abs(x), abs(y), abs(z))
        if not 0.0 < largest < math.inf:
            return None
        x, y, z = x / largest, y / largest, z / largest
        length = math.sqrt(x * x + y * y + z * z)
    if not math.isfinite(degrees):
        return None
    half = math.fmod(degrees, 720.0) * DEGREE * 0.5
    scale = math.sin(half) / length
    return (math.cos(half), x * scale, y * scale, z * scale)


def quaternion_product(a: Quaternion, b: Quaternion) -> Quaternion:
    """The rotation that turns by `b` first and by `a` after."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def unit_quaternion(q: Quaternion) -> Quaternion:
    """The quaternion at length one; one of no length is no rotation."""
    largest = max(map(abs, q))
    if not 0.0 < largest < math.inf:
        return NO_ROTATION
    w, x, y, z = (value / largest for value in q)
    length = math.sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length)


def rotate_vector(q: Quaternion, v: Vector) -> Vector:
    """`v` turned by the unit quaternion `q`."""
    w, x, y, z = q
    vx, vy, vz = v
    tx = 2.0 * (y * vz - z * vy)
    ty = 2.0 * (z * vx - x * vz)
    tz = 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def matrix_of(pose: Pose) -> Matrix:
    """The 4x4 matrix of a pose."""
    w, x, y, z = pose.rotation
    px, py, pz = pose.translation
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), px),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), py),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), pz),
        (0.0, 0.0, 0.0, 1.0),
    )


def multiply_matrices(a: Matrix, b: Matrix) -> Matrix:
    """The product of two 4x4 matrices, `b` applied first."""
    columns = list(zip(*b, strict=True))
    return tuple(
        (
            _dot(row, columns[0]),
            _dot(row, columns[1]),
            _dot(row, columns[2]),
            _dot(row, columns[3]),
        )
        for row in a
    )


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return math.fsum(x * y for x, y in zip(a, b, strict=True))


def rigid_part(matrix: Matrix) -> tuple[Pose, bool]:
    """The pose nearest to an affine matrix, and whether it is the same transform.

    The rotation is that of the columns made orthonormal in turn (Gram-Schmidt); a reflection is
    undone by turning the third column round. Tolerance 1e-6, that of six written digits.
    """
    columns = [tuple(matrix[row][column] for row in range(3)) for column in range(3)]
    x = _unit(columns[0])
    along = sum(a * b for a, b in zip(x, columns[1], strict=True))
    y = _unit(tuple(b - along * a for a, b in zip(x, columns[1], strict=True)))
    z = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    exact = all(
        abs(given - made) <= 2e-6
        for given_column, made_column in zip(columns, (x, y, z), strict=True)
        for given, made in zip(given_column, made_column, strict=True)
    )
    orientation = quaternion_from_matrix(tuple(zip(x, y, z, strict=True)))
    position = (matrix[0][3], matrix[1][3], matrix[2][3])
    return Pose(position, None if orientation == NO_ROTATION else orientation), exact


def _unit(vector: Sequence[float]) -> Vector:
    length = math.sqrt(math.fsum(part * part for part in vector))
    if not 0.0 < length < math.inf:
        return (1.0, 0.0, 0.0)
    return (vector[0] / length, vector[1] / length, vector[2] / length)


def quaternion_from_matrix(rows: Sequence[Sequence[float]]) -> Quaternion:
    """The unit quaternion of a rotation matrix (w not negative)."""
    (a, b, c), (d, e, f), (g, h, i) = ((r[0], r[1], r[2]) for r in rows[:3])
    squares = (1 + a + e + i, 1 + a - e - i, 1 - a + e - i, 1 - a - e + i)
    largest = max(range(4), key=squares.__getitem__)
    s = 2.0 * math.sqrt(max(squares[largest], 0.0))
    parts = (
        (s / 4, (h - f) / s, (c - g) / s, (d - b) / s),
        ((h - f) / s, s / 4, (b + d) / s, (c + g) / s),
        ((c - g) / s, (b + d) / s, s / 4, (f + h) / s),
        ((d - b) / s, (c + g) / s, (f + h) / s, s / 4),
    )[largest]
    w, x, y, z = parts
    return (w, x, y, z) if w >= 0.0 else (-w, -x, -y, -z)

"""Rotations: quaternions (w, x, y, z), matrices, axis and angle, angles about fixed axes.

All functions work on the last one or two dimensions and are vectorised over the leading ones.
A quaternion stands for the same rotation at any length but zero; angles are in radians; matrices
act on column vectors from the left.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "IDENTITY",
    "between",
    "conjugate",
    "fixed_angles",
    "from_axis_angle",
    "from_matrix",
    "multiply",
    "normalize",
    "rotate",
    "rotate_tensor",
    "to_axis_angle",
    "to_matrix",
    "turned",
    "unrotate",
]

Floats = NDArray[np.float64]

IDENTITY: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)


def _floats(value: ArrayLike) -> Floats:
    return np.asarray(value, dtype=np.float64)


def multiply(first: ArrayLike, second: ArrayLike) -> Floats:
    """Hamilton product: the rotation `second` followed by `first`. (..., 4) and (..., 4)."""
    p, q = _floats(first), _floats(second)
    return np.stack(
        _product(tuple(p[..., i] for i in range(4)), tuple(q[..., i] for i in range(4))), axis=-1
    )


def _product(p: tuple[Any, ...], q: tuple[Any, ...]) -> tuple[Any, Any, Any, Any]:
    pw, px, py, pz = p
    qw, qx, qy, qz = q
    return (
        pw * qw - px * qx - py * qy - pz * qz,
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
    )


def conjugate(quaternion: ArrayLike) -> Floats:
    """The inverse rotation (of the same length). (..., 4)."""
    return np.asarray(_floats(quaternion) * np.array([1.0, -1.0, -1.0, -1.0]))


def normalize(quaternion: ArrayLike) -> Floats:
    """The quaternion at length one, safe for very large and very small ones. (..., 4)."""
    q = _floats(quaternion)
    # Scaling by a power of two first is exact, and keeps the squares within range.
    _, exponent = np.frexp(np.max(np.abs(q), axis=-1, keepdims=True))
    q = np.ldexp(q, -exponent)
    return np.asarray(q / np.sqrt(np.sum(q * q, axis=-1, keepdims=True)))


def rotate(quaternion: ArrayLike, vector: ArrayLike) -> Floats:
    """`vector` (..., 3) rotated by `quaternion` (..., 4)."""
    return _apply(to_matrix(quaternion), _floats(vector))


def unrotate(quaternion: ArrayLike, vector: ArrayLike) -> Floats:
    """`vector` (..., 3) rotated by the inverse of `quaternion` (..., 4)."""
    return _apply(np.swapaxes(to_matrix(quaternion), -1, -2), _floats(vector))


def _apply(matrix: Floats, vector: Floats) -> Floats:
    # Term by term, as BLAS gives other bits to arrays that lie in memory differently.
    x, y, z = (vector[..., i, None] for i in range(3))
    return np.asarray(matrix[..., 0] * x + matrix[..., 1] * y + matrix[..., 2] * z)


def rotate_tensor(quaternion: ArrayLike, tensor: ArrayLike) -> Floats:
    """R·T·Rᵀ: a tensor (..., 3, 3) in the rotated frame's axes, seen from outside."""
    matrix = to_matrix(quaternion)
    return np.asarray(matrix @ _floats(tensor) @ np.swapaxes(matrix, -1, -2))


def to_matrix(quaternion: ArrayLike) -> Floats:
    """The rotation matrix (..., 3, 3) of a quaternion (..., 4)."""
    q = normalize(quaternion)
    w, x, y, z = (q[..., i] for i in range(4))
    matrix = np.empty((*q.shape[:-1], 3, 3))
    matrix[..., 0, 0] = 1 - 2 * (y * y + z * z)
    matrix[..., 0, 1] = 2 * (x * y - w * z)
    matrix[..., 0, 2] = 2 * (x * z + w * y)
    matrix[..., 1, 0] = 2 * (x * y + w * z)
    matrix[..., 1, 1] = 1 - 2 * (x * x + z * z)
    matrix[..., 1, 2] = 2 * (y * z - w * x)
    matrix[..., 2, 0] = 2 * (x * z - w * y)
    matrix[..., 2, 1] = 2 * (y * z + w * x)
    matrix[..., 2, 2] = 1 - 2 * (x * x + y * y)
    return matrix


def from_matrix(matrix: ArrayLike) -> Floats:
    """The unit quaternion (..., 4), w ≥ 0, of a rotation matrix (..., 3, 3)."""
    m = _floats(matrix)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    # Four candidates, each four times one component times the whole quaternion; the one whose
    # own component is the largest is the most accurate.
    wx = m[..., 2, 1] - m[..., 1, 2]
    wy = m[..., 0, 2] - m[..., 2, 0]
    wz = m[..., 1, 0] - m[..., 0, 1]
    xy = m[..., 0, 1] + m[..., 1, 0]
    xz = m[..., 0, 2] + m[..., 2, 0]
    yz = m[..., 1, 2] + m[..., 2, 1]
    rows: list[list[Any]] = [
        [1 + xx + yy + zz, wx, wy, wz],
        [wx, 1 + xx - yy - zz, xy, xz],
        [wy, xy, 1 - xx + yy - zz, yz],
        [wz, xz, yz, 1 - xx - yy + zz],
    ]
    table = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    best = np.argmax(np.diagonal(table, axis1=-2, axis2=-1), axis=-1)
    chosen = np.take_along_axis(table, best[..., None, None], axis=-2)[..., 0, :]
    sign = np.where(chosen[..., :1] < 0, -1.0, 1.0)
    return normalize(chosen * sign)


def from_axis_angle(axis: ArrayLike, angle: ArrayLike) -> Floats:
    """The unit quaternion (..., 4) of a turn by `angle` (...) about `axis` (..., 3), any length."""
    a = _floats(axis)
    half = 0.5 * _floats(angle)[..., None]
    _, exponent = np.frexp(np.max(np.abs(a), axis=-1, keepdims=True))
    a = np.ldexp(a, -exponent)
    length = np.sqrt(np.sum(a * a, axis=-1, keepdims=True))
    unit = np.divide(a, length, out=np.zeros_like(a), where=length > 0)
    vector = unit * np.sin(half)
    cosine = np.broadcast_to(np.cos(half), (*vector.shape[:-1], 1))
    return np.concatenate([cosine, vector], axis=-1)


def to_axis_angle(quaternion: ArrayLike) -> tuple[Floats, Floats]:
    """Unit axis (..., 3) and angle (...) in [0, π]; the axis of no rotation is x."""
    q = normalize(quaternion)
    q = q * np.where(q[..., :1] < 0, -1.0, 1.0)
    vector = q[..., 1:]
    length = np.hypot(np.hypot(vector[..., :1], vector[..., 1:2]), vector[..., 2:])
    still = np.broadcast_to(np.array([1.0, 0.0, 0.0]), vector.shape).copy()
    axis = np.divide(vector, length, out=still, where=length > 0)
    return axis, np.asarray(2.0 * np.arctan2(length[..., 0], q[..., 0]))


def fixed_angles(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Floats:
    """Rz·Ry·Rx: turns about the fixed axes x, then y, then z, as pe's ``rotate(x, y, z)``."""
    about_x = from_axis_angle((1.0, 0.0, 0.0), x)
    about_y = from_axis_angle((0.0, 1.0, 0.0), y)
    about_z = from_axis_angle((0.0, 0.0, 1.0), z)
    return multiply(about_z, multiply(about_y, about_x))


def turned(
    quaternion: tuple[float, ...], x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """A single rotation followed by `fixed_angles`, at length one; quick, without arrays."""
    x, y, z = 0.5 * x, 0.5 * y, 0.5 * z
    turn = _product((math.cos(y), 0.0, math.sin(y), 0.0), (math.cos(x), math.sin(x), 0.0, 0.0))
    turn = _product((math.cos(z), 0.0, 0.0, math.sin(z)), turn)
    product = _product(turn, quaternion)
    exponent = math.frexp(max(map(abs, product)))[1]
    w, x, y, z = (math.ldexp(number, -exponent) for number in product)
    length = math.sqrt(w * w + x * x + y * y + z * z)
    return w / length, x / length, y / length, z / length


def between(start: ArrayLike, end: ArrayLike) -> Floats:
    """A rotation (..., 4) that turns the direction `start` (..., 3) onto `end` (..., 3).

    It is the shortest one, unless the two are opposite to within a few minutes of arc.
    """
    one, two = np.broadcast_arrays(_directions(start), _directions(end))
    opposite = _dot(one, two) < -0.999999
    near = np.where(opposite, -one, one)
    turn = normalize(np.concatenate([1.0 + _dot(near, two), np.cross(near, two)], axis=-1))
    if not opposite.any():
        return turn
    # Half a turn about any axis across is exact; what is left is small.
    across = np.cross(one, np.eye(3)[np.argmin(np.abs(one), axis=-1)])
    half = normalize(np.concatenate([np.zeros_like(across[..., :1]), across], axis=-1))
    return np.where(opposite, multiply(turn, half), turn)


def _directions(vectors: ArrayLike) -> Floats:
    v = _floats(vectors)
    _, exponent = np.frexp(np.max(np.abs(v), axis=-1, keepdims=True))
    v = np.ldexp(v, -exponent)
    return np.asarray(v / np.sqrt(_dot(v, v)))


def _dot(first: Floats, second: Floats) -> Floats:
    return np.asarray(np.sum(first * second, axis=-1, keepdims=True))

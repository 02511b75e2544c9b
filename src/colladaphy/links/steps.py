"""Transforms in the order of the document: translate and rotate as poses, the others as matrices.

COLLADA 1.5 §node: the transforms of an element are applied as if each were the parent of the next.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.affine import lookat_matrix, skew_matrix
from colladaphy.links.poses import Poses, quaternions_of_turns
from colladaphy.links.sums import exact_sum

__all__ = [
    "Steps",
    "Transforms",
    "matrix_of",
    "own_transforms",
    "poses_of",
    "poses_of_steps",
    "product",
    "rigid_parts",
    "step_matrix",
]

Array = NDArray[Any]


@dataclass(slots=True)
class Steps:
    """The translate and rotate children of n elements, in the order of the document."""

    owner: Array
    """(m,) the row of the element."""
    turns: Array
    """(m,) whether it is a rotate."""
    values: Array
    """(m, 4) x y z, and degrees."""
    count: int

    @classmethod
    def of(cls, elements: Any) -> Steps:
        """The steps of rows that have children translate and rotate."""
        translate, rotate = elements.translate, elements.rotate
        owner = np.concatenate([translate.owner, rotate.owner])
        values = np.zeros((len(owner), 4))
        if len(translate):
            values[: len(translate), :3] = translate.value
        if len(rotate):
            values[len(translate) :] = rotate.value
        turns = np.zeros(len(owner), np.bool_)
        turns[len(translate) :] = True
        if len(translate) and len(rotate):
            order = np.argsort(np.concatenate([translate.ordinals, rotate.ordinals]), kind="stable")
            owner, values, turns = owner[order], values[order], turns[order]
        return cls(owner, turns, values, len(elements))

    def last(self) -> Array:
        """Which steps are the last of their element (m,)."""
        last = np.ones(len(self.owner), np.bool_)
        last[:-1] = self.owner[1:] != self.owner[:-1]
        return last

    def without(self, rows: Array) -> Steps:
        """The same without some steps (a mask)."""
        keep = ~rows
        return Steps(self.owner[keep], self.turns[keep], self.values[keep], self.count)


def poses_of(elements: Any) -> Poses:
    """The poses of rows that have children translate and rotate, composed in order."""
    translate, rotate = elements.translate, elements.rotate
    if translate.is_whole and rotate.is_whole and len(elements):
        if bool(np.all(translate.ordinals < rotate.ordinals)):
            quaternions, turned = quaternions_of_turns(rotate.value)
            moved = np.ones(len(elements), np.bool_)
            return Poses(translate.value.copy(), moved, quaternions, turned)
    elif not len(rotate) and not len(translate):
        return Poses.none(len(elements))
    return poses_of_steps(Steps.of(elements))


def poses_of_steps(steps: Steps, *, exact: bool = True) -> Poses:
    """The poses of all elements, their steps composed in order (see `quaternions_of_turns`)."""
    poses = Poses.none(steps.count)
    owner = steps.owner
    if not len(owner):
        return poses
    single = _poses(steps, exact)
    for rows in _by_rank(owner):
        mine = owner[rows]
        inner = single.take(rows)
        if len(mine) == steps.count:
            poses = poses.then(inner)
        else:
            poses.put(mine, poses.take(mine).then(inner))
    return poses


def _poses(steps: Steps, exact: bool) -> Poses:
    """Each step as a pose."""
    turns = steps.turns
    single = Poses.of(len(turns), steps.values[:, :3], moved=~turns)
    if turns.any():
        quaternions, turned = quaternions_of_turns(steps.values[turns], exact=exact)
        rows = np.flatnonzero(turns)[turned]
        single.orientations[rows] = quaternions[turned]
        single.turned[rows] = True
    return single


def _by_rank(owner: Array) -> list[Array]:
    """The rows that are the first of their owner, then the second, and so on."""
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    sizes = np.diff(np.append(starts, len(owner)))
    return [starts[sizes > rank] + rank for rank in range(int(sizes.max()))]


@dataclass(slots=True)
class Transforms:
    """Transforms that are poses, but for some rows that are matrices."""

    poses: Poses
    matrices: dict[int, Array]
    """4x4 by row, of those that are no poses."""


def own_transforms(nodes: Any) -> Transforms:
    """The transform of each node in its parent."""
    named = [(name, getattr(nodes, name)) for name in ("matrix", "scale", "skew", "lookat")]
    others = [(name, rows) for name, rows in named if len(rows)]
    if not others:
        return Transforms(poses_of(nodes), {})
    steps = Steps.of(nodes)
    mixed = np.zeros(len(nodes), np.bool_)
    for _, rows in others:
        mixed[rows.owner] = True
    poses = poses_of_steps(steps.without(mixed[steps.owner]))
    # Those with a matrix are composed step by step, as matrices once one of them is.
    entries: dict[int, list[tuple[int, str, Array]]] = {}
    for name, rows in [*others, ("translate", nodes.translate), ("rotate", nodes.rotate)]:
        for row, ordinal, value in zip(
            rows.owner.tolist(), rows.ordinals.tolist(), rows.value, strict=True
        ):
            if mixed[row]:
                entries.setdefault(row, []).append((ordinal, name, value))
    matrices = {}
    for row, found in entries.items():
        made = None
        for _, name, value in sorted(found, key=lambda entry: entry[0]):
            step = step_matrix(name, value)
            made = step if made is None else product(made, step)
        assert made is not None
        matrices[row] = made
    return Transforms(poses, matrices)


def step_matrix(name: str, value: Array) -> Array:
    """The 4x4 matrix of one transform, by the name of its element."""
    made = np.eye(4)
    match name:
        case "matrix":
            made = np.array(value, dtype=np.float64).reshape(4, 4)
        case "scale":
            made = np.diag([*value.tolist(), 1.0])
        case "skew":
            made = np.array(skew_matrix(value.tolist()))
        case "lookat":
            made = np.array(lookat_matrix(value.tolist()))
        case "translate":
            made[:3, 3] = value
        case _:
            quaternions, _ = quaternions_of_turns(value[None])
            made = matrix_of(Poses.of(1, None, quaternions))[0]
    return made


def matrix_of(poses: Poses) -> Array:
    """The 4x4 matrices (n, 4, 4) of poses."""
    w, x, y, z = poses.orientations.T
    made = np.zeros((len(poses), 4, 4))
    made[:, 0, 0], made[:, 0, 1], made[:, 0, 2] = (
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y))  # fmt: skip
    made[:, 1, 0], made[:, 1, 1], made[:, 1, 2] = (
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x))  # fmt: skip
    made[:, 2, 0], made[:, 2, 1], made[:, 2, 2] = (
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))  # fmt: skip
    made[:, :3, 3] = poses.positions
    made[:, 3, 3] = 1.0
    return made


def product(outer: Array, inner: Array) -> Array:
    """The product of two 4x4 matrices, each sum rounded once."""
    columns = inner.T.tolist()
    return np.array([
        [exact_sum(a * b for a, b in zip(row, column, strict=True)) for column in columns]
        for row in outer.tolist()
    ])  # fmt: skip


def rigid_parts(matrices: Array) -> tuple[Poses, Array]:
    """The poses nearest to affine matrices (n, 4, 4), and which are the same transforms.

    The rotation is that of the columns made orthonormal in turn (Gram-Schmidt); a reflection is
    undone by turning the third column round. Tolerance 2e-6, that of six written digits.
    """
    with np.errstate(all="ignore"):
        columns = [matrices[:, :3, place] for place in range(3)]
        x = _units(columns[0])
        a, b, c = (x * columns[1]).T
        y = _units(columns[1] - (a + b + c)[:, None] * x)
        z = np.column_stack(
            [x[:, i] * y[:, j] - x[:, j] * y[:, i] for i, j in ((1, 2), (2, 0), (0, 1))]
        )
        made = np.stack([x, y, z], axis=2)
        exact = np.all(np.abs(matrices[:, :3, :3] - made) <= 2e-6, axis=(1, 2))
    orientations = _quaternions(made)
    turned = np.any(orientations != np.array([1.0, 0.0, 0.0, 0.0]), axis=1)
    return Poses.of(len(matrices), matrices[:, :3, 3], orientations, turned=turned), exact


def _units(vectors: Array) -> Array:
    squares = (vectors * vectors).tolist()
    length = np.array([math.sqrt(exact_sum(row)) for row in squares])
    good = (length > 0.0) & (length < np.inf)
    made = vectors / np.where(good, length, 1.0)[:, None]
    made[~good] = (1.0, 0.0, 0.0)
    return np.asarray(made)


def _quaternions(matrices: Array) -> Array:
    """Unit quaternions (n, 4), w not negative, of rotation matrices (n, 3, 3)."""
    made = [_quaternion(matrix) for matrix in matrices.tolist()]
    return np.array(made).reshape(-1, 4)


def _quaternion(rows: list[list[float]]) -> tuple[float, float, float, float]:
    (a, b, c), (d, e, f), (g, h, i) = rows
    squares = (1 + a + e + i, 1 + a - e - i, 1 - a + e - i, 1 - a - e + i)
    largest = max(range(4), key=squares.__getitem__)
    s = 2.0 * math.sqrt(max(squares[largest], 0.0))
    w, x, y, z = (
        (s / 4, (h - f) / s, (c - g) / s, (d - b) / s),
        ((h - f) / s, s / 4, (b + d) / s, (c + g) / s),
        ((c - g) / s, (b + d) / s, s / 4, (f + h) / s),
        ((d - b) / s, (c + g) / s, (f + h) / s, s / 4),
    )[largest]
    return (w, x, y, z) if w >= 0.0 else (-w, -x, -y, -z)

"""Poses compose as matrices do, row by row, and keep the bits of what is not moved."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.links.poses import Poses, quaternions_of_turns, rotate_vectors, unit_quaternions
from colladaphy.links.steps import matrix_of, product, rigid_parts

_calm = st.floats(-100, 100)
_vectors = st.tuples(_calm, _calm, _calm)
_quaternions = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: max(map(abs, q)) > 1e-3)
_rows = st.tuples(st.none() | _vectors, st.none() | _quaternions)
_pairs = st.lists(st.tuples(_rows, _rows), min_size=1, max_size=5)


def poses_of(rows: list[Any]) -> Poses:
    """Poses of (position or None, quaternion or None)."""
    positions = np.array([row[0] or (0.0, 0.0, 0.0) for row in rows])
    turns = unit_quaternions(np.array([row[1] or (1.0, 0.0, 0.0, 0.0) for row in rows]))
    return Poses.of(
        len(rows), positions, turns,
        moved=np.array([row[0] is not None for row in rows]),
        turned=np.array([row[1] is not None for row in rows]),
    )  # fmt: skip


@given(_pairs)
def test_composition_is_that_of_matrices(pairs: list[Any]) -> None:
    one, other = poses_of([pair[0] for pair in pairs]), poses_of([pair[1] for pair in pairs])
    expected = matrix_of(one) @ matrix_of(other)
    assert np.allclose(matrix_of(one.then(other)), expected, atol=1e-9)
    for a, b, c in zip(matrix_of(one), matrix_of(other), expected, strict=True):
        assert np.allclose(product(a, b), c, atol=1e-9)


@given(_pairs)
def test_rows_do_not_depend_on_each_other(pairs: list[Any]) -> None:
    one, other = poses_of([pair[0] for pair in pairs]), poses_of([pair[1] for pair in pairs])
    whole = one.then(other)
    for row in range(len(pairs)):
        here = np.array([row])
        alone = one.take(here).then(other.take(here))
        for name in ("positions", "moved", "orientations", "turned"):
            assert getattr(alone, name).tobytes() == getattr(whole.take(here), name).tobytes()


@given(st.lists(_rows, min_size=1, max_size=5))
def test_inverse(rows: list[Any]) -> None:
    poses = poses_of(rows)
    made = matrix_of(poses.then(poses.inverse()))
    assert np.allclose(made, np.eye(4), atol=1e-9)


@given(st.tuples(st.floats(allow_nan=False), st.floats(), st.floats()))
def test_what_is_not_moved_keeps_every_bit(position: tuple[float, float, float]) -> None:
    pose = Poses.of(1, np.array([position]))
    for made in (Poses.none(1).then(pose), pose.then(Poses.none(1))):
        assert made.positions.tobytes() == np.array([position]).tobytes()


@given(_vectors.filter(any), st.floats(-720, 720))
def test_axis_and_angle(axis: tuple[float, float, float], degrees: float) -> None:
    made, turns = quaternions_of_turns(np.array([[*axis, degrees]]))
    assert np.isclose(np.sum(made * made), 1.0)
    if turns[0]:
        turned = Poses.of(1, None, made).points(np.array([axis]))[0]
        assert np.allclose(turned, axis, atol=1e-9 * (1 + np.max(np.abs(axis))))
    half = np.array([*axis, degrees / 2])[None]
    again, _ = quaternions_of_turns(half)
    twice = Poses.of(1, None, again).then(Poses.of(1, None, again))
    assert np.allclose(np.abs(np.sum(twice.orientations * made)), 1.0)


def test_what_turns_nothing() -> None:
    turns = np.array([[0, 0, 1, 0], [0, 0, 0, 90], [np.nan, 0, 0, 90], [0, 0, 1, np.inf],
                      [1e-200, 0, 0, 90], [1e200, 0, 0, 90]])  # fmt: skip
    made, turned = quaternions_of_turns(turns)
    assert turned.tolist() == [False, False, False, False, True, True]
    assert np.allclose(made[4:], [np.sqrt(0.5), np.sqrt(0.5), 0, 0])
    assert made[:4].tolist() == [[1.0, 0.0, 0.0, 0.0]] * 4


@given(st.lists(_rows, min_size=1, max_size=3))
def test_the_rigid_part_of_a_pose_is_the_pose(rows: list[Any]) -> None:
    matrices = matrix_of(poses_of(rows))
    made, exact = rigid_parts(matrices)
    assert exact.all()
    assert np.allclose(matrix_of(made), matrices, atol=1e-6)


@given(_rows, st.floats(0.1, 10))
def test_the_rigid_part_leaves_scale_out(row: Any, scale: float) -> None:
    matrix = matrix_of(poses_of([row]))
    made, exact = rigid_parts(matrix @ np.diag([scale, scale, scale, 1.0]))
    assert np.allclose(matrix_of(made), matrix, atol=1e-6)
    assert bool(exact[0]) == (abs(scale - 1.0) <= 2e-6) or abs(scale - 1.0) < 1e-5


def test_the_rigid_part_of_a_mirror_is_a_rotation() -> None:
    made, exact = rigid_parts(np.diag([1.0, 1.0, -1.0, 1.0])[None])
    assert not exact[0]
    assert np.isclose(np.linalg.det(matrix_of(made)[0]), 1.0)


_whole = st.integers(-8, 8)


@given(
    st.lists(
        st.tuples(
            st.tuples(_whole, _whole, _whole, _whole).filter(any), st.tuples(_whole, _whole, _whole)
        ),
        min_size=1, max_size=4,
    )
)  # fmt: skip
def test_the_largest_vectors_are_turned_as_others_are(rows: list[Any]) -> None:
    turns = unit_quaternions(np.array([turn for turn, _ in rows], float))
    vectors = np.array([vector for _, vector in rows]) / 8.0
    large = 2.0**1023
    assert np.array_equal(
        rotate_vectors(turns, vectors * large), rotate_vectors(turns, vectors) * large
    )
    mixed = np.concatenate([vectors, vectors * large])
    again = rotate_vectors(np.concatenate([turns, turns]), mixed)
    assert np.array_equal(again[: len(rows)], rotate_vectors(turns, vectors))

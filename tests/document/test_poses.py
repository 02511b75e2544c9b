"""Poses compose as matrices do, and keep the bits of what is not moved."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.document.poses import (
    IDENTITY,
    Pose,
    matrix_of,
    multiply_matrices,
    quaternion_from_axis_angle,
    quaternion_from_matrix,
    rigid_part,
    unit_quaternion,
)

_calm = st.floats(-100, 100)
_vectors = st.tuples(_calm, _calm, _calm)
_quaternions = (
    st.tuples(*[st.floats(-1, 1)] * 4)
    .filter(lambda q: max(map(abs, q)) > 1e-3)
    .map(unit_quaternion)
)
_poses = st.builds(Pose, st.none() | _vectors, st.none() | _quaternions)


@given(_poses, _poses)
def test_composition_is_that_of_matrices(one: Pose, other: Pose) -> None:
    expected = np.array(matrix_of(one)) @ np.array(matrix_of(other))
    assert np.allclose(np.array(matrix_of(one.then(other))), expected, atol=1e-9)
    made = multiply_matrices(matrix_of(one), matrix_of(other))
    assert np.allclose(np.array(made), expected, atol=1e-9)


@given(_poses)
def test_inverse(pose: Pose) -> None:
    assert np.allclose(np.array(matrix_of(pose.then(pose.inverse()))), np.eye(4), atol=1e-9)


@given(st.tuples(st.floats(allow_nan=False), st.floats(), st.floats()))
def test_identity_keeps_every_bit(position: tuple[float, float, float]) -> None:
    pose = Pose(position, None)
    assert IDENTITY.then(pose) is not None
    for made in (IDENTITY.then(pose), pose.then(IDENTITY)):
        assert made.position is not None
        assert [each.hex() for each in made.position] == [each.hex() for each in position]


@given(_vectors.filter(any), st.floats(-720, 720))
def test_axis_and_angle(axis: tuple[float, float, float], degrees: float) -> None:
    made = quaternion_from_axis_angle(*axis, degrees)
    if made is None:
        return
    assert math.isclose(sum(part * part for part in made), 1.0)
    turned = Pose(None, made).point(axis)
    assert np.allclose(turned, axis, atol=1e-6)
    trace = sum(matrix_of(Pose(None, made))[i][i] for i in range(3))
    assert math.isclose((trace - 1) / 2, math.cos(math.radians(degrees)), abs_tol=1e-9)


def test_what_turns_nothing() -> None:
    assert quaternion_from_axis_angle(1, 0, 0, 0) is None
    assert quaternion_from_axis_angle(0, 0, 0, 90) is None
    assert quaternion_from_axis_angle(1, 0, 0, math.inf) is None
    tiny = quaternion_from_axis_angle(1e-200, 0, 0, 180)
    assert tiny is not None
    assert math.isclose(tiny[1], 1.0)


@given(_quaternions)
def test_quaternion_from_matrix(q: tuple[float, float, float, float]) -> None:
    made = quaternion_from_matrix(matrix_of(Pose(None, q)))
    assert math.isclose(abs(sum(a * b for a, b in zip(made, q, strict=True))), 1.0, rel_tol=1e-9)


@given(_poses)
def test_rigid_part_of_a_pose_is_the_pose(pose: Pose) -> None:
    made, exact = rigid_part(matrix_of(pose))
    assert exact
    assert np.allclose(np.array(matrix_of(made)), np.array(matrix_of(pose)), atol=1e-6)


@given(_poses, st.floats(1.5, 10))
def test_rigid_part_leaves_scale_out(pose: Pose, scale: float) -> None:
    scaled = np.array(matrix_of(pose)) @ np.diag([scale, 1.0, 1.0, 1.0])
    made, exact = rigid_part(tuple(tuple(row) for row in scaled.tolist()))
    assert not exact
    assert np.allclose(np.array(matrix_of(made)), np.array(matrix_of(pose)), atol=1e-6)


def test_rigid_part_of_a_mirror_is_a_rotation() -> None:
    mirror = tuple(tuple(row) for row in np.diag([1.0, 1.0, -1.0, 1.0]).tolist())
    made, exact = rigid_part(mirror)
    assert not exact
    assert np.linalg.det(np.array(matrix_of(made))[:3, :3]) > 0

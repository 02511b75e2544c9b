"""Rotations against the matrices that define them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.world import World, rotations

angles = st.floats(-20, 20)
vectors = st.tuples(*[st.floats(-100, 100)] * 3)
quaternions = st.tuples(*[st.floats(-10, 10)] * 4).filter(lambda q: max(map(abs, q)) > 1e-3)


def about(axis: int, angle: float) -> Any:
    """The matrix of a turn about a coordinate axis, by hand."""
    cosine, sine = math.cos(angle), math.sin(angle)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = cosine
    matrix[second, first], matrix[first, second] = sine, -sine
    return matrix


@given(angles, angles, angles)
def test_rotate_is_rz_ry_rx(x: float, y: float, z: float) -> None:
    expected = about(2, z) @ about(1, y) @ about(0, x)
    assert np.allclose(rotations.to_matrix(rotations.fixed_angles(x, y, z)), expected, atol=1e-12)
    world = World()
    body = world.create_box(1, (1, 2, 3), (1, 2, 3), "oak")
    body.rotate(x, y, z)
    assert np.allclose(rotations.to_matrix(body.orientation), expected, atol=1e-12)
    assert body.position.tolist() == [1, 2, 3]


@given(quaternions, quaternions, vectors)
def test_a_product_turns_by_one_after_the_other(p: Any, q: Any, v: Any) -> None:
    one_by_one = rotations.rotate(p, rotations.rotate(q, v))
    assert np.allclose(rotations.rotate(rotations.multiply(p, q), v), one_by_one, atol=1e-9)


@given(quaternions)
def test_matrices_and_quaternions_are_the_same_rotation(q: Any) -> None:
    matrix = rotations.to_matrix(q)
    assert np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
    assert math.isclose(float(np.linalg.det(matrix)), 1, abs_tol=1e-12)
    back = rotations.from_matrix(matrix)
    assert back[0] >= 0
    assert np.allclose(rotations.to_matrix(back), matrix, atol=1e-12)


@given(quaternions)
def test_axis_and_angle_and_back(q: Any) -> None:
    axis, angle = rotations.to_axis_angle(q)
    assert math.isclose(float(np.linalg.norm(axis)), 1, abs_tol=1e-12)
    assert 0 <= angle <= math.pi + 1e-12
    back = rotations.from_axis_angle(axis, angle)
    assert np.allclose(rotations.to_matrix(back), rotations.to_matrix(q), atol=1e-12)


@given(quaternions, vectors)
def test_the_conjugate_undoes(q: Any, v: Any) -> None:
    assert np.allclose(rotations.unrotate(q, rotations.rotate(q, v)), v, atol=1e-9)
    assert np.allclose(rotations.rotate(rotations.conjugate(q), v), rotations.unrotate(q, v))


@given(vectors, vectors)
def test_between_turns_one_direction_onto_another(a: Any, b: Any) -> None:
    if min(np.linalg.norm(a), np.linalg.norm(b)) < 1e-3:
        return
    turned = rotations.rotate(rotations.between(a, b), a / np.linalg.norm(a))
    assert np.allclose(turned, b / np.linalg.norm(b), atol=1e-9)


def test_between_opposite_directions() -> None:
    for axis in np.eye(3):
        for near in (np.zeros(3), np.array([1e-9, -2e-9, 1e-9]), np.array([1e-4, 0, 1e-4])):
            end = -axis + near
            turned = rotations.rotate(rotations.between(axis, end), axis)
            assert np.allclose(turned, end / np.linalg.norm(end), atol=1e-12)


def test_a_tiny_turn_is_kept() -> None:
    axis, angle = rotations.to_axis_angle(rotations.from_axis_angle((0, 0, 1), 1e-200))
    assert math.isclose(float(angle), 1e-200, rel_tol=1e-12)
    assert axis.tolist() == [0, 0, 1]


def test_everything_is_vectorised() -> None:
    rng = np.random.default_rng(1)
    p, q = rng.normal(size=(2, 5, 7, 4))
    v, x = rng.normal(size=(5, 7, 3)), rng.normal(size=(5, 7))
    for function, arguments in (
        (rotations.multiply, (p, q)),
        (rotations.rotate, (p, v)),
        (rotations.unrotate, (p, v)),
        (rotations.to_matrix, (p,)),
        (rotations.normalize, (p,)),
        (rotations.from_axis_angle, (v, x)),
        (rotations.fixed_angles, (x, x + 1, x + 2)),
        (rotations.rotate_tensor, (p, rng.normal(size=(5, 7, 3, 3)))),
        (rotations.between, (v, rng.normal(size=(5, 7, 3)))),
        (rotations.between, (v, -v)),
    ):
        together = function(*arguments)
        single = function(*(argument[3, 4] for argument in arguments))
        assert np.allclose(together[3, 4], single, atol=1e-14)
    back = rotations.from_matrix(rotations.to_matrix(p))
    assert back.shape == p.shape


@given(st.tuples(*[st.floats(-9, 9)] * 4), st.tuples(*[st.floats(-100, 100)] * 3))
def test_a_single_turn_is_as_with_arrays(q: Any, angles: Any) -> None:
    if max(map(abs, q)) < 1e-3:
        return
    quick = rotations.turned(q, *angles)
    plain = rotations.normalize(rotations.multiply(rotations.fixed_angles(*angles), q))
    # Sines may differ in their last bit.
    assert np.allclose(quick, plain, rtol=0, atol=1e-15)

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform import frames

component = st.floats(-10, 10)
axis = st.tuples(component, component, component).filter(lambda a: np.linalg.norm(a) > 1e-3)
angle = st.one_of(st.floats(-720, 720), st.sampled_from([0.0, 90.0, 180.0, -180.0, 360.0]))


@given(axis, angle)
def test_rotation_follows_rodrigues(direction: tuple[float, float, float], degrees: float) -> None:
    u = np.array(direction) / np.linalg.norm(direction)
    t = math.radians(degrees)
    cross = -np.cross(np.eye(3), u).T
    expected = np.eye(3) + math.sin(t) * cross + (1 - math.cos(t)) * cross @ cross
    assert np.allclose(frames.rotation((*direction, degrees))[:3, :3], expected, atol=1e-12)


@given(axis, angle)
@example((0.0, 0.0, 1.0), 4.5153127766788647e-159)
@example((1.0, 2.0, 3.0), 1e-320)
def test_axis_and_angle_give_the_rotation_back(
    direction: tuple[float, float, float], degrees: float
) -> None:
    matrix = frames.rotation((*direction, degrees))
    again = frames.axis_angle(matrix)
    assert 0.0 <= again[3] <= 180.0
    assert np.linalg.norm(again[:3]) == pytest.approx(1.0)
    assert np.allclose(frames.rotation(again), matrix, atol=1e-13)


def test_transforms_apply_in_document_order() -> None:
    node = etree.fromstring(
        "<node xmlns='urn:x'><translate>1 0 0</translate><!-- c --><rotate>0 0 1 90</rotate>"
        "<scale>2 2 2</scale><instance_geometry/><translate>1 0 0</translate></node>"
    )
    moved = frames.transform_of(node) @ [0, 0, 0, 1]
    assert np.allclose(moved, [1, 2, 0, 1])


def test_lookat_puts_the_node_at_the_eye_looking_along_minus_z() -> None:
    step = etree.fromstring("<lookat>0 0 10 0 0 0 0 1 0</lookat>")
    assert np.allclose(frames.of_element(step), frames.translation((0, 0, 10)))
    aside = frames.of_element(etree.fromstring("<lookat>0 0 0 1 0 0 0 1 0</lookat>"))
    assert np.allclose(aside @ [0, 0, -1, 0], [1, 0, 0, 0])


def test_skew_shears_along_the_second_axis() -> None:
    shear = frames.of_element(etree.fromstring("<skew>45 1 0 0 0 1 0</skew>"))
    assert np.allclose(shear @ [1, 0, 0, 1], [1, 1, 0, 1])
    assert np.allclose(shear @ [0, 1, 0, 1], [0, 1, 0, 1])


def test_nearest_rotation_says_what_it_left_out() -> None:
    pose = frames.translation((1, 2, 3)) @ frames.rotation((1, 2, 3, 50))
    same, exact = frames.nearest_rotation(pose)
    assert exact
    assert np.array_equal(same, pose)
    rigid, exact = frames.nearest_rotation(pose @ np.diag([2.0, 2.0, 2.0, 1.0]))
    assert not exact
    assert np.allclose(rigid, pose)
    mirrored, exact = frames.nearest_rotation(pose @ np.diag([-1.0, 1.0, 1.0, 1.0]))
    assert not exact
    assert np.linalg.det(mirrored) == pytest.approx(1.0)


@given(axis, angle, axis)
def test_inverse_undoes(
    direction: tuple[float, float, float], degrees: float, offset: tuple[float, float, float]
) -> None:
    matrix = frames.translation(offset) @ frames.rotation((*direction, degrees))
    assert np.allclose(frames.inverse(matrix) @ matrix, np.eye(4), atol=1e-9)


def test_a_flat_scale_has_the_inverse_of_its_rigid_part() -> None:
    flat = frames.translation((1, 0, 0)) @ np.diag([1.0, 1.0, 0.0, 1.0])
    assert np.allclose(frames.inverse(flat) @ [1, 0, 0, 1], [0, 0, 0, 1])

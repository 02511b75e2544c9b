"""Transforms of nodes: order, matrices, skew, lookat (COLLADA 1.5 §node)."""

from __future__ import annotations

import numpy as np
import pytest
from lxml import etree

from colladaphy.document.affine import lookat_matrix, skew_matrix
from colladaphy.document.names import COLLADA
from colladaphy.document.nodes import own_transform
from colladaphy.document.poses import Pose, matrix_of


def node(content: str) -> etree._Element:
    return etree.fromstring(f'<node xmlns="{COLLADA}">{content}</node>')


def matrix(content: str) -> np.ndarray:  # type: ignore[type-arg]
    made = own_transform(node(content))
    return np.array(matrix_of(made) if isinstance(made, Pose) else made)


def test_transforms_apply_in_document_order() -> None:
    turned = matrix("<rotate>0 0 1 90</rotate><translate>1 0 0</translate>")
    assert np.allclose(turned[:3, 3], [0, 1, 0])
    moved = matrix("<translate>1 0 0</translate><rotate>0 0 1 90</rotate>")
    assert np.allclose(moved[:3, 3], [1, 0, 0])


def test_matrix_and_scale() -> None:
    made = matrix("<scale>2 3 4</scale><matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix>")
    assert np.allclose(made[:3, 3], [10, 18, 28])
    assert np.allclose(np.diag(made), [2, 3, 4, 1])


def test_comments_in_numbers_are_passed_over() -> None:
    made = matrix("<translate>1 <!-- two -->2 3</translate>")
    assert made[:3, 3].tolist() == [1, 2, 3]


def test_lookat_looks_along_minus_z() -> None:
    made = np.array(lookat_matrix([0, 0, 10, 0, 0, 0, 0, 1, 0]))
    assert np.allclose(made[:3, 3], [0, 0, 10])
    assert np.allclose(made[:3, :3], np.eye(3))
    assert np.allclose(matrix("<lookat>5 0 0 0 0 0 0 0 1</lookat>")[:3, 2], [1, 0, 0])


def test_skew_shears_along_the_second_axis() -> None:
    made = np.array(skew_matrix([45, 0, 1, 0, 1, 0, 0]))
    assert np.allclose(made @ [0, 1, 0, 1], [1, 1, 0, 1])
    assert np.allclose(made @ [1, 0, 0, 1], [1, 0, 0, 1])
    assert np.isclose(np.linalg.det(made), 1.0)


@pytest.mark.parametrize("content", ["", "<extra/>", '<node xmlns="x"/>'])
def test_no_transform_is_the_identity(content: str) -> None:
    assert own_transform(node(content)) == Pose()

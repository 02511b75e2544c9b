"""Transforms of nodes: order, matrices, skew, lookat (COLLADA 1.5 §node)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from colladaphy.columns.reading import Document
from colladaphy.links.affine import lookat_matrix, skew_matrix
from colladaphy.links.names import COLLADA, c
from colladaphy.links.steps import Transforms, matrix_of, own_transforms
from colladaphy_schema.scene_columns import NodeTypeRows


def transform(content: str) -> Transforms:
    columns = Document.of(f'<node xmlns="{COLLADA}">{content}</node>'.encode())
    return own_transforms(columns.rows(NodeTypeRows, c("node")))


def matrix(content: str) -> NDArray[Any]:
    made = transform(content)
    return made.matrices[0] if made.matrices else matrix_of(made.poses)[0]


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
    made = transform(content)
    assert not made.matrices and made.poses.is_identity().tolist() == [True]

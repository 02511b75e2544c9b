"""What a transform does beside moving and turning, in words."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mapper.documents import simple

import colladaphy
from colladaphy.links.affine import skew_matrix, stretch_of
from colladaphy.world import rotations

QUARTER = np.array([0.5, 0.5, 0.5, 0.5])


@pytest.mark.parametrize(
    ("scale", "said"),
    [
        ((0.001, 0.001, 0.001), "scales by 0.001"),
        ((1, 2, 3), "scales its axes by 1, 2, 3"),
        ((-1, 1, 1), "mirrors"),
        ((-2, 2, 2), "scales by 2 and mirrors"),
        ((1, 1, 1), "is not rigid"),
    ],
)
def test_factors(scale: tuple[float, ...], said: str) -> None:
    matrix = np.eye(4)
    matrix[:3, :3] = rotations.to_matrix(QUARTER) @ np.diag(scale)
    assert stretch_of(matrix) == said


@given(st.floats(1e-6, 1e6))
def test_any_factor_is_told_to_six_digits(factor: float) -> None:
    said = stretch_of(np.diag([factor, factor, factor, 1.0]))
    if abs(factor - 1.0) > 1e-5:
        assert float(said.removeprefix("scales by ")) == pytest.approx(factor, rel=1e-5)


def test_a_skew_is_told() -> None:
    assert "skews" in stretch_of(np.array(skew_matrix([30, 1, 0, 0, 0, 1, 0])))


@pytest.mark.parametrize(
    ("transform", "said"),
    [
        ("<scale>0.001 0.001 0.001</scale>", "scales by 0.001"),
        ("<matrix>-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>", "mirrors"),
        ("<skew>30 1 0 0 0 1 0</skew>", "skews"),
    ],
)
def test_validate_and_load_say_the_factor(transform: str, said: str) -> None:
    data = simple(nodes=f'<node id="n">{transform}</node>')
    document = colladaphy.read(data)
    document.load()
    for report in (colladaphy.validate(data), document.report):
        (finding,) = [found for found in report if found.code == "link-not-rigid"]
        assert said in finding.message

"""Convex hulls of points that are hard, and of many."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from colladaphy.mapper.hull import convex_hull
from colladaphy.mapper.loading.closedness import are_closed

Floats = NDArray[np.float64]


def volume(points: Floats, faces: NDArray[np.int64]) -> float:
    corners = points[faces] - points.mean(axis=0)
    return float(np.sum(corners[:, 0] * np.cross(corners[:, 1], corners[:, 2]))) / 6


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(-14, -7))
def test_points_that_are_nearly_in_a_plane_make_a_box(seed: int, exponent: int) -> None:
    # All 27 points of a grid, twice, a little off their places.
    grid = np.array(np.meshgrid(*[[0.0, 1.0, 2.0]] * 3)).reshape(3, -1).T
    points = np.concatenate([grid, grid])
    points += 10.0**exponent * np.random.default_rng(seed).uniform(-1, 1, points.shape)
    hull = convex_hull(points)
    assert hull is not None
    assert are_closed([hull]).all()
    assert volume(*hull) == pytest.approx(8.0, rel=20 * 10.0**exponent)


def test_the_time_grows_little_faster_than_the_number_of_points() -> None:
    points = np.random.default_rng(1).normal(size=(16_000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    start = time.process_time()
    hull = convex_hull(points)
    assert time.process_time() - start < 8.0  # 1.4 s; it was 11 s, and grew with the square
    assert hull is not None
    assert (len(hull[0]), len(hull[1])) == (16_000, 2 * 16_000 - 4)
    assert volume(*hull) == pytest.approx(4 / 3 * np.pi, rel=1e-3)

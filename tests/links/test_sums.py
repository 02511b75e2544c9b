"""Sums of any numbers."""

from __future__ import annotations

import math

from hypothesis import example, given
from hypothesis import strategies as st

from colladaphy.links.sums import exact_sum
from colladaphy.world import World


@given(st.lists(st.floats()))
@example([1.7e308, 1.7e308])
@example([math.inf, -math.inf])
@example([1.7e308, 1.7e308, -1.7e308])
def test_every_list_has_a_sum(numbers: list[float]) -> None:
    try:
        expected = math.fsum(numbers)
    except (OverflowError, ValueError):
        assert not math.isfinite(exact_sum(numbers))
    else:
        found = exact_sum(iter(numbers))
        assert found == expected or (math.isnan(found) and math.isnan(expected))


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=4, max_size=4))
@example([1.2e154, 1.2e154, 0.0, 0.0])
def test_an_orientation_of_any_length_is_taken(numbers: list[float]) -> None:
    if any(numbers):
        world = World()
        body = world.create_sphere(1, (0, 0, 0), 1, "iron")
        body.orientation = numbers
        assert math.isclose(math.hypot(*body.orientation), 1.0, rel_tol=1e-12)

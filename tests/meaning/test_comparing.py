"""Which values of the two profiles are the same."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.meaning.comparing import same

INF, NAN = np.inf, np.nan


@pytest.mark.parametrize(
    ("one", "other", "expected"),
    [
        (1.0, 1.000001, True),
        (1.0, 1.0001, False),
        (INF, INF, True),
        (INF, -INF, False),
        (INF, 1.0, False),
        (1e305, 1.7e308, True),
        (1e305, -1e305, False),
        (1e305, INF, True),
        (1e-310, 3e-310, True),
        (NAN, 1.0, True),
        (0.0, -0.0, True),
    ],
)
def test_two_values(one: float, other: float, expected: bool) -> None:
    with np.errstate(all="ignore"):
        for first, second in ((one, other), (other, one)):
            assert same(np.array([[first]]), np.array([[second]])).tolist() == [expected]


@given(st.lists(st.tuples(st.floats(), st.floats()), min_size=1, max_size=6))
def test_rows_are_compared_each_by_itself(pairs: list[tuple[float, float]]) -> None:
    with np.errstate(all="ignore"):
        one, other = np.array(pairs).T[:, :, None]
        alone = [bool(same(one[row : row + 1], other[row : row + 1])[0]) for row in range(len(one))]
        assert same(one, other).tolist() == alone

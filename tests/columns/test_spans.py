"""Stretches of an array, all at once."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.columns.spans import places_of

STRETCHES = st.lists(st.tuples(st.integers(0, 50), st.integers(0, 5), st.integers(1, 4)))


@given(STRETCHES, st.integers(1, 4))
def test_they_are_those_of_ranges(stretches: list[tuple[int, int, int]], step: int) -> None:
    starts, counts, steps = np.array(stretches, np.int64).reshape(-1, 3).T
    each = [place for start, count, step in stretches for place in
            range(start, start + count * step, step)]  # fmt: skip
    assert places_of(starts, counts, steps).tolist() == each
    alike = [place for start, count, _ in stretches for place in
             range(start, start + count * step, step)]  # fmt: skip
    assert places_of(starts, counts, step).tolist() == alike

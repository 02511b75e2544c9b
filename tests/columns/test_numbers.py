"""Many numbers at once are written as one alone, and read back to the same bits."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.columns.numbers import float_text, integer_texts, list_texts, texts_of

numbers = (
    st.floats(allow_nan=False)
    | st.floats(-1e3, 1e3)
    | st.floats(1e-6, 1e-3)
    | st.floats(1e14, 1e18)
    | st.integers(-(10**20), 10**20).map(float)
    | st.sampled_from([0.0, -0.0, 1e-4, 9.999e-5, 1e16, 9999999999999998.0, 5e-324])
)
integers = st.integers(-(2**63), 2**63 - 1)
many = settings(max_examples=200)


@many
@given(st.integers(1, 4).flatmap(lambda m: st.lists(st.lists(numbers, min_size=m, max_size=m))))
def test_rows_of_floats(rows: list[list[float]]) -> None:
    width = len(rows[0]) if rows else 3
    column = np.array(rows, dtype=np.float64).reshape(-1, width)
    texts = texts_of(column)
    assert texts == [" ".join(map(float_text, row)) for row in rows]
    again = [float(word) for text in texts for word in text.split(" ")]
    assert np.array(again).tobytes() == column.tobytes()


@many
@given(st.integers(1, 3).flatmap(lambda m: st.lists(st.lists(integers, min_size=m, max_size=m))))
def test_rows_of_integers(rows: list[list[int]]) -> None:
    width = len(rows[0]) if rows else 2
    column = np.array(rows, dtype=np.int64).reshape(-1, width)
    assert integer_texts(column) == [" ".join(map(str, row)) for row in rows]


@many
@given(st.lists(st.lists(numbers, max_size=4)))
def test_lists_of_any_length(lists: list[list[float]]) -> None:
    values = np.array([number for part in lists for number in part], dtype=np.float64)
    texts = list_texts(values, np.array([len(part) for part in lists], dtype=np.int64))
    assert texts == [" ".join(map(float_text, part)) for part in lists]

"""Many numbers at once are written and read as one alone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.mapper import bulk
from colladaphy.mapper.numbers import float_text

numbers = (
    st.floats(allow_nan=False, allow_infinity=False)
    | st.floats(-1e3, 1e3)
    | st.floats(1e-6, 1e-3)
    | st.floats(1e14, 1e18)
    | st.integers(-(10**20), 10**20).map(float)
    | st.sampled_from([0.0, -0.0, 1e-4, 9.999e-5, 1e16, 9999999999999998.0, 5e-324])
)
many = settings(max_examples=200)


@many
@given(st.integers(1, 4).flatmap(lambda m: st.lists(st.lists(numbers, min_size=m, max_size=m))))
def test_there_and_back(rows: list[list[float]]) -> None:
    width = len(rows[0]) if rows else 3
    column = np.array(rows, dtype=np.float64).reshape(-1, width)
    texts = bulk.texts_of(column)
    assert texts == [" ".join(map(float_text, row)) for row in rows]
    again = bulk.numbers_of(texts, width)
    assert again.tobytes() == column.tobytes()


SPELLINGS = ["INF", "-INF", "NaN", "+1", ".5", "1.", "01", "1E5", "-0", "0", "-0.0", "1e400",
             "-00", "1e-400", "18446744073709551615", "9223372036854775809",
             "123456789012345678901234567890", "0.1", "2.5e-3"]  # fmt: skip


@many
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["", " ", "\n\t"]),
            st.sampled_from(SPELLINGS) | numbers.map(repr),
            st.sampled_from([" ", "\n", "  "]),
            st.sampled_from(SPELLINGS) | numbers.map("{:.17e}".format),
        )
    )
)
def test_every_spelling_of_xml_schema(parts: list[tuple[str, str, str, str]]) -> None:
    texts = ["".join(part) for part in parts]
    expected = np.array([[float(word) for word in text.split()] for text in texts])
    assert bulk.numbers_of(texts, 2).tobytes() == expected.reshape(-1, 2).tobytes()


@pytest.mark.parametrize("text", ["1", "1 2 3", "1 x", "1e 2", "1,2", "", "[1 2]", "1 null 2"])
def test_what_is_not_two_numbers(text: str) -> None:
    with pytest.raises(ValueError):
        bulk.numbers_of([text], 2)

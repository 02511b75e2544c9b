"""Numbers that were read once are not read again, whoever asks for them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.columns import texts
from colladaphy.columns.texts import Ranges, floats_of
from colladaphy.columns.words import Words

LISTS = st.lists(
    st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=4),
    min_size=1, max_size=12,
)  # fmt: skip


def ranges_of(lists: list[list[float]]) -> Ranges:
    parts = [" ".join(map(repr, each)).encode() for each in lists]
    ends = np.cumsum([len(part) + 1 for part in parts]) - 1
    data = b"|".join(parts)
    starts = np.append(0, ends[:-1] + 1)
    return Ranges(Words(np.frombuffer(data, np.uint8)), starts, ends)


@given(LISTS, st.data())
def test_of_parts_and_of_the_rest(lists: list[list[float]], data: st.DataObject) -> None:
    ranges = ranges_of(lists)
    groups = data.draw(st.lists(st.sampled_from((-1, 0, 1, 2)), min_size=len(lists),
                                max_size=len(lists)))  # fmt: skip
    for group in (0, 1, 2):
        rows = np.flatnonzero(np.array(groups) == group)
        if len(rows):
            counts = np.array([len(lists[row]) for row in rows])
            alike = bool(np.all(counts == counts[0]))
            values = np.array([value for row in rows for value in lists[row]])
            ranges.all_words.keep(ranges.starts[rows], values, None if alike else counts)
    values, counts = floats_of(ranges, None)
    assert values.tolist() == [value for each in lists for value in each]
    lengths = [len(each) for each in lists]
    assert ([lengths[0]] * len(lists) if counts is None else counts.tolist()) == lengths
    if counts is None:
        assert len(set(lengths)) == 1


def test_nothing_is_read_that_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    ranges = ranges_of([[1.0, 2.0], [3.0], [4.0, 5.0], [6.0]])
    ranges.all_words.keep(ranges.starts[[0, 2]], np.array([1.0, 2.0, 4.0, 5.0]), None)
    ranges.all_words.keep(ranges.starts[[1, 3]], np.array([3.0, 6.0]), None)
    monkeypatch.setattr(texts, "_part", lambda *arguments: pytest.fail("it was read again"))
    values, counts = floats_of(ranges, None)
    assert values.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert counts is not None and counts.tolist() == [2, 1, 2, 1]

"""Which child became which, and what has to move."""

from __future__ import annotations

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from colladaphy.document.alignment import align, longest_increasing


@given(st.lists(st.integers(0, 20), unique=True, max_size=8))
def test_longest_increasing_subsequence(numbers: list[int]) -> None:
    found = [number for number in numbers if number in longest_increasing(numbers)]
    assert found == sorted(found)
    best = max(
        size
        for size in range(len(numbers) + 1)
        for chosen in combinations(numbers, size)
        if list(chosen) == sorted(chosen)
    )
    assert len(found) == best


def nodes(text: str) -> list[etree._Element]:
    return list(etree.fromstring(f"<r>{text}</r>"))


def matched(before: str, after: str) -> list[tuple[int | None, bool]]:
    return align(nodes(before), nodes(after))


def test_equal_nodes_belong_together_wherever_they_are() -> None:
    assert matched("<a>1</a><a>2</a><b/>", "<b/><a>2</a><a>1</a>") == [
        (2, False), (1, False), (0, False)
    ]  # fmt: skip


def test_changed_nodes_are_known_by_their_ids() -> None:
    before = '<a id="x">1</a><a id="y">2</a>'
    assert matched(before, '<a id="y">3</a><a id="x">4</a>') == [(1, True), (0, True)]


def test_what_is_left_belongs_together_by_name_in_order() -> None:
    assert matched("<a>1</a><a>2</a><a>3</a>", "<a>1</a><a>x</a><b/><a>3</a>") == [
        (0, False), (1, True), (None, True), (2, False)
    ]  # fmt: skip
    assert matched("<a>1</a><!--c-->", "<!--d--><a>1</a>") == [(1, True), (0, False)]


TAGS = st.sampled_from(["<a/>", "<a>1</a>", '<a id="1"/>', '<a id="2"/>', '<b sid="1"/>', "<b/>"])


@given(st.lists(TAGS, max_size=8), st.lists(TAGS, max_size=8))
def test_every_node_has_at_most_one_origin(before: list[str], after: list[str]) -> None:
    old, new = nodes("".join(before)), nodes("".join(after))
    result = align(old, new)
    origins = [index for index, _ in result if index is not None]
    assert len(result) == len(new)
    assert len(set(origins)) == len(origins)
    for (index, changed), node in zip(result, new, strict=True):
        if index is not None:
            assert old[index].tag == node.tag
            assert changed == (etree.tostring(old[index]) != etree.tostring(node))
    left = {old[i].tag for i in range(len(old)) if i not in origins}
    assert not left & {node.tag for (index, _), node in zip(result, new, strict=True)
                       if index is None}  # fmt: skip

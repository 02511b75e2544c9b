"""Counts of arrays and accessors that are not those of the values there."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import MESH, C, codes, document, mended


def mesh(array: str, accessor: str, numbers: str = "0 0 0 1 0 0 0 1 0 0 0 1") -> etree._ElementTree:
    content = (
        MESH.format("g")
        .replace('count="12"', f'count="{array}"')
        .replace('count="4" stride="3"', accessor)
        .replace("0 0 0 1 0 0 0 1 0 0 0 1", numbers)
    )
    return document(
        f'<library_geometries><geometry id="g"><mesh>{content}</mesh></geometry>'
        "</library_geometries>"
    )


def counts(root: etree._Element) -> tuple[str | None, ...]:
    array, accessor = root.find(f".//{C}float_array"), root.find(f".//{C}accessor")
    return array.get("count"), accessor.get("count"), accessor.get("stride")


@pytest.mark.parametrize(
    ("array", "accessor"),
    [
        ("4", 'count="12" stride="3"'),  # the array counts points, the accessor numbers
        ("4", 'count="4" stride="3"'),
        ("12", 'count="12" stride="3"'),
        ("12", 'count="5" stride="3"'),
        ("12", 'count="4"'),
        ("99", 'count="12"'),
    ],
)
def test_counts_are_those_of_the_values(array: str, accessor: str) -> None:
    root, findings = mended(mesh(array, accessor))
    assert counts(root) == ("12", "4", "3")
    assert codes(findings) == {"repair-count"}
    assert all(finding.severity == "warning" for finding in findings)


def test_an_accessor_may_leave_values_out() -> None:
    for accessor in ('count="3" stride="3"', 'count="3" stride="3" offset="3"'):
        _, findings = mended(mesh("12", accessor))
        assert findings == []


def test_comments_are_no_values() -> None:
    numbers = "0 0 0 1<!-- 7 8 9 --> 0 0 0 1 0 0 0 1"
    _, findings = mended(mesh("12", 'count="4" stride="3"', numbers))
    assert findings == []


@given(st.integers(1, 9), st.integers(1, 5), st.integers(0, 60), st.integers(0, 60))
def test_no_accessor_reaches_beyond_its_values(
    rows: int, stride: int, array: int, count: int
) -> None:
    numbers = " ".join(["0.5"] * (rows * stride))
    root, _ = mended(mesh(str(array), f'count="{count}" stride="{stride}"', numbers))
    found = [int(value or 0) for value in counts(root)]
    assert found[0] == rows * stride
    assert found[1] == min(count, rows)

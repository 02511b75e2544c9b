"""Values of columns, case by case."""

from __future__ import annotations

import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.columns import texts as texts_module
from colladaphy.columns.reading import Document
from colladaphy.columns.texts import Ranges, booleans_of, floats_of, integers_of
from colladaphy.columns.words import Words
from colladaphy_schema.core_columns import FloatArrayTypeRows, TargetableFloat3TypeRows
from colladaphy_schema.physics_columns import InstanceRigidBodyTypeRows, RigidBodyTypeRows
from colladaphy_schema.rows import Column, Lists, Rows

C = "{http://www.collada.org/2008/03/COLLADASchema}"


def document(body: str, head: str = "") -> Document:
    return Document.of(f'{head}<COLLADA xmlns="{C[1:-1]}">{body}</COLLADA>'.encode())


def ranges(texts: list[str]) -> Ranges:
    """Texts one after the other, with one byte between them."""
    data = "|".join(texts).encode() + b"|"
    stops = np.cumsum([len(text.encode()) + 1 for text in texts]) - 1
    starts = np.array([0, *(stops[:-1] + 1)])
    return Ranges(Words(np.frombuffer(data, np.uint8)), starts, stops)


def bits(values: Any) -> list[str]:
    return ["nan" if math.isnan(v) else struct.pack(">d", v).hex() for v in values]


SPELLED = {
    "-0": -0.0, "0": 0.0, "-0.0": -0.0, "INF": math.inf, "-INF": -math.inf, "NaN": math.nan,
    "1e400": math.inf, "-1e400": -math.inf, "1E5": 1e5, "+1": 1.0, ".5": 0.5, "1.": 1.0,
    "007": 7.0, "5e-324": 5e-324, "1e-400": 0.0,
    "123456789012345678901234567890": 1.2345678901234568e29,
    "18446744073709551615": 1.8446744073709552e19, "9223372036854775808": 9.223372036854775808e18,
    "0.1": 0.1, "-1.5": -1.5, "9007199254740993": 9007199254740992.0,
    "2.2250738585072011e-308": 2.225073858507201e-308, "-0e5": -0.0, "-0E-2": -0.0,
    "0.30000000000000004000000000000000000000000000000000000001": 0.30000000000000004,
}  # fmt: skip


@pytest.mark.parametrize("spelling", SPELLED)
@pytest.mark.parametrize("around", [[], ["1", "2.5"], ["-0", "3"]])
def test_spellings_of_a_number(spelling: str, around: list[str]) -> None:
    values, counts = floats_of(ranges([*around, spelling, *around]), 1)
    expected = [*map(SPELLED.get, around, map(float, around)), SPELLED[spelling],
                *map(SPELLED.get, around, map(float, around))]  # fmt: skip
    assert counts is None
    assert bits(values) == bits(expected)


words = st.sampled_from(list(SPELLED)) | st.floats().map(
    lambda v: repr(v).replace("inf", "INF").replace("nan", "NaN")
)
blanks = st.sampled_from([" ", " ", " ", "  ", "\n", "\t", " \r\n"])


@given(st.lists(st.lists(st.tuples(words, blanks), max_size=5), max_size=12), st.data())
def test_lists_of_numbers(rows: list[list[tuple[str, str]]], data: st.DataObject) -> None:
    spelled = []
    for row in rows:
        text = "".join(word + blank for word, blank in row)
        spelled.append(data.draw(st.sampled_from(["", "", "\n "])) + text
                       if data.draw(st.booleans()) else text.rstrip())  # fmt: skip
    expected = [[float(word) for word in text.split()] for text in spelled]
    found = (
        ranges(spelled)
        if spelled
        else Ranges(Words(np.zeros(0, np.uint8)), *[np.zeros(0, int)] * 2)
    )
    before = texts_module._PART
    texts_module._PART = 3
    try:
        values, counts = floats_of(found, None)
    finally:
        texts_module._PART = before
    assert bits(values) == bits([value for row in expected for value in row])
    if counts is None:
        assert len({len(row) for row in expected}) <= 1
    else:
        assert counts.tolist() == [len(row) for row in expected]


@given(st.lists(st.integers(-(2**66), 2**66) | st.integers(-5, 5), min_size=1, max_size=8))
def test_integers(numbers: list[int]) -> None:
    values, _ = integers_of(ranges([str(number) for number in numbers]), 1)
    assert values.tolist() == numbers
    small = all(-(2**63) <= number < 2**63 for number in numbers)
    assert values.dtype == (np.int64 if small else object)


@pytest.mark.parametrize("more", ["true", " false\n", "1", "0 "])
def test_truth_values(more: str) -> None:
    found = booleans_of(ranges(["true", "false", "1", "0", more]))
    assert found.tolist() == [True, False, True, False, more.strip() in ("true", "1")]


def test_an_empty_element_has_the_default_of_its_place() -> None:
    for text in ("", "<!-- nothing -->"):
        found = document(f"<a><g>{text}</g><g>1 2 3</g></a>").rows(
            TargetableFloat3TypeRows, C + "g"
        )
        found.empty_text = "7 8 9"
        assert found.value.tolist() == [[7.0, 8.0, 9.0], [1.0, 2.0, 3.0]]


def test_a_number_goes_through_a_comment() -> None:
    found = document("<g>1<!-- and -->2 3 <?x?>4</g>").rows(TargetableFloat3TypeRows, C + "g")
    assert found.value.tolist() == [[12.0, 3.0, 4.0]]


def test_lists_of_a_mesh() -> None:
    found = document('<f count="0"/><f count="2">1 2</f><f count="3">\n3 4\n5</f>').rows(
        FloatArrayTypeRows, C + "f"
    )
    lists = found.value
    assert isinstance(lists, Lists)
    assert [lists[row].tolist() for row in range(3)] == [[], [1.0, 2.0], [3.0, 4.0, 5.0]]
    assert found.count.tolist() == [0, 2, 3]


class Texts(Rows):
    """One attribute of each kind of white space."""

    __slots__ = ()
    a: Column[list[str]] = Column("a", "attribute", "string", optional=True)
    b: Column[list[str]] = Column("b", "attribute", "token", optional=True)
    value: Column[list[str]] = Column("", "text", "string")
    token: Column[list[str]] = Column("", "text", "token")


def test_white_space() -> None:
    found = document(
        '<x a=" 1\t2\n3\r\n4&#10;&#9;" b=" \u00a01\n \t2 &#10; 3 "> 1\r\n\t2 &#13;</x><x/>'
    ).rows(Texts, C + "x")
    assert found.a == [" 1 2 3 4\n\t", None]
    assert found.b == ["\u00a01 2 3", None]
    assert found.value == [" 1\n\t2 \r", ""]
    assert found.token == ["1 2", ""]


BODIES = """
<rigid_body sid="a"/><rigid_body sid=" b"/><rigid_body sid="c&#100;"/><rigid_body sid="e"/>
<rigid_body/><instance_rigid_body body="a" target="#1"/><instance_rigid_body body="b" target="#1"/>
<instance_rigid_body body="cd" target=" #1"/><instance_rigid_body body="f"/>
<instance_rigid_body body="g" target="#2"/>
"""


def test_references_without_strings() -> None:
    found = document(BODIES)
    instances = found.rows(InstanceRigidBodyTypeRows, C + "instance_rigid_body")
    codes, texts = found.factorized(instances, "target")
    assert [texts[code] if code >= 0 else None for code in codes.tolist()] == [
        "#1", "#1", "#1", None, "#2",
    ]  # fmt: skip
    assert sorted(texts) == ["#1", "#2"]


@given(st.lists(st.sampled_from(["#a", "#b" * 9, "#c" * 60, "é"]) | st.text("xyz", max_size=3)))
def test_factors_are_what_they_stand_for(urls: list[str]) -> None:
    found = document("<i/>" + "".join(f'<i body="{url}"/>' for url in urls))
    rows = found.rows(InstanceRigidBodyTypeRows, C + "i")
    codes, texts = found.factorized(rows, "body")
    assert [texts[code] if code >= 0 else None for code in codes.tolist()] == [None, *urls]
    assert sorted(texts) == sorted(set(urls))


def test_foreign_techniques_are_left_alone() -> None:
    found = document(
        '<rigid_body sid="a"/><technique profile="x"><z xmlns=""><rigid_body sid="b"/></z>'
        f'<y><rigid_body sid="c"/></y></technique><rigid_body xmlns="{C[1:-1]}" sid="d"/>'
    )
    assert found.rows(RigidBodyTypeRows, C + "rigid_body").sid == ["a", "d"]


def test_selected_rows_are_of_the_same_parents() -> None:
    found = document(BODIES)
    bodies = found.rows(RigidBodyTypeRows, C + "rigid_body")
    some = bodies.select(np.array([False, True, False, True, False]))
    assert some.sid == ["b", "e"]
    assert some.owner.tolist() == [1, 3]
    assert bodies.select(np.ones(5, np.bool_)) is bodies

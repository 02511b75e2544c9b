"""Text to value and back, lexically as XML Schema 1.0 has it, for single values and lists."""

from __future__ import annotations

import math
import re
import struct

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from lxml import etree

from colladaphy_schema import lexical
from colladaphy_schema.codec import CodecError

ELEMENT = etree.fromstring("<value/>")
DOUBLE = re.compile(
    r"[ \t\r\n]*([+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([Ee][+-]?[0-9]+)?|-?INF|NaN)[ \t\r\n]*"
)
INTEGER = re.compile(r"[ \t\r\n]*[+-]?[0-9]+[ \t\r\n]*")
BOOLEAN = re.compile(r"[ \t\r\n]*(true|false|0|1)[ \t\r\n]*")
NEAR = st.text("0123456789+-.eE_ \t\nxINFinfaNtyrulsj٣１\u00a0\u2003", max_size=8)
VALIDISH = st.one_of(
    NEAR,
    st.floats().map(repr),
    st.floats().map(lexical.number_text),
    st.integers().map(str),
    st.sampled_from(["true", "false", "TRUE", "1", "0", "10", "INF", "-INF", "+INF", "NaN", "inf"]),
)


def accepts(function: object, text: str) -> bool:
    try:
        function(text, ELEMENT)  # type: ignore[operator]
    except CodecError:
        return False
    return True


@given(VALIDISH)
@example("1_0")
@example("infinity")
@example("nan")
@example("１")
@example("+INF")
@example("")
@example(" ")
@example("0x1p3")
def test_exactly_the_lexical_space_is_accepted(text: str) -> None:
    assert accepts(lexical.number, text) == bool(DOUBLE.fullmatch(text))
    assert accepts(lexical.integer, text) == bool(INTEGER.fullmatch(text))
    assert accepts(lexical.boolean, text) == bool(BOOLEAN.fullmatch(text))


@given(st.lists(VALIDISH, max_size=4), st.sampled_from([" ", "\n", "\t ", "\r\n"]))
def test_lists_accept_what_their_items_accept(texts: list[str], separator: str) -> None:
    joined = separator.join(texts)
    items = re.split("[ \t\r\n]+", joined.strip(" \t\r\n")) if joined.strip(" \t\r\n") else []
    for one, many in (
        (lexical.number, lexical.numbers),
        (lexical.integer, lexical.integers),
        (lexical.boolean, lexical.booleans),
    ):
        expected = all(accepts(one, item) for item in items)
        assert accepts(many, joined) == expected
        if expected:
            assert repr(many(joined, ELEMENT)) == repr([one(item, ELEMENT) for item in items])


@given(st.lists(st.floats(), max_size=5))
def test_floats_come_back_to_the_same_bits(values: list[float]) -> None:
    text = lexical.numbers_text(values)
    again = lexical.numbers(text, ELEMENT)
    assert all(DOUBLE.fullmatch(word) for word in text.split())
    assert [bits(x) for x in again] == [bits(x) for x in values]
    for value in values:
        assert bits(lexical.number(lexical.number_text(value), ELEMENT)) == bits(value)


def bits(value: float) -> bytes:
    return b"NaN" if math.isnan(value) else struct.pack("<d", value)


@given(st.lists(st.integers(), max_size=5), st.lists(st.booleans(), max_size=5))
def test_integers_and_booleans_come_back(integers: list[int], booleans: list[bool]) -> None:
    assert lexical.integers(lexical.integers_text(integers), ELEMENT) == integers
    text = " ".join(map(lexical.boolean_text, booleans))
    assert lexical.booleans(text, ELEMENT) == booleans


def test_numbers_of_numpy_and_integers_are_written_as_floats() -> None:
    numpy = pytest.importorskip("numpy")
    assert lexical.numbers_text(numpy.array([1.5, -0.0])) == "1.5 -0.0"
    assert lexical.numbers_text(numpy.array([0.5], dtype="f4")) == "0.5"
    assert lexical.numbers_text([1, 2.5]) == "1.0 2.5"
    assert lexical.number_text(numpy.float64(0.1)) == "0.1"
    assert lexical.integer_text(numpy.int64(7)) == "7"
    assert lexical.integer_text(True) == "1"
    with pytest.raises(TypeError):
        lexical.integer_text(1.5)  # type: ignore[arg-type]


XML_TEXT = st.text(
    st.characters(blacklist_categories=["Cs"]).filter(
        lambda c: c in "\t\n\r" or (c >= " " and c not in "\ufffe\uffff")
    )
)


@given(XML_TEXT)
@example("\r\n\t <&>\"']]>")
def test_any_text_survives_as_content_and_as_attribute(text: str) -> None:
    source = f'<a b="{lexical.attribute_escaped(text)}">{lexical.text_escaped(text)}</a>'
    element = etree.fromstring(source.encode())
    assert (element.text or "") == text
    assert element.get("b") == text


@pytest.mark.parametrize("character", ["\x00", "\x1f", "\ud800", "\ufffe"])
def test_what_xml_cannot_hold_is_refused(character: str) -> None:
    with pytest.raises(CodecError, match=r"U\+"):
        lexical.text_escaped(character)
    with pytest.raises(CodecError, match=r"U\+"):
        lexical.attribute_escaped(character)


def test_other_types() -> None:
    assert lexical.hexadecimal(" 0aFf ", ELEMENT) == b"\x0a\xff"
    assert lexical.base64_bytes("aGV s\nbG8=", ELEMENT) == b"hello"
    assert lexical.collapsed(" a \n b\u00a0 ") == "a b\u00a0"
    assert lexical.normalized("a\nb\t c") == "a b  c"
    assert lexical.words(" \u00a0x\u2003 y ") == ["\u00a0x\u2003", "y"]
    assert str(lexical.moment(" 2024-01-31T12:00:00Z ", ELEMENT)) == "2024-01-31T12:00:00Z"
    for function, text in (
        (lexical.hexadecimal, "abc"),
        (lexical.base64_bytes, "a"),
        (lexical.moment, "yesterday"),
    ):
        with pytest.raises(CodecError, match="line 1: <value>"):
            function(text, ELEMENT)

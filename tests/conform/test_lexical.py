"""What texts must have meant, by type."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform.grammar import SimpleType, grammar
from colladaphy.conform.lexical import is_valid, mend, name_from
from colladaphy.conform.numerals import spelled_number
from colladaphy.conform.solids import numbers_of


def simple(primitive: str) -> SimpleType:
    return SimpleType(primitive, primitive=primitive)


@pytest.mark.parametrize(
    ("text", "kind", "meant"),
    [
        ("TRUE", "boolean", "true"),
        ("off", "boolean", "false"),
        ("perhaps", "boolean", None),
        ("-1.#IND", "double", "NaN"),
        ("-Infinity", "double", "-INF"),
        ("0,5", "double", "0.5"),
        ("1_0", "double", None),
        ("3.0", "unsignedLong", "3"),
        ("-3", "unsignedLong", "0"),
        ("300", "unsignedByte", "255"),
        ("1e400", "long", None),
        ("a b/c", "NCName", "a_b_c"),
        ("1st", "ID", "_1st"),
        ("", "NCName", None),
        ("file://c:/a b.blend", "anyURI", "file:///c%3A/a%20b.blend"),
        ("100%", "anyURI", "100%25"),
        ("2006-04-05 15:20:17", "dateTime", "2006-04-05T15:20:17"),
        ("2017-03-15T05:23:02.500000+0100", "dateTime", "2017-03-15T05:23:02.500000+01:00"),
        ("Wed Apr 05 15:20:17 2006", "dateTime", "2006-04-05T15:20:17"),
        ("2006-04-05", "dateTime", "2006-04-05T00:00:00"),
        ("yesterday", "dateTime", None),
    ],
)
def test_what_a_text_must_have_meant(text: str, kind: str, meant: str | None) -> None:
    assert not is_valid(text, simple(kind))
    mended, _ = mend(text, simple(kind))
    if kind == "anyURI" and meant is not None:
        assert mended is not None
        assert mended.replace("%3A", ":") == meant.replace("%3A", ":")
    else:
        assert mended == meant
    assert mended is None or is_valid(mended, simple(kind))


def test_a_colour_without_alpha_is_opaque() -> None:
    color = grammar()["fx_common_color_or_texture_type"].children["color"].type.value
    assert mend("1 0 0", color) == ("1 0 0 1", False)


def test_lists_that_are_too_long_lose_their_end_and_say_so() -> None:
    three = grammar()["box_type"].children["half_extents"].type
    assert mend("1 2 3 4", three) == ("1 2 3", True)
    assert mend("1 2", three) == (None, False)


@given(st.text())
def test_any_text_makes_a_name(text: str) -> None:
    assert is_valid(name_from(text), simple("NCName"))
    assert name_from(name_from(text)) == name_from(text)


@given(st.text(alphabet=st.characters(codec="utf-8", exclude_categories=["C"])))
def test_validity_is_that_of_libxml2(text: str) -> None:
    for primitive in ("double", "boolean", "NCName", "anyURI", "long", "dateTime", "NMTOKEN"):
        schema = etree.XMLSchema(
            etree.fromstring(
                '<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema">'
                f'<xs:element name="v" type="xs:{primitive}"/></xs:schema>'
            )
        )
        element = etree.Element("v")
        element.text = text
        # It takes an exponent without digits for a number, which XML Schema does not.
        if primitive != "double" or spelled_number(text.strip()) is None:
            assert is_valid(text, simple(primitive)) == schema.validate(element), primitive


def test_numbers_of_a_text_that_is_no_list_of_numbers() -> None:
    assert numbers_of(None) == []
    assert numbers_of(etree.fromstring("<a>1 two</a>")) == []
    assert numbers_of(etree.fromstring("<a>1, 2</a>")) == [1, 2]

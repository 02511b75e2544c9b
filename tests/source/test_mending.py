"""Text that is not well-formed for a small reason is read where repair is asked for."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from colladaphy.errors import XmlError
from colladaphy.source import parse

NS = "http://www.collada.org/2008/03/COLLADASchema"
PE = "{urn:colladaphy:pe:1}"


def document(content: str, name: str = "") -> bytes:
    return (
        f'<?xml version="1.0"?>\n<!-- <COLLADA a="b"> -->\n<COLLADA xmlns="{NS}" version="1.5.0">\n'
        f"<asset><contributor><author>{name}</author></contributor></asset>\n"
        f'<extra><technique profile="pe">{content}</technique></extra>\n</COLLADA>'
    ).encode()


def test_undeclared_prefixes_are_refused_unless_mended() -> None:
    data = document("<pe:world>\n<pe:uid>1</pe:uid></pe:world>")
    with pytest.raises(XmlError, match="read the file with repair"):
        parse(data)
    parsed = parse(data, mend=True)
    world = parsed.tree.getroot().find(f".//{PE}world")
    assert world is not None
    assert world.sourceline == 5
    (finding,) = parsed.findings
    assert (finding.code, finding.line) == ("repair-undeclared-prefix", 5)
    assert "'pe'" in finding.message
    assert "2 times" in finding.message


def test_prefixes_of_elements_and_attributes_that_nobody_knows() -> None:
    data = document('<px:a xsi:nil="true"/>\n<py:b pz:c="1"/>')
    parsed = parse(data, mend=True)
    assert {finding.message.split("'")[1] for finding in parsed.findings} == {
        "px", "xsi", "py", "pz",
    }  # fmt: skip
    assert [finding.line for finding in parsed.findings] == [5, 5, 6, 6]
    assert etree.QName(parsed.tree.find(".//{*}a")).namespace == "urn:colladaphy:undeclared:px"


def test_a_declaration_further_in_stays_what_it_is() -> None:
    parsed = parse(document('<pe:a/><pe:b xmlns:pe="urn:other"/>'), mend=True)
    assert parsed.tree.find(f".//{PE}a") is not None
    assert parsed.tree.find(".//{urn:other}b") is not None


def test_one_byte_of_latin_1() -> None:
    data = document("<a/>", "Ren@ Ümlaut".replace("@", "\u00e9")).replace(
        "\u00e9".encode(), b"\xe9"
    )
    with pytest.raises(XmlError):
        parse(data)
    parsed = parse(data, mend=True)
    assert parsed.tree.findtext(".//{*}author") == "Ren\u00e9 Ümlaut"
    (finding,) = parsed.findings
    assert (finding.code, finding.line, finding.column) == ("repair-encoding", 4, 32)
    assert "0xe9" in finding.message


def test_both_at_once_and_many_bytes() -> None:
    data = document("<pe:a>\n</pe:a>", "@@").replace(b"@", b"\x80")
    parsed = parse(data, mend=True)
    assert parsed.tree.findtext(".//{*}author") == "\u20ac\u20ac"
    assert [finding.code for finding in parsed.findings] == [
        "repair-encoding", "repair-undeclared-prefix",
    ]  # fmt: skip
    assert "1 more" in parsed.findings[0].message


@pytest.mark.parametrize(
    "data",
    [document("<a>"), document("<pe:a></pe:b>"), document("<pe:a><b></pe:a>"), b"<COLLADA"],
)
def test_what_is_broken_otherwise_stays_an_error(data: bytes) -> None:
    with pytest.raises(XmlError):
        parse(data, mend=True)


def test_another_encoding_that_is_stated_is_taken_at_its_word() -> None:
    data = document("<a/>", "\u00e9").decode().replace("?>", ' encoding="ISO-8859-1"?>', 1)
    parsed = parse(data.encode("latin-1"), mend=True)
    assert parsed.findings == ()
    assert parsed.tree.findtext(".//{*}author") == "\u00e9"


@given(st.text(st.characters(min_codepoint=0xA0, max_codepoint=0xFF), min_size=1, max_size=9))
def test_any_latin_text_is_read_as_what_it_was(letters: str) -> None:
    name = "x".join(letters) + "x"  # no two of these bytes are one letter of UTF-8
    parsed = parse(document("<a/>", "@").replace(b"@", name.encode("latin-1")), mend=True)
    assert parsed.tree.findtext(".//{*}author") == name
    assert [finding.code for finding in parsed.findings] == ["repair-encoding"]


def test_wellformed_text_is_not_looked_at_again() -> None:
    assert parse(document("<a/>"), mend=True).findings == ()

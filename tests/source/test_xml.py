"""Hostile and broken XML: every kind has its own code, and nothing is fetched or expanded."""

from __future__ import annotations

import bz2
import gzip
import lzma
from collections.abc import Callable

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from colladaphy.errors import ColladaError, XmlError
from colladaphy.findings import Finding
from colladaphy.source import COLLADA_1_4, COLLADA_1_5, Limits, parse

OPEN = f'<COLLADA xmlns="{COLLADA_1_5}" version="1.5.0">'.encode()
CLOSE = b"</COLLADA>"


def refused(data: bytes, **limits: int) -> Finding:
    with pytest.raises(XmlError) as caught:
        parse(data, Limits(**limits))
    (finding,) = caught.value.findings
    assert finding.hint
    return finding


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "xml-empty"),
        (b" \r\n\t", "xml-empty"),
        (b"\xef\xbb\xbf", "xml-empty"),
        (b"solid cube\nfacet", "xml-not-xml"),
        (b"\x1f\x8b\x08\x00binary", "xml-not-xml"),
        (b"<!DOCTYPE html>\n<html><head/></html>", "xml-html"),
        (b"<HTML><body>404</body></HTML>", "xml-html"),
        (b'<?xml version="1.0"?><!-- x --><!DOCTYPE html><html/>', "xml-html"),
        (b'<?xml version="1.0"?><html xmlns="http://www.w3.org/1999/xhtml"/>', "xml-html"),
        (b"<!DOCTYPE COLLADA>" + OPEN + CLOSE, "xml-doctype"),
        (b'<!DOCTYPE COLLADA SYSTEM "http://x.example/a.dtd">' + OPEN + CLOSE, "xml-doctype"),
        (b'<!DOCTYPE COLLADA [<!ENTITY a SYSTEM "file:///etc/passwd">]>' + OPEN, "xml-doctype"),
        (b'<!DOCTYPE C [<!ENTITY a "a"><!ENTITY b "&a;&a;">]><C>&b;</C>', "xml-doctype"),
        ("<!DOCTYPE a><COLLADA/>".encode("utf-16"), "xml-doctype"),
        (
            '<?xml version="1.0" encoding="UTF-16LE"?><!DOCTYPE a><a/>'.encode("utf-16-le"),
            "xml-doctype",
        ),
        (OPEN + b"<a></b>" + CLOSE, "xml-malformed"),
        (OPEN + b"&undefined;" + CLOSE, "xml-malformed"),
        (OPEN + b"\0" + CLOSE, "xml-malformed"),
        (OPEN + b'<a b="1" b="2"/>' + CLOSE, "xml-malformed"),
        (OPEN + b"<pe:a/>" + CLOSE, "xml-malformed"),
        (OPEN + b"\xff\xff" + CLOSE, "xml-encoding"),
        (b'<?xml version="1.0" encoding="latin-99"?><COLLADA/>', "xml-encoding"),
        (OPEN, "xml-truncated"),
        (OPEN + b"<a><b>x\n", "xml-truncated"),
        (OPEN + b"<a b", "xml-truncated"),
        (OPEN + b'<a b="c', "xml-truncated"),
        (OPEN + b"<!-- comment", "xml-truncated"),
        (OPEN + b"<![CDATA[ data", "xml-truncated"),
        (OPEN + b"<a>\xc3", "xml-truncated"),
        (OPEN + b"</COLLA", "xml-truncated"),
        (b'<?xml version="1.0"?>\n', "xml-truncated"),
        (OPEN + CLOSE + b"junk", "xml-trailing"),
        (OPEN + CLOSE + OPEN + CLOSE, "xml-trailing"),
        (b'<svg xmlns="http://www.w3.org/2000/svg"/>', "xml-wrong-root"),
        (b'<COLLADA xmlns="urn:other"/>', "xml-wrong-namespace"),
    ],
)
def test_each_kind_of_bad_input_has_its_code(data: bytes, code: str) -> None:
    assert refused(data).code == code


def test_what_was_found_is_named() -> None:
    assert "<sdf>" in refused(b"<sdf/>").message
    assert "urn:other" in refused(b'<COLLADA xmlns="urn:other"/>').message
    assert "solid cube" in refused(b"solid cube\nfacet").message


def test_line_and_column() -> None:
    finding = refused(OPEN + b"\n<asset>\n   <a></b></asset>" + CLOSE)
    assert (finding.line, finding.column) == (3, 11)
    finding = refused(b"<!-- a\n -->\n  <!DOCTYPE COLLADA>" + OPEN + CLOSE)
    assert (finding.line, finding.column) == (3, 3)
    assert refused(OPEN + b"\n<asset>\n").line == 3


@pytest.mark.parametrize("namespace", [COLLADA_1_4, COLLADA_1_5])
def test_both_versions_are_parsed(namespace: str) -> None:
    parsed = parse(f'<COLLADA xmlns="{namespace}"/>'.encode())
    assert parsed.tree.getroot().tag == f"{{{namespace}}}COLLADA"
    assert parsed.file is None


def nested(levels: int) -> bytes:
    return OPEN + b"<a>" * (levels - 1) + b"</a>" * (levels - 1) + CLOSE


@pytest.mark.parametrize("limit", [3, 100, 256, 257, 1000, 2048])
def test_depth(limit: int) -> None:
    parse(nested(limit), Limits(depth=limit))
    assert refused(nested(limit + 1), depth=limit).code == "xml-too-deep"


def test_default_depth_stops_an_attack() -> None:
    assert refused(nested(100_000)).code == "xml-too-deep"


@pytest.mark.parametrize(
    "content",
    [b"%s", b"<![CDATA[%s]]>", b"<!--%s-->", b'<a b="%s"/>', b"<?a %s?>", b"<%s/>"],
)
def test_default_text_limit(content: bytes) -> None:
    data = OPEN + content.replace(b"%s", b"x" * 12_000_000) + CLOSE
    assert refused(data).code == "xml-text-too-long"


@pytest.mark.parametrize("content", [b"%s", b'<a b="%s"/>', b"<!--%s-->"])
@pytest.mark.parametrize("limit", [500, 12_000_000])
def test_text_limit_can_be_set(content: bytes, limit: int) -> None:
    parse(OPEN + content.replace(b"%s", b"x" * limit) + CLOSE, Limits(text=limit))
    longer = OPEN + content.replace(b"%s", b"x" * (limit + 1)) + CLOSE
    assert refused(longer, text=limit).code == "xml-text-too-long"


def test_element_limit() -> None:
    data = OPEN + b"<a></a>" * 9 + CLOSE
    parse(data, Limits(elements=10))
    assert refused(data, elements=9).code == "xml-too-many-elements"
    wide = '<?xml version="1.0" encoding="UTF-16"?><COLLADA>' + "<a></a>" * 9 + "</COLLADA>"
    parse(wide.encode("utf-16"), Limits(elements=11))
    assert refused(wide.encode("utf-16"), elements=9).code == "xml-too-many-elements"


@pytest.mark.parametrize("value", [0, -1, 2.5, True])
def test_limits_cannot_be_switched_off(value: object) -> None:
    with pytest.raises(ValueError, match="positive integer"):
        Limits(text=value)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="at most"):
        Limits(depth=3000)


def test_nothing_is_followed(tmp_path: object) -> None:
    data = (
        f'<COLLADA xmlns="{COLLADA_1_5}" xmlns:xi="http://www.w3.org/2001/XInclude" '
        'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
        'xsi:schemaLocation="urn:x file:///etc/passwd">'
        '<?xml-stylesheet href="file:///etc/passwd"?><xi:include href="/etc/passwd" parse="text"/>'
        "</COLLADA>"
    ).encode()
    (instruction, include) = parse(data).tree.getroot()
    assert include.tag == "{http://www.w3.org/2001/XInclude}include"
    assert include.text is None and instruction.text == 'href="file:///etc/passwd"'


def test_comments_instructions_and_cdata_are_kept() -> None:
    from lxml import etree

    data = OPEN + b"<!-- c --><?p i?><a><![CDATA[<&]]></a>" + CLOSE
    assert etree.tostring(parse(data).tree) == data


_VALID = (
    b'<?xml version="1.0" encoding="utf-8"?>\n'
    + OPEN
    + "<asset><!-- c --><title>ä</title></asset><a b='c'><![CDATA[d]]></a>".encode()
    + CLOSE
)


@example(b"\xff\xfe")
@example(b"<")
@example(b"<?xml")
@example(b"PK\x03\x04")
@given(
    st.one_of(
        st.binary(max_size=300),
        st.binary(max_size=100).map(lambda tail: b"<COLLADA" + tail),
        st.binary(max_size=100).map(lambda tail: b"PK\x03\x04" + tail),
        st.integers(0, len(_VALID)).map(lambda cut: _VALID[:cut]),
        st.tuples(st.integers(0, len(_VALID)), st.binary(min_size=1, max_size=4)).map(
            lambda at: _VALID[: at[0]] + at[1] + _VALID[at[0] + len(at[1]) :]
        ),
        st.text(max_size=100).map(lambda text: text.encode("utf-16", "surrogatepass")),
    )
)
@settings(max_examples=300)
def test_bytes_give_a_tree_or_an_error_of_ours(data: bytes) -> None:
    try:
        parsed = parse(data)
    except ColladaError as error:
        assert error.findings
    else:
        assert parsed.tree.getroot().tag.endswith("COLLADA")


@given(st.integers(1, len(_VALID) - 1))
def test_every_truncation_is_an_error(cut: int) -> None:
    with pytest.raises(XmlError) as caught:
        parse(_VALID[:cut])
    assert caught.value.findings[0].code in {"xml-truncated", "xml-malformed"}


@pytest.mark.parametrize("pack", [gzip.compress, bz2.compress, lzma.compress])
def test_a_compressed_file_is_called_so(pack: Callable[[bytes], bytes]) -> None:
    with pytest.raises(XmlError, match="compressed with"):
        parse(pack(OPEN + CLOSE))

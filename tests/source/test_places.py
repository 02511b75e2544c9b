"""Lines and columns of elements, beyond what libxml2 keeps."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from colladaphy.findings import element_path, unchanging
from colladaphy.source.places import locate


def test_lines_and_columns() -> None:
    data = '<a>\n  <b/><p:b xmlns:p="x"\n    y="ä"><c/></p:b>\n ä<c/></a>'.encode()
    assert locate(data, ["/a", "/a/b[1]", "/a/b[2]", "/a/b[2]/c", "/a/c", "/a/d"]) == {
        "/a": (1, 1),
        "/a/b[1]": (2, 3),
        "/a/b[2]": (2, 7),
        "/a/b[2]/c": (3, 11),
        "/a/c": (4, 3),
    }


def test_lines_beyond_sixteen_bits() -> None:
    data = b"<a>" + b"\n" * 100_000 + b" <b/></a>"
    assert locate(data, ["/a/b"]) == {"/a/b": (100_001, 2)}


def test_encodings() -> None:
    text = "<a>ä<b/></a>"
    assert locate("<a>\nä<b/></a>".encode("utf-16"), ["/a/b"]) == {"/a/b": (2, 2)}
    latin = '<?xml version="1.0" encoding="iso-8859-1"?>' + text
    assert locate(latin.encode("latin-1"), ["/a/b"]) == {"/a/b": (1, 48)}
    assert locate(b'<?xml version="1.0" encoding="none"?><a/>', ["/a"]) == {}


@given(
    st.recursive(
        st.just("<a/>"),
        lambda inner: st.lists(inner, max_size=4).map(
            lambda parts: "<b>" + "\n ".join(parts) + "<!-- c --></b>"
        ),
        max_leaves=30,
    )
)
def test_every_element_is_found_where_libxml2_has_it(text: str) -> None:
    root = etree.fromstring(text)
    paths = {element_path(element): element.sourceline for element in root.iter(etree.Element)}
    one_by_one = [element_path(node) for node in root.iter()]
    with unchanging():
        assert [element_path(node) for node in root.iter()] == one_by_one
    found = locate(text.encode(), paths)
    assert {path: line for path, (line, _) in found.items()} == paths

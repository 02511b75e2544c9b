"""The index of the bytes against libxml2's tree: names, parents, attributes, texts and places."""

from __future__ import annotations

import itertools
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from colladaphy.columns.index import Index
from colladaphy.columns.names import Names, NotPlain
from colladaphy.columns.plain import plain
from colladaphy.columns.reading import Document
from colladaphy.columns.words import Words
from colladaphy_schema.rows import Column, Rows

BLOCKS = (1, 40, 1 << 20)


class TextRows(Rows):
    """Any elements, with the first text in them."""

    __slots__ = ()
    value: Column[list[str]] = Column("", "text", "string")


def elements_of(document: Document) -> list[dict[str, Any]]:
    """What columns know of each element."""
    count = len(document.index)
    every = np.arange(count, dtype=np.int32)
    rows = TextRows(count, owners=count, origin=document, ordinals=every)
    names = {code: name for name, codes in document._codes.items() for code in codes}
    texts = rows.value
    lasts = document.index.last_within(every).tolist()
    return [
        {
            "name": names[code],
            "parent": parent,
            "text": text,
            "last": last,
            "level": level,
        }
        for code, parent, text, last, level in zip(
            document.index.codes.tolist(), document.index.parent.tolist(), texts, lasts,
            document.index.level.tolist(), strict=True,
        )
    ]  # fmt: skip


def assert_like_tree(data: bytes, block: int = 1 << 20) -> Document:
    """Everything that the index says is in the tree."""
    root = etree.fromstring(data, etree.XMLParser(huge_tree=True, strip_cdata=False))
    tree = etree.ElementTree(root)
    document = Document.of(data, tree, block=block)
    elements = list(root.iter("*"))
    number = {element: place for place, element in enumerate(elements)}
    found = elements_of(document)
    assert len(found) == len(elements)
    for element, said in zip(elements, found, strict=True):
        parent = element.getparent()
        assert said["name"] == element.tag
        assert said["parent"] == (-1 if parent is None else number[parent])
        assert said["text"] == first_text(element)
        assert said["last"] == number[element] + len(list(element.iter("*"))) - 1
        assert said["level"] == 1 + len(list(element.iterancestors()))
        for name, value in element.attrib.items():
            if "}" not in name:
                assert document.attribute_of(number[element], name) == " ".join(
                    word for word in value.translate(FLAT).split(" ") if word
                )
        assert document.attribute_of(number[element], "absent") is None
    whole = document.texts_within(range(len(elements)))
    for element, text in zip(elements, whole, strict=True):
        assert text.startswith(b"<") and text.endswith(b">")
        local = etree.QName(element).localname.encode()
        assert local in text.partition(b">")[0]
        assert text.count(b"<") - text.count(b"</") == len(list(element.iter("*")))
        assert text.endswith(b"/>") or local in text.rpartition(b"</")[2]
    assert document.places.elements(range(len(elements))) == elements
    assert [document.element(place) for place in range(len(elements))] == elements
    return document


FLAT = str.maketrans("\t\n\r", "   ")


def first_text(element: etree._Element) -> str:
    """The text before the first child, over comments and instructions."""
    text = element.text or ""
    for child in element:
        if isinstance(child.tag, str):
            break
        text += child.tail or ""
    return text


# --- arbitrary documents

LETTERS = ["a", "b", "rigid_body", "rigid_bodies", "library_of_a_thing_xx", "library_of_b_thing_xx",
           "x" * 40, "x" * 39 + "y", "é", "technique"]  # fmt: skip
BLANKS = st.sampled_from([" ", "\n", "\t", "  ", "\r\n"])
MAYBE = st.sampled_from(["", "", "", " ", "\n", "\t "])
CONTENTS = st.sampled_from(
    ["", "1", "1 2.5\n3", " ", "&amp;&lt;x", "&#65;&#x42;", "é€😀", "'", '"', "='", "a\tb",
     "x\r\ny", "-0 INF", "ab" * 60]
)  # fmt: skip
BETWEEN = st.sampled_from(
    ["", "", "", "\n", "<!-- <a b='c'> -->", "<?go on?>", "<!---->", "<!--é\n-->", "t"]
)
WRAPPED = st.sampled_from(["{}", "{}", "{}", "{}", "<![CDATA[{}]]>"])


@st.composite
def attributes(draw: st.DrawFn) -> str:
    names = draw(st.lists(st.sampled_from(["id", "sid", "url", "axmlns", "pid", "xmln", "x" * 20]),
                          unique=True, max_size=5))  # fmt: skip
    text = ""
    for name in names:
        value = draw(CONTENTS)
        quote = draw(st.sampled_from(['"', '"', '"', '"', "'"]))
        value = value.replace(quote, "&quot;" if quote == '"' else "&apos;")
        spaces = draw(st.sampled_from(["", "", "", "", " "]))
        text += f"{draw(BLANKS)}{name}{spaces}={spaces}{quote}{value}{quote}"
    return text


@st.composite
def markup(draw: st.DrawFn, depth: int = 0, prefixes: tuple[str, ...] = ()) -> str:
    declared = ""
    for prefix in draw(st.lists(st.sampled_from(["", "p", "q"]), unique=True, max_size=2)):
        uri = draw(st.sampled_from(["urn:1", "urn:2", *([""] if not prefix else [])]))
        declared += f'{draw(BLANKS)}xmlns{":" if prefix else ""}{prefix}="{uri}"'
        if prefix:
            prefixes = tuple({*prefixes, prefix})
    prefix = draw(st.sampled_from(["", "", *(f"{p}:" for p in sorted(prefixes))]))
    name = prefix + draw(st.sampled_from(LETTERS))
    first, second = (declared, draw(attributes())) if draw(st.booleans()) else (
        draw(attributes()), declared)  # fmt: skip
    head = f"<{name}{first}{second}{draw(MAYBE)}"
    if draw(st.integers(0, 4)) == 0:
        return head + "/>"
    content = draw(CONTENTS)
    wrapped = draw(WRAPPED)
    text = wrapped.format(content if wrapped == "{}" else "1 < 2")
    for _ in range(draw(st.integers(0, 3 if depth < 4 else 0))):
        text += draw(BETWEEN) + draw(markup(depth + 1, prefixes))
    text += draw(BETWEEN)
    return f"{head}>{text}</{name}{draw(MAYBE)}>"


@st.composite
def texts(draw: st.DrawFn) -> bytes:
    head = draw(st.sampled_from(["", '<?xml version="1.0"?>', "<?xml version='1.0'?>\n", "told"]))
    root = draw(markup())
    before = draw(st.sampled_from(["", "", "<!-- before -->\n", "<?a b?>"]))
    after = draw(st.sampled_from(["", "\n", "<!-- after -->", " "]))
    encodings = ["utf-8", "utf-8", "utf-8-sig", "utf-16", "iso-8859-15"]
    encoding = draw(st.sampled_from(encodings))
    if (head + before + root + after).isascii() and draw(st.booleans()):
        encoding = "US-ASCII"
    elif encoding == "iso-8859-15":
        root = root.replace("😀", "?")
    if head == "told" or encoding in ("US-ASCII", "iso-8859-15"):
        head = f'<?xml version="1.0" encoding="{encoding.removesuffix("-sig")}"?>'
    return (head + before + root + after).encode(encoding)


@given(texts(), st.sampled_from(BLOCKS))
def test_any_spelling_is_read_as_libxml2_reads_it(data: bytes, block: int) -> None:
    assert_like_tree(data, block)


# --- cases by hand


@pytest.mark.parametrize("block", BLOCKS)
@pytest.mark.parametrize(
    "body",
    [
        "<a/>",
        "<a ></a >",
        '<a  id = "x"/>',
        "<a id='x' sid=\"y\"/>",
        '<a id="&gt;>"/>',
        "<a>1 > 0</a>",
        "<a><![CDATA[<b>]]></a>",
        '<a\n\tid="1\t2\n3"\r\n sid="\t"/>',
        "<a>x<!-- y -->z</a>",
        "<a><a><a/></a><a/></a>",
        '<a xmlns="urn:1"><b xmlns=""><c/></b><d xmlns="urn:2"><e/></d><f/></a>',
        '<p:a xmlns:p="urn:1"><p:a xmlns:p="urn:2"/><p:a/></p:a>',
        '<p:a xmlns:p="urn:1" xmlns:q="urn:1"><q:a/><r:a xmlns:r="urn:2"/></p:a>',
        '<a id="&#10;&#9;&#xd;&amp;"/>',
        "<a>say \"hi\" and 'ho' = 'x'</a>",
        "<library_of_a_thing_xx><library_of_b_thing_xx/></library_of_a_thing_xx>",
        "<a>" + "".join(f'<n{k} id="{k}"/>' for k in range(700)) + "</a>",
        "<a>" + "".join(f"<{'n' * 9}{k:03}{'m' * 9}/>" for k in range(300)) + "</a>",
        "<a " + " ".join(f'id{k}="{k}"' for k in range(300)) + "/>",
    ],
)
def test_cases(body: str, block: int) -> None:
    document = assert_like_tree(body.encode(), block)
    assert len(document.index) >= 1


def test_deep_nesting() -> None:
    assert_like_tree(b"<a>" * 250 + b"</a>" * 250, 100)


def test_what_is_spelled_plainly_is_not_copied() -> None:
    data = b'<?xml version="1.0" encoding="utf-8"?>\n<a id="it\'s"/>'
    text, start = plain(data)
    assert text is data
    assert data[start:] == b'\n<a id="it\'s"/>'


def test_comments_leave_everything_where_it_was() -> None:
    data = b"<a>1<!-- 2 -->3<?x?></a><!-- -->"
    text, _ = plain(data)
    assert len(text) == len(data)
    assert bytes(text) == b"<a>1\0\0\0\0\0\0\0\0\0\0" + b"3\0\0\0\0\0</a>\0\0\0\0\0\0\0\0"


@pytest.mark.parametrize("data", [b"<a>1 > 0</a>", b'<a b ="c"/>', b'<a b= "c"/>', b"<a>"])
def test_what_is_not_plain_is_refused(data: bytes) -> None:
    with pytest.raises(NotPlain):
        Index(data)


def test_names_that_collide_are_told_apart() -> None:
    """Names of the same length, first and last letters; more of them than the table has room."""
    names = [f"{'a' * 8}{k:04}{'b' * 8}".encode() for k in range(3000)]
    names += [bytes(pair) for pair in itertools.product(b"abcdefgh", repeat=4)]
    data = b"<" + b"/><".join(names) + b"/>"
    starts = np.cumsum([1, *(len(name) + 3 for name in names[:-1])])
    known = Names()
    codes = known.codes(
        Words(np.frombuffer(data, np.uint8)), starts, np.array(list(map(len, names)))
    )
    assert [known.texts[code] for code in codes.tolist()] == names
    again = known.codes(
        Words(np.frombuffer(data, np.uint8)), starts, np.array(list(map(len, names)))
    )
    assert np.array_equal(again, codes)


# --- places


@given(texts())
def test_places_are_those_of_the_tags(data: bytes) -> None:
    document = Document.of(data, etree.ElementTree(etree.fromstring(data)))
    count = len(document.index)
    places = document.places.places(range(count))
    assert places == [document.place(number) for number in range(count)]
    if document.places._source is None:
        assert [place.line for place in places] == [
            document.element(number).sourceline for number in range(count)
        ]
        return
    lines = data.decode("utf-8-sig").split("\n")
    for number, place in enumerate(places):
        assert place.line is not None and place.column is not None
        name = document.index.names.texts[int(document.index.codes[number])].decode()
        assert lines[place.line - 1][place.column - 1 :].startswith(f"<{name}")


def test_an_element_is_found_over_comments() -> None:
    root = etree.fromstring(b"<a><!-- x --><b/><?y?><c><!-- z --><d/></c></a>")
    document = Document.of(etree.tostring(root), etree.ElementTree(root))
    assert [document.element(number).tag for number in range(4)] == ["a", "b", "c", "d"]
    with pytest.raises(ValueError, match="without a tree"):
        Document.of(b"<a/>").element(0)


@given(st.binary(min_size=1, max_size=70), st.data())
def test_words_at_any_place(data: bytes, draw: st.DataObject) -> None:
    places = draw.draw(st.lists(st.integers(0, len(data) - 1)))
    found = Words(np.frombuffer(data, np.uint8)).at(np.array(places, np.int64))
    padded = data + bytes(8)
    assert [int(word) for word in found] == [
        int.from_bytes(padded[place : place + 8], "little") for place in places
    ]


@pytest.mark.parametrize(
    ("many", "head", "tail"),
    [
        (b"<!-- x --><b/>", b"<a>", b"</a>"),
        (b"<p%d:b xmlns:p%d='urn:%d'><p%d:b xmlns:p%d='urn:x'/></p%d:b>", b"<a>", b"</a>"),
        (b'<p:b xmlns:p="urn:%d"/>', b'<a xmlns="urn:1">', b"</a>"),
        (b'<t><b xmlns="urn:2"><c/></b></t><d/>', b'<a xmlns="urn:1">', b"</a>"),
        (b"<n%d/>", b"<a>", b"</a>"),
        (b' a%d="1"', b"<a", b"/>"),
    ],
)
def test_time_grows_with_the_document(many: bytes, head: bytes, tail: bytes) -> None:
    """Ten times as many take ten times as long, not a hundred."""

    def seconds(count: int) -> float:
        parts = [many.replace(b"%d", b"%d" % number) for number in range(count)]
        data = head + b"".join(parts) + tail
        began = time.process_time()
        Document.of(data)
        return time.process_time() - began

    few = min(seconds(2000) for _ in range(3))
    assert seconds(20_000) < 40 * few + 0.1

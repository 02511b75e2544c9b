"""Validating without a tree: it accepts nothing that a tree would refuse, and most of the rest."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from colladaphy.errors import XmlError
from colladaphy.gate import accepts, faults, gate, is_valid, is_valid_text, numerals, text
from colladaphy.gate.messages import translate
from colladaphy.gate.numerals import incomplete_numbers, may_hold_incomplete_numbers
from colladaphy.source import COLLADA_1_4, COLLADA_1_5, Limits
from colladaphy.source.plain import in_short_pieces
from colladaphy.source.xml import parse_bytes
from colladaphy.testing import covering_documents, documents, mutants

PE = "urn:colladaphy:pe:1"
ASSET = (
    "<asset><created>2010-01-01T00:00:00Z</created>"
    "<modified>2010-01-01T00:00:00Z</modified></asset>"
)
OPEN = f'<COLLADA xmlns="{COLLADA_1_5}" version="1.5.0">'
many = settings(max_examples=2 * settings().max_examples)


@pytest.fixture(autouse=True, scope="module")
def small_documents_too() -> Iterator[None]:
    """Small documents go the way of large ones."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text, "_SMALL", 0)
        patch.setattr(numerals, "_LONG", 0)
        yield


def document(content: str, head: str = "") -> bytes:
    return f"{head}{OPEN}{ASSET}{content}</COLLADA>".encode()


def nodes(content: str) -> str:
    return f"<library_nodes>{content}</library_nodes>"


def technique(content: str, attributes: str = "") -> str:
    return nodes(
        f'<node><extra><technique profile="pe"{attributes}>{content}</technique></extra></node>'
    )


def profile(content: str) -> str:
    return technique(content, f' xmlns:pe="{PE}"')


def comments(content: str) -> str:
    contributor = f"<contributor><comments>{content}</comments></contributor>"
    return nodes(f"<node>{ASSET.replace('<created', contributor + '<created', 1)}</node>")


def refused(data: bytes, limits: Limits) -> bool:
    """The way through a tree."""
    try:
        tree = parse_bytes(data, None, limits)
    except XmlError:
        return True
    return bool(gate(tree, fresh=True) or gate(tree) or incomplete_numbers(tree, data))


def agreed(data: bytes, limits: Limits | None = None) -> bool:
    """Whether a document is accepted, which it may only be if the tree is not refused."""
    limits = limits or Limits()
    accepted = accepts(data, limits)
    assert not (accepted and refused(data, limits))
    return accepted


@many
@given(documents())
def test_documents_of_the_whole_schema(data: bytes) -> None:
    agreed(data)


@many
@given(mutants())
def test_mutants(data: bytes) -> None:
    agreed(data)
    agreed(b"\xef\xbb\xbf" + data)


def test_most_valid_documents_are_accepted() -> None:
    accepted = [agreed(data) for data in covering_documents()]
    assert sum(accepted) > 0.9 * len(accepted)


BASE = document(
    nodes(
        '<node id="a" sid="s"><translate>1e5 2 3</translate>'
        "<instance_geometry url='#a'/></node><node id='b' name='x &amp; y'/>"
    )
    + profile("<pe:motion><pe:angular_velocity>1 2e3 3</pe:angular_velocity></pe:motion>")
    + '<extra><technique profile="p"><thing id="c"/></technique></extra>',
    '<?xml version="1.0" encoding="UTF-8"?>\n<!-- made by hand -->\n',
)
FRAGMENTS = (
    "<!---->", "<!-- - -->", "<![CDATA[1]]>", "<?x y?>", "&#101;", "&amp;", "&x;", "1e", "1e+", "e",
    "2.5E ", ' id="a"', " id='b'", '\nid = "c"', ' x:id="a"', f' xmlns:pe="{PE}"', "<pe:thing/>",
    f' xmlns:x="{PE}"', "<x:body/>", "<x:uid/>", f' xmlns="{PE}"', ' xmlns=""',
    ' xmlns:x="urn:colladaphy:pe&#58;1"', "<foreign/>", "<node/>", "<node id='a'/>", "ä", "\0",
    "<!DOCTYPE a>", "<", ">", '"', "/", " ", "\r\n", "]]>", "</node>", "<a>", "</a>", "COLLADA",
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"', ' xsi:type="node_type"',
    ' xsi:nil="true"', ' xsi:schemaLocation="a b"', "<instance_node url='#a'/>", "<pe:body/>",
)  # fmt: skip
EDITS = st.lists(
    st.tuples(st.integers(0, len(BASE)), st.integers(0, 12), st.sampled_from(FRAGMENTS)),
    min_size=1,
    max_size=4,
)


def edited(data: bytes, edits: list[tuple[int, int, str]]) -> bytes:
    for place, removed, added in edits:
        # Mostly at markup, where an edit has the best chances to stay well-formed.
        start = data.find(b"<>\" '"[place % 5 : place % 5 + 1], place) + place % 2
        data = data[:start] + added.encode() + data[start + removed * (place % 3 == 0) :]
    return data


def test_the_base_of_edits_holds_no_doubt_but_its_foreign_technique() -> None:
    assert not refused(BASE, Limits())
    assert not agreed(BASE)
    assert agreed(BASE.replace(b'<thing id="c"/>', b""))


@settings(max_examples=10 * settings().max_examples)
@given(EDITS, st.booleans())
def test_edits_of_text(edits: list[tuple[int, int, str]], foreign: bool) -> None:
    base = BASE if foreign else BASE.replace(b'<thing id="c"/>', b"")
    agreed(edited(base, edits))


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (nodes("<node/>"), True),
        (nodes("<!-- a remark -->\n<node/>"), True),
        (nodes("<?a b?><node/>"), True),
        (nodes('<node id="a"/><node id="b"/>'), True),
        (nodes('<node id="a"/><node\tid\n=\r" a "/>'), False),
        (nodes("<node id=\"a\"/><node id='a'/>"), False),
        (nodes('<node id="a"/><node id="&#97;"/>'), False),
        (nodes("<node><translate>1e-5 2.E3 1e+0</translate></node>"), True),
        (nodes("<node><translate>1e 2 3</translate></node>"), False),
        (nodes("<node><translate>1 2 3e+</translate></node>"), False),
        (nodes("<node><translate>1 2 <!---->3e</translate></node>"), False),
        (nodes("<node><translate>1 2 &#51;e</translate></node>"), False),
        (nodes("<node><translate>1 2e&#32;3</translate></node>"), False),
        (nodes("<node><translate>1 2 3<!---->e</translate></node>"), False),
        (nodes("<node><translate>1 2 <![CDATA[3e]]></translate></node>"), False),
        (nodes("<node><nonsense/></node>"), False),
        (profile("<pe:body uid='1'/>"), True),
        (profile("<pe:body uid='x'/>"), False),
        (profile("<pe:thing/>"), False),
        (profile("<pe:uid>1</pe:uid>"), False),
        (profile("<foreign xmlns=''><pe:thing/></foreign>"), False),
        (technique("<x:thing/>", ' xmlns:x="urn:colladaphy:pe&#58;1"'), False),
        (technique("<foreign id='a'/><other id='b'/>"), True),
        (technique("<node><node/></node>"), True),
        (technique("<COLLADA/>"), False),
        (technique("<COLLADA version='1.5.0'>" + ASSET + "</COLLADA>"), True),
        (comments("ä" * 1000), True),
        (comments("x" * 100_000), True),
    ],
)
def test_what_is_accepted(content: str, expected: bool) -> None:
    data = document(content)
    assert agreed(data) is expected
    assert refused(data, Limits()) is not expected or not expected


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xef\xbb\xbf",
        b"<html/>",
        f'<?xml version="1.0"?><!DOCTYPE COLLADA>{OPEN}{ASSET}</COLLADA>'.encode(),
        f'<!-- --><!DOCTYPE COLLADA [<!ENTITY a "a">]>{OPEN}{ASSET}</COLLADA>'.encode(),
        document("", '<?xml version="1.0" encoding="utf-16"?>'),
        document("").decode().encode("utf-16"),
        document("")[:-3],
        document("") + b"<a/>",
        document("").replace(b"COLLADA", b"node"),
        document("").replace(COLLADA_1_5.encode(), COLLADA_1_4.encode()),
        f'<pe:body xmlns:pe="{PE}"/>'.encode(),
        f'<COLLADA xmlns="{PE}"/>'.encode(),
        b"<COLLADA/>",
        document("<colladaphy.gate:document/>"),
        document(comments("ä"), '<?xml version="1.0" encoding="us-ascii"?>'),
    ],
)
def test_what_is_no_document_is_refused(data: bytes) -> None:
    assert not agreed(data)
    assert refused(data, Limits()) or data.startswith(b"\xff\xfe")


@pytest.mark.parametrize("limit", [1, 255, 256, 257, 300, 2048])
@pytest.mark.parametrize("depth", [100, *range(250, 262), 2046, 2047, 2048, 2049])
def test_depth(depth: int, limit: int) -> None:
    levels = depth - 2  # COLLADA and library_nodes
    data = document(nodes("<node>" * levels + "</node>" * levels))
    accepted = agreed(data, Limits(depth=limit))
    assert accepted is (depth <= min(limit, 256)) or limit < 256


@pytest.mark.parametrize("size", [999, 5000, 100_000])
@pytest.mark.parametrize("limit", [1, 1000, 6000, 20_000, 10_000_000])
def test_long_texts(size: int, limit: int) -> None:
    for content in (
        comments("x" * size),
        comments("x" * size + "&amp;"),
        comments("ä" * (size // 2)),
        nodes(f'<node name="{"x" * size}"/>'),
        nodes("<!--" + "<" * size + "--><node/>"),
        nodes("<node/><?" + "x" * size + "?>"),
    ):
        accepted = agreed(document(content), Limits(text=limit))
        assert not (accepted and size > limit)


def test_texts_beyond_what_libxml2_allows() -> None:
    for size in (9_999_000, 10_000_001):
        for content in (
            comments("x" * size),
            nodes(f'<node name="{"x" * size}"/>'),
            nodes("<!--" + "<" * size + "--><node/>"),
        ):
            data = document(content)
            assert agreed(data) is (size < 10_000_000)
            agreed(data, Limits(text=20_000_000))


def test_too_many_elements() -> None:
    data = document(nodes("<node/>" * 1000))
    assert agreed(data, Limits(elements=2000))
    assert not agreed(data, Limits(elements=1000))


@pytest.mark.parametrize(
    "bits",
    [
        "1 2&#32;3 ",
        "1 <!----> 2 ",
        "1 <?a?> 2 ",
        "1 <![CDATA[2]]> ",
        "ä",
    ],
)
def test_texts_in_many_bits_are_left_to_trees(bits: str) -> None:
    """libxml2 measures the text anew for every bit, so that it takes n² steps without a tree."""
    data = document(comments(bits * 10_000))
    assert not in_short_pieces(data, 10_000_000)
    assert not agreed(data)
    assert is_valid_text(data)
    assert not is_valid_text(data.replace(b"<node>", b"<node x='1'>"))


@many
@given(mutants())
def test_text_and_tree_are_judged_alike(data: bytes) -> None:
    """But for ids, of which libxml2 keeps account in a tree only."""
    tree = etree.ElementTree(etree.fromstring(data))
    complaints = faults._validate(tree)
    said = [(element, translate(code, message)) for element, code, message in complaints]
    assert is_valid_text(data) is not bool(faults._clean(said))


@pytest.mark.parametrize(
    ("content", "valid"),
    [
        ('<node xsi:type="node_type"/>', True),
        ('<node xsi:type="source_type"/>', False),
        ('<node xsi:type="unknown"/>', False),
        ('<node xsi:nil="true"/>', False),
        ('<node xsi:schemaLocation="urn:x http://x.example/x.xsd"/>', True),
        ('<node id="a"/><node id="a"/>', True),
        ("<node><extra><technique profile='x'><a><b xsi:type='x'/></a></technique></extra></node>",
         False),
        ("<node><extra><technique profile='x'><COLLADA/></technique></extra></node>", False),
    ],
)  # fmt: skip
def test_types_nils_ids_and_wildcards(content: str, valid: bool) -> None:
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    data = document(nodes(content)).replace(b"<library_nodes", f"<library_nodes {xsi}".encode())
    tree = etree.ElementTree(etree.fromstring(data))
    assert is_valid_text(data) is valid
    assert is_valid(tree) is valid
    assert (not [f for f in gate(tree) if f.code != "schema-duplicate-id"]) is valid
    agreed(data)


@pytest.mark.parametrize(
    ("uri", "accepted"),
    [
        ("http://x.example/a-b/c.xsd", True),
        ("urn:x:y", True),
        ("ht;p://www.w3.org/2001/XMLSchema-instance", False),
        ("a b", False),
        ("%zz", False),
        ("urn:a|b", False),
        ("", False),
        ("http://www.w3.org/2000/xmlns/", False),
        ("http://www.w3.org/XML/1998/namespace", False),
    ],
)
def test_namespaces_that_may_be_no_uris_are_left_to_trees(uri: str, accepted: bool) -> None:
    data = document("").replace(b" version=", f' xmlns:a="{uri}" version='.encode(), 1)
    assert agreed(data) is accepted


def test_integers_that_no_program_reads() -> None:
    for digits, accepted in ((2000, True), (4301, False), (20_000, False)):
        number = "7" * digits
        data = document(profile(f'<pe:body uid="{number}"/>'))
        assert agreed(data) is accepted
        assert refused(data, Limits()) is not accepted
        assert not refused(document(nodes(f"<node name='{number}'/>")), Limits())
        assert not refused(document(nodes(f"<node><scale>1 1 {number}</scale></node>")), Limits())


def test_threads_do_not_disturb_each_other() -> None:
    good = document(nodes("".join(f'<node id="n{number}"/>' for number in range(3000))))
    bad = good.replace(b'id="n2999"', b'x="1"')
    other = document(profile("<pe:body uid='1'/>" * 3000))
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(accepts, [good, bad, other] * 20)) == [True, False, True] * 20


@settings(max_examples=10 * settings().max_examples)
@given(st.lists(st.sampled_from(list("0159.;>[eE+- <\"'&]x/")), max_size=12).map("".join))
def test_exponents_are_found_in_long_texts_as_in_short_ones(text: str) -> None:
    data = text.encode()
    assert may_hold_incomplete_numbers(data) is (numerals._IN_BYTES.search(data) is not None)

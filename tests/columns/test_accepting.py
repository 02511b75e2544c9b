"""Documents that are accepted without validating what repeats: never one that a tree refuses."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tools.bench.kinds import KINDS

from colladaphy.columns import accepting, closings, paths, sure, thinning
from colladaphy.columns.accepting import judge
from colladaphy.columns.reading import Document
from colladaphy.errors import XmlError
from colladaphy.gate import gate
from colladaphy.gate.numerals import incomplete_numbers
from colladaphy.source import COLLADA_1_5, Limits
from colladaphy.source.xml import parse_bytes
from colladaphy.testing import covering_documents, documents, mutants

_ASSET = "<created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified>"


@pytest.fixture(autouse=True, scope="module")
def small_documents_too() -> Iterator[None]:
    """Small documents go the way of large ones, and two elements are many."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(accepting, "_LARGE", 0)
        patch.setattr(accepting, "_REGULAR", 2.0)
        patch.setattr(thinning, "_FEW", 1)
        patch.setattr(sure, "_FEW", 0)
        yield


def refused(data: bytes) -> bool:
    """The way through a tree."""
    try:
        tree = parse_bytes(data, None, Limits())
    except XmlError:
        return True
    return bool(gate(tree, fresh=True) or incomplete_numbers(tree, data))


def agreed(data: bytes) -> bool:
    """Whether a document is accepted, which it may only be if the tree is not refused."""
    accepted = judge(data).accepted
    assert not (accepted and refused(data))
    return accepted


def cameras() -> bytes:
    """Elements whose content is not told by pairs of neighbours."""
    made = "".join(
        f'<camera id="c{number}"><optics><technique_common><orthographic>{content}<znear>1</znear>'
        "<zfar>2</zfar></orthographic></technique_common></optics></camera>"
        for number, content in enumerate(
            ["<xmag>1</xmag>", "<ymag>1</ymag>", "<xmag>1</xmag><ymag>2</ymag>",
             "<xmag>1</xmag><aspect_ratio>1</aspect_ratio>",
             "<ymag>1</ymag><aspect_ratio>1</aspect_ratio>"] * 3
        )
    )  # fmt: skip
    return (
        f'<COLLADA xmlns="{COLLADA_1_5}" version="1.5.0"><asset>{_ASSET}</asset>'
        f"<library_cameras>{made}</library_cameras></COLLADA>"
    ).encode()


@cache
def bases() -> tuple[bytes, ...]:
    """Documents with a few records of every kind that is written."""
    return (*(kind.document(5) for kind in KINDS.values()), cameras())


FRAGMENTS = (
    b"", b"1", b"1 2", b"1\n2", b"x", b"e5", b"1e", b"1.", b".5", b"+1", b"INF", b"1_0", b"true",
    b"null", b"[1]", b"1,2", b"-", b"0x1", b"1e999", b"  ", b"&amp;", b"&#1;", b"&x;", b"<",
    b">", b'"', b"'", b"/", b"\0", b"\x01", b"\xff", "ä".encode(), b"\xef\xbf\xbf", b"<!-- a -->",
    b"<!-- -- -->", b"<?x?>", b"<![CDATA[1]]>", b"<foreign/>", b"<extra/>", b"</node>", b"<node/>",
    b'<node id="Node2"/>', b' id="Node2"', b" id='Node2'", b' sid="a b"', b' name="x"', b' y="1"',
    b' xmlns=""', b' xmlns:pe="urn:x"', b' xmlns:pe="urn:colladaphy:pe:1"', b' uid="-1"',
    b' url="#a#b"', b' url="%zz"', b"#", b"Model1/Body1", b"false", b"2", b"<xmag>1</xmag>",
    b"<ymag>1</ymag>", b"<aspect_ratio>1</aspect_ratio>", b"<mass>1</mass>", b"<pe:body/>",
    b"<pe:uid>1</pe:uid>", b"text", b"\t", b"\r\n", b"]]>", b"</pe:body>",
    b"<translate>1</translate>", b"a\nb",
)  # fmt: skip


def edited(data: bytes, place: int, way: int, fragment: bytes) -> bytes:
    """A document with something put in, left out, or in the place of something else."""
    mark = (b">", b"<", b'"', b" ")[way % 4]
    start = data.find(mark, place % len(data)) + (way // 4) % 2
    if way // 8 == 0:
        return data[:start] + fragment + data[start:]
    ends = [data.find(end, start + 1) for end in (b"<", b">", b'"', b" ")]
    end = min((end for end in ends if end > start), default=len(data))
    if way // 8 == 1:
        return data[:start] + fragment + data[end:]
    if way // 8 == 2:
        return data[:start] + data[end + 1 :]
    return data[:end] + data[start:end] + data[end:]


def planted(number: int) -> bytes:
    """One of endless edits of the bases, always the same."""
    draw = random.Random(number)
    data = draw.choice(bases())
    begin = data.index(b"<asset>")
    place = draw.randrange(begin, len(data))
    return edited(data, place, draw.randrange(32), draw.choice(FRAGMENTS))


def with_lenses_added() -> Iterator[bytes]:
    """The cameras with one more element in all places."""
    data = cameras()
    places = [place + 1 for place in range(len(data)) if data[place : place + 1] == b">"]
    for place in places:
        for name in (b"xmag", b"ymag", b"aspect_ratio"):
            yield data[:place] + b"<%b>1</%b>" % (name, name) + data[place:]


def test_whole_bases_are_accepted_and_lose_what_repeats() -> None:
    for data in bases():
        assert agreed(data)
        found = thinning.thinned(data)
        assert found is not None
        assert len(found.rest) < len(data) or data == cameras()


@settings(max_examples=20 * settings().max_examples)
@given(st.integers(0, 10**9))
def test_edits_of_documents_with_records(number: int) -> None:
    agreed(planted(number))


@given(documents())
def test_documents_of_the_whole_schema(data: bytes) -> None:
    agreed(data)


@given(mutants())
def test_mutants(data: bytes) -> None:
    agreed(data)


@pytest.mark.parametrize("spelling", ["x{}", "xmlns:x{}"])
def test_very_many_names_are_left_to_the_gate(spelling: str) -> None:
    content = "".join(f'<node {spelling.format(n)}="urn:x:{n}"/>' for n in range(31_000))
    data = cameras().replace(b"<library_cameras>", f"<library_nodes>{content}"
                             "</library_nodes><library_cameras>".encode())  # fmt: skip
    assert thinning.thinned(data) is None
    assert judge(data).accepted is spelling.startswith("xmlns")


def test_contents_that_neighbours_do_not_tell() -> None:
    accepted = [agreed(data) for data in with_lenses_added()]
    assert 0 < sum(accepted) < len(accepted)


def test_most_valid_documents_are_accepted() -> None:
    accepted = [agreed(data) for data in covering_documents()]
    assert sum(accepted) > 0.9 * len(accepted)


def _first_only(ranges: Any, _: object) -> Any:
    return np.zeros(min(len(ranges), 1), np.int64)


def _any_width(ranges: Any, _: object) -> Any:
    return _plain_numbers_of(ranges, None)


def _no_neighbours(rows: Any, *_: object) -> Any:
    return rows[:1]


_plain_numbers_of = sure.plain_numbers_of


@pytest.mark.parametrize(
    ("home", "name", "fault"),
    [
        (thinning, "_ids_are_unique", lambda *_: True),
        (thinning, "_characters_are_legal", lambda *_: True),
        (thinning, "unsure", _first_only),
        (sure, "plain_numbers_of", _any_width),
        (closings, "_blanks_only", lambda *_: None),
        (closings.Closings, "check", lambda *_: None),
        (paths, "_examples", _no_neighbours),
        (thinning.Declarations, "is_local", lambda *_: True),
    ],
)
def test_planted_faults_are_found(
    home: Any, name: str, fault: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search that finds nothing above does find what is wrong."""
    monkeypatch.setattr(home, name, fault)
    edits = map(planted, range(20_000)) if name != "is_local" else with_lenses_added()
    assert any(judge(data).accepted and refused(data) for data in edits), (
        f"no edit shows that {name} is wrong"
    )


@pytest.mark.parametrize("name", KINDS)
def test_columns_that_were_read_on_the_way_are_those_of_the_document(name: str) -> None:
    data = KINDS[name].document(40)
    columns = judge(data).columns
    assert columns is not None
    again = Document.of(data)
    assert columns._codes == again._codes
    assert np.array_equal(columns.index.codes, again.index.codes)
    assert columns.place(len(again.index) - 1) == again.place(len(again.index) - 1)

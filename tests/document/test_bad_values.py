"""Whatever a document says, reading, decoding, loading and writing raise only ColladaError."""

from __future__ import annotations

import io
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.mapper.documents import simple

import colladaphy
from colladaphy.testing import documents, mutants, worlds

TEXTS = [
    *["1e", "2.5E+", "-1e-", "1E 2e", "NaN", "INF", "-INF", "1e400", "-1e400", "1e-400", ""],
    *["0", "-0", "-1", "5e-324", "1.7e308", "9" * 20, "true", "1 2 3", "#x", " 1 ", "x", "\u0661"],
]


@st.composite
def worlds_with_other_texts(draw: st.DrawFn) -> bytes:
    """What a World is stored as, with some numbers, names or references exchanged."""
    stream = io.BytesIO()
    colladaphy.write(draw(worlds(min_bodies=0)), stream)
    root = etree.fromstring(stream.getvalue())
    elements = list(root.iter(etree.Element))
    leaves = [element for element in elements if not len(element) and (element.text or "").strip()]
    holders = [element for element in elements if element.attrib]
    for _ in range(draw(st.integers(1, 4))):
        text = draw(st.sampled_from(TEXTS))
        if draw(st.booleans()):
            element = draw(st.sampled_from(leaves))
            words = (element.text or "").split()
            words[draw(st.integers(0, len(words) - 1))] = text
            element.text = " ".join(words)
        else:
            element = draw(st.sampled_from(holders))
            element.set(draw(st.sampled_from(sorted(element.keys()))), text)
    return etree.tostring(root)


def attempt(action: Any) -> None:
    try:
        action()
    except colladaphy.ColladaError as error:
        assert error.findings
        assert all(finding.code and finding.message for finding in error.findings)


def use_every_way(data: bytes) -> None:
    for repair in (False, True):
        try:
            document = colladaphy.read(data, repair=repair)
        except colladaphy.ColladaError as error:
            assert error.findings
            continue
        attempt(document.load)
        attempt(lambda document=document: document.root)
        attempt(document.load)
        attempt(lambda document=document: document.load(prefer="common", si=True, up_axis="X_UP"))
        attempt(lambda document=document: document.load(prefer="profile"))
        attempt(lambda document=document: [list(scene.models) for scene in document.scenes])
        stream = io.BytesIO()
        attempt(lambda document=document, stream=stream: document.write(stream))
        if stream.getvalue():
            schema = [
                finding
                for finding in colladaphy.validate(stream.getvalue())
                if finding.stage == "schema"
            ]
            assert not schema


@settings(max_examples=40)
@given(worlds_with_other_texts())
def test_stored_worlds_with_other_texts(data: bytes) -> None:
    use_every_way(data)


@settings(max_examples=25)
@given(mutants() | mutants(areas=["physics"]))
def test_mutants(data: bytes) -> None:
    use_every_way(data)


@settings(max_examples=25)
@given(documents() | documents(areas=["physics"]))
def test_documents(data: bytes) -> None:
    use_every_way(data)


@pytest.mark.parametrize("way", ["root", "load", "scene", "model", "write"])
@pytest.mark.parametrize("number", ["1e", "2.5E+"])
def test_a_number_without_its_exponent(number: str, way: str) -> None:
    """libxml2 takes it for valid, so that whoever reads the number has to refuse it."""
    data = simple().replace(b"<radius>1</radius>", f"<radius>\n{number}</radius>".encode())
    document = colladaphy.read(data)
    scene = document.scenes[0]
    ways: dict[str, Any] = {
        "root": lambda: document.root,
        "load": document.load,
        "scene": scene.load,
        "model": scene.models[0].load,
        "write": lambda: document.write(io.BytesIO()),
    }
    with pytest.raises(colladaphy.SchemaError) as caught:
        ways[way]()
    (finding,) = caught.value.findings
    assert finding.code == "schema-invalid-value"
    assert finding.path is not None and finding.path.endswith("/radius")
    assert finding.line and finding.hint and number in finding.message


def with_unit(meter: str) -> bytes:
    data = simple().replace(b"<up_axis>", f'<unit meter="{meter}" name="u"/><up_axis>'.encode())
    assert b"<unit" in data
    return data


def test_a_unit_without_its_exponent() -> None:
    data = with_unit("1e")
    with pytest.raises(colladaphy.SchemaError):
        _ = colladaphy.read(data).unit


@pytest.mark.parametrize("value", ["heavy", None, object(), float("nan")])
def test_edits_that_no_document_can_hold(value: Any) -> None:
    document = colladaphy.read(with_unit("1"))
    document.root.asset.unit.meter = value
    attempt(lambda: document.write(io.BytesIO()))
    document = colladaphy.read(simple())
    document.root.asset.title = "a\0b"
    with pytest.raises(colladaphy.SchemaError):
        document.write(io.BytesIO())


def test_units_that_make_numbers_overflow() -> None:
    document = colladaphy.read(with_unit("1e200"))
    document.load()
    with pytest.raises(colladaphy.DocumentError) as caught:
        document.load(si=True)
    assert caught.value.findings[0].code == "load-conversion"


def test_a_unit_of_no_length() -> None:
    with pytest.raises(colladaphy.ColladaError):
        colladaphy.read(with_unit("0")).load(si=True)


def test_lists_in_an_extra_are_no_polygons() -> None:
    """What repair has moved out of the way, say."""
    stream = io.BytesIO()
    world = colladaphy.World()
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    world.create_mesh(1, (0, 0, 0), corners, faces, "iron")
    colladaphy.write(world, stream)
    extra = b"</p><extra><technique profile='x'><p xmlns='urn:x'/><p>x</p></technique></extra>"
    document = colladaphy.read(stream.getvalue().replace(b"</p>", extra))
    assert colladaphy.compare(document.load(), world) == []

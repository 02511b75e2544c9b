"""Rows made by hand: what they become, and what is refused."""

from __future__ import annotations

import itertools
import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from tests.columns.test_bindings import COLLADA

from colladaphy.columns import pieces
from colladaphy.columns.numbers import float_text, list_texts, texts_of
from colladaphy.columns.reading import Document
from colladaphy.columns.writing import document_bytes, document_chunks
from colladaphy.errors import SchemaError
from colladaphy.gate import is_valid_text
from colladaphy_schema.core_columns import (
    AssetTypeRows,
    AssetTypeUnitRows,
    RotateTypeRows,
    TechniqueTypeRows,
    TranslateTypeRows,
)
from colladaphy_schema.document_columns import ColladaRows
from colladaphy_schema.pe_columns import BodyRows
from colladaphy_schema.physics_columns import (
    LibraryPhysicsModelsTypeRows,
    PhysicsModelTypeRows,
    RigidBodyTypeRows,
    RigidBodyTypeTechniqueCommonRows,
    RigidBodyTypeTechniqueCommonShapeRows,
)
from colladaphy_schema.rows import Masked
from colladaphy_schema.scene_columns import (
    LibraryVisualScenesTypeRows,
    NodeTypeRows,
    VisualSceneTypeRows,
)

C = "{http://www.collada.org/2008/03/COLLADASchema}"
PE = "{urn:colladaphy:pe:1}"


def root() -> ColladaRows:
    """A document with nothing but what every one needs."""
    rows = ColladaRows(1)
    rows.version = ["1.5.0"]
    rows.asset = asset = AssetTypeRows(1)
    asset.created = asset.modified = ["1970-01-01T00:00:00Z"]
    return rows


def scene(count: int) -> tuple[ColladaRows, NodeTypeRows]:
    """A document with nodes."""
    rows = root()
    rows.library_visual_scenes = library = LibraryVisualScenesTypeRows(1)
    library.visual_scene = visual = VisualSceneTypeRows(1)
    visual.node = nodes = NodeTypeRows(count, np.zeros(count, np.int64))
    return rows, nodes


def parsed(rows: ColladaRows) -> etree._Element:
    text = document_bytes(rows)
    assert is_valid_text(text)
    assert b"".join(document_chunks(rows)) == text
    return etree.fromstring(text)


def test_the_least_document() -> None:
    assert document_bytes(root()) == (
        b'<?xml version="1.0" encoding="UTF-8"?>\n'
        b'<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">\n'
        b"<asset>\n<created>1970-01-01T00:00:00Z</created>\n"
        b"<modified>1970-01-01T00:00:00Z</modified>\n</asset>\n</COLLADA>\n"
    )


def test_every_node_has_a_line_of_its_own() -> None:
    rows, nodes = scene(2)
    nodes.id = ["a", None]
    nodes.translate = TranslateTypeRows(1, np.array([1]))
    nodes.translate.value = np.array([[1.0, 0.5, -0.0]])
    assert document_bytes(rows).decode().splitlines()[6:] == [
        "<library_visual_scenes>", "<visual_scene>", '<node id="a"/>',
        "<node><translate>1 0.5 -0</translate></node>", "</visual_scene>",
        "</library_visual_scenes>", "</COLLADA>",
    ]  # fmt: skip


def test_kinds_that_alternate_are_sorted_by_their_numbers() -> None:
    rows, nodes = scene(3)
    nodes.translate = moved = TranslateTypeRows(3, np.array([0, 0, 2]), order=np.array([1, 3, 9]))
    moved.value = np.arange(9.0).reshape(3, 3)
    nodes.rotate = turned = RotateTypeRows(3, np.array([0, 2, 2]), order=np.array([2, 8, 10]))
    turned.value = np.arange(12.0).reshape(3, 4)
    found = [[etree.QName(e).localname[0] for e in node] for node in parsed(rows).iter(C + "node")]
    assert found == [["t", "r", "t"], [], ["r", "t", "r"]]


def test_kinds_without_numbers_stand_in_the_order_of_the_schema() -> None:
    rows, nodes = scene(2)
    nodes.translate = TranslateTypeRows(2)
    nodes.translate.value = np.zeros((2, 3))
    nodes.rotate = RotateTypeRows(1, np.array([1]))
    nodes.rotate.value = np.zeros((1, 4))
    found = [[etree.QName(e).localname for e in node] for node in parsed(rows).iter(C + "node")]
    assert found == [["translate"], ["rotate", "translate"]]


orders = st.lists(st.tuples(st.integers(0, 4), st.booleans()), max_size=14)


@given(orders, st.integers(1, 40))
def test_any_order_of_two_kinds(items: list[tuple[int, bool]], heavy: int) -> None:
    """Every mixture, in blocks of any size."""
    items = sorted(items, key=lambda item: item[0])
    rows, nodes = scene(5)
    for kind, name, width in ((True, "translate", 3), (False, "rotate", 4)):
        mine = [place for place, item in enumerate(items) if item[1] is kind]
        owner = np.array([items[place][0] for place in mine], np.int64)
        made = (TranslateTypeRows if kind else RotateTypeRows)(
            len(mine), owner, order=np.array(mine, np.int64)
        )
        made.value = np.repeat(np.array(mine, np.float64)[:, None], width, axis=1)
        setattr(nodes, name, made)
    before = pieces._HEAVY
    pieces._HEAVY = heavy
    try:
        tree = parsed(rows)
    finally:
        pieces._HEAVY = before
    found = [
        (number, child.tag == C + "translate", float((child.text or "").split()[0]))
        for number, node in enumerate(tree.iter(C + "node"))
        for child in node
    ]
    assert found == [(owner, kind, place) for place, (owner, kind) in enumerate(items)]


def bodies(count: int) -> tuple[ColladaRows, RigidBodyTypeRows]:
    rows = root()
    rows.library_physics_models = library = LibraryPhysicsModelsTypeRows(1)
    library.physics_model = model = PhysicsModelTypeRows(1)
    model.rigid_body = body = RigidBodyTypeRows(count, np.zeros(count, np.int64))
    body.sid = [f"body{place}" for place in range(count)]
    body.technique_common = common = RigidBodyTypeTechniqueCommonRows(count)
    common.shape = RigidBodyTypeTechniqueCommonShapeRows(count)
    return rows, body


def test_the_profile_is_declared_where_it_begins() -> None:
    rows, body = bodies(2)
    body.technique = technique = TechniqueTypeRows(1, np.array([1]))
    technique.profile = ["pe"]
    technique.body = BodyRows(1)
    technique.body.uid = Masked(np.array([7]), np.array([True]))
    text = document_bytes(rows)
    assert text.count(b"xmlns:pe") == 1
    assert b'<technique profile="pe"><pe:body xmlns:pe="urn:colladaphy:pe:1" uid="7"/>' in text


def test_defaults_are_left_out_unless_they_were_stated() -> None:
    rows, nodes = scene(2)
    nodes.type = ["NODE", "JOINT"]
    assert b'<node/>\n<node type="JOINT"/>' in document_bytes(rows)
    unit = rows.asset.unit = AssetTypeUnitRows(1)
    unit.meter, unit.name = np.array([1.0]), ["meter"]
    assert b"<unit/>" in document_bytes(rows)
    text = document_bytes(rows).replace(b"<unit/>", b'<unit meter="1"/>')
    again = Document.of(text).rows(ColladaRows, COLLADA)
    assert document_bytes(again) == text


# --- what is refused


def broken(change: Any) -> ColladaRows:
    rows, body = bodies(2)
    change(rows, body)
    return rows


def set_to(name: str, value: Any) -> Any:
    return lambda rows, body: setattr(body, name, value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows, body: body.known.pop("sid"), "sid is missing: assign `sid`"),
        (set_to("sid", ["a"]), "has 1 values for 2 rows"),
        (set_to("sid", ["a", None]), "sid is missing in row 1"),
        (set_to("sid", ["a", 3]), "holds 3: its values are texts"),
        (set_to("name", ["a\x00", None]), "which no XML can hold"),
        (set_to("name", ["\ud800", None]), "which no XML can hold"),
        (lambda rows, body: body.known.pop("technique_common"), "technique_common is missing"),
        (set_to("technique_common", RigidBodyTypeTechniqueCommonRows(1, np.array([1]))),
         "technique_common is missing in row 0"),
        (set_to("technique_common", RigidBodyTypeTechniqueCommonRows(2, np.array([1, 1]))),
         "row 1 has more than one"),
        (set_to("technique", TechniqueTypeRows(2, np.array([1, 0]))), "owners that descend"),
        (set_to("technique", TechniqueTypeRows(1, np.array([2]))), "owners beyond the 2 rows"),
        (set_to("technique", TechniqueTypeRows(1, np.array([0, 1]))), "2 owners for 1 rows"),
        (set_to("technique", NodeTypeRows(2)), "it needs TechniqueTypeRows"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused(change: Any, message: str) -> None:
    with pytest.raises(SchemaError, match=message):
        document_bytes(broken(change))


def test_two_alternatives_of_a_choice_are_refused() -> None:
    from colladaphy_schema.geometry_columns import BoxTypeRows, SphereTypeRows

    rows, body = bodies(2)
    shape = body.technique_common.shape
    shape.sphere = SphereTypeRows(2)
    shape.sphere.radius = np.array([1.0, 2.0])
    assert is_valid_text(document_bytes(rows))
    shape.box = BoxTypeRows(1, np.array([1]))
    shape.box.half_extents = np.ones((1, 3))
    with pytest.raises(SchemaError, match="row 1: more than one of"):
        document_bytes(rows)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (np.zeros((1, 2)), r"it needs \(n, 3\)"),
        (np.zeros(3), r"it needs \(n, 3\)"),
        ([["a", "b", "c"]], "cannot be written"),
        (Masked(np.zeros((1, 3)), np.array([False])), "missing in row 0"),
    ],
)
def test_numbers_that_do_not_fit_are_refused(value: Any, message: str) -> None:
    rows, nodes = scene(1)
    nodes.translate = TranslateTypeRows(1)
    nodes.translate.value = value
    with pytest.raises(SchemaError, match=message):
        document_bytes(rows)


def test_one_root() -> None:
    with pytest.raises(SchemaError, match="one root"):
        document_bytes(ColladaRows(2))


# --- texts and numbers


@given(st.lists(st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"]) |
                        st.sampled_from("\t\n\r<>&\"' ")), min_size=1, max_size=6))  # fmt: skip
def test_every_text_is_read_as_it_was_written(names: list[str]) -> None:
    names = [name.replace("\ufffe", "").replace("\uffff", "") for name in names]
    rows, nodes = scene(len(names))
    nodes.name = list(names)
    tree = etree.fromstring(document_bytes(rows))
    assert [node.get("name") for node in tree.iter(C + "node")] == names


BITS = st.integers(0, 2**64 - 1).map(lambda bits: struct.unpack("<d", struct.pack("<Q", bits))[0])
ODD = st.sampled_from([0.0, -0.0, 5e-324, 1e16, 1e15, 1e-4, 9.999e-5, math.inf, -math.inf,
                       math.nan, 1e300, 123456789.0, 0.1])  # fmt: skip
NUMBERS = BITS | ODD | st.floats(-1e6, 1e6)


@given(
    st.integers(1, 5).flatmap(
        lambda width: st.lists(st.lists(NUMBERS, min_size=width, max_size=width), max_size=30)
    )
)
def test_numbers_are_written_as_repr_writes_them(rows: list[list[float]]) -> None:
    values = np.array(rows, np.float64) if rows else np.zeros((0, 3))
    expected = [" ".join(map(float_text, row)) for row in rows]
    assert texts_of(values) == expected
    for row, text in zip(rows, expected, strict=True):
        for value, word in zip(row, text.split(), strict=True):
            back = float(word)
            assert struct.pack("<d", back) == struct.pack("<d", value) or value != value != back
            assert not word.endswith(".0")


@given(st.lists(st.lists(NUMBERS, max_size=5), max_size=20))
def test_lists_of_any_lengths(rows: list[list[float]]) -> None:
    flat = np.array(list(itertools.chain.from_iterable(rows)), np.float64)
    counts = np.array([len(row) for row in rows], np.int64)
    assert list_texts(flat, counts) == [" ".join(map(float_text, row)) for row in rows]


@given(st.lists(st.integers(-(2**70), 2**70), min_size=1, max_size=9))
def test_integers_of_any_size(numbers: list[int]) -> None:
    try:
        values = np.array(numbers, np.int64)
    except OverflowError:
        values = np.array(numbers, object)
    assert list_texts(values, np.array([len(numbers)])) == [" ".join(map(str, numbers))]


def test_many_records_are_written_as_few_are() -> None:
    """Blocks of records are joined like single ones."""
    count = 5000
    rows, nodes = scene(count)
    nodes.id = [f"n{place}" for place in range(count)]
    nodes.translate = TranslateTypeRows(count)
    nodes.translate.value = values = np.random.default_rng(1).standard_normal((count, 3))
    tree = parsed(rows)
    found = [float(word) for e in tree.iter(C + "translate") for word in (e.text or "").split()]
    assert np.array_equal(np.array(found).reshape(-1, 3), values)


def test_many_kinds_that_alternate_in_one_record() -> None:
    """They are too many for one block, and come in no runs."""
    count = 9000
    rows, nodes = scene(1)
    owner = np.zeros(count, np.int64)
    nodes.translate = moved = TranslateTypeRows(count, owner, order=np.arange(count) * 2)
    moved.value = np.repeat(np.arange(count, dtype=np.float64)[:, None], 3, axis=1)
    nodes.rotate = turned = RotateTypeRows(count, owner, order=np.arange(count) * 2 + 1)
    turned.value = np.repeat(np.arange(count, dtype=np.float64)[:, None], 4, axis=1)
    (node,) = parsed(rows).iter(C + "node")
    expected = [text for number in range(count) for text in ([str(number)] * 3, [str(number)] * 4)]
    assert [(child.text or "").split() for child in node] == expected

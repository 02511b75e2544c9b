"""Documents of physics: all valid, nearly all with bodies, of every structure."""

from __future__ import annotations

import time
from collections import Counter
from functools import cache

import pytest
from hypothesis import strategies as st
from lxml import etree
from tests.testing.collecting import drawn, smallest

import colladaphy
from colladaphy.conform.grammar import NAMESPACE
from colladaphy.testing import documents, foreign_documents, mutants, physics_documents, worlds
from colladaphy.testing.changing.spelling import respelled

NS = {"c": NAMESPACE, "pe": "urn:colladaphy:pe:1"}
COUNT = 300


@cache
def many() -> list[bytes]:
    return drawn(physics_documents(), COUNT)


@cache
def loaded() -> list[tuple[int, set[str]]]:
    """How many bodies each of the documents loads, and what is said on the way."""
    found = []
    for data in many():
        document = colladaphy.read(data)
        bodies = len(document.load().bodies)
        found.append((bodies, {finding.code for finding in document.report}))
    return found


def test_all_are_valid_in_form_and_meaning() -> None:
    for data in many():
        report = colladaphy.validate(data)
        assert report.valid, (data, [str(finding) for finding in report])


def test_nearly_all_hold_bodies() -> None:
    assert sum(bodies > 0 for bodies, _ in loaded()) >= 0.95 * COUNT


STRUCTURES = {
    "nested model": "//c:physics_model/c:instance_physics_model",
    "model nested twice": "//c:physics_model[count(c:instance_physics_model) > 1]",
    "repeated model": "//c:physics_scene/c:instance_physics_model"
    "[@url = preceding-sibling::c:instance_physics_model/@url]",
    "shared body": "//c:instance_rigid_body"
    "[@body = preceding-sibling::c:instance_rigid_body/@body]",
    "parent": "//c:instance_physics_model/@parent",
    "instance_node": "//c:node/c:instance_node",
    "node in a library": "//c:library_nodes/c:node",
    "nested nodes": "//c:visual_scene//c:node/c:node",
    "lookat": "//c:node/c:lookat",
    "matrix": "//c:node/c:matrix",
    "mass at the instance": "//c:instance_rigid_body/c:technique_common/c:mass",
    "dynamic at the instance": "//c:instance_rigid_body/c:technique_common/c:dynamic",
    "inertia at the instance": "//c:instance_rigid_body/c:technique_common/c:inertia",
    "mass_frame at the instance": "//c:instance_rigid_body/c:technique_common/c:mass_frame",
    "shape at the instance": "//c:instance_rigid_body/c:technique_common/c:shape",
    "velocity": "//c:instance_rigid_body/c:technique_common/c:velocity",
    "constraint": "//c:instance_rigid_constraint",
    "constraint in a nested model": "//c:physics_model//c:instance_rigid_constraint",
    "spring": "//c:rigid_constraint//c:spring",
    "several scenes": "//c:physics_scene[2]",
    "several scenes in effect": "//c:scene/c:instance_physics_scene[2]",
    "inline material": "//c:shape/c:physics_material",
    "material of a library": "//c:shape/c:instance_physics_material",
    "density": "//c:shape/c:density",
    "hollow": "//c:shape/c:hollow",
    "mesh": "//c:shape/c:instance_geometry[substring(@url, 2) = //c:geometry[c:mesh]/@id]",
    "convex mesh": "//c:geometry/c:convex_mesh[c:source]",
    "hull": "//c:geometry/c:convex_mesh[@convex_hull_of]",
    "polylist": "//c:polylist",
    "polygons": "//c:polygons",
    "stride": "//c:accessor[@stride > 3]",
    "offset": "//c:accessor[@offset]",
    "profile": "//c:technique[@profile = 'pe']//pe:body",
    "other technique": "//c:technique[@profile = 'other']",
    "extra": "//c:extra[@type = 'note']",
    "comment": "//comment()",
    "instruction": "//processing-instruction()",
    "comment in a number": "//*[comment() and normalize-space(text()[last()]) != '']",
    "kinematics": "//c:library_kinematics_models",
    "unit": "//c:asset/c:unit[@meter != 1]",
    "axis": "//c:asset/c:up_axis[. != 'Z_UP']",
    **{form: f"//c:shape/c:{form}" for form in ("sphere", "box", "capsule", "cylinder", "plane")},
}


def test_every_structure_occurs() -> None:
    counts: Counter[str] = Counter()
    for data in many():
        root = etree.fromstring(data)
        counts.update(name for name, path in STRUCTURES.items() if root.xpath(path, namespaces=NS))
    assert {name for name in STRUCTURES if counts[name] == 0} == set()


SPELLINGS = {
    "utf-16": lambda data: data.startswith((b"\xff\xfe", b"\xfe\xff")),
    "latin-1": lambda data: b"iso-8859-1" in data[:80].lower(),
    "mark": lambda data: data.startswith(b"\xef\xbb\xbf"),
    "prefix": lambda data: b"<c:COLLADA" in data,
    "characters": lambda data: b"<![CDATA[" in data,
    "exponent": lambda data: b"e-" in data,
    "no ascii": lambda data: "Kö".encode() in data or "λ".encode() in data,
}


def test_every_spelling_occurs() -> None:
    found = {name for data in many() for name, is_so in SPELLINGS.items() if is_so(data)}
    assert SPELLINGS.keys() - found == set()


@pytest.mark.parametrize(
    "style", ["plus", "short", "zeros", "bare", "exponent", "shifted", "capital", "mixed"]
)
def test_numbers_are_spelled_otherwise(style: str) -> None:
    text = "0.5 2 -3.25 40"
    made = respelled(text, style)
    assert made != text
    assert [float(word) for word in made.split()] == [float(word) for word in text.split()]


def test_profiles_are_fresh_and_stale() -> None:
    stale = {"profile-old-value", "profile-not-understood"}
    profiles = [b"urn:colladaphy:pe:1" in data for data in many()]
    said = [bool(codes & stale) for _, codes in loaded()]
    assert any(said)
    assert sum(profiles) > sum(said) + 10


def test_profiles_and_oddities_can_be_left_out() -> None:
    for data in drawn(physics_documents(profiles=False, oddities=False), 60):
        assert b"urn:colladaphy:pe:1" not in data
        assert data.startswith(b'<?xml version="1.0" encoding="utf-8"?>\n<COLLADA xmlns=')
        assert b"<extra" not in data
        assert b"<!--" not in data


def lines(data: bytes) -> int:
    """How many lines a document has, one an element."""
    root = etree.fromstring(data)
    etree.indent(root)
    return len(etree.tostring(root).splitlines())


def test_the_simplest_document_is_one_body() -> None:
    data = smallest(physics_documents(), lambda data: True)
    assert len(colladaphy.read(data).load().bodies) == 1
    assert lines(data) <= 42


@pytest.mark.parametrize(
    ("name", "most"),
    [("nested model", 90), ("constraint", 80), ("instance_node", 90)],
)
def test_failing_documents_are_short(name: str, most: int) -> None:
    def has(data: bytes) -> bool:
        return bool(etree.fromstring(data).xpath(STRUCTURES[name], namespaces=NS))

    data = smallest(physics_documents(), has)
    assert lines(data) <= most, data.decode()


FAST = {
    "worlds": (worlds(), 0.05),
    "extreme worlds": (worlds(extreme=True), 0.05),
    "planar worlds": (worlds(planar=True), 0.05),
    "physics": (physics_documents(), 0.05),
    "foreign": (foreign_documents(), 0.05),
    "documents": (documents(), 0.1),
    "mutants": (mutants(), 0.1),
}


@pytest.mark.parametrize("name", FAST)
def test_strategies_are_fast(name: str) -> None:
    """In seconds of the processor, ten times below what hypothesis complains of."""
    strategy: st.SearchStrategy[object]
    strategy, most = FAST[name]
    drawn(strategy, 5)  # what is made once is made now
    start = time.process_time()
    drawn(strategy, 60)
    assert (time.process_time() - start) / 60 < most

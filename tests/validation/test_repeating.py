"""Faults of form of very large documents are those that a tree of all of it shows."""

from __future__ import annotations

import io
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.columns.test_accepting import planted

import colladaphy
from colladaphy.columns.reading import Document
from colladaphy.columns.thinning import thinned
from colladaphy.findings import Finding
from colladaphy.gate.faults import violations
from colladaphy.gate.numerals import incomplete_violations
from colladaphy.meaning.hits import findings_of
from colladaphy.source import Limits, load
from colladaphy.source.xml import parse_bytes
from colladaphy.validation.copies import Copy
from colladaphy.validation.repeating import check_rest
from colladaphy.validation.schema_stage import schema_hits
from colladaphy.world import World


def by_tree(data: bytes) -> list[Finding]:
    tree = parse_bytes(data, None, Limits())
    first = violations(tree, fresh=True) + incomplete_violations(tree, data)
    return findings_of(Document.of(data, tree), None, schema_hits(Copy.of(tree), first))


def by_rest(data: bytes) -> list[Finding]:
    """Without what the other does not say: the repairs, and that the document is large."""
    found = thinned(data)
    told = [] if found is None else check_rest(found, load(data, Limits()), Limits())
    return [replace(finding, repair=None) for finding in told if finding.code != "schema-large"]


def agreed(data: bytes) -> bool:
    """Whether anything was told; it has to be the same."""
    told = by_rest(data)
    if told:
        assert told == by_tree(data)
    return bool(told)


@given(st.integers(0, 10**9))
def test_what_is_left_tells_all_faults(number: int) -> None:
    agreed(planted(number))


def test_most_faults_are_told_by_what_is_left() -> None:
    told = [agreed(planted(number)) for number in range(150)]
    assert sum(told) > 10


def spheres(count: int) -> str:
    world = World()
    for number in range(count):
        world.create_sphere(number, (0, 0, number), 1 + number / count, "iron")
    target = io.BytesIO()
    colladaphy.write(world, target)
    return target.getvalue().decode()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("<sphere><radius>1.5</radius>", "<sphere><radius>x1.5</radius>", True),
        ("<sphere><radius>1.5</radius>", "<sphere><wrong/><radius>1.5</radius>", True),
        # The others of the path could be as faulty as the one that is left of them.
        ("<sphere><radius>1.5</radius>", "<sphere>", False),
    ],
)
def test_structure_that_repeats_is_left_to_a_tree(old: str, new: str, told: bool) -> None:
    text = spheres(400)
    assert text.count(old) == 1
    assert agreed(text.replace(old, new).encode()) is told


def test_very_large_documents(monkeypatch: pytest.MonkeyPatch) -> None:
    text = spheres(400)
    data = text.replace("<sphere><radius>1.5</radius>", "<sphere><radius>x</radius>").encode()
    monkeypatch.setattr("colladaphy.validation.stages.HUGE", len(data))
    monkeypatch.setattr("colladaphy.validation.stages.parse_loaded", None)  # no tree is made
    large, found = colladaphy.validate(data)
    assert large.code == "schema-large"
    assert (found.code, found.repair) == ("schema-invalid-value", "repair-unreadable-value")
    assert found.line == data[: data.index(b"<radius>x")].count(b"\n") + 1
    assert found.path is not None
    assert found.path.endswith("rigid_body[201]/technique_common/shape/sphere/radius")

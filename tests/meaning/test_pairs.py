"""Two edits of one document: what is wrong twice is told twice, and near misses stay such."""

from __future__ import annotations

import random
from difflib import SequenceMatcher
from itertools import combinations, pairwise
from pathlib import Path

import pytest
from tests.meaning.test_cases import BASES, FAULTS, NEAR, Case

import colladaphy

CASES: dict[str, Case] = {each.values[0].name: each.values[0] for each in [*NEAR, *FAULTS]}
TOLD_TWICE = (
    # Keeping another velocity has nothing to do with whose a node is, or with where it stands.
    ("an old velocity", "a node that is another body's, and stands elsewhere"),
    ("an old target of a spring", "a node that was moved away from its joint"),
    ("limits that are others, below and above", "a node that was moved away from its joint"),
    ("a body that the profile fixes", "a shape more than is kept, with a mass"),
    (
        "a body that the profile fixes",
        "a mass of zero of a shape, where another one of the body is kept",
    ),
    # Channels of one animation move at a time, whatever clip is not there.
    (
        "two channels of one target",
        "the animation of a clip is not there, and moves what another does",
    ),
    ("an animation of a number by keys of three", "no interpolation"),
    ("one value for a translation", "no interpolation"),
    ("an animation of a number by keys of three", "times that are positions"),
    ("a set that the mesh lacks", "index of a normal out of range"),
)  # fmt: skip
"""Faults of elements that have to do with one another, but of which neither is the cause."""
COMPARING = {
    "animation-morph-targets", "animation-skin-count", "asset-inner-axis", "geometry-inward",
    "geometry-open", "link-body-not-instanced", "link-body-twice", "link-missing",
    "physics-bodies-nested", "physics-frames-turned", "physics-joint-fixed",
    "physics-several-gravities", "profile-old-value", "schema-duplicate-id",
}  # fmt: skip
"""Rules that compare what stands in two places: edits of both may well make a fault together."""


def _hunks(case: Case) -> list[tuple[int, int, list[str]]]:
    """The lines of the base that a case replaces, and by what."""
    old = BASES[case.base].read_text("utf-8").split("\n")
    new = case.text().split("\n")
    return [(begin, end, new[first:last])
            for kind, begin, end, first, last
            in SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
            if kind != "equal"]  # fmt: skip


def _both(*cases: Case) -> str | None:
    """The base after the edits of all, unless they are of the same lines, or of adjacent ones."""
    hunks = sorted(hunk for case in cases for hunk in _hunks(case))
    if any(end >= begin for (_, end, _), (begin, _, _) in pairwise(hunks)):
        return None
    lines = BASES[cases[0].base].read_text("utf-8").split("\n")
    for begin, end, new in reversed(hunks):
        lines[begin:end] = new
    return "\n".join(lines)


def _codes(text: str, folder: Path) -> list[str]:
    path = folder / "case.dae"
    path.write_text(text, "utf-8")
    (folder / "wood.png").touch()
    return sorted(finding.code for finding in colladaphy.validate(path))


@pytest.mark.parametrize(("one", "other"), TOLD_TWICE)
def test_two_faults_are_two_findings(one: str, other: str, tmp_path: Path) -> None:
    cases = CASES[one], CASES[other]
    text = _both(*cases)
    assert text is not None
    assert _codes(text, tmp_path) == sorted(case.rule for case in cases)


def test_a_node_of_a_scene_that_is_not_shown_is_not_what_an_instance_meant(tmp_path: Path) -> None:
    text = CASES["a body of a node of another visual scene"].text()
    lost = text.replace('url="#lent"', 'url="#model"')
    assert _codes(lost, tmp_path) == ["link-node-nowhere", "link-wrong-type"]


def test_a_node_of_the_library_is_shown_by_the_name_of_the_file(tmp_path: Path) -> None:
    text = _both(CASES["a body of a library node in one place"], CASES["this file"])
    assert text is not None
    assert _codes(text, tmp_path) == []
    other = text.replace("case.dae#lent", "elsewhere/case.dae#lent")
    assert "link-node-nowhere" in _codes(other, tmp_path)


def test_two_near_misses_are_no_fault(tmp_path: Path) -> None:
    near = [parameter.values[0] for parameter in NEAR]
    pairs = [pair for pair in combinations(near, 2) if pair[0].base == pair[1].base]
    tried = 0
    for pair in random.Random(20).sample(pairs, 220):
        text = _both(*pair)
        if text is None:
            continue
        tried += 1
        found = set(_codes(text, tmp_path)) - COMPARING
        assert not found, (found, [case.name for case in pair])
    assert tried > 100

"""Every real file becomes valid, keeps its physics, and is left alone the second time."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from colladaphy.conform import conform
from colladaphy.conform.context import standard_elements
from colladaphy.gate import gate

CORPUS = Path(__file__).resolve().parents[3] / "shared" / "corpus"
MALFORMED = "colladatools-simple-arm-hostile.dae"
FILES = sorted(path.name for path in CORPUS.glob("*.dae") if path.name != MALFORMED)


@pytest.mark.parametrize("name", FILES)
def test_every_file_becomes_valid_and_stays_as_it_is(name: str, corpus_dir: Path) -> None:
    tree = etree.parse(str(corpus_dir / name))
    before = etree.tostring(tree)
    result, findings = conform(tree, file=name)
    assert etree.tostring(tree) == before
    assert gate(result) == []
    assert findings
    again, more = conform(result)
    assert more == []
    assert etree.tostring(again) == etree.tostring(result)


COUNTED = (
    "rigid_body", "shape", "rigid_constraint", "physics_material", "physics_model",
    "physics_scene", "instance_rigid_body", "instance_physics_model", "instance_physics_material",
    "instance_rigid_constraint", "gravity", "time_step", "mass_frame", "density", "velocity",
)  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_no_physics_is_lost_or_invented(
    name: str, corpus_dir: Path, corpus_facts: dict[str, Any]
) -> None:
    tree = etree.parse(str(corpus_dir / name))
    result, findings = conform(tree, file=name)
    found = Counter(
        etree.QName(element).localname for element in standard_elements(result.getroot())
    )
    codes = Counter(finding.code for finding in findings)
    for kind in COUNTED:
        expected = corpus_facts[name]["counts"].get(kind, 0)
        if kind == "mass_frame":  # Bullet's bodies get one, with a finding that counts them
            expected += sum(
                int(finding.message.split(" of ")[2].split()[0])
                for finding in findings
                if finding.code == "convention-mass-centre"
            )
        if kind == "shape":  # an assumed shape is a finding; so is an empty one that went
            expected += codes["repair-missing-shape"] - codes["repair-empty-shape"]
        assert found[kind] == expected, kind


@pytest.mark.parametrize("name", FILES)
def test_what_is_not_physics_survives(name: str, corpus_dir: Path) -> None:
    tree = etree.parse(str(corpus_dir / name))
    result, _ = conform(tree, file=name)
    before = words_of(tree.getroot())
    after = words_of(result.getroot())
    assert not before - after


def words_of(root: etree._Element) -> Counter[str]:
    """Every visible word of a document's arrays and of its users' own techniques."""
    words: Counter[str] = Counter()
    for element in root.iter(etree.Element):
        if etree.QName(element).localname in ("float_array", "p", "v", "vcount", "Name_array"):
            words.update((element.text or "").split())
    return words

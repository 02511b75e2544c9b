"""Every real file of the corpus: in by the door, to a World, out again, with nothing uncounted."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from tests.producers.checking import accept, faults, words_outside

import colladaphy
from colladaphy.cli import run
from colladaphy.errors import XmlError

CORPUS = Path(__file__).resolve().parents[3] / "shared" / "corpus"
MALFORMED = "colladatools-simple-arm-hostile.dae"
FILES = sorted(path.name for path in CORPUS.glob("*.dae") if path.name != MALFORMED)
# Bodies whose only shape is not in the file, or has no extent, and that state no inertia.
SKIPPED = {"chimera-nivel1-extra.dae": 3, "bullet-jenga.dae": 3}
# Links with neither shape nor mass, which are frames of reference.
FRAMES = {
    "openrave-baxter-arm-left.dae": 1,
    "openrave-baxter-arm-right.dae": 1,
    "urdf-kr10.dae": 3,
}
# Joints of kinematics; those that fix a mere frame of reference bind nothing.
KINEMATIC = {
    "openrave-baxter-arm-left.dae": 10,
    "openrave-baxter-arm-right.dae": 10,
    "urdf-kr10.dae": 7,
}
COUNTED = (
    "instance_rigid_body", "instance_rigid_constraint", "physics_material", "physics_model",
    "physics_scene", "rigid_body", "rigid_constraint", "shape",
)  # fmt: skip


def test_the_corpus_is_what_the_facts_describe(corpus_facts: dict[str, Any]) -> None:
    assert sorted([*FILES, MALFORMED]) == sorted(corpus_facts)


@pytest.mark.parametrize("name", FILES)
def test_every_way_leads_to_the_same_world(name: str, corpus_dir: Path) -> None:
    accept((corpus_dir / name).read_bytes())


@pytest.mark.parametrize("name", FILES)
def test_every_body_is_loaded_or_reported(
    name: str, corpus_dir: Path, corpus_facts: dict[str, Any]
) -> None:
    document = colladaphy.read(corpus_dir / name, repair=True)
    world = document.load()
    counts = corpus_facts[name]["counts"]
    found = Counter(finding.code for finding in document.report)
    skipped = sum(found[f"load-{why}"] for why in ("empty-shape", "no-geometry", "bad-value"))
    assert skipped == SKIPPED.get(name, 0)
    assert found["load-no-body"] == FRAMES.get(name, 0)
    assert len(world.bodies) + skipped + FRAMES.get(name, 0) == counts["instance_rigid_body"]
    joints = counts.get("instance_rigid_constraint", 0) + KINEMATIC.get(name, 0)
    lost = found["load-constraint-skipped"] + found["load-constraint-faulty"]
    assert len(world.joints) + lost == joints


@pytest.mark.parametrize("name", FILES)
def test_the_facts_of_info_are_those_of_the_corpus(
    name: str, corpus_dir: Path, corpus_facts: dict[str, Any], capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(["info", "--format", "json", str(corpus_dir / name)]) == 0
    facts = json.loads(capfd.readouterr().out)
    meant = corpus_facts[name]
    counts = meant["counts"]
    assert facts["version"] == meant["version"]
    for kind in COUNTED:
        assert facts["document"][kind] == counts.get(kind, 0), kind
    shapes = dict(meant["shapes"])
    shapes.pop("(none)", None)  # a mesh in a shape, which 1.4 does not have either
    assert {k: v for k, v in facts["document"]["shapes"].items() if k != "mesh"} == shapes


@pytest.mark.parametrize("name", FILES)
def test_the_command_line_converts_to_valid_files(
    name: str, corpus_dir: Path, tmp_path: Path
) -> None:
    target = tmp_path / "out.dae"
    assert run(["convert", str(corpus_dir / name), str(target)]) == 0
    found = faults(target.read_bytes())
    assert not found, found
    assert run(["validate", str(target)]) == int(not colladaphy.validate(target).valid)
    assert not words_outside((corpus_dir / name).read_bytes()) - words_outside(target.read_bytes())
    before = target.read_bytes()
    assert run(["repair", str(target), "--in-place"]) == 0
    assert target.read_bytes() == before


def test_the_malformed_file_is_refused_with_its_place(corpus_dir: Path) -> None:
    with pytest.raises(XmlError) as caught:
        colladaphy.read(corpus_dir / MALFORMED, repair=True)
    (finding,) = caught.value.findings
    assert finding.code == "xml-malformed"
    assert finding.line == 68

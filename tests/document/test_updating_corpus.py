"""Real files with their Worlds written back into them: nothing is lost, and nothing is inexact."""

from __future__ import annotations

import io
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from lxml import etree
from tests.conftest import CORPUS

import colladaphy
from colladaphy.document import Document
from colladaphy.world import World, compare

NS = "http://www.collada.org/2008/03/COLLADASchema"
# One file is no XML at all, which is what it is there for.
FILES = sorted(path.name for path in CORPUS.glob("*.dae") if "hostile" not in path.name)
FILES = FILES or ["the corpus"]


def reread(document: Document) -> Document:
    file = io.BytesIO()
    document.write(file, check=False)
    return colladaphy.read(file.getvalue())


def elements(document: Document) -> Counter[str]:
    return Counter(str(element.tag) for element in document.tree.iter(etree.Element))


def disturbed(world: World, seed: int) -> World:
    """The World with everything that can move elsewhere, and moving."""
    chance = np.random.default_rng(seed)
    for body in world.bodies:
        if not body.fixed:
            body.position = np.asarray(body.position) + chance.normal(size=3)
            body.rotate(*chance.normal(size=3))
            body.linear_velocity, body.angular_velocity = chance.normal(size=(2, 3))
    world.time, world.step_count = 1.5, 360
    return world


@pytest.mark.parametrize("name", FILES)
def test_worlds_of_real_files_read_back(corpus_dir: Path, name: str) -> None:
    document = colladaphy.read(corpus_dir / name, repair=True)
    world = document.load()
    before, known = elements(document), len(document.report)
    for seed in range(2):
        document.update(disturbed(world, seed))
    again = reread(document)
    assert compare(again.load(), world) == []
    noticed = {finding.code for finding in document.report.findings[known:]}
    assert "store-inexact" not in noticed
    # Nodes are moved by other steps, and that is all.
    steps = {f"{{{NS}}}{step}" for step in ("translate", "rotate", "scale", "matrix", "node")}
    lost = {tag: count for tag, count in (before - elements(again)).items() if tag not in steps}
    assert lost == {}


@pytest.mark.parametrize("name", FILES)
def test_what_is_seen_keeps_its_place_beside_the_body(corpus_dir: Path, name: str) -> None:
    """Without the exact poses of the profile, the nodes alone say where bodies are."""
    document = colladaphy.read(corpus_dir / name, repair=True)
    world = disturbed(document.load(), 1)
    document.update(world)
    again = reread(document).load(prefer="common")
    for body, other in zip(world.bodies, again.bodies, strict=True):
        scale = 1.0 + float(np.max(np.abs(body.position)))
        assert np.allclose(body.position, other.position, rtol=0, atol=1e-9 * scale)
        assert abs(np.dot(body.orientation, other.orientation)) == pytest.approx(1.0)


@pytest.mark.parametrize("name", FILES)
def test_bodies_of_real_files_come_and_go(corpus_dir: Path, name: str) -> None:
    document = colladaphy.read(corpus_dir / name, repair=True)
    world = document.load()
    if len(world.bodies) > 1 and not len(world.joints):
        world.destroy(world.bodies[0])
    world.create_box(5, (1, 2, 3), (1, 1, 1), "iron", name="added")
    world.masses[-2:] *= 2.0
    document.update(world)
    assert compare(reread(document).load(), world) == []
    assert "store-inexact" not in {finding.code for finding in document.report}


def test_a_kinematic_joint_that_is_gone_stays_so(corpus_dir: Path) -> None:
    """The kinematics are taken out of effect, and the other joints are constraints."""
    document = colladaphy.read(corpus_dir / "urdf-kr10.dae", repair=True)
    world = document.load()
    world.destroy_joint(world.joints[2])
    document.update(world)
    assert compare(reread(document).load(), world) == []
    assert "store-inexact" not in {finding.code for finding in document.report}

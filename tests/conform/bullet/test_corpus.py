"""Real files go to Bullet whole, and to readers of 1.4.1 valid."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree
from tests.conform.bullet import bullet_reader
from tests.conftest import CORPUS

from colladaphy.conform import conform
from colladaphy.conform.exporting import export

HOSTILE = "colladatools-simple-arm-hostile.dae"  # it is not well-formed
FILES = sorted(path.name for path in CORPUS.glob("*.dae") if path.name != HOSTILE)


def test_the_model_of_bullet_reads_what_bullet_reads(corpus_dir: Path) -> None:
    """Of the 73 bodies of this file Bullet itself loads 67."""
    world = bullet_reader.read((corpus_dir / "bullet-jenga.dae").read_bytes())
    assert len(world.bodies) == 67
    assert len(world.lost) == 6


@pytest.mark.parametrize("name", FILES)
def test_real_files(name: str, corpus_dir: Path) -> None:
    tree, _ = conform(etree.parse(corpus_dir / name))
    export(tree, "collada-1.4")
    data, findings = export(tree, "bullet")
    world = bullet_reader.read(data)
    left_out = [f for f in findings if f.code.endswith(("bullet-no-shape", "bullet-no-body"))]
    users = tree.getroot().findall(".//{*}physics_scene//{*}instance_rigid_body")
    assert world.lost == []
    assert len(world.bodies) + len(left_out) == len(users)
    if name == "bullet-jenga.dae":
        assert len(world.bodies) == 73

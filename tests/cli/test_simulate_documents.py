"""``colladaphy simulate`` on documents that hold more than a World: all of it is in OUT."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from lxml import etree
from tests.conftest import CORPUS

import colladaphy
from colladaphy.cli import run
from colladaphy.engines import Checkpoints
from colladaphy.world import World, compare

NS = "{http://www.collada.org/2008/03/COLLADASchema}"


def visual_files() -> list[str]:
    """The files of the corpus that show something; one is no XML at all, for other tests."""
    found = sorted(
        path.name
        for path in CORPUS.glob("*.dae")
        if "hostile" not in path.name and b"library_visual_scenes" in path.read_bytes()
    )
    return found or ["the corpus"]


def libraries(file: Path) -> Counter[str]:
    """The libraries of a document, and how much is in each of them."""
    root = etree.parse(str(file)).getroot()
    found: Counter[str] = Counter()
    for library in root.iterchildren("{*}*"):
        if str(library.tag).startswith(f"{NS}library_"):
            found[str(library.tag)] += len(list(library.iterchildren("{*}*")))
    return found


def world_of(file: Path) -> World:
    world: World = colladaphy.read(file).load()
    return world


@pytest.mark.parametrize("name", visual_files())
def test_every_library_of_the_document_is_in_the_result(
    corpus_dir: Path, tmp_path: Path, name: str
) -> None:
    source, target = tmp_path / "in.dae", tmp_path / "out.dae"
    assert run(["repair", str(corpus_dir / name), str(source)]) == 0
    arguments = ["simulate", str(source), str(target), "--steps", "2", "--engine", "mujoco"]
    assert run([*arguments, "--checkpoint-every", "1"]) == 0
    before = libraries(source)
    for file in (target, *Checkpoints(tmp_path / "in.checkpoints").paths()):
        assert before - libraries(file) == Counter()
    assert world_of(target).step_count == 2
    assert compare(world_of(target), world_of(tmp_path / "in.checkpoints" / target_name(2))) == []
    # Go on from the checkpoint: what was carried once is carried again.
    again = tmp_path / "again.dae"
    assert run([*arguments[:2], str(again), *arguments[3:], "--resume"]) == 0
    assert libraries(again) == libraries(target)
    assert compare(world_of(again), world_of(target)) == []
    assert run(["validate", str(target)]) == run(["validate", str(source)])


def target_name(step: int) -> str:
    return Checkpoints("").path(step).name

"""Checkpoints in a folder: names, rotation, what is whole and what is not."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy import document
from colladaphy.engines import Checkpoints, Simulation, read_checkpoint
from colladaphy.errors import ColladaError, EngineError, OutputError
from colladaphy.world import compare


def simulation() -> Simulation:
    return Simulation(SCENES["walker"](), "mujoco")


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_names_and_rotation(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path / "deep" / "er", keep=2)
    checkpoints.begin()
    run = simulation()
    run.run(50, checkpoints=checkpoints, checkpoint_every=10)
    assert names(checkpoints.folder) == [
        "checkpoint-000000000040.dae",
        "checkpoint-000000000050.dae",
    ]
    assert checkpoints.newest().path == checkpoints.path(50)
    assert compare(checkpoints.newest().world, run.world) == []


def test_checkpoints_are_valid_documents_that_anyone_can_read(tmp_path: Path) -> None:
    run = simulation()
    run.run(10)
    file = run.checkpoint(tmp_path / "a.dae")
    assert colladaphy.validate(file).valid
    assert compare(colladaphy.read(file).load(), run.world) == []


def test_another_runs_folder_is_refused(tmp_path: Path) -> None:
    simulation().checkpoint(Checkpoints(tmp_path))
    with pytest.raises(EngineError, match="engine-checkpoint-other-run"):
        Checkpoints(tmp_path).begin()


def test_keeping_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(EngineError, match="engine-steps"):
        Checkpoints(tmp_path, keep=0)


def test_the_newest_whole_one_is_found_and_the_others_reported(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path, keep=9)
    run = simulation()
    run.run(50, checkpoints=checkpoints, checkpoint_every=10)
    truncated, flipped = checkpoints.path(50), checkpoints.path(40)
    truncated.write_bytes(truncated.read_bytes()[:2000])
    text = flipped.read_text("utf-8")
    number = text.index("<velocity>") + len("<velocity>") + 3
    digit = next(i for i in range(number, len(text)) if text[i].isdigit() and text[i] != "9")
    flipped.write_text(text[:digit] + "9" + text[digit + 1 :], "utf-8")
    resumed = Simulation.resume(tmp_path)
    assert resumed.world.step_count == 30
    broken = [f for f in resumed.report if f.code == "engine-checkpoint-broken"]
    assert [Path(f.file or "").name for f in broken] == [truncated.name, flipped.name]
    assert "checksum" in broken[1].message
    with pytest.raises(EngineError, match="engine-checkpoint-broken"):
        Simulation.resume(truncated)


def test_no_checkpoint_is_whole(tmp_path: Path) -> None:
    with pytest.raises(EngineError, match="There is no checkpoint"):
        Simulation.resume(tmp_path)
    Checkpoints(tmp_path).path(7).write_bytes(b"")
    with pytest.raises(EngineError, match="No checkpoint is whole") as caught:
        Simulation.resume(tmp_path)
    assert len(caught.value.findings) == 2


def test_a_scene_is_no_checkpoint(tmp_path: Path) -> None:
    colladaphy.write(SCENES["walker"](), tmp_path / "a.dae")
    with pytest.raises(EngineError, match="engine-checkpoint-stateless"):
        read_checkpoint(tmp_path / "a.dae")


def test_rotation_removes_nothing_while_the_newest_cannot_be_read_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    checkpoints = Checkpoints(tmp_path, keep=1)
    run = simulation()
    run.checkpoint(checkpoints)
    run.run(10)
    write = document.write

    def write_badly(world: colladaphy.World, target: Path) -> None:
        write(world, target)
        target.write_bytes(target.read_bytes()[:-100])

    monkeypatch.setattr(document, "write", write_badly)
    with pytest.raises(EngineError, match="engine-checkpoint-broken"):
        run.checkpoint(checkpoints)
    monkeypatch.undo()
    assert Simulation.resume(tmp_path).world.step_count == 0
    run.checkpoint(checkpoints)
    assert names(tmp_path) == ["checkpoint-000000000010.dae"]


def test_rotation_leaves_broken_ones_that_are_newer(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path, keep=1)
    checkpoints.path(99).write_bytes(b"<COLLADA")
    run = simulation()
    run.run(20, checkpoints=checkpoints, checkpoint_every=10)
    assert checkpoints.newest().path == checkpoints.path(20)
    assert len(checkpoints.newest().findings) == 1


def test_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("mine")
    with pytest.raises(OutputError):
        simulation().checkpoint(Checkpoints(tmp_path / "x" / "y"))
    with pytest.raises(ColladaError):
        Checkpoints(tmp_path / "x").paths()


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, Simulation]:
    run = simulation()
    run.run(25)
    file = run.checkpoint(tmp_path_factory.mktemp("whole") / "a.dae")
    return file.read_bytes(), run


@settings(max_examples=40)
@given(data=st.data())
def test_damaged_files_are_the_old_state_or_a_clear_message(
    whole: tuple[bytes, Simulation], tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    """Truncated, bit-flipped, zeroed: never another World than the one that was written."""
    content, run = bytearray(whole[0]), whole[1]
    kind = data.draw(st.sampled_from(["truncate", "flip", "zero"]))
    place = data.draw(st.integers(0, len(content) - 1))
    if kind == "truncate":
        del content[place:]
    elif kind == "flip":
        content[place] ^= 1 << data.draw(st.integers(0, 7))
    else:
        content[place : place + 512] = bytes(len(content[place : place + 512]))
    file = tmp_path_factory.mktemp("damaged") / "a.dae"
    file.write_bytes(bytes(content))
    try:
        world = read_checkpoint(file)
    except EngineError as error:
        assert "a.dae" in str(error) and error.findings
    else:
        assert compare(world, run.world) == []

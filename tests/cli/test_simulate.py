"""``colladaphy simulate``: runs, results, checkpoints, interruption, exit codes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy.cli import run
from colladaphy.engines import Checkpoints, Simulation, create_engine
from colladaphy.world import World, compare

COMMAND = [sys.executable, "-c", "from colladaphy.cli import main; main()"]


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "scene.dae"
    colladaphy.write(SCENES["general"](), file)
    return file


def simulate(*arguments: object) -> int:
    return run(["simulate", *(str(argument) for argument in arguments)])


def result(file: Path) -> World:
    world: World = colladaphy.read(file).load()
    return world


def test_the_result_is_that_of_the_library(
    scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert simulate(scene, tmp_path / "out.dae", "--steps", 50, "--engine", "mujoco") == 0
    simulation = Simulation(result(scene), "mujoco")
    simulation.run(50)
    assert compare(result(tmp_path / "out.dae"), simulation.world) == []
    output = capsys.readouterr()
    assert "steps             50, up to 50" in output.out
    for what in ("engine            mujoco", "contacts", "kinetic energy", "momentum"):
        assert what in output.out
    assert "engine-joint-velocity" in output.err
    assert "\r" not in output.err  # no progress where nobody looks on
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.dae", scene.name]


def test_dt_and_standard_output(scene: Path, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    assert simulate(scene, "-", "--steps", 10, "--dt", 0.001) == 0
    world = colladaphy.read(capfdbinary.readouterr().out).load()
    assert world.time_step == 0.001 and world.step_count == 10


def test_resumed_run_is_the_run(scene: Path, tmp_path: Path) -> None:
    options = ("--checkpoint-every", 20, "--keep", 2)
    straight = ("--checkpoint-dir", tmp_path / "straight")
    assert simulate(scene, tmp_path / "a.dae", "--steps", 100, *options, *straight) == 0
    assert simulate(scene, "--steps", 60, *options) == 0
    assert len(Checkpoints(tmp_path / "scene.checkpoints").paths()) == 2
    assert simulate(scene, tmp_path / "b.dae", "--steps", 100, *options, "--resume") == 0
    assert (tmp_path / "a.dae").read_bytes() == (tmp_path / "b.dae").read_bytes()


def test_broken_checkpoints_are_passed_over_and_named(
    scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert simulate(scene, "--steps", 40, "--checkpoint-every", 20) == 0
    newest = Checkpoints(tmp_path / "scene.checkpoints").path(40)
    newest.write_bytes(newest.read_bytes()[:3000])
    assert simulate(scene, "--steps", 50, "--resume") == 0
    output = capsys.readouterr()
    assert "engine-checkpoint-broken" in output.err and newest.name in output.err
    assert "Resumed at step 20." in output.err
    for path in newest.parent.iterdir():
        path.write_bytes(b"<COLLADA/>")
    assert simulate(scene, "--steps", 50, "--resume") == 1
    assert "No checkpoint is whole" in capsys.readouterr().err


def test_another_scenes_checkpoints_are_noticed(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert simulate(scene, "--steps", 10, "--checkpoint-every", 10) == 0
    world = result(scene)
    world.masses[2] *= 2
    colladaphy.write(world, scene)
    assert simulate(scene, "--steps", 20, "--resume") == 0
    assert "IN is not the scene of this checkpoint" in capsys.readouterr().err


def test_wrong_usage_and_files(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulate(scene, "--steps", 10, "--checkpoint-every", 10) == 0
    assert simulate(scene, "--steps", 10, "--checkpoint-every", 10) == 2
    assert "--resume" in capsys.readouterr().err
    assert simulate(scene, "--resume", "--checkpoint-dir", "none") == 2
    assert "There is no checkpoint" in capsys.readouterr().err
    assert simulate("missing.dae") == 2
    assert simulate(scene, "--dt", 0) == 2
    assert simulate(scene, "--engine", "bullet") == 2
    assert simulate("-", "--resume") == 2
    assert simulate(scene, "no/such/folder/out.dae", "--steps", 1) == 2


def test_content_that_cannot_be_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = World(time_step=0.1)
    world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", mass=0.0)
    colladaphy.write(world, tmp_path / "a.dae")
    assert simulate(tmp_path / "a.dae", "--engine", "mujoco") == 1
    assert "engine-mass" in capsys.readouterr().err
    (tmp_path / "b.dae").write_text("<COLLADA")
    assert simulate(tmp_path / "b.dae") in (1, 2)


def test_trajectory_goes_on_where_it_was(scene: Path, tmp_path: Path) -> None:
    options = ("--checkpoint-every", 20, "--trajectory-every", 5)
    whole, parts = tmp_path / "whole.npz", tmp_path / "parts.npz"
    straight = ("--checkpoint-dir", tmp_path / "straight")
    assert simulate(scene, "--steps", 60, *options, "--trajectory", whole, *straight) == 0
    assert simulate(scene, "--steps", 30, *options, "--trajectory", parts) == 0
    assert simulate(scene, "--steps", 60, *options, "--trajectory", parts, "--resume") == 0
    with np.load(whole) as one, np.load(parts) as two:
        assert one["step_counts"].tolist() == list(range(0, 61, 5))
        assert sorted(one.files) == sorted(two.files)
        for name in one.files:
            np.testing.assert_array_equal(one[name], two[name])


def test_a_streamed_trajectory_goes_on_where_it_was(scene: Path, tmp_path: Path) -> None:
    zarr = pytest.importorskip("zarr")
    options = ("--checkpoint-every", 20, "--trajectory-every", 5)
    whole, parts = tmp_path / "whole.npz", tmp_path / "parts.zarr"
    straight = ("--checkpoint-dir", tmp_path / "straight")
    assert simulate(scene, "--steps", 60, *options, "--trajectory", whole, *straight) == 0
    assert simulate(scene, "--steps", 30, *options, "--trajectory", parts) == 0
    assert simulate(scene, "--steps", 60, *options, "--trajectory", parts, "--resume") == 0
    group = zarr.open_group(str(parts), mode="r")
    with np.load(whole) as one:
        assert group["step"][:].tolist() == one["step_counts"].tolist()
        np.testing.assert_array_equal(group["positions"][:], one["positions"])


def test_outputs_are_checked_before_the_run(
    scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    never = ("--steps", 10**9)  # a run that begins does not end
    (tmp_path / "folder").mkdir()
    for arguments, what in (
        ((tmp_path / "none" / "out.dae",), "There is no folder"),
        ((tmp_path / "folder",), "is a folder"),
        (("--trajectory", "motion.csv"), ".npz nor .zarr"),
        (("--trajectory", "none/motion.npz"), "There is no folder"),
        ((tmp_path / "out.npz", "--trajectory", "out.npz"), "another file"),
        (("--engine", "bullet"), "pymunk"),
        (("--engine-option", "solver=cg"), "--engine"),
        (("--engine", "mujoco", "--engine-option", "solver"), "KEY=VALUE"),
    ):
        assert simulate(scene, *arguments, *never) == 2, arguments
        assert what in " ".join(capsys.readouterr().err.split()), arguments
    assert simulate(scene, "--engine", "mujoco", "--engine-option", "colour=red", *never) != 0
    assert "colour" in capsys.readouterr().err


def test_settings_of_the_engine(scene: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.dae"
    settings = ("--engine-option", "solver=cg", "--engine-option", "sleep=false")
    assert simulate(scene, out, "--steps", 20, "--engine", "mujoco", *settings) == 0
    simulation = Simulation(result(scene), create_engine("mujoco", solver="cg", sleep=False))
    simulation.run(20)
    assert compare(result(out), simulation.world) == []
    simulation = Simulation(result(scene), create_engine("mujoco", solver="newton"))
    simulation.run(20)
    assert compare(result(out), simulation.world) != []


def test_a_result_that_cannot_be_written_is_kept_in_a_checkpoint(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    def full(*_: object) -> None:
        raise colladaphy.OutputError("No space left.")

    monkeypatch.setattr("colladaphy.cli.simulate._write", full)
    assert simulate(scene, tmp_path / "out.dae", "--steps", 5) == 2
    error = capsys.readouterr().err
    assert "No space left" in error and "nothing of the run is lost" in error
    resumed = Simulation.resume(scene.with_suffix(".checkpoints"))
    assert resumed.world.step_count == 5


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_it_says_how_to_go_on_and_loses_nothing(
    scene: Path, tmp_path: Path, number: signal.Signals
) -> None:
    arguments = ["simulate", str(scene), "out.dae", "--steps", "1000000000", "--engine", "mujoco"]
    process = subprocess.Popen(
        [*COMMAND, *arguments], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip
    assert process.stderr is not None
    first = process.stderr.readline()  # the warnings come when all is ready to run
    time.sleep(0.5)
    process.send_signal(number)
    output, errors = process.communicate(timeout=60)
    errors = first + errors
    assert process.returncode == 130, errors
    assert "steps" in output
    assert not (tmp_path / "out.dae").exists()
    found = Checkpoints(tmp_path / "scene.checkpoints").newest()
    assert f"Interrupted at step {found.world.step_count}" in errors
    hint = next(line for line in errors.splitlines() if line.startswith("Go on with: "))
    again = hint.removeprefix("Go on with: ").split()
    assert again[:2] == ["colladaphy", "simulate"] and again[-1] == "--resume"
    goal = str(found.world.step_count + 10)
    again[again.index("--steps") + 1] = goal
    done = subprocess.run([*COMMAND, *again[1:]], cwd=tmp_path, capture_output=True, check=True)
    assert done.returncode == 0
    assert result(tmp_path / "out.dae").step_count == int(goal)


def test_interrupted_beside_another_runs_checkpoints(scene: Path, tmp_path: Path) -> None:
    assert simulate(scene, "--steps", 10, "--checkpoint-every", 10) == 0
    process = subprocess.Popen(
        [*COMMAND, "simulate", str(scene), "--steps", "1000000000"], cwd=tmp_path,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stderr is not None
    first = process.stderr.readline()
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    errors = first + process.communicate(timeout=60)[1]
    assert "--checkpoint-dir" in errors and "scene.checkpoints-2" in errors
    assert len(Checkpoints(tmp_path / "scene.checkpoints").paths()) == 1
    assert len(Checkpoints(tmp_path / "scene.checkpoints-2").paths()) == 1


def test_progress_on_a_terminal(scene: Path, tmp_path: Path) -> None:
    pty = pytest.importorskip("pty")
    master, slave = pty.openpty()
    process = subprocess.Popen(
        [*COMMAND, "simulate", str(scene), "--steps", "20000"], cwd=tmp_path,
        stdout=subprocess.PIPE, stderr=slave,
    )  # fmt: skip
    os.close(slave)
    seen = b""
    while True:
        try:
            seen += os.read(master, 65536)
        except OSError:
            break
        if not seen or (process.poll() is not None and b"\x1b[K" in seen):
            break
    process.communicate(timeout=60)
    os.close(master)
    assert process.returncode == 0
    assert b"/20000" in seen and b" steps a second" in seen

"""Never lose data: killed at any moment, a full disk, a folder that cannot be written to."""

from __future__ import annotations

import os
import random
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy.engines import Checkpoints, Simulation, digest, read_checkpoint
from colladaphy.errors import OutputError
from colladaphy.world import compare

ROOT = Path(__file__).resolve().parents[2]
KILLS = 300 if os.environ.get("HYPOTHESIS_PROFILE") == "nightly" else 8

RUNNER = """
import sys
from colladaphy.engines import Checkpoints, Simulation
from tests.engines.scenes import SCENES
folder, steps = sys.argv[1], int(sys.argv[2])
checkpoints = Checkpoints(folder, keep=2)
if checkpoints.paths():
    simulation = Simulation.resume(folder)
else:
    simulation = Simulation(SCENES["general"](), "mujoco")
print("ready", simulation.world.step_count, flush=True)
left = steps - simulation.world.step_count
simulation.run(max(0, left), checkpoints=checkpoints, checkpoint_every=1)
print("done", flush=True)
"""


@contextmanager
def running(script: str, *arguments: object) -> Iterator[subprocess.Popen[str]]:
    """A Python process that is killed, by SIGKILL, at the end of the block."""
    command = [sys.executable, "-c", script, *(str(argument) for argument in arguments)]
    process = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None and process.stderr is not None
    with process.stdout, process.stderr:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGKILL)
            process.wait()


def test_killed_at_random_moments(tmp_path: Path) -> None:
    """After every SIGKILL there is a whole checkpoint, no older than the last one; and the run
    that was killed so often ends where the run that never was does."""
    chance = random.Random(KILLS)
    folder = tmp_path / "killed"
    reached = 0
    for number in range(KILLS):
        with running(RUNNER, folder, 10**9) as process:
            assert process.stdout is not None and process.stderr is not None
            ready = process.stdout.readline().split()
            assert ready[:1] == ["ready"], process.stderr.read()
            assert int(ready[1]) >= reached
            while number >= KILLS // 2 and not reached and not Checkpoints(folder).paths():
                assert process.poll() is None
                time.sleep(0.05)  # a busy machine has not come that far yet
            time.sleep(chance.random() * 0.8)
        checkpoints = Checkpoints(folder, keep=2)
        if checkpoints.paths():
            found = checkpoints.newest()
            assert found.findings == ()  # saved atomically: what has its name is whole
            assert found.world.step_count >= reached
            reached = found.world.step_count
    assert reached > 0
    killed = Checkpoints(folder).newest().world
    straight = Simulation(SCENES["general"](), "mujoco")
    series = Checkpoints(tmp_path / "straight")
    straight.run(reached, checkpoints=series, checkpoint_every=1)
    assert compare(straight.world, killed) == []
    # Kills between writing and removing have left too many; the next rotation mends that.
    Simulation.resume(folder).run(1, checkpoints=Checkpoints(folder, keep=2), checkpoint_every=1)
    assert len(Checkpoints(folder).paths()) == 2


def test_killed_while_the_same_file_is_written_over(tmp_path: Path) -> None:
    script = (
        "import sys, colladaphy\n"
        "from colladaphy.engines import Simulation\n"
        "from tests.engines.scenes import SCENES\n"
        "simulation = Simulation(SCENES['walker'](), 'mujoco')\n"
        "while True:\n"
        "    simulation.run(1)\n"
        "    simulation.checkpoint(sys.argv[1])\n"
        "    print(simulation.world.step_count, flush=True)\n"
    )
    file = tmp_path / "a.dae"
    chance = random.Random(7)
    for _ in range(max(3, KILLS // 4)):
        with running(script, file) as process:
            assert process.stdout is not None
            for _ in range(3):
                process.stdout.readline()
            time.sleep(chance.random() * 0.05)
        assert read_checkpoint(file).step_count >= 3


def run_to(steps: int) -> Simulation:
    simulation = Simulation(SCENES["general"](), "mujoco")
    simulation.run(steps)
    return simulation


@contextmanager
def small_files() -> Iterator[None]:
    """No file may grow beyond 4 kB, as on a disk that is nearly full.

    Not a fixture: the limit holds for the whole process, and pytest writes to its own output
    between a test and the end of its fixtures.
    """
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)


def test_files_that_may_not_grow(tmp_path: Path) -> None:
    checkpoints = Checkpoints(tmp_path, keep=1)
    run = run_to(10)
    old = run.checkpoint(checkpoints)
    before = old.read_bytes()
    run.run(10)
    with small_files(), pytest.raises(OutputError, match="too large"):
        run.checkpoint(checkpoints)
    assert [path.name for path in tmp_path.iterdir()] == [old.name]
    assert old.read_bytes() == before
    assert run.run(10).step_count == 30  # the run itself goes on


@pytest.fixture
def tiny_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 128 kB, where mounting is allowed."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=128k", "tmpfs", str(disk)]
    try:
        done = subprocess.run(mount, capture_output=True, check=False)
    except FileNotFoundError:
        pytest.skip("there is no mount here")
    if done.returncode:
        pytest.skip("mounting is not allowed here")
    try:
        yield disk
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_full_disk(tiny_disk: Path) -> None:
    checkpoints = Checkpoints(tiny_disk, keep=100)
    run = run_to(1)
    with pytest.raises(OutputError, match="disk is full"):
        run.run(1000, checkpoints=checkpoints, checkpoint_every=1)
    kept = checkpoints.paths()
    assert kept and all(read_checkpoint(path).step_count for path in kept)
    assert [path for path in tiny_disk.iterdir() if path not in kept] == []  # nothing half-written
    resumed = Simulation.resume(tiny_disk)
    assert resumed.report.findings[0].code != "engine-checkpoint-broken"
    # With a smaller number to keep, the same disk is enough.
    for path in kept[:-1]:
        path.unlink()
    again = Checkpoints(tiny_disk, keep=2)
    resumed.run(20, checkpoints=again, checkpoint_every=1)
    assert len(again.paths()) == 2


def test_folder_that_is_read_only(tmp_path: Path) -> None:
    folder = tmp_path / "still"
    checkpoints = Checkpoints(folder)
    run = run_to(5)
    old = run.checkpoint(checkpoints)
    content = digest(read_checkpoint(old))
    run.run(5)
    if os.geteuid() == 0:  # root may write everywhere, except where nobody may
        done = subprocess.run(["chattr", "+i", str(folder)], capture_output=True, check=False)
        if done.returncode:
            pytest.skip("a folder cannot be made read-only for root here")
        undo = ["chattr", "-i", str(folder)]
    else:
        folder.chmod(0o555)
        undo = ["chmod", "755", str(folder)]
    try:
        with pytest.raises(OutputError, match="permission is denied"):
            run.checkpoint(checkpoints)
        with pytest.raises(OutputError):
            colladaphy.write(run.world, folder / "other.dae")
    finally:
        subprocess.run(undo, check=True)
    assert [path.name for path in folder.iterdir()] == [old.name]
    assert digest(read_checkpoint(old)) == content

"""A run that is stopped and resumed is the run that was not stopped: to the last bit."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.engines.scenes import PLANAR, SCENES

from colladaphy.engines import ENGINES, Engine, Simulation, create_engine, digest
from colladaphy.world import World, compare

ROOT = Path(__file__).resolve().parents[2]


# pymunk runs planar scenes only.
RUNS = [(engine, scene) for engine in ENGINES for scene in SCENES
        if engine != "pymunk" or scene in PLANAR]  # fmt: skip
every_run = pytest.mark.parametrize(("engine", "scene"), RUNS, indirect=["engine"])


def scene_for(engine: Engine, name: str) -> Simulation:
    return Simulation(SCENES[name](), engine)


@every_run
@pytest.mark.parametrize("at", [0, 1, 37, 150, 400, 1500])
def test_resumed_run_equals_the_run_that_went_on(
    engine: Engine, scene: str, at: int, tmp_path: Path
) -> None:
    going = scene_for(engine, scene)
    going.run(at)
    file = going.checkpoint(tmp_path / "checkpoint.dae")
    resumed = Simulation.resume(file, create_engine(engine.name))
    assert [f for f in resumed.report if "state" in f.code] == []
    assert compare(going.world, resumed.world) == []
    for _ in range(3):
        going.run(100)
        resumed.run(100)
        assert compare(going.world, resumed.world) == []


@every_run
def test_pieces_of_a_run_are_the_run(engine: Engine, scene: str) -> None:
    whole, pieces = scene_for(engine, scene), scene_for(create_engine(engine.name), scene)
    whole.run(300)
    for count in (1, 2, 50, 47, 200):
        pieces.run(count)
    assert compare(whole.world, pieces.world) == []


@every_run
def test_observing_does_not_disturb(engine: Engine, scene: str) -> None:
    seen: list[int] = []
    quiet, watched = scene_for(engine, scene), scene_for(create_engine(engine.name), scene)
    quiet.run(100)
    watched.run(100, observers=[lambda world: seen.append(world.step_count)], every=7)
    watched.contacts()
    assert seen == [0, *range(7, 101, 7)]
    assert compare(quiet.world, watched.world) == []


RUNNER = """
import sys
from colladaphy.engines import Checkpoints, Simulation, digest
from tests.engines.scenes import SCENES
engine, scene, folder, what = sys.argv[1:]
checkpoints = Checkpoints(folder, keep=9)
if what == "resume":
    simulation = Simulation.resume(folder, engine)
else:
    simulation = Simulation(SCENES[scene](), engine)
total = 150 if what == "stop" else 300
steps = total - simulation.world.step_count
simulation.run(steps, checkpoints=checkpoints, checkpoint_every=50)
print(digest(simulation.world), simulation.world.step_count)
"""


@every_run
def test_across_processes_and_hash_seeds(engine: Engine, scene: str, tmp_path: Path) -> None:
    def run(folder: str, what: str, hash_seed: str) -> list[str]:
        environment = os.environ | {"PYTHONHASHSEED": hash_seed}
        command = [sys.executable, "-c", RUNNER, engine.name, scene, str(tmp_path / folder), what]
        done = subprocess.run(
            command, env=environment, cwd=ROOT, capture_output=True, text=True, check=True
        )
        return done.stdout.split()

    straight = run("straight", "run", "1")
    assert run("stopped", "stop", "2")[1] == "150"
    assert run("stopped", "resume", "3") == straight
    assert straight[1] == "300"
    assert sorted(path.name for path in (tmp_path / "stopped").iterdir()) == sorted(
        path.name for path in (tmp_path / "straight").iterdir()
    )
    for path in (tmp_path / "straight").iterdir():
        assert path.read_bytes() == (tmp_path / "stopped" / path.name).read_bytes()


@settings(max_examples=20)
@given(st.lists(st.integers(0, 60), min_size=1, max_size=4))
def test_any_series_of_checkpoints(stops: list[int]) -> None:
    """In memory: storing and loading at the same steps gives the same run."""
    one, two = (Simulation(SCENES["pile"](), "mujoco") for _ in range(2))
    for stop in stops:
        one.run(stop)
        two.run(stop)
        one._rebuild()
        two = Simulation(two.world, "mujoco")
    one.run(30)
    two.run(30)
    assert compare(one.world, two.world) == []


def test_digest_sees_what_compare_sees() -> None:
    world, other = SCENES["general"](), SCENES["general"]()
    assert digest(world) == digest(other)
    other.positions[3, 2] = -0.0 if other.positions[3, 2] == 0 else -other.positions[3, 2]
    assert compare(world, other) and digest(world) != digest(other)
    assert digest(world, motion=False) == digest(other, motion=False)
    other.masses[3] *= 2
    assert digest(world, motion=False) != digest(other, motion=False)


def test_state_that_cannot_be_understood_is_refused() -> None:
    from colladaphy.engines.mujoco_engine import memory

    engine = create_engine("mujoco")
    simulation = Simulation(SCENES["general"](), engine)
    simulation.run(5)
    compiled, data = engine._model.compiled, engine._data
    good = memory.remember(compiled, data)
    assert memory.recall(compiled, data, good)
    for bad in (b"", b"x", good[:-9], zlib.compress(b"{}\n"), zlib.compress(bytes(10**7))):
        assert not memory.recall(compiled, data, bad)


@pytest.mark.parametrize("scene", ["pile", "general"])
def test_indices_that_lead_out_of_bounds_are_refused(scene: str) -> None:
    """MuJoCo follows them unchecked, and a file can hold anything."""
    from colladaphy.engines.mujoco_engine import memory

    engine = create_engine("mujoco", sleep=True)
    simulation = Simulation(SCENES[scene](), engine)
    simulation.run(1500)
    assert simulation.world.sleeping.any()
    compiled, data = engine._model.compiled, engine._data
    head, _, floats = zlib.decompress(memory.remember(compiled, data)).partition(b"\n")
    record = json.loads(head)
    for name, value in record.items():
        for bad in (-1000, 10**6, 2**40):
            changed = [bad, *value[1:]] if isinstance(value, list) else bad
            line = json.dumps({**record, name: changed}).encode()
            assert not memory.recall(compiled, data, zlib.compress(line + b"\n" + floats))
    ring = [0 if tree >= 0 else tree for tree in record["tree_asleep"]]
    line = json.dumps({**record, "tree_asleep": ring}).encode()
    assert not memory.recall(compiled, data, zlib.compress(line + b"\n" + floats))


@pytest.mark.parametrize("options", [{}, {"sleep": True}, {"integrator": "rk4"}])
def test_a_heap_of_many_materials_resumes_exactly(options: dict[str, Any], tmp_path: Path) -> None:
    """Large scenes are solved by another method, and set frictions in every step."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    for i in range(3):
        world.create_material(
            f"m{i}", density=1000, restitution=0.2 * i, static_friction=0.1 + 0.1 * i,
            dynamic_friction=0.1 + 0.1 * i, poisson_ratio=0.3, young_modulus=1, stiffness=1,
            damping_normal=0, damping_tangential=0,
        )  # fmt: skip
    world.create_plane(1, (0, 0, 1), 0, "m2")
    for i in range(60):
        place = (1.01 * (i % 4), 1.01 * (i // 4 % 4), 0.6 + 1.02 * (i // 16))
        world.create_sphere(2, place, 0.5, f"m{i % 3}", linear_velocity=(0.1 * (i % 3), 0, 0))
    going = Simulation(world, create_engine("mujoco", **options))
    assert any("Solver cg" in finding.message for finding in going.report)
    for at in (7, 60):
        going.run(at)
        file = going.checkpoint(tmp_path / f"{at}.dae")
        resumed = Simulation.resume(file)
        for _ in range(2):
            going.run(40)
            resumed.run(40)
            assert compare(going.world, resumed.world) == []
    assert len(going.contacts()) > 50

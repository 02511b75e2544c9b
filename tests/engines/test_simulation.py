"""Choosing an engine, time steps, edits between runs, observers, and what fails."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy.engines import (
    ENGINES,
    Engine,
    Simulation,
    Trajectory,
    angular_momentum,
    checkpoint_rules,
    create_engine,
    engine_names,
    momentum,
)
from colladaphy.engines import selection as selecting
from colladaphy.engines.rules import RULES
from colladaphy.errors import EngineError, InputError
from colladaphy.world import World, compare, rotations

Maker = Callable[..., World]


def codes(simulation: Simulation) -> list[str]:
    return [finding.code for finding in simulation.report]


def test_engines_keep_the_protocol(engine: Engine) -> None:
    assert isinstance(engine, Engine)
    assert engine.name in ENGINES
    assert engine.version.split(".")[0].isdigit()


def test_rules_are_all_listed_once() -> None:
    rules = RULES + checkpoint_rules.RULES
    assert len({rule.code for rule in rules}) == len(rules)
    assert all(rule.stage == "engine" for rule in rules)


def test_time_step_of_the_world_of_the_caller_or_assumed() -> None:
    world = SCENES["general"]()
    assert "engine-time-step-default" not in codes(Simulation(world))
    Simulation(world, dt=0.01)
    assert world.time_step == 0.01
    world.time_step = None
    assert "engine-time-step-default" in codes(Simulation(world))
    assert world.time_step == 1 / 240


@pytest.mark.parametrize("dt", [0.0, -1.0, float("inf"), float("nan")])
def test_impossible_time_steps(dt: float) -> None:
    with pytest.raises(EngineError, match="engine-time-step"):
        Simulation(SCENES["general"](), dt=dt)


def test_auto_takes_mujoco_for_what_is_not_planar() -> None:
    simulation = Simulation(SCENES["general"]())
    assert simulation.engine.name == "mujoco"


def test_auto_without_mujoco_says_why_and_how_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    class Flat:
        name = "pymunk"

        def check(self, _: World) -> list[colladaphy.Finding]:
            return [selecting.UNKNOWN.at(message="the gravity is out of plane")]

    def create(name: str) -> object:
        if name == "pymunk":
            return Flat()
        raise EngineError(selecting.NOT_INSTALLED.at())

    monkeypatch.setattr(selecting, "create_engine", create)
    with pytest.raises(EngineError) as caught:
        Simulation(SCENES["general"]())
    assert "the gravity is out of plane" in str(caught.value)
    assert "pip install 'colladaphy[mujoco]'" in str(caught.value)


def test_a_library_that_is_missing_is_an_error_that_says_so() -> None:
    script = (
        "import sys; sys.modules['mujoco'] = None\n"
        "from colladaphy.engines import create_engine\n"
        "from colladaphy.errors import EngineError\n"
        "try: create_engine('mujoco')\n"
        "except EngineError as error: print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert "engine-not-installed" in done.stdout
    assert "pip install 'colladaphy[mujoco]'" in done.stdout


def test_unknown_engine() -> None:
    with pytest.raises(EngineError, match="auto, pymunk, mujoco"):
        create_engine("bullet")


def test_importing_engines_imports_no_engine() -> None:
    script = "import sys, colladaphy.engines; print({'mujoco', 'pymunk'} & set(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "set()"


def test_seed_that_is_not_used_is_reported() -> None:
    assert "engine-seed-unused" in codes(Simulation(SCENES["general"](), seed=7))


def test_edits_between_runs_are_taken_up(engine: Engine, empty: Maker) -> None:
    world = empty()
    body = world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    simulation = Simulation(world, engine)
    simulation.run(10)
    body.linear_velocity = (1.0, 0.0, 0.0)
    simulation.run(240)
    assert body.position[0] == pytest.approx(1.0, abs=0.01)
    other = world.create_sphere(2, (0, 0, 5), 0.5, "ball", linear_velocity=(0, 0, 1))
    simulation.run(240)
    assert other.position[2] == pytest.approx(6.0, abs=0.01)


def test_edits_win_over_the_state_of_the_engine(tmp_path: Path) -> None:
    simulation = Simulation(SCENES["general"]())
    simulation.run(20)
    world = simulation.world
    world.body(2).position = (0, 0, 9)
    again = Simulation(world, "mujoco")
    assert "engine-state-stale" in codes(again)
    again.run(1)
    assert world.body(2).position[2] == pytest.approx(9.0, abs=0.1)


def test_another_engine_or_version_goes_on_from_the_world(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = Simulation(SCENES["general"](), "mujoco")
    simulation.run(20)
    file = simulation.checkpoint(tmp_path / "a.dae")
    engine_class = type(create_engine("mujoco"))
    monkeypatch.setattr(engine_class, "version", property(lambda self: "0.0"))
    other = Simulation.resume(file)
    assert "engine-state-version" in codes(other)
    monkeypatch.setattr(engine_class, "name", "havok")
    other = Simulation.resume(file, create_engine("mujoco"))
    assert "engine-state-engine" in codes(other)
    before = np.array(other.world.positions)
    other.run(1)
    np.testing.assert_allclose(other.world.positions, before, atol=0.1)


def test_steps_that_cannot_be(empty: Maker) -> None:
    simulation = Simulation(SCENES["general"]())
    for arguments in ({"steps": -1}, {"steps": 1, "every": 0}):
        with pytest.raises(EngineError, match="engine-steps"):
            simulation.run(**arguments)


def test_divergence_is_an_error_and_the_world_stays(empty: Maker) -> None:
    world = empty(dt=1.0)
    body = world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    body.force = (body.mass * 1e11, 0, 0)
    simulation = Simulation(world, "mujoco")
    before = np.array(world.positions)
    with pytest.raises(EngineError, match="engine-diverged"):
        simulation.run(5)
    np.testing.assert_array_equal(world.positions, before)
    assert world.step_count == 0
    body.force = (0, 0, 0)
    assert simulation.run(5).step_count == 5


def test_stop_and_progress(empty: Maker) -> None:
    world = empty()
    world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    done: list[int] = []
    simulation = Simulation(world, "mujoco")
    summary = simulation.run(10**9, stop=lambda: len(done) > 3, progress=done.append)
    assert summary.step_count == done[-1]
    assert done == sorted(done)


def test_trajectory_is_saved_and_gone_on_with(tmp_path: Path, empty: Maker) -> None:
    world = empty((0, 0, -9.81))
    world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    file = tmp_path / "t.npz"
    whole = Trajectory(file)
    simulation = Simulation(world, "mujoco")
    simulation.run(20, observers=[whole], every=5)
    whole.save_again()
    with np.load(file) as arrays:
        assert arrays["step_counts"].tolist() == [0, 5, 10, 15, 20]
        assert arrays["positions"].shape == (5, 1, 3)
        assert arrays["sids"].tolist() == [1]
    part = Trajectory.load(file, until=12)
    assert len(part) == 3
    part(world)
    assert part.column("positions").shape == (4, 1, 3)
    file.write_bytes(file.read_bytes()[:100])
    with pytest.raises(InputError):
        Trajectory.load(file)


def test_momenta_and_energy_against_a_sum_by_hand() -> None:
    world = World((0, -3, 0), time_step=0.1)
    box = world.create_box(1, (1, 2, 3), (1, 2, 3), "oak", linear_velocity=(1, 0, 2))
    box.rotate(0.3, 0.2, 0.1)
    box.angular_velocity = (0.5, -1, 2)
    ball = world.create_sphere(2, (-1, 0, 1), 0.5, "iron", linear_velocity=(0, 4, 0))
    world.create_sphere(3, (9, 9, 9), 0.5, "iron", fixed=True)
    expected, about, energy, height = np.zeros(3), np.zeros(3), 0.0, 0.0
    for body in (box, ball):
        p = body.mass * body.linear_velocity
        inertia = rotations.rotate_tensor(body.orientation, body.inertia)
        spin = inertia @ body.angular_velocity
        expected = expected + p
        about = about + np.cross(body.position, p) + spin
        energy += 0.5 * (p @ body.linear_velocity + body.angular_velocity @ spin)
        height += body.mass * 3 * body.position[1]
    np.testing.assert_allclose(momentum(world), expected, rtol=1e-12)
    np.testing.assert_allclose(angular_momentum(world), about, rtol=1e-12)
    summary = Simulation(world, "mujoco").summary()
    assert summary.kinetic_energy == pytest.approx(energy, rel=1e-12)
    assert summary.potential_energy == pytest.approx(height, rel=1e-12)
    assert summary.bodies == 2


def test_listing_1_runs(tmp_path: Path) -> None:
    example = Path(__file__).resolve().parents[2] / "examples" / "listing1.py"
    out = tmp_path / "out.dae"
    done = subprocess.run(
        [sys.executable, str(example), str(out)], capture_output=True, text=True, check=True
    )
    assert "step_count=100" in done.stdout and "time=50.0" in done.stdout
    world = colladaphy.read(out).load()
    plane, box, one, two = world.bodies
    assert plane.fixed and world.step_count == 100
    # Gravity pulls along -x onto the plane; nothing falls through it, and the spheres stay joined.
    for body, height in ((box, 1.0), (one, 0.5), (two, 0.5)):
        assert body.position[0] == pytest.approx(height, abs=0.05)
    assert np.linalg.norm(two.position - one.position) == pytest.approx(np.sqrt(2), rel=1e-9)
    assert compare(world, colladaphy.read(out).load()) == []


def broken(failure: str) -> str:
    """What is said when the library fails in some way while it is loaded."""
    script = f"""
import sys
class Broken:
    def find_spec(self, name, path=None, target=None):
        if name == "mujoco":
            raise {failure}
sys.meta_path.insert(0, Broken())
from colladaphy.engines import create_engine
from colladaphy.errors import EngineError
try: create_engine("mujoco")
except EngineError as error: print(error)
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    return done.stdout


@pytest.mark.parametrize(
    "failure", ['OSError("libmujoco.so: cannot open")', 'AttributeError("mjtObj")']
)
def test_any_failure_of_a_library_is_a_finding_that_helps(failure: str) -> None:
    said = broken(failure)
    assert "engine-not-installed" in said and "pip" in said
    assert failure.split('"')[1] in said


def test_libraries_that_overwrite_each_other_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    installed = {"mujoco": "3.17.0", "mujoco-core": "4.0.1"}
    monkeypatch.setattr(selecting, "version", installed.__getitem__)

    def fail(_: str) -> object:
        raise ImportError("libmujoco.so.4 is not there")

    monkeypatch.setattr(selecting, "import_module", fail)
    with pytest.raises(EngineError) as caught:
        create_engine("mujoco")
    said = str(caught.value)
    assert "mujoco 3.17.0 and mujoco-core 4.0.1 overwrite each other" in said
    assert "pip uninstall mujoco mujoco-core" in said


def test_engines_of_other_packages_are_found(monkeypatch: pytest.MonkeyPatch, empty: Maker) -> None:
    """An entry point is an engine by name, and what "auto" tries last."""
    from importlib.metadata import EntryPoint

    point = EntryPoint(
        "mine", "colladaphy.engines.pymunk_engine:PymunkEngine", "colladaphy.engines"
    )
    monkeypatch.setattr(
        selecting.extensions, "offered",
        lambda group: (point,) if group == "colladaphy.engines" else (),
    )  # fmt: skip
    assert engine_names() == (*ENGINES, "mine")
    world = empty()
    world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    simulation = Simulation(world, create_engine("mine", iterations="30"))
    assert simulation.engine.options["iterations"] == 30
    monkeypatch.setattr(selecting, "ENGINES", {})
    chosen, findings = selecting.choose(world)
    assert type(chosen).__name__ == "PymunkEngine" and findings

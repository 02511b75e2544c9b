"""Steering a run: forces at every step, edits taken up or refused, contact events, options."""

from __future__ import annotations

import math
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest

from colladaphy.engines import (
    ContactEvent,
    Engine,
    Simulation,
    create_engine,
)
from colladaphy.engines.state import recorded_options
from colladaphy.errors import EngineError
from colladaphy.world import World, compare, rotations


def ball(empty: Any, **options: Any) -> World:
    world: World = empty((0, 0, 0))
    world.create_sphere(1, (0, 0, 0), 0.5, "ball", **options)
    return world


def counting(engine: Engine, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Notes every load of an engine."""
    loads: list[str] = []
    load = type(engine).load

    def counted(self: Any, *arguments: Any, **options: Any) -> None:
        loads.append(self.name)
        load(self, *arguments, **options)

    monkeypatch.setattr(type(engine), "load", counted)
    return loads


def test_forces_of_a_callback(engine: Engine, empty: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A spring of the user's own: cos(ω t), at every step, and never a reload."""
    world = ball(empty, linear_velocity=(0, 0, 0))
    body = world.body(1)
    body.position = (1, 0, 0)
    loads, times = counting(engine, monkeypatch), []

    def pull(seen: World, time: float) -> None:
        assert seen is world and time == world.time
        times.append(time)
        body.force = -9.0 * body.mass * body.position

    simulation = Simulation(world, engine, forces=pull)
    simulation.run(240)
    assert len(times) == 240 and len(loads) == 1
    assert body.position[0] == pytest.approx(math.cos(3.0), abs=0.03)
    assert world.forces.tolist() == [[0, 0, 0]]


def test_edits_between_runs_need_no_reload(
    engine: Engine, empty: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = ball(empty)
    body = world.body(1)
    loads = counting(engine, monkeypatch)
    simulation = Simulation(world, engine)
    for _ in range(24):
        body.force = (10 * body.mass, 0, 0)
        simulation.run(1)
    assert body.linear_velocity[0] == pytest.approx(1.0)
    body.linear_velocity = (0, 0, 2)
    simulation.run(240)
    assert body.position[2] == pytest.approx(2.0, abs=0.01)
    assert len(loads) == 1
    body.position = (0, 0, 5)
    simulation.run(1)
    assert body.position[2] == pytest.approx(5.0, abs=0.01)
    world.create_sphere(2, (0, 0, 9), 0.5, "ball", linear_velocity=(0, 0, 1))
    simulation.run(240)
    assert world.body(2).position[2] == pytest.approx(10.0, abs=0.01)
    world.gravity = (0, 0, -10)
    before = body.linear_velocity[2]
    simulation.run(24)
    assert body.linear_velocity[2] == pytest.approx(before - 1.0)


def test_observers_steer_and_are_refused_what_they_cannot(engine: Engine, empty: Any) -> None:
    world = ball(empty)
    body = world.body(1)

    def kick(seen: World) -> None:
        if seen.step_count == 24:
            body.linear_velocity = (1, 0, 0)

    simulation = Simulation(world, engine)
    simulation.run(264, observers=[kick], every=8)
    assert body.position[0] == pytest.approx(1.0, abs=0.01)

    def build(seen: World) -> None:
        if seen.step_count == 272:
            seen.create_sphere(2, (0, 0, 9), 0.5, "ball")

    with pytest.raises(EngineError, match="engine-edit"):
        simulation.run(24, observers=[build], every=8)
    assert simulation.run(8).step_count == 280  # and between two runs it is taken up
    world.destroy(world.create_sphere(3, (0, 0, 20), 0.5, "ball"))
    simulation.run(8, observers=[kick], every=8)  # an id that was used up changes nothing


def test_a_steered_run_is_resumed_to_the_last_bit(engine: Engine, empty: Any,
                                                  tmp_path: Path) -> None:  # fmt: skip
    def push(world: World, time: float) -> None:
        body = world.body(2)
        body.force = (body.mass * math.sin(9 * time), 0, 0)

    world = empty((0, 0, -9.81), friction=0.5)
    world.create_plane(1, (0, 0, 1), 0, "ball")
    world.create_box(2, (0, 0, 0.6), (1, 1, 1), "ball")
    going = Simulation(world, engine, forces=push)
    going.run(50)
    file = going.checkpoint(tmp_path / "a.dae")
    resumed = Simulation.resume(file, forces=push)
    for _ in range(3):
        going.run(50)
        resumed.run(50)
        assert compare(going.world, resumed.world) == []


def test_contact_events(engine: Engine, empty: Any) -> None:
    world = empty((0, 0, -9.81), restitution=0.5)
    world.create_plane(1, (0, 0, 1), 0, "ball")
    world.create_sphere(2, (0, 0, 1.0), 0.5, "ball")
    events: list[ContactEvent] = []
    Simulation(world, engine, on_contact=events.append).run(200)
    assert [event.began for event in events[:4]] == [True, False, True, False]
    assert all((event.first, event.second) == (1, 2) for event in events)
    assert all(bool(event.contacts) is event.began for event in events)
    fall = math.sqrt(2 * 0.5 / 9.81)
    assert events[0].step_count / 240 == pytest.approx(fall, abs=2 / 240)


@pytest.mark.parametrize("name", ["pymunk", "mujoco"])
def test_options_are_checked_and_resumed_with(name: str, empty: Any, tmp_path: Path) -> None:
    for bad in ({"solvr": "cg"}, {"sleep": "perhaps"}, {"friction": "least"}, {"sleep": 3}):
        with pytest.raises(EngineError, match="engine-option"):
            create_engine(name, **bad)
    engine = create_engine(name, sleep="on", friction="average")
    world = ball(empty)
    going = Simulation(world, engine)
    going.run(5)
    file = going.checkpoint(tmp_path / "a.dae")
    state = world.engine_state
    assert state is not None
    chosen = recorded_options(state)
    assert chosen is not None and chosen["sleep"] is True and chosen["friction"] == "average"
    for resumed in (Simulation.resume(file), Simulation.resume(file, name)):
        assert resumed.engine.options == engine.options
        assert not [f for f in resumed.report if "state" in f.code]
    other = Simulation.resume(file, create_engine(name))
    assert "engine-state-options" in {finding.code for finding in other.report}


def test_a_checkpoint_of_an_unknown_engine_is_no_silent_other_one(
    empty: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = create_engine("pymunk")
    monkeypatch.setattr(type(engine), "name", "havok")
    file = Simulation(ball(empty), engine).checkpoint(tmp_path / "a.dae")
    monkeypatch.undo()
    with pytest.raises(EngineError, match="engine-state-no-engine") as caught:
        Simulation.resume(file)
    assert "havok" in str(caught.value)
    named = Simulation.resume(file, "pymunk")
    assert "engine-state-engine" in {finding.code for finding in named.report}
    np.testing.assert_array_equal(named.world.positions, [[0, 0, 0]])


def test_contacts_of_a_summary_are_those_of_its_moment(engine: Engine, empty: Any) -> None:
    """They are counted late, but not too late."""
    world = empty((0, 0, -9.81), restitution=1.0)
    world.create_plane(1, (0, 0, 1), 0, "ball")
    world.create_sphere(2, (0, 0, 0.5), 0.5, "ball", linear_velocity=(0, 0, -1))
    simulation = Simulation(world, engine)
    kept = simulation.run(1)
    expected = len(simulation.contacts())
    simulation.run(20)
    assert len(simulation.contacts()) != expected
    assert kept.contacts == expected == 1


def test_energies_of_a_summary_are_those_of_its_moment(engine: Engine, empty: Any) -> None:
    """They are computed late, of the bodies as they were."""
    world = empty((0, 0, -10))
    world.create_sphere(1, (0, 0, 3), 0.5, "ball", linear_velocity=(2, 0, 0))
    mass, kept = world.body(1).mass, Simulation(world, engine).summary()
    assert kept == Simulation(world, engine).summary()
    world.body(1).linear_velocity = (0, 0, 9)
    world.body(1).position = (0, 0, 99)
    world.body(1).mass = 77.0
    world.gravity = (0, 0, 0)
    assert kept.kinetic_energy == pytest.approx(2 * mass)
    assert kept.energy == pytest.approx(32 * mass)
    assert kept.momentum == pytest.approx((2 * mass, 0, 0))
    assert kept.angular_momentum == pytest.approx((0, 6 * mass, 0))
    assert kept != Simulation(world, engine).summary()


@pytest.mark.parametrize("planar", [True, False])
def test_poses_between_steps_need_no_load(
    planar: bool, engine: Engine, empty: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A body that is moved and turned by hand goes on from there, whatever else goes on."""
    world = empty((0, 0, 0))
    normal = np.array([0.0, 1.0, 0.0]) if planar else np.array([2.0, 1.0, -2.0]) / 3
    ahead = np.cross(normal, (0.0, 0.0, 1.0))
    start = [np.cross(normal, ahead) * 3 * i for i in range(3)]
    for number, place in enumerate(start):
        world.create_box(number, place, (1, 1, 1), "ball",
                         orientation=rotations.between((0, 1, 0), normal))  # fmt: skip
    box, other = world.bodies[0], world.bodies[1]
    other.linear_velocity, other.angular_velocity = ahead, 2.0 * normal
    loads = counting(engine, monkeypatch)
    simulation = Simulation(world, engine)
    turn = rotations.from_axis_angle(normal, 0.1)
    for number in range(1, 41):
        box.position = start[0] - 0.01 * number * ahead
        box.orientation = rotations.multiply(turn, box.orientation)
        given = box.orientation.copy()
        simulation.run(3)
        np.testing.assert_allclose(box.position, start[0] - 0.01 * number * ahead, atol=1e-12)
        np.testing.assert_allclose(box.orientation, given, atol=1e-12)
    assert len(loads) == 1
    angle = rotations.from_axis_angle(normal, 2.0 * world.time)
    facing = rotations.multiply(angle, rotations.between((0, 1, 0), normal))
    np.testing.assert_allclose(np.abs(facing @ other.orientation), 1.0, atol=1e-9)
    np.testing.assert_allclose(other.position, start[1] + world.time * ahead, atol=1e-9)
    # It collides where it stands now.
    box.position = other.position + 1.5 * ahead
    simulation.run(240)
    assert box.linear_velocity @ ahead > 0.1


def test_a_pose_out_of_the_plane_is_refused(empty: Any) -> None:
    world = empty((0, 0, -10))
    for number in range(3):
        world.create_sphere(number, (2 * number, 0, number**2), 0.5, "ball")
    simulation = Simulation(world, "pymunk")
    simulation.run(1)
    world.bodies[0].position = (0, 1, 0)
    with pytest.raises(EngineError, match="plane"):
        simulation.run(1)
    world.bodies[0].position = (0, 0, 0)
    simulation.run(1)


def test_a_steered_step_costs_about_a_free_one(engine: Engine, empty: Any) -> None:
    """Within a small factor, and by far less than a load, for a scene of some size."""
    world = empty((0, 0, -9.81))
    for i in range(500):
        world.create_sphere(2, (1.5 * i, 0, 0), 0.5, "ball")
    simulation = Simulation(world, engine)

    def spent(run: Any, count: int = 20) -> float:
        best = math.inf
        for _ in range(3):
            start = process_time()
            run(count)
            best = min(best, (process_time() - start) / count)
        return best

    simulation.run(20)
    free = spent(simulation.run)
    steered = Simulation(world, engine, forces=lambda seen, _: seen.forces[:, 0].fill(1e-9))
    steered.run(5)
    assert spent(steered.run) < 5 * free + 1e-3


def test_findings_are_told_before_the_engine_sets_up(
    engine: Engine, empty: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[Any] = []
    before: list[int] = []
    load = type(engine).load

    def late(self: Any, *arguments: Any, **options: Any) -> None:
        before.append(len(told))
        load(self, *arguments, **options)

    monkeypatch.setattr(type(engine), "load", late)
    simulation = Simulation(ball(empty), engine, on_finding=told.append)
    assert before == [len(told)] and told == list(simulation.report)
    assert "engine-settings" in {finding.code for finding in told}


@pytest.mark.parametrize("integrator", ["rk4", "implicitfast", "implicit", "euler"])
@pytest.mark.parametrize("solver", ["newton", "cg"])
def test_every_integrator_and_solver_swings_a_pendulum(integrator: str, solver: str) -> None:
    world = World((0, 0, -9.81), time_step=1 / 480)
    bob = world.create_sphere(1, (0.05, 0, -1), 0.1, "iron")
    world.attach_hinge_joint(None, bob, anchor1=(0, 0, 0), axis=(0, 1, 0))
    period = 2 * math.pi * math.sqrt((1 + 0.4 * 0.01) / 9.81)
    engine = create_engine("mujoco", integrator=integrator, solver=solver)
    Simulation(world, engine).run(round(5 * period * 480))
    assert bob.position[0] == pytest.approx(0.05, rel=0.01)


def test_substeps_are_steps(empty: Any) -> None:
    """Four parts of a step are four shorter steps, in all of which a force acts."""
    ends = []
    for parts, dt in ((4, 1 / 60), (1, 1 / 240)):
        world = empty((0, 0, -9.81), dt=dt, restitution=0.5)
        world.create_plane(1, (0, 0, 1), 0, "ball")
        body = world.create_sphere(2, (0, 0, 1), 0.5, "ball")
        Simulation(world, create_engine("pymunk", substeps=parts)).run(round(1 / dt))
        ends.append(body.position)
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12)
    world = empty(dt=0.1)
    body = world.create_sphere(2, (0, 0, 0), 0.5, "ball")
    body.force = (10 * body.mass, 0, 0)
    Simulation(world, create_engine("pymunk", substeps=4)).run(3)
    assert body.linear_velocity[0] == pytest.approx(1.0)

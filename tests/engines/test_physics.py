"""Physics that can be checked by hand, in planar scenes that every engine can run."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from colladaphy.engines import (
    Engine,
    Simulation,
    kinetic_energy,
    momentum,
    potential_energy,
)
from colladaphy.engines.observers import Trajectory
from colladaphy.world import World, rotations

Maker = Callable[..., World]
G = 9.81

# pymunk moves with the velocity before a step; MuJoCo is exact where nothing touches.
TRIANGLE = {"pymunk": lambda n: n * (n - 1) / 2, "mujoco": lambda n: n * n / 2}


@pytest.mark.parametrize("velocity", [(0.0, 0.0, 0.0), (3.0, 0.0, 4.0)])
def test_free_fall_and_projectile(
    engine: Engine, empty: Maker, velocity: tuple[float, float, float]
) -> None:
    world = empty((0.0, 0.0, -G))
    body = world.create_sphere(1, (1.0, 0.0, 5.0), 0.5, "ball", linear_velocity=velocity)
    steps, dt = 240, world.time_step
    Simulation(world, engine).run(steps)
    start, speed, down = np.array((1.0, 0.0, 5.0)), np.array(velocity), np.array((0, 0, -G))
    stepwise = start + speed * steps * dt + down * dt**2 * TRIANGLE[engine.name](steps)
    np.testing.assert_allclose(body.position, stepwise, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(body.linear_velocity, speed + down * steps * dt, atol=1e-12)
    exact = start + speed * 1.0 + down / 2
    np.testing.assert_allclose(body.position, exact, atol=G * dt)
    assert world.step_count == steps
    assert world.time == pytest.approx(1.0)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_collision_keeps_momentum_and_follows_restitution(
    engine: Engine, empty: Maker, restitution: float
) -> None:
    world = empty(restitution=restitution)
    one = world.create_sphere(1, (-2.0, 0, 0), 0.5, "ball", linear_velocity=(2.0, 0, 0))
    two = world.create_sphere(2, (2.0, 0, 0), 0.75, "ball", linear_velocity=(-1.0, 0, 0))
    before, energy = momentum(world), kinetic_energy(world)
    simulation = Simulation(world, engine)
    simulation.run(480)
    np.testing.assert_allclose(momentum(world), before, rtol=1e-9, atol=1e-9 * abs(before[0]))
    assert kinetic_energy(world) <= energy * (1 + 1e-9)
    apart = (two.linear_velocity - one.linear_velocity)[0]
    # MuJoCo's contacts go 0.999 of the way, and move apart what overlaps.
    miss = 0.03 * 3.0 if engine.name == "mujoco" else 1e-6
    assert apart == pytest.approx(3.0 * restitution, abs=miss)
    reduced = one.mass * two.mass / (one.mass + two.mass)
    lost = 0.5 * reduced * (9.0 - apart**2)
    assert kinetic_energy(world) == pytest.approx(energy - lost, rel=1e-6)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("speed", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("dt", [1 / 60, 1 / 240, 1 / 1000])
def test_drops_rebound_by_their_restitution(
    engine: Engine, empty: Maker, restitution: float, speed: float, dt: float
) -> None:
    """To within 0.05 of the speed, wherever in a step the ground is met."""
    for phase in (0.0, 0.3, 0.6, 0.9):
        world = empty(dt=dt, restitution=restitution, friction=0.4)
        world.create_plane(1, (0, 0, 1), 0, "ball")
        height = (1.5 + phase) * speed * dt
        ball = world.create_sphere(
            2, (0, 0, height + 0.5), 0.5, "ball", linear_velocity=(0, 0, -speed)
        )
        Simulation(world, engine).run(40)
        assert ball.linear_velocity[2] / speed == pytest.approx(restitution, abs=0.05)


@pytest.mark.parametrize(("degrees", "slides"), [(15.0, False), (25.0, True)])
def test_slope_under_and_over_the_friction_angle(
    engine: Engine, empty: Maker, degrees: float, slides: bool
) -> None:
    friction = math.tan(math.radians(20.0))
    angle = math.radians(degrees)
    # The slope is level and gravity is tilted: the same, but for the frame.
    world = empty((G * math.sin(angle), 0.0, -G * math.cos(angle)), friction=friction)
    world.create_plane(1, (0, 0, 1), 0.0, "ball")
    body = world.create_box(2, (0, 0, 0.5), (2.0, 1.0, 1.0), "ball")
    simulation = Simulation(world, engine)
    simulation.run(120)
    settled, speed = body.position[0], body.linear_velocity[0]
    simulation.run(240)
    way = body.position[0] - settled
    if slides:
        acceleration = G * (math.sin(angle) - friction * math.cos(angle))
        assert way == pytest.approx(speed + acceleration / 2, rel=0.03)
    else:
        assert abs(way) < 2e-3
    assert body.position[2] == pytest.approx(0.5, abs=0.01)


def _period(times: np.ndarray, values: np.ndarray) -> float:
    """Mean time between upward zero crossings, interpolated."""
    up = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    assert len(up) > 2
    share = values[up] / (values[up] - values[up + 1])
    crossings = times[up] + share * (times[up + 1] - times[up])
    return float(np.mean(np.diff(crossings)))


@pytest.mark.parametrize("reverse", [False, True])
def test_pendulum_period_on_a_hinge(engine: Engine, empty: Maker, reverse: bool) -> None:
    world = empty((0.0, 0.0, -G), dt=1 / 480)
    amplitude, length, radius = 0.05, 1.0, 0.2
    place = (length * math.sin(amplitude), 0.0, -length * math.cos(amplitude))
    bob = world.create_sphere(1, place, radius, "ball")
    if reverse:
        anchor = -bob.position
        world.attach_hinge_joint(bob, None, anchor1=anchor, axis=(0, 1, 0))
    else:
        world.attach_hinge_joint(None, bob, anchor1=(0, 0, 0), axis=(0, 1, 0))
    record = Trajectory()
    Simulation(world, engine).run(3840, observers=[record], every=8)
    inertia = bob.mass * length**2 + 0.4 * bob.mass * radius**2
    small = 2 * math.pi * math.sqrt(inertia / (bob.mass * G * length))
    expected = small * (1 + amplitude**2 / 16)
    track = record.column("positions")[:, 0]
    assert _period(record.times, track[:, 0]) == pytest.approx(expected, rel=2e-3)
    distances = np.linalg.norm(track, axis=1)
    np.testing.assert_allclose(distances, length, atol=2e-3)


def test_spring_frequency_on_a_slider(engine: Engine, empty: Maker) -> None:
    world = empty(dt=1 / 480)
    bob = world.create_sphere(1, (0.5, 0.0, 0.0), 0.2, "ball")
    stiffness = 40.0 * bob.mass
    world.attach_slider_joint(
        None, bob, anchor1=(0, 0, 0), anchor2=(0, 0, 0), axis=(1, 0, 0),
        linear_spring=(stiffness, 0.0, 0.0),
    )  # fmt: skip
    energy = kinetic_energy(world) + potential_energy(world)
    assert energy == pytest.approx(0.5 * stiffness * 0.25)
    record = Trajectory()
    Simulation(world, engine).run(3840, observers=[record], every=8)
    expected = 2 * math.pi / math.sqrt(40.0)
    track = record.column("positions")[:, 0]
    assert _period(record.times, track[:, 0]) == pytest.approx(expected, rel=2e-3)
    assert np.abs(track[:, 1:]).max() < 1e-3
    after = kinetic_energy(world) + potential_energy(world)
    assert after == pytest.approx(energy, rel=0.05)


def test_union_moves_as_one_body(engine: Engine, empty: Maker) -> None:
    world = empty((0.0, 0.0, -G), friction=0.5)
    world.create_plane(1, (0, 0, 1), 0.0, "ball")
    parts = [
        world.create_sphere(2, (0.0, 0.0, 2.0), 0.3, "ball"),
        world.create_box(3, (0.6, 0.0, 2.1), (1.0, 0.3, 0.4), "ball"),
    ]
    union = world.create_union(4, parts, linear_velocity=(0.5, 0, 0))
    before = [(part.local_position, part.local_orientation) for part in parts]
    Simulation(world, engine).run(50)
    free = union.position[2]
    steps = TRIANGLE[engine.name](50)
    height = (2.0 * parts[0].mass + 2.1 * parts[1].mass) / union.mass
    assert free == pytest.approx(height - G * steps / 240**2)
    Simulation(world, engine).run(400)
    for part, (position, orientation) in zip(parts, before, strict=True):
        np.testing.assert_array_equal(part.local_position, position)
        np.testing.assert_array_equal(part.local_orientation, orientation)
    low = [part.position[2] for part in parts]
    assert low[0] == pytest.approx(0.3, abs=0.02)
    assert low[1] > 0.19


def test_fixed_joint_holds(engine: Engine, empty: Maker) -> None:
    world = empty((0.0, 0.0, -G), friction=0.5)
    world.create_plane(1, (0, 0, 1), 0.0, "ball")
    one = world.create_sphere(2, (0.0, 0.0, 1.0), 0.3, "ball")
    two = world.create_sphere(3, (0.8, 0.0, 1.6), 0.3, "ball", linear_velocity=(0, 0, -2))
    world.attach_fixed_joint(one, two)

    def seen() -> np.ndarray:
        return rotations.unrotate(one.orientation, two.position - one.position)

    apart = seen()
    simulation = Simulation(world, engine)
    for _ in range(40):
        simulation.run(10)
        assert np.linalg.norm(seen() - apart) < 0.02
    turn = rotations.multiply(rotations.conjugate(one.orientation), two.orientation)
    assert rotations.to_axis_angle(turn)[1] < 0.02
    assert one.position[2] > 0.25 and two.position[2] > 0.25


def test_hinge_limits_stop_a_pendulum(engine: Engine, empty: Maker) -> None:
    world = empty((0.0, 0.0, -G))
    bob = world.create_sphere(1, (1.0, 0.0, 0.0), 0.2, "ball")
    # It starts level and would fall by a quarter turn; the limit lets it fall by half of that.
    world.attach_hinge_joint(
        None, bob, anchor1=(0, 0, 0), axis=(0, 1, 0), limits=(-math.pi / 4, math.pi / 4)
    )
    Simulation(world, engine).run(960)
    assert bob.position[2] == pytest.approx(-math.sqrt(0.5), abs=0.03)
    assert bob.position[0] == pytest.approx(math.sqrt(0.5), abs=0.03)


def test_resting_pile_keeps_still(engine: Engine, empty: Maker) -> None:
    world = empty((0.0, 0.0, -G), friction=0.6)
    world.create_plane(1, (0, 0, 1), 0.0, "ball")
    boxes = [world.create_box(2, (0, 0, 0.5 + i), (1, 1, 1), "ball") for i in range(4)]
    simulation = Simulation(world, engine)
    simulation.run(240)
    assert len(simulation.contacts()) or any(box.sleeping for box in boxes)
    for i, box in enumerate(boxes):
        np.testing.assert_allclose(box.position, (0, 0, 0.5 + i), atol=0.05)
    assert simulation.summary().kinetic_energy < 1e-2


def test_forces_act_during_one_step(engine: Engine, empty: Maker) -> None:
    world = empty()
    body = world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    body.force = (body.mass * 240.0, 0.0, 0.0)
    simulation = Simulation(world, engine)
    simulation.run(1)
    assert body.linear_velocity[0] == pytest.approx(1.0)
    np.testing.assert_array_equal(body.force, 0.0)
    simulation.run(10)
    assert body.linear_velocity[0] == pytest.approx(1.0)

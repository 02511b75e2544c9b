"""Contacts against closed forms: rebounds, sliding, oblique impacts, and slow motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from colladaphy.engines import Simulation, kinetic_energy, potential_energy
from colladaphy.engines.mujoco_engine import MujocoEngine
from colladaphy.world import Body, BodyColumns, Kind, World

G = 9.81


def ground(
    restitution: float, friction: float, *, gravity: float = G, dt: float = 1 / 240
) -> World:
    world = World((0, 0, -gravity), time_step=dt)
    world.create_material(
        "ball", density=1000, restitution=restitution, static_friction=friction / 2,
        dynamic_friction=friction / 2, poisson_ratio=0.3, young_modulus=1, stiffness=1,
        damping_normal=0, damping_tangential=0,
    )  # fmt: skip
    world.set_pair("ball", "ball", restitution=restitution)
    world.create_plane(1, (0, 0, 1), 0, "ball")
    return world


def sphere(world: World, height: float, velocity: Any) -> Body:
    return world.create_sphere(2, (0, 0, height + 0.5), 0.5, "ball", linear_velocity=velocity)


def box(world: World, height: float, velocity: Any) -> Body:
    return world.create_box(2, (0, 0, height + 0.5), (1, 1, 1), "ball", linear_velocity=velocity)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("speed", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("dt", [1 / 60, 1 / 240, 1 / 1000])
@pytest.mark.parametrize("solver", ["newton", "cg"])
@pytest.mark.parametrize("make", [sphere, box])
def test_drops_rebound_by_their_restitution(
    make: Callable[[World, float, Any], Body], restitution: float, speed: float, dt: float,
    solver: str,
) -> None:  # fmt: skip
    for phase in (0.0, 0.3, 0.6, 0.9):  # of a step, in which the ground is met
        world = ground(restitution, 0.4, gravity=0.0, dt=dt)
        body = make(world, (1.5 + phase) * speed * dt, (0, 0, -speed))
        Simulation(world, MujocoEngine(solver=solver)).run(40)
        assert body.linear_velocity[2] / speed == pytest.approx(restitution, abs=0.05)


def test_a_ball_that_bounces_loses_what_its_restitution_takes() -> None:
    world = ground(0.8, 0.0)
    body = sphere(world, 1.0, (0, 0, 0))
    simulation, heights, before = Simulation(world, "mujoco"), [], 0.0
    for _ in range(700):
        simulation.run(1)
        speed = body.linear_velocity[2]
        if before > 0 >= speed:
            heights.append(body.position[2] - 0.5)
        before = speed
    np.testing.assert_allclose(heights[:4], 0.64 ** np.arange(1, 5), rtol=0.1)


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("speed", [1.0, 10.0])
def test_a_box_slides_by_coulomb_and_does_not_lift(friction: float, speed: float) -> None:
    world = ground(0.0, friction)
    body = world.create_box(2, (0, 0, 0.25), (2, 2, 0.5), "ball", linear_velocity=(speed, 0, 0))
    steps = min(120, int(0.8 * speed / (friction * G) * 240))
    simulation = Simulation(world, "mujoco")
    for _ in range(steps):
        simulation.run(1)
        assert abs(body.position[2] - 0.25) < 5e-4
    slowed = speed - body.linear_velocity[0]
    assert slowed == pytest.approx(friction * G * steps / 240, rel=2e-3)


@pytest.mark.parametrize("friction", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_oblique_impact_of_a_ball(friction: float, restitution: float) -> None:
    """By Coulomb's law: it slides through the impact, or leaves rolling, at 5/7 of its speed."""
    world = ground(restitution, friction, gravity=0.0)
    body = sphere(world, 0.1, (3, 0, -4))
    Simulation(world, "mujoco").run(60)
    expected = max(3 - friction * (1 + restitution) * 4, 3 * 5 / 7)
    assert body.linear_velocity[0] == pytest.approx(expected, abs=0.03)
    assert body.linear_velocity[2] == pytest.approx(4 * restitution, abs=4 * 0.05)


@pytest.mark.parametrize(
    ("rule", "expected"), [("sum", 0.7), ("average", 0.35), ("product", 0.12), ("maximum", 0.4)]
)
def test_frictions_are_combined_as_asked(rule: str, expected: float) -> None:
    world = World((0, 0, -G), time_step=1 / 240)
    for name, friction in (("a", 0.3), ("b", 0.4)):
        world.create_material(
            name, density=1000, restitution=0, static_friction=friction,
            dynamic_friction=friction, poisson_ratio=0.3, young_modulus=1, stiffness=1,
            damping_normal=0, damping_tangential=0,
        )  # fmt: skip
    world.create_plane(1, (0, 0, 1), 0, "a")
    body = world.create_box(2, (0, 0, 0.25), (2, 2, 0.5), "b", linear_velocity=(5.0, 0, 0))
    Simulation(world, MujocoEngine(friction=rule)).run(60)
    assert 5 - body.linear_velocity[0] == pytest.approx(expected * G / 4, rel=0.01)


@pytest.mark.parametrize("solver", ["newton", "cg"])
def test_a_tower_stands(solver: str) -> None:
    world = World((0, 0, -G), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    boxes = [world.create_box(i, (0, 0, 0.5 + i), (1, 1, 1), "oak") for i in range(10)]
    simulation = Simulation(world, MujocoEngine(solver=solver))
    simulation.run(1200)
    for i, one in enumerate(boxes):
        np.testing.assert_allclose(one.position, (0, 0, 0.5 + i), atol=3e-3)
    assert simulation.summary().kinetic_energy < 1e-3


@pytest.mark.parametrize("sleep", [False, True])
@pytest.mark.parametrize("unit", [1.0, 1000.0])
def test_a_slow_slide_goes_its_way_in_any_unit(sleep: bool, unit: float) -> None:
    """3 cm/s without friction: 30 cm in 10 s, in metres and in millimetres."""
    world = ground(0.0, 0.0, gravity=G * unit)
    body = world.create_box(
        2, (0, 0, 0.5 * unit), (unit, unit, unit), "ball", linear_velocity=(0.03 * unit, 0, 0)
    )
    Simulation(world, MujocoEngine(sleep=sleep)).run(2400)
    assert body.position[0] == pytest.approx(0.3 * unit, rel=1e-3)
    assert body.linear_velocity[0] == pytest.approx(0.03 * unit, rel=1e-3)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1000.0])
def test_what_rests_falls_asleep_in_any_unit_if_asked(unit: float) -> None:
    asleep = []
    for sleep in (False, True):
        world = ground(0.0, 0.5, gravity=G * unit)
        world.create_box(2, (0, 0, 0.5 * unit), (unit, unit, unit), "ball")
        simulation = Simulation(world, MujocoEngine(sleep=sleep))
        simulation.run(480)
        asleep.append(simulation.summary().sleeping)
        np.testing.assert_allclose(world.linear_velocities, 0.0, atol=1e-3 * unit)
    assert asleep == [0, 1]


def test_an_asymmetric_top_keeps_its_energy_beside_what_touches() -> None:
    """20 s at 1/240 to 1e-6, also in a scene in which something else is in contact."""
    for crowd in (False, True):
        world = World((0, 0, -G if crowd else 0), time_step=1 / 240)
        if crowd:
            world.create_plane(1, (0, 0, 1), 0, "granite")
            world.create_sphere(2, (0, 0, 0.5), 0.5, "oak")
        top = world.create_box(
            3, (9, 0, 3000), (1, 2, 3), "oak", angular_velocity=(0.1, 5, 0.1),
            linear_velocity=(1, 0, 0),
        )  # fmt: skip

        def energy(world: World = world) -> float:
            return kinetic_energy(world) + potential_energy(world)

        before, spin = energy(), top.angular_velocity
        Simulation(world, MujocoEngine(integrator="rk4")).run(4800)
        assert np.linalg.norm(top.angular_velocity - spin) > 1.0  # it does tumble
        scale = 0.5 * spin @ top.inertia @ spin
        assert abs(energy() - before) < 1e-6 * (scale + abs(before))


def test_what_is_computed_with_is_said() -> None:
    world = ground(0.0, 0.0)
    sphere(world, 1.0, (0, 0, 0))
    found = {finding.code: finding.message for finding in Simulation(world, "mujoco").report}
    assert "rk4" in found["engine-settings"] and "order 4" in found["engine-settings"]
    for i in range(60):
        world.create_sphere(10 + i, (3 + i, 0, 1), 0.4, "ball")
    found = {finding.code: finding.message for finding in Simulation(world, "mujoco").report}
    assert "cg" in found["engine-settings"] and "order 1" in found["engine-settings"]


def test_pairs_of_many_materials_cost_no_setup() -> None:
    """600 materials, each with a friction and a restitution of its own, and no explicit pairs."""
    world = World((0, 0, -G), time_step=1 / 240)
    for i in range(600):
        world.create_material(
            f"m{i}", density=1000, restitution=i / 600, static_friction=i / 600,
            dynamic_friction=i / 600, poisson_ratio=0.3, young_modulus=1, stiffness=1,
            damping_normal=0, damping_tangential=0,
        )  # fmt: skip
        world.create_sphere(i, (1.5 * i, 0, 0.6), 0.5, f"m{i}")
    world.create_plane(1, (0, 0, 1), 0, "m0")
    engine = MujocoEngine()
    Simulation(world, engine).run(37)
    assert engine._model is not None and engine._model.compiled.npair == 0
    pair = world.pair("m0", "m599")
    np.testing.assert_allclose(engine._model.surfaces.table.restitution[0, -1], pair.restitution)
    bounced = world.linear_velocities[:-1, 2]
    assert bounced[590] > bounced[300] > bounced[10]


@pytest.mark.parametrize(("jointed", "count", "seconds"), [(False, 15_000, 7), (True, 6000, 9)])
def test_a_long_setup_is_announced(jointed: bool, count: int, seconds: int) -> None:
    world = World((0, 0, -G), time_step=1 / 240)
    place = np.stack([np.arange(count) * 2.0, np.zeros(count), np.zeros(count)], axis=-1)
    world.extend(
        BodyColumns(
            kinds=np.full(count, Kind.SPHERE), positions=place,
            dimensions=np.tile([0.5, 0, 0, 0], (count, 1)),
        )
    )  # fmt: skip
    if jointed:
        world.attach_ball_joint(world.bodies[0], world.bodies[1])
    said = [f.message for f in MujocoEngine().check(world) if f.code == "engine-setup"]
    assert len(said) == 1 and f"about {seconds} s" in said[0]

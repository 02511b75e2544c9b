"""Forces, impulses, masses, materials and limits that are given between steps, in both engines.

What they change of momentum is what they are, to rounding; nothing needs a new `Simulation`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import colladaphy
from colladaphy.engines import Engine, Simulation, angular_momentum, kinetic_energy, momentum
from colladaphy.errors import EngineError
from colladaphy.world import Body, World


def pair(empty: Any, *, joined: bool) -> tuple[World, Body, Body]:
    """A union and a box in the plane y = 0, moving, joined by a hinge or not."""
    world: World = empty()
    parts = [world.create_sphere(i, (i, 0, 0), 0.4, "ball") for i in (1, 2)]
    union = world.create_union(3, parts, angular_velocity=(0, 0.5, 0))
    box = world.create_box(4, (3, 0, 0.5), (0.5, 0.5, 0.5), "ball", linear_velocity=(0, 0, 1))
    if joined:
        world.attach_hinge_joint(union, box, axis=(0, 1, 0))
    return world, union, box


@pytest.mark.parametrize("joined", [False, True])
def test_impulses_are_what_momentum_gains(engine: Engine, empty: Any, joined: bool) -> None:
    """Also through joints, which pass them on."""
    world, union, box = pair(empty, joined=joined)
    simulation = Simulation(world, engine)
    simulation.run(3)
    before = momentum(world), angular_momentum(world)
    impulse, at = np.array((40.0, 0, 70)), np.array((2.5, 0, 0.3))
    union.members[1].apply_impulse(impulse, at=at)
    box.apply_impulse(-0.5 * impulse)
    moment = np.cross(at, impulse) - 0.5 * np.cross(box.position, impulse)
    simulation.run(1)
    size = float(np.linalg.norm(before[0])) + 100
    np.testing.assert_allclose(momentum(world), before[0] + 0.5 * impulse, atol=1e-9 * size)
    # A first-order step moves bodies on straight lines, and keeps what it has about the origin.
    np.testing.assert_allclose(angular_momentum(world), before[1] + moment, atol=1e-6 * size)


def test_forces_at_points_turn_and_push_for_one_step(engine: Engine, empty: Any) -> None:
    world, union, _ = pair(empty, joined=False)
    simulation = Simulation(world, engine)
    simulation.run(2)
    before = momentum(world), angular_momentum(world)
    force = np.array((300.0, 0, -200))
    at = union.velocity_at((2, 0, 0)) / 240 + (2, 0, 0)
    arm = at - union.position
    union.apply_force(force, at=at)
    simulation.run(1)
    gained = momentum(world) - before[0]
    np.testing.assert_allclose(gained, force / 240, atol=1e-9 * np.linalg.norm(before[0]))
    spin = angular_momentum(world) - before[1]
    np.testing.assert_allclose(spin[1], np.cross(union.position + arm, force)[1] / 240, rtol=2e-2)
    assert not world.forces.any() and not world.torques.any()


def test_a_pushed_spin_is_the_closed_form(engine: Engine, empty: Any) -> None:
    """A couple on a free box: ω = M t / I."""
    world = empty()
    box = world.create_box(1, (0, 0, 0), (1, 1, 1), "ball")

    def couple(_: World, __: float) -> None:
        reach = np.array((0.0, 0.0, 0.5))
        box.apply_force((30, 0, 0), at=box.position + reach)
        box.apply_force((-30, 0, 0), at=box.position - reach)

    simulation = Simulation(world, engine, forces=couple)
    simulation.run(240)
    assert box.angular_velocity[1] == pytest.approx(30 / box.inertia[1, 1], rel=1e-9)
    np.testing.assert_allclose(box.linear_velocity, 0, atol=1e-12)


def test_masses_materials_and_limits_are_taken_up(engine: Engine, empty: Any) -> None:
    world = empty((0, 0, -10))
    world.create_material(
        "bouncy", density=1, restitution=1, static_friction=0, dynamic_friction=0,
        poisson_ratio=0.3, young_modulus=100, stiffness=100, damping_normal=0,
        damping_tangential=0,
    )  # fmt: skip
    for other in ("ball", "bouncy"):
        world.set_pair("bouncy", other, restitution=1.0)
    floor = world.create_box(1, (0, 0, -0.5), (9, 9, 1), "ball", fixed=True)
    body = world.create_sphere(2, (0, 0, 2), 0.5, "ball")
    simulation = Simulation(world, engine)
    simulation.run(24)
    body.mass *= 2
    start = body.linear_velocity[2]
    body.apply_force((0, 0, 20 * body.mass))
    simulation.run(1)
    assert body.linear_velocity[2] - start == pytest.approx(10 / 240)
    body.material = "bouncy"
    simulation.run(140)
    assert body.linear_velocity[2] > 1.0, "it bounces"
    del floor

    swing = empty((0, 0, -10))
    bob = swing.create_sphere(1, (1, 0, 0), 0.1, "ball")
    hinge = swing.attach_hinge_joint(None, bob, anchor1=(0, 0, 0), axis=(0, 1, 0))
    run = Simulation(swing, engine)
    run.run(10)
    assert hinge.coordinates[0] > 0.005 and hinge.speed[0] > 0.1
    hinge.angular_max = (0, 0, 0.3)
    hinge.angular_min = (0, 0, -0.3)
    run.run(480)
    assert hinge.coordinates[0] < 0.32
    energy = kinetic_energy(swing)
    hinge.angular_min, hinge.angular_max = (0, 0, -math.inf), (0, 0, math.inf)
    run.run(60)
    assert hinge.coordinates[0] > 0.5 and kinetic_energy(swing) > energy


def test_coordinates_are_those_of_the_pendulum(engine: Engine, empty: Any) -> None:
    """Energy in the hinge's own terms: ½ I φ̇² = m g (cos φ0 - cos φ) of a pendulum."""
    world = empty((0, 0, -10))
    bob = world.create_sphere(1, (0, 0, -1), 0.1, "ball")
    hinge = world.attach_hinge_joint(None, bob, anchor1=(0, 0, 0), axis=(0, 1, 0))
    inertia = bob.mass * (1 + 0.4 * 0.01)
    bob.apply_impulse((bob.mass * 2.0, 0, 0))
    start = bob.mass * 2.0 / inertia  # the joint makes of the blow a turn about it
    Simulation(world, engine).run(60)
    angle, speed = hinge.coordinates[0], hinge.speed[0]
    assert abs(angle) > 0.3
    lost = 0.5 * inertia * (start**2 - speed**2)
    assert lost == pytest.approx(bob.mass * 10 * (1 - math.cos(angle)), rel=0.02)


def test_unions_that_are_not_their_members_are_said(engine: Engine, empty: Any) -> None:
    world, union, _ = pair(empty, joined=False)
    assert "engine-union-differs" not in {f.code for f in Simulation(world, engine).report}
    world.member_columns.masses[:] *= 2
    found = [f for f in Simulation(world, engine).report if f.code == "engine-union-differs"]
    assert len(found) == 1 and repr(union) in found[0].message
    union.add_up()
    assert "engine-union-differs" not in {f.code for f in Simulation(world, engine).report}


def test_world_run_is_that_of_pe(empty: Any) -> None:
    world = empty((0, 0, -10))
    ball = world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    run = world.run(100, 0.01, engine="pymunk")
    assert isinstance(run, colladaphy.Simulation) and run.engine.name == "pymunk"
    assert world.step_count == 100 and world.time == pytest.approx(1.0)
    assert ball.linear_velocity[2] == pytest.approx(-10)
    run.run(100)
    world.run(100)
    assert world.time_step == 0.01 and ball.linear_velocity[2] == pytest.approx(-30)
    with pytest.raises(EngineError, match="engine-unknown"):
        world.run(1, engine="havok")

"""Motors of joints: a speed, with a limited force or torque, in both engines and in files."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import colladaphy
from colladaphy.engines import (
    Engine,
    Simulation,
    angular_momentum,
    choose,
    create_engine,
    momentum,
)
from colladaphy.errors import EngineError, WorldError
from colladaphy.world import Joint, World, compare

STEP = 1 / 240


def wheel(
    empty: Any, *, reverse: bool = False, axis: Any = (0, 1, 0), gravity: Any = (0, 0, 0)
) -> tuple[World, Joint, float]:
    """A bob that turns about the origin, with the moment of inertia about that."""
    world: World = empty(gravity)
    bob = world.create_sphere(1, (0, 0, -1), 0.1, "ball", mass=2)
    one, two = (bob, None) if reverse else (None, bob)
    anchors = {"anchor1": (0, 0, 1)} if reverse else {"anchor1": (0, 0, 0)}
    joint = world.attach_hinge_joint(one, two, axis=axis, **anchors)
    return world, joint, 2 * (1 + 0.4 * 0.01)


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("axis", [(0, 1, 0), (0, -1, 0)])
@pytest.mark.parametrize("speed", [3.0, -3.0])
def test_a_motor_speeds_up_by_its_torque_and_holds_its_speed(
    engine: Engine, empty: Any, reverse: bool, axis: Any, speed: float
) -> None:
    """ω = M t / I until it is the motor's."""
    world, joint, inertia = wheel(empty, reverse=reverse, axis=axis)
    joint.motor = (speed, 4.0)
    simulation = Simulation(world, engine)
    simulation.run(120)
    along = math.copysign(1, speed)
    assert joint.speed[0] * along == pytest.approx(4.0 * 120 * STEP / inertia, rel=1e-3)
    assert joint.coordinates[0] * along == pytest.approx(0.5 * 4.0 * 0.25 / inertia, rel=0.02)
    simulation.run(480)
    assert joint.speed[0] == pytest.approx(speed, rel=2e-3)


def test_a_motor_between_two_bodies_keeps_momentum(engine: Engine, empty: Any) -> None:
    world = empty()
    one = world.create_box(1, (0, 0, 0), (1, 1, 1), "ball", linear_velocity=(1, 0, 2))
    two = world.create_box(2, (1.5, 0, 0), (1, 1, 0.5), "ball", linear_velocity=(1, 0, 2))
    joint = world.attach_hinge_joint(one, two, axis=(0, 1, 0), motor=(2.0, 300.0))
    before, spin = momentum(world), angular_momentum(world)
    Simulation(world, engine).run(480)
    assert joint.speed[0] == pytest.approx(2.0, rel=5e-3)
    # MuJoCo's steps of first order are in the joints' coordinates, not in the bodies'.
    slack = {"pymunk": 1e-9, "mujoco": 1e-4}[engine.name] * np.abs(before).max()
    np.testing.assert_allclose(momentum(world), before, atol=slack)
    np.testing.assert_allclose(angular_momentum(world), spin, atol=2e-2 * np.abs(before).max())


def test_a_strong_motor_lifts_and_a_weak_one_sags(engine: Engine, empty: Any) -> None:
    for strength, lifts in ((40.0, True), (10.0, False)):
        world, joint, _ = wheel(empty, gravity=(0, 0, -10))  # m g l is 20
        joint.motor = (0.5, strength)
        Simulation(world, engine).run(480)
        if lifts:
            assert joint.coordinates[0] == pytest.approx(1.0, rel=0.02)
        else:  # it swings about where the torque is in balance
            assert abs(joint.coordinates[0]) < 2 * math.asin(10 / 20) + 0.05


def test_contacts_and_limits_win(engine: Engine, empty: Any) -> None:
    world, joint, _ = wheel(empty)
    world.create_box(2, (0.7, 0, -1), (0.5, 3, 3), "ball", fixed=True)
    joint.motor = (-1.0, 5.0)  # towards +x
    Simulation(world, engine).run(480)
    bob = joint.body2
    assert bob is not None and bob.position[0] < 0.37
    assert abs(joint.speed[0]) < 0.02
    world, joint, _ = wheel(empty)
    joint.motor = (1.0, 5.0)
    joint.angular_min, joint.angular_max = (0, 0, -0.5), (0, 0, 0.5)
    Simulation(world, engine).run(480)
    assert joint.coordinates[0] == pytest.approx(0.5, abs=0.03)


def test_motors_are_taken_up_by_a_running_engine(engine: Engine, empty: Any) -> None:
    world, joint, _ = wheel(empty)
    simulation = Simulation(world, engine)
    simulation.run(10)
    assert joint.speed[0] == 0
    joint.motor = (1.0, 30.0)
    simulation.run(144)  # pymunk's overshoots, and settles
    assert joint.speed[0] == pytest.approx(1.0, rel=1e-2)
    joint.motor = None
    joint.body2.apply_force((50, 0, 0))  # type: ignore[union-attr]
    simulation.run(1)
    assert joint.motor == (0, 0) and joint.speed[0] != pytest.approx(1.0, rel=3e-2)


def test_a_run_with_a_motor_is_resumed_to_the_last_bit(
    engine: Engine, empty: Any, tmp_path: Path
) -> None:
    world, joint, _ = wheel(empty, gravity=(0, 0, -9.81))
    joint.motor = (0.1 + 0.2, 1 / 3)
    going = Simulation(world, engine)
    going.run(30)
    file = going.checkpoint(tmp_path / "a.dae")
    resumed = Simulation.resume(file)
    assert resumed.world.joints[0].motor == (0.1 + 0.2, 1 / 3)
    for simulation in (going, resumed):
        simulation.run(60)
    assert compare(going.world, resumed.world) == []
    assert colladaphy.validate(file).valid


def test_sliders_are_driven_by_mujoco_alone(empty: Any) -> None:
    world = empty()
    cart = world.create_box(1, (0, 0, 0), (1, 1, 1), "ball", mass=4)
    joint = world.attach_slider_joint(None, cart, axis=(1, 0, 0), motor=(2.0, 8.0))
    with pytest.raises(EngineError, match="engine-joint-motor"):
        Simulation(world, "pymunk")
    assert choose(world)[0].name == "mujoco"
    simulation = Simulation(world)
    simulation.run(120)
    assert joint.speed[0] == pytest.approx(8.0 * 0.5 / 4, rel=1e-3)
    simulation.run(240)
    assert joint.speed[0] == pytest.approx(2.0, rel=2e-3)


def test_motors_that_cannot_be(engine: Engine, empty: Any) -> None:
    world = empty()
    ball = world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    joint = world.attach_ball_joint(None, ball, motor=(1, 1))
    with pytest.raises(EngineError, match="engine-joint-motor"):
        Simulation(world, engine)
    with pytest.raises(WorldError, match="physics-joint-value"):
        joint.motor = (2, 1)
    joint.motor = None
    Simulation(world, engine).run(1)
    ring = empty()
    boxes = [ring.create_box(i, (i % 2, 0, i // 2), (0.5, 0.5, 0.5), "ball") for i in range(4)]
    for one, two in ((0, 1), (1, 3), (3, 2)):
        ring.attach_hinge_joint(boxes[one], boxes[two], axis=(0, 1, 0), motor=(1, 1))
    ring.attach_hinge_joint(boxes[2], boxes[0], axis=(0, 1, 0), motor=(1, 1))
    with pytest.raises(EngineError, match="engine-joint-loop"):
        Simulation(ring, "mujoco")


@pytest.mark.parametrize("solver", ["newton", "cg"])
@pytest.mark.parametrize("integrator", ["rk4", "implicitfast", "euler"])
def test_every_solver_drives(empty: Any, solver: str, integrator: str) -> None:
    world, joint, _ = wheel(empty, gravity=(0, 0, -10))
    joint.motor = (0.5, 40.0)
    top = world.create_box(5, (9, 0, 0), (1, 2, 3), "ball", angular_velocity=(1, 2, 3))
    Simulation(world, create_engine("mujoco", solver=solver, integrator=integrator)).run(240)
    assert joint.coordinates[0] == pytest.approx(0.5, rel=0.02)
    assert np.any(top.angular_velocity != (1, 2, 3))


def test_units_of_motors(tmp_path: Path) -> None:
    world = World(unit=("centimeter", 0.01), up_axis="Z_UP")
    bodies = [world.create_sphere(i, (i * 300, 0, 0), 50, "oak", mass=5) for i in range(2)]
    world.attach_slider_joint(None, bodies[0], axis=(1, 0, 0), motor=(200, 300))
    world.attach_hinge_joint(None, bodies[1], axis=(1, 0, 0), motor=(2, 30_000))
    colladaphy.write(world, tmp_path / "a.dae")
    si = colladaphy.read(tmp_path / "a.dae").load(si=True)
    assert si.joints[0].motor == pytest.approx((2, 3))
    assert si.joints[1].motor == pytest.approx((2, 3))

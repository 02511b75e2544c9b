"""Joints and velocities: momentum is kept, the nearest motion is found, and drift stays small."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.engines import (
    Engine,
    Simulation,
    angular_momentum,
    create_engine,
    kinetic_energy,
    momentum,
)
from colladaphy.errors import EngineError
from colladaphy.world import Body, World, rotations

AT_LOAD = 1e-6
"""A time step so short that the World after it is the World at load."""


def listing_1(*, swapped: bool) -> tuple[World, list[Body]]:
    """Thesis listing 1: two spheres, one of them moving, and a fixed joint between them."""
    world = World(time_step=AT_LOAD)
    places = [((2, 4, 0), (0, -0.4, 0)), ((2, 5, 1), (0, 0, 0))]
    order = (1, 0) if swapped else (0, 1)
    made = {i: world.create_sphere(1, places[i][0], 0.5, "iron", linear_velocity=places[i][1])
            for i in order}  # fmt: skip
    world.attach_fixed_joint(made[0], made[1])
    return world, [made[0], made[1]]


@pytest.mark.parametrize("swapped", [False, True])
def test_listing_1_keeps_its_momentum(engine: Engine, swapped: bool) -> None:
    world, bodies = listing_1(swapped=swapped)
    before, spin = momentum(world), angular_momentum(world)
    simulation = Simulation(world, engine)
    assert "engine-joint-velocity" in {finding.code for finding in simulation.report}
    simulation.run(1)
    np.testing.assert_allclose(momentum(world), before, atol=1e-9 * abs(before[1]))
    np.testing.assert_allclose(angular_momentum(world), spin, atol=1e-9 * np.abs(spin).max())
    assert before[1] == pytest.approx(-1649, rel=1e-3)
    middle = (bodies[0].linear_velocity + bodies[1].linear_velocity) / 2
    np.testing.assert_allclose(middle, (0, -0.2, 0), atol=1e-6)
    for body in bodies:
        np.testing.assert_allclose(body.angular_velocity, (-1 / 6, 0, 0), atol=1e-6)


def rows_of(one: Body, two: Body, kind: str, point: Any, axis: Any) -> np.ndarray:
    """What a joint forbids of (v, ω) of two bodies, (k, 12): by hand, from its definition."""
    axis = np.array(axis) / np.linalg.norm(axis)
    across = np.linalg.svd(axis[None])[2][1:]
    shifts = {"slider": across}.get(kind, np.eye(3))
    turns = {"hinge": across, "ball": np.zeros((0, 3))}.get(kind, np.eye(3))
    rows = []
    for way in shifts:
        arms = [np.cross(np.array(point) - body.position, way) for body in (one, two)]
        rows.append(np.concatenate([-way, -arms[0], way, arms[1]]))
    rows += [np.concatenate([np.zeros(3), -way, np.zeros(3), way]) for way in turns]
    return np.array(rows).reshape(-1, 12)


def nearest(bodies: list[Body], joints: list[tuple[int, int, np.ndarray]]) -> np.ndarray:
    """The motion (n, 6) nearest by kinetic energy to that of `bodies`, densely, by the formula."""
    size = 6 * len(bodies)
    inverse = np.zeros((size, size))
    motion = np.zeros(size)
    for i, body in enumerate(bodies):
        motion[6 * i : 6 * i + 6] = [*body.linear_velocity, *body.angular_velocity]
        if not body.fixed:
            tensor = rotations.rotate_tensor(body.orientation, body.inertia)
            inverse[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = np.eye(3) / body.mass
            inverse[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = np.linalg.inv(tensor)
        else:
            motion[6 * i : 6 * i + 6] = 0.0
    jacobian = np.zeros((sum(len(rows) for _, _, rows in joints), size))
    place = 0
    for one, two, rows in joints:
        part = jacobian[place : place + len(rows)]
        part[:, 6 * one : 6 * one + 6] = rows[:, :6]
        part[:, 6 * two : 6 * two + 6] = rows[:, 6:]
        place += len(rows)
    weight = jacobian @ inverse @ jacobian.T
    impulses = np.linalg.lstsq(weight, jacobian @ motion, rcond=1e-11)[0]
    return (motion - inverse @ jacobian.T @ impulses).reshape(-1, 6)


KINDS = ("fixed", "hinge", "ball", "slider")


def attach(world: World, kind: str, one: Body, two: Body, point: Any, axis: Any) -> None:
    at = [rotations.unrotate(body.orientation, np.array(point) - body.position)
          for body in (one, two)]  # fmt: skip
    own = [rotations.unrotate(body.orientation, np.array(axis, dtype=float)) for body in (one, two)]
    if kind == "fixed":
        world.attach_fixed_joint(one, two)
    elif kind == "ball":
        world.attach_ball_joint(one, two, anchor1=at[0], anchor2=at[1])
    elif kind == "hinge":
        world.attach_hinge_joint(one, two, anchor1=at[0], anchor2=at[1], axis=own[0])
    else:
        world.attach_slider_joint(one, two, anchor1=at[0], anchor2=at[1], axis=own[0])


vectors = st.tuples(*[st.floats(-2, 2).map(lambda x: round(x, 3))] * 3)


@st.composite
def trees(draw: st.DrawFn, *, flat: bool, loop: bool = False) -> Any:
    """Boxes of any velocities, one joined to another of those before; perhaps a loop of them."""
    world = World(time_step=AT_LOAD)
    count = 3 if loop else draw(st.integers(2, 4))
    bodies = []
    for i in range(count):
        x, y, z = draw(vectors)
        place, speed, spin = (2.5 * i + x, 0 if flat else y, z), draw(vectors), draw(vectors)
        if flat:
            speed, spin = (speed[0], 0, speed[2]), (0, spin[1], 0)
        bodies.append(world.create_box(
            i, place, (1e-3, 1e-3, 1e-3), "oak", mass=1.0 + i, inertia=(0.3, 0.4, 0.35 + 0.1 * i),
            linear_velocity=speed, angular_velocity=spin,
            fixed=i == 0 and not loop and draw(st.booleans()),
        ))  # fmt: skip
        if bodies[0].fixed:
            bodies[0].linear_velocity = bodies[0].angular_velocity = (0, 0, 0)
        if not flat:
            bodies[-1].rotate(*draw(vectors))
    joints = []
    ends = [(draw(st.integers(0, i - 1)), i) for i in range(1, count)]
    if loop:
        ends = [(0, 1), (1, 2), (2, 0)]
    for one, two in ends:
        kind = draw(st.sampled_from(("fixed", "hinge", "ball") if loop else KINDS))
        point = draw(vectors)
        axis = (0.6, 0, 0.8) if kind == "slider" else (0, 1, 0)
        if flat:
            point = (point[0], 0, point[2])
            kind = "hinge" if kind == "ball" else kind
        else:
            axis = draw(vectors.filter(lambda v: sum(x * x for x in v) > 0.5))
        attach(world, kind, bodies[one], bodies[two], point, axis)
        joints.append((one, two, rows_of(bodies[one], bodies[two], kind, point, axis)))
    for joint in world.joints:
        joint.interpenetrate = True
    return world, bodies, joints


def check_nearest(name: str, case: Any) -> None:
    world, bodies, joints = case
    expected = nearest(bodies, joints)
    still = [body for body in bodies if body.fixed]
    before, spin = momentum(world), angular_momentum(world)
    Simulation(world, name).run(1)
    found = np.concatenate([world.linear_velocities, world.angular_velocities], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-4)
    if not still:
        np.testing.assert_allclose(momentum(world), before, atol=1e-9 * 20)
        np.testing.assert_allclose(angular_momentum(world), spin, atol=1e-9 * 100)


@settings(max_examples=40, deadline=None)
@given(trees(flat=False))
def test_nearest_motion_of_trees(case: Any) -> None:
    check_nearest("mujoco", case)


@settings(max_examples=20, deadline=None)
@given(trees(flat=False, loop=True))
def test_nearest_motion_of_loops(case: Any) -> None:
    check_nearest("mujoco", case)


@settings(max_examples=40, deadline=None)
@given(trees(flat=True))
def test_nearest_motion_in_the_plane(case: Any) -> None:
    for name in ("pymunk", "mujoco"):
        world = case[0]
        kept = np.array(world.linear_velocities), np.array(world.angular_velocities)
        poses = np.array(world.positions), np.array(world.orientations)
        check_nearest(name, case)
        world.linear_velocities, world.angular_velocities = kept
        world.positions, world.orientations = poses
        world.time, world.step_count, world.engine_state = 0.0, 0, None


@settings(max_examples=20, deadline=None)
@given(trees(flat=True, loop=True))
def test_nearest_motion_of_loops_in_the_plane(case: Any) -> None:
    check_nearest("pymunk", case)


def test_motion_that_joints_allow_is_left_and_not_reported(engine: Engine) -> None:
    world = World(time_step=1 / 240)
    one = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", angular_velocity=(0, 1, 0))
    two = world.create_box(2, (2, 0, 0), (1, 1, 1), "oak", linear_velocity=(0, 0, -2),
                           angular_velocity=(0, 1, 0))  # fmt: skip
    world.attach_fixed_joint(one, two)
    codes = {finding.code for finding in Simulation(world, engine).report}
    assert "engine-joint-velocity" not in codes and "engine-joint-displaced" not in codes


def sliders(seed: int) -> tuple[World, Body, Body, np.ndarray]:
    """Two boxes of any motion, and a slider between them off the line of their centres."""
    random = np.random.default_rng(seed)
    world = World(time_step=1 / 240)
    made = []
    for i in range(2):
        place, speed = random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)
        place[1] = speed[1] = 0.0
        made.append(world.create_box(
            i, place, (0.6, 0.6, 0.6), "oak", mass=random.uniform(0.5, 2),
            inertia=np.full(3, random.uniform(0.05, 0.3)), linear_velocity=speed,
            angular_velocity=(0, random.uniform(-2, 2), 0),
        ))  # fmt: skip
    one, two = made
    angle = random.uniform(0, 2 * math.pi)
    axis = np.array((math.cos(angle), 0, math.sin(angle)))
    point = random.uniform(-1, 1, 3) * (1, 0, 1)
    world.attach_slider_joint(
        one, two, anchor1=point - one.position, anchor2=point - two.position, axis=axis,
        interpenetrate=True,
    )  # fmt: skip
    return world, one, two, axis


@pytest.mark.parametrize("seed", range(30))
def test_sliders_between_moving_bodies_are_stable(engine: Engine, seed: int) -> None:
    """They stay on their line, and energy, momentum and angular momentum stay what they are."""
    world, one, two, axis = sliders(seed)
    start = two.position - one.position
    simulation = Simulation(world, engine)
    simulation.run(1)
    energy, before, spin = kinetic_energy(world), momentum(world), angular_momentum(world)
    for _ in range(20):
        simulation.run(24)
        assert kinetic_energy(world) == pytest.approx(energy, rel=0.03)
        off = rotations.unrotate(one.orientation, two.position - one.position) - start
        assert np.linalg.norm(np.cross(axis, off)) < 0.01
    np.testing.assert_allclose(momentum(world), before, atol=1e-9)
    np.testing.assert_allclose(angular_momentum(world), spin, atol=1e-7)


@pytest.mark.parametrize("amplitude", [0.1, 1.0])
def test_a_pendulum_keeps_its_swing(engine: Engine, amplitude: float) -> None:
    """Ten seconds at 1/240, to a part in a thousand."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    place = (math.sin(amplitude), 0, -math.cos(amplitude))
    bob = world.create_sphere(1, place, 0.2, "iron")
    world.attach_hinge_joint(None, bob, anchor1=(0, 0, 0), axis=(0, 1, 0))
    simulation = Simulation(world, engine)
    simulation.run(1800)
    widest = 0.0
    for _ in range(600):
        simulation.run(1)
        widest = max(widest, abs(math.atan2(bob.position[0], -bob.position[2])))
    assert widest == pytest.approx(amplitude, rel=1e-3)


def test_a_slow_slide_goes_its_way(engine: Engine, empty: Any) -> None:
    """3 cm/s without friction: 30 cm in 10 s."""
    world = empty((0, 0, -9.81))
    world.create_plane(1, (0, 0, 1), 0, "ball")
    box = world.create_box(2, (0, 0, 0.5), (1, 1, 1), "ball", linear_velocity=(0.03, 0, 0))
    Simulation(world, engine).run(2400)
    assert box.position[0] == pytest.approx(0.3, rel=2e-3)
    assert box.linear_velocity[0] == pytest.approx(0.03, rel=2e-3)


@pytest.mark.parametrize("name", ["pymunk", "mujoco"])
def test_sleep_is_the_users_choice(name: str, empty: Any) -> None:
    world = empty((0, 0, -9.81), friction=0.5)
    world.create_plane(1, (0, 0, 1), 0, "ball")
    box = world.create_box(2, (0, 0, 0.5), (1, 1, 1), "ball")
    Simulation(world, name).run(480)
    assert not box.sleeping
    asleep = Simulation(world, create_engine(name, sleep=True))
    asleep.run(480)
    assert box.sleeping and not np.any(box.linear_velocity)
    awake = Simulation(world, name)
    assert "engine-awake" in {finding.code for finding in awake.report}
    awake.run(1)
    assert not box.sleeping


WRONG = {
    "engine-joint-displaced": {"anchor1": (0, 0, 0), "anchor2": (-1, 0, 0.25)},
    "engine-joint-outside": {"anchor2": (-1, 0, 0), "limits": (0.5, 1.0)},
    "engine-joint-limits": {"anchor2": (-1, 0, 0), "limits": (0.5, -0.5)},
}


@pytest.mark.parametrize("code", WRONG)
def test_joints_that_do_not_fit_are_found_alike(engine: Engine, code: str) -> None:
    world = World(time_step=1 / 240)
    one = world.create_box(1, (0, 0, 0), (0.5, 0.5, 0.5), "oak")
    two = world.create_box(2, (1, 0, 0), (0.5, 0.5, 0.5), "oak")
    world.attach_hinge_joint(one, two, axis=(0, 1, 0), **WRONG[code])
    found = {finding.code for finding in engine.check(world)}
    assert {name for name in found if name.startswith("engine-joint")} == {code}
    if code == "engine-joint-limits":
        with pytest.raises(EngineError, match=code):
            Simulation(world, engine)


@pytest.mark.parametrize("interpenetrate", [False, True])
def test_joined_bodies_that_overlap_are_found(engine: Engine, interpenetrate: bool) -> None:
    world = World(time_step=1 / 240)
    one = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak")
    two = world.create_box(2, (0.9, 0, 0), (1, 1, 1), "oak")
    world.attach_hinge_joint(one, two, axis=(0, 1, 0), interpenetrate=interpenetrate)
    codes = [finding.code for finding in Simulation(world, engine).report]
    assert ("engine-joint-overlap" in codes) is not interpenetrate


def test_what_is_not_used_is_said_once(engine: Engine) -> None:
    world = World((0, 0, -9.81), time_step=1 / 240)
    plane = world.create_plane(1, (0, 0, 1), 0, "granite")
    world.create_box(2, (0, 0, 0.5), (1, 1, 1), "oak")
    plane.linear_velocity = (1, 0, 0)
    found = list(Simulation(world, engine).report)
    codes = [finding.code for finding in found]
    assert codes.count("engine-still-velocity") == codes.count("engine-material-unused") == 1
    said = next(f.message for f in found if f.code == "engine-material-unused")
    assert "Young's modulus" in said and "stiffness" in said and "damping" not in said


def test_beyond_all_measure_is_diverged(engine: Engine, empty: Any) -> None:
    world = empty()
    body = world.create_sphere(1, (0, 0, 0), 0.5, "ball")
    world.attach_slider_joint(
        None,
        body,
        axis=(1, 0, 0),
        anchor1=(-0.1, 0, 0),
        anchor2=(0, 0, 0),
        linear_spring=(1e7 * body.mass, 0, 0),
    )
    simulation = Simulation(world, engine)
    with pytest.raises(EngineError, match="engine-diverged"):
        simulation.run(5000)

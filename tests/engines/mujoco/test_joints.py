"""Joints as kinematic trees: poses, velocities, directions, loops, and what is refused."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from colladaphy.engines import Simulation, create_engine
from colladaphy.engines.frames import ORIGIN, Pose
from colladaphy.engines.jointed import misfit
from colladaphy.engines.mujoco_engine.forest import plan
from colladaphy.engines.mujoco_engine.refusals import check
from colladaphy.errors import EngineError
from colladaphy.world import FREE, Body, World, rotations

INF = float("inf")
number = st.floats(-2, 2, allow_subnormal=False)
vector = st.tuples(number, number, number)
quaternion = st.tuples(number, number, number, number).filter(lambda q: sum(x * x for x in q) > 0.1)
frame = st.tuples(vector, quaternion)


def codes(world: World) -> list[str]:
    return [finding.code for finding in check(world)]


def pose(body: Body | None) -> Pose:
    return ORIGIN if body is None else Pose.of(body.position, body.orientation)


@st.composite
def axis(draw: st.DrawFn, most: float) -> tuple[float, float, float]:
    """Lower limit, upper limit and a coordinate within: locked, limited or free."""
    kind = draw(st.sampled_from(["locked", "locked at", "limited", "free"]))
    at = draw(st.floats(-most, most))
    if kind == "locked":
        return 0.0, 0.0, 0.0
    if kind == "locked at":
        return at, at, at
    return (-most, most, at) if kind == "limited" else (-INF, INF, at)


@st.composite
def jointed(draw: st.DrawFn) -> tuple[World, Any, bool]:
    """Two boxes, or one and the world, that a joint of any kind holds as they are."""
    world = World(time_step=0.01)
    shifts = [draw(axis(1.0)) for _ in range(3)]
    turns = [draw(axis(1.2)) for _ in range(3)]
    one = Pose.of(draw(vector), draw(quaternion))
    frame1, frame2 = draw(frame), draw(frame)
    turn = np.array(rotations.IDENTITY)
    for unit, (_, _, angle) in zip(np.eye(3), turns, strict=True):
        turn = rotations.multiply(turn, rotations.from_axis_angle(unit, angle))
    between = Pose.of([value for _, _, value in shifts], turn)
    two = one @ Pose.of(*frame1) @ between @ Pose.of(*frame2).inverse()
    grounded = draw(st.sampled_from(["none", "first", "second", "second is the world"]))
    if grounded == "second is the world":
        one, two = two.inverse() @ one, ORIGIN
    options: dict[str, Any] = {"mass": 1.0, "inertia": (1.0, 1.1, 1.2)}
    first = world.create_box(
        1, one.position, (0.1, 0.1, 0.1), "oak", orientation=one.orientation,
        fixed=grounded == "first", **options,
    )  # fmt: skip
    second: Body | None = None
    if grounded != "second is the world":
        second = world.create_box(
            2, two.position, (0.1, 0.1, 0.1), "oak", orientation=two.orientation,
            fixed=grounded == "second", **options,
        )  # fmt: skip
    joint = world.attach_joint(
        first, second, frame1=frame1, frame2=frame2, interpenetrate=True,
        linear_min=[a[0] for a in shifts], linear_max=[a[1] for a in shifts],
        angular_min=[a[0] for a in turns], angular_max=[a[1] for a in turns],
    )  # fmt: skip
    freely = sum(low != high for low, high, _ in turns) == 3
    return world, joint, freely


def placed(world: World) -> Any:
    """The engine with `world` loaded, and MuJoCo's poses computed."""
    engine = create_engine("mujoco")
    engine.load(world)
    mujoco.mj_kinematics(engine._model.compiled, engine._data)
    return engine


@settings(max_examples=80)
@given(jointed())
def test_bodies_stay_where_the_joint_lets_them_be(case: tuple[World, Any, bool]) -> None:
    world, joint, _ = case
    off, angle = misfit(joint, pose(joint.body1), pose(joint.body2))
    assert off < 1e-9 and angle < 1e-6
    engine = placed(world)
    for body in (joint.body1, joint.body2):
        if body is None or body.fixed:
            continue
        id = engine._model.bodies[body.sid]
        np.testing.assert_allclose(engine._data.xpos[id], body.position, atol=1e-9)
        turn = rotations.multiply(rotations.conjugate(body.orientation), engine._data.xquat[id])
        assert abs(abs(turn[0]) - 1.0) < 1e-9


@settings(max_examples=40)
@given(jointed(), st.lists(number, min_size=12, max_size=12))
def test_velocities_come_back(case: tuple[World, Any, bool], speeds: list[float]) -> None:
    """Any speeds of the joint's freedoms are velocities of the bodies, and back."""
    world, _, _ = case
    engine = placed(world)
    data, compiled = engine._data, engine._model.compiled
    assume(compiled.nv > 0)
    data.qvel[:] = speeds[: compiled.nv]
    engine._stepped = True
    engine.store(world)
    world.engine_state = None  # or it would be taken instead of the velocities
    again = placed(world)
    # Near a gimbal lock speeds are not unique, but the motion is.
    linear, angular = np.array(world.linear_velocities), np.array(world.angular_velocities)
    again._stepped = True
    again.store(world)
    np.testing.assert_allclose(world.linear_velocities, linear, atol=1e-6)
    np.testing.assert_allclose(world.angular_velocities, angular, atol=1e-6)


@settings(max_examples=25)
@given(jointed(), st.lists(number, min_size=6, max_size=6))
def test_what_is_locked_stays_locked(case: tuple[World, Any, bool], push: list[float]) -> None:
    world, joint, _ = case
    assume(any(joint.enabled for joint in world.joints))
    moving = np.flatnonzero(~world.fixed)
    world.forces[moving[-1]] = np.array(push[:3])
    world.torques[moving[-1]] = np.array(push[3:])
    simulation = Simulation(world, "mujoco")
    simulation.run(20)
    off, angle = misfit(joint, pose(joint.body1), pose(joint.body2))
    assert off < 1e-6
    turning = np.count_nonzero(joint.angular_min != joint.angular_max)
    if turning != 2:  # two turns about tilted axes have no closest pose that is this simple
        assert angle < 1e-5


def two_boxes() -> tuple[World, Body, Body]:
    world = World(time_step=1 / 240)
    one = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak")
    two = world.create_box(2, (0.9, 0, 0), (1, 1, 1), "oak")
    return world, one, two


@pytest.mark.parametrize("interpenetrate", [False, True])
def test_joined_bodies_collide_unless_they_may_interpenetrate(interpenetrate: bool) -> None:
    world, one, two = two_boxes()
    world.attach_ball_joint(one, two, interpenetrate=interpenetrate)
    simulation = Simulation(world, "mujoco")
    simulation.run(1)
    assert bool(simulation.contacts()) is not interpenetrate


def test_interpenetrating_also_where_friction_needs_explicit_pairs() -> None:
    world, one, _ = two_boxes()
    world.create_material(
        "ice", density=900, restitution=0, static_friction=0.01, dynamic_friction=0.01,
        poisson_ratio=0.3, young_modulus=1, stiffness=1, damping_normal=0, damping_tangential=0,
    )  # fmt: skip
    cold = world.create_box(3, (0, 0.9, 0), (1, 1, 1), "ice")
    simulation = Simulation(world, "mujoco")

    def touch() -> bool:
        simulation.run(1)
        found = {(contact.first, contact.second) for contact in simulation.contacts()}
        return (one.sid, cold.sid) in found

    assert touch()
    world.attach_ball_joint(one, cold, interpenetrate=True)
    assert not touch()


def test_disabled_joint_does_nothing() -> None:
    world, one, two = two_boxes()
    two.position = (5, 0, 0)
    joint = world.attach_fixed_joint(one, two)
    joint.enabled = False
    two.linear_velocity = (1, 0, 0)
    Simulation(world, "mujoco").run(240)
    assert two.position[0] == pytest.approx(6.0)


def test_joint_that_holds_nothing_is_left_out() -> None:
    world, one, two = two_boxes()
    none = tuple(-x for x in FREE)
    world.attach_joint(
        one, two, frame1=((0, 0, 0), (1, 0, 0, 0)), frame2=((0, 0, 0), (1, 0, 0, 0)),
        linear_min=none, linear_max=FREE, angular_min=none, angular_max=FREE,
    )  # fmt: skip
    assert plan(world).links == {}


def test_trees_grow_from_what_is_fixed() -> None:
    world = World(time_step=0.01)
    bodies = [world.create_sphere(i, (2 * i, 0, 0), 0.5, "oak") for i in range(4)]
    bodies[3].fixed = True
    for one, two in ((0, 1), (1, 2), (2, 3)):
        world.attach_ball_joint(bodies[one], bodies[two])
    forest = plan(world)
    assert forest.order == [3, 2, 1]
    assert [(link.parent, link.reverse) for link in forest.links.values()] == [
        (4, True), (3, True), (2, True),
    ]  # fmt: skip
    assert forest.loops == [] and forest.inert == []


def square() -> tuple[World, list[Body]]:
    world = World((0, 0, -9.81), time_step=1 / 240)
    places = [(0, 0, 5), (2, 0, 5), (2, 2, 5), (0, 2, 5)]
    return world, [world.create_sphere(i, place, 0.3, "oak") for i, place in enumerate(places)]


@pytest.mark.parametrize("kind", ["fixed", "ball", "hinge"])
def test_loops_are_closed(kind: str) -> None:
    world, bodies = square()
    for i in range(4):
        one, two = bodies[i], bodies[(i + 1) % 4]
        if kind == "fixed":
            world.attach_fixed_joint(one, two)
        elif kind == "ball":
            world.attach_ball_joint(one, two)
        else:
            world.attach_hinge_joint(one, two, axis=(0, 0, 1))
    world.attach_ball_joint(None, bodies[0])
    assert codes(world).count("engine-joint-approximated") == 1
    simulation = Simulation(world, "mujoco")
    simulation.run(240)
    for joint in world.joints:
        off, _ = misfit(joint, pose(joint.body1), pose(joint.body2))
        assert off < 0.01


def test_loops_that_cannot_be_closed_are_refused() -> None:
    world, bodies = square()
    for i in range(4):
        world.attach_slider_joint(bodies[i], bodies[(i + 1) % 4], axis=(0, 0, 1))
    with pytest.raises(EngineError, match="closes a loop"):
        Simulation(world, "mujoco")


def test_joints_that_cannot_be_are_named() -> None:
    world, one, two = two_boxes()
    frames: dict[str, Any] = {
        "frame1": ((0, 0, 0), (1, 0, 0, 0)), "frame2": ((-0.9, 0, 0), (1, 0, 0, 0)),
    }  # fmt: skip
    world.attach_joint(one, two, **frames, linear_min=(1, 0, 0), linear_max=(0, 0, 0))
    assert "engine-joint-limits" in codes(world)


def test_displaced_bodies_are_reported_and_put_right() -> None:
    world, one, two = two_boxes()
    world.attach_fixed_joint(one, two)
    two.position = (5, 0, 0)
    assert "engine-joint-displaced" in codes(world)
    Simulation(world, "mujoco").run(1)
    assert np.linalg.norm(two.position - one.position) == pytest.approx(0.9)


def test_joint_between_what_is_fixed_is_inert() -> None:
    world, one, two = two_boxes()
    world.attach_hinge_joint(one, two, axis=(0, 0, 1))
    one.fixed = two.fixed = True
    assert "engine-joint-inert" in codes(world)
    Simulation(world, "mujoco").run(1)


@pytest.mark.parametrize(
    ("joint", "count"),
    [
        ({"angular_min": (-1, -1, -1), "angular_max": (1, 1, 1)}, 1),
        ({"angular_min": (0, 0, -1), "angular_max": (0, 0, 1)}, 0),
        (
            {
                "angular_min": (-INF,) * 3,
                "angular_max": (INF,) * 3,
                "angular_spring": (1.0, 0.0, 0.5),
            },
            1,
        ),
    ],
)
def test_what_is_approximated_is_said(joint: dict[str, Any], count: int) -> None:
    world, one, two = two_boxes()
    world.attach_joint(
        one, two, frame1=((0.45, 0, 0), (1, 0, 0, 0)), frame2=((-0.45, 0, 0), (1, 0, 0, 0)), **joint
    )
    assert codes(world).count("engine-joint-approximated") == count


def test_angular_spring_swings_about_its_target() -> None:
    world = World(time_step=1 / 480)
    wheel = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", mass=1.0, inertia=(1, 1, 1))
    world.attach_hinge_joint(None, wheel, axis=(0, 0, 1), angular_spring=(4.0, 0.0, 0.3))
    angles = []
    simulation = Simulation(world, "mujoco")
    simulation.run(1509, observers=[lambda w: angles.append(2 * np.arcsin(w.orientations[0, 3]))])
    # One period is 2π/√(4/1) = π s: 1508 steps.
    assert max(angles) == pytest.approx(0.6, abs=0.01)
    assert angles[-1] == pytest.approx(0.0, abs=0.01)

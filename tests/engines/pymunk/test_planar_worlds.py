"""Any planar World runs, and goes on from a store as it does when loaded elsewhere."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.strategies import DrawFn
from tests.world.rebuilding import rebuilt

from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.errors import EngineError
from colladaphy.findings import Severity
from colladaphy.world import Body, World, compare, rotations

places, angles = st.floats(-3, 3), st.floats(-3, 3)
sizes = st.floats(0.2, 1.5)


@st.composite
def planar_worlds(draw: DrawFn) -> World:
    """Scenes in the plane y = 2 with contacts, unions, joints, springs and several materials."""
    world = World((draw(places), 0, draw(st.floats(-10, 0))), time_step=1 / 120)
    if draw(st.booleans()):
        world.set_pair("iron", "oak", draw(st.floats(0, 1)), 0.3, draw(st.floats(0, 1)))
    if draw(st.booleans()):
        world.create_plane(1, (0, 0, 1), draw(st.floats(-6, -3)), "granite")
    bodies = [draw(_body(world)) for _ in range(draw(st.integers(1, 6)))]
    if len(bodies) > 3:
        bodies = [world.create_union(1, bodies[:2], fixed=draw(st.booleans())), *bodies[2:]]
    for body in bodies:
        body.linear_velocity = (draw(places), 0, draw(places))
        body.angular_velocity = (0, draw(places), 0)
        body.force = (draw(places), 0, draw(places))
        body.torque = (0, draw(places), 0)
        body.sleeping = draw(st.booleans())
    for _ in range(draw(st.integers(0, 3))):
        draw(_joint(world, bodies))
    return world


@st.composite
def _body(draw: DrawFn, world: World) -> Body:
    position = (draw(places), 2, draw(places))
    material = draw(st.sampled_from(["iron", "oak", "fir"]))
    fixed = draw(st.integers(0, 4)) == 0
    match draw(st.sampled_from(["sphere", "box", "capsule", "cylinder", "wheel"])):
        case "sphere":
            return world.create_sphere(1, position, draw(sizes), material, fixed=fixed)
        case "box":
            lengths = (draw(sizes), draw(sizes), draw(sizes))
            body = world.create_box(1, position, lengths, material, fixed=fixed)
        case "capsule":
            radius, length = draw(sizes), draw(sizes)
            body = world.create_capsule(1, position, radius, length, material, fixed=fixed)
        case "cylinder":
            radii, length = (draw(sizes), draw(sizes)), draw(sizes)
            body = world.create_cylinder(1, position, radii, length, material, fixed=fixed)
        case _:
            body = world.create_cylinder(1, position, draw(sizes), 1, material, fixed=fixed)
            body.rotate(0, 0, math.pi / 2)
    body.rotate(0, draw(angles), 0)
    return body


@st.composite
def _joint(draw: DrawFn, world: World, bodies: list[Body]) -> None:
    one = draw(st.sampled_from([None, *bodies]))
    two = draw(st.sampled_from([body for body in bodies if body != one] or [None]))
    if one == two:
        return
    limits = draw(
        st.sampled_from([(-math.inf, math.inf), (-0.5, 0.5), (0.0, math.inf), (-0.1, 1.0)])
    )
    spring = draw(st.none() | st.tuples(st.floats(0, 5e3), st.floats(0, 1e2), st.floats(-1, 1)))
    through = draw(st.booleans())
    match draw(st.sampled_from(["hinge", "slider", "fixed", "ball"])):
        case "hinge":
            axis = _inside(one, draw(st.sampled_from([(0, 1, 0), (0, -1, 0)])))
            world.attach_hinge_joint(
                one, two, axis=axis, limits=limits, angular_spring=spring, interpenetrate=through
            )
        case "slider":
            angle = draw(angles)
            axis = _inside(one, (math.cos(angle), 0, math.sin(angle)))
            world.attach_slider_joint(
                one, two, axis=axis, limits=limits, linear_spring=spring, interpenetrate=through
            )
        case "ball":
            world.attach_ball_joint(one, two, interpenetrate=through)
        case _:
            world.attach_fixed_joint(one, two, interpenetrate=through)


def _inside(body: Body | None, axis: tuple[float, float, float]) -> np.ndarray:
    """An axis of the world in the frame of a body."""
    return np.array(axis) if body is None else rotations.unrotate(body.orientation, axis)


def finish(engine: PymunkEngine, world: World, steps: int) -> bool:
    try:
        engine.step(steps)
    except EngineError as error:
        assert [finding.code for finding in error.findings] == ["engine-diverged"]
        return False
    engine.store(world)
    return True


@settings(max_examples=settings().max_examples // 2)
@given(planar_worlds(), st.lists(st.integers(1, 40), min_size=1, max_size=3))
def test_planar_worlds_resume_exactly(world: World, stops: list[int]) -> None:
    going = PymunkEngine()
    errors = [f for f in going.check(world) if f.severity is Severity.ERROR]
    assert errors == [], errors[0].message
    copy = rebuilt(world)
    going.load(world)
    for stop in stops:
        resumed = PymunkEngine()
        resumed.load(copy)
        if not finish(going, world, stop):
            assert not finish(resumed, copy, stop)
            return
        assert finish(resumed, copy, stop)
        assert compare(world, copy) == []
        going.load(world)
        copy = rebuilt(copy)
    moving = ~world.fixed
    assert np.all(world.positions[moving][:, 1] == copy.positions[moving][:, 1])
    assert np.all(np.abs(world.linear_velocities[:, 1]) == 0)
    assert np.all(np.abs(world.angular_velocities[:, (0, 2)]) == 0)

"""Forces, impulses and speeds of bodies and joints, and values that are set later."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.world import Body, Joint, World, rotations

small = st.floats(-5, 5)
places = st.tuples(small, small, small)
sizes = st.floats(0.3, 3)


def momenta(world: World) -> tuple[Any, Any]:
    """Momentum and angular momentum about the origin, by their definition."""
    linear, angular = np.zeros(3), np.zeros(3)
    for body in world.bodies:
        if not body.fixed:
            push = body.mass * body.linear_velocity
            spin = rotations.rotate_tensor(body.orientation, body.inertia) @ body.angular_velocity
            linear, angular = linear + push, angular + np.cross(body.position, push) + spin
    return linear, angular


def scene(rows: list[Any]) -> tuple[World, Body, Body]:
    """A union of a box and a turned box, both with a motion."""
    world = World()
    (place, angles, size), (other, turn, length) = rows
    one = world.create_box(1, place, (size, 2 * size, 0.5), "oak", linear_velocity=angles)
    two = world.create_capsule(2, other, size, length, "iron", angular_velocity=turn)
    one.rotate(*angles)
    two.rotate(*turn)
    return world, world.create_union(3, [one, two]), one


parts = st.lists(st.tuples(places, places, sizes), min_size=2, max_size=2)


@given(parts, places, places)
def test_an_impulse_is_what_momentum_gains(rows: Any, impulse: Any, at: Any) -> None:
    world, union, member = scene(rows)
    before = momenta(world)
    for body in (union, member):
        body.apply_impulse(impulse, at=at)
    after = momenta(world)
    scale = 1e-9 * (1 + union.mass * 100)
    np.testing.assert_allclose(after[0] - before[0], 2 * np.array(impulse), atol=scale)
    np.testing.assert_allclose(after[1] - before[1], 2 * np.cross(at, impulse), atol=scale)
    union.linear_velocity = union.angular_velocity = (0, 0, 0)
    member.apply_impulse(impulse)
    np.testing.assert_allclose(momenta(world)[1], np.cross(member.position, impulse), atol=scale)


@given(parts, places, places)
def test_forces_add_up_with_their_torques(rows: Any, force: Any, at: Any) -> None:
    _, union, member = scene(rows)
    union.apply_force(force)
    np.testing.assert_array_equal(union.torque, (0, 0, 0))
    member.apply_force(force, at=at)
    np.testing.assert_allclose(union.force, 2 * np.array(force))
    np.testing.assert_allclose(union.torque, np.cross(at - union.position, force), atol=1e-9)
    member.apply_force(-2 * np.array(force))
    np.testing.assert_allclose(union.force, (0, 0, 0), atol=1e-12)


@given(parts, places)
def test_points_move_as_the_body_does(rows: Any, at: Any) -> None:
    """Against where the point is a moment later."""
    _, union, member = scene(rows)
    speed = union.velocity_at(at)
    np.testing.assert_allclose(member.velocity_at(at), speed)
    np.testing.assert_allclose(union.velocity_at(member.position), member.linear_velocity)
    moment = 1e-6
    spin = union.angular_velocity * moment
    turn = rotations.from_axis_angle(spin if np.any(spin) else (1, 0, 0), np.linalg.norm(spin))
    center = union.position + moment * union.linear_velocity
    later = center + rotations.rotate(turn, at - union.position)
    np.testing.assert_allclose((later - at) / moment, speed, atol=1e-3)


def test_what_is_fixed_bears_it_and_what_is_light_refuses() -> None:
    world = World()
    wall = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", fixed=True)
    wall.apply_impulse((1, 0, 0), at=(0, 5, 0))
    wall.apply_force((1, 0, 0), at=(0, 5, 0))
    assert wall.force.tolist() == wall.torque.tolist() == [0, 0, 0]
    assert wall.linear_velocity.tolist() == wall.angular_velocity.tolist() == [0, 0, 0]
    point = world.create_body(2, (0, 0, 0), 2.0)
    point.apply_impulse((4, 0, 0))
    assert point.linear_velocity.tolist() == [2, 0, 0]
    with pytest.raises(WorldError, match="physics-inertia"):
        point.apply_impulse((4, 0, 0), at=(0, 1, 0))
    with pytest.raises(WorldError, match="physics-mass"):
        world.create_body(3, (0, 0, 0), 0.0).apply_impulse((1, 0, 0))
    point.sleeping = True
    point.apply_impulse((1, 0, 0))
    assert not point.sleeping
    for wrong in ((1, 2), (1, 2, math.nan), "up"):
        with pytest.raises(WorldError, match="physics-number"):
            point.apply_force(wrong)  # type: ignore[arg-type]


@given(parts, st.floats(0.1, 50))
def test_a_set_mass_is_a_made_one(rows: Any, factor: float) -> None:
    """Of a body, a member (its union follows) and a union (its members follow)."""
    world, union, member = scene(rows)
    alone = world.create_sphere(9, (1, 2, 3), 0.7, "oak")
    alone.mass = 42
    made = world.create_sphere(9, (1, 2, 3), 0.7, "oak", mass=42)
    assert alone.mass == 42
    np.testing.assert_allclose(alone.inertia, made.inertia, rtol=1e-14)
    before = {body: body.velocity_at((1, 2, 3)) for body in union.members}
    member.mass *= factor
    other = World()
    twins = [
        other.create_box(1, member.position, member.lengths, "oak", mass=member.mass,
                         orientation=member.orientation),
        other.create_capsule(2, union.members[1].position, union.members[1].radius,
                             union.members[1].length, "iron",
                             orientation=union.members[1].orientation),
    ]  # fmt: skip
    again = other.create_union(3, twins)
    assert union.mass == pytest.approx(again.mass)
    np.testing.assert_allclose(union.position, again.position, atol=1e-9)
    tolerance = 1e-9 * np.trace(again.inertia)
    tensor = rotations.rotate_tensor(union.orientation, union.inertia)
    np.testing.assert_allclose(tensor, again.inertia, atol=tolerance)
    for body, speed in before.items():
        np.testing.assert_allclose(body.velocity_at((1, 2, 3)), speed, atol=1e-8)
    total, inertia, mass = union.mass, union.inertia, member.mass
    union.mass = total * factor
    np.testing.assert_allclose(union.inertia, inertia * factor)
    assert member.mass == pytest.approx(mass * factor)
    assert world.differing_unions() == []


def test_masses_of_all_kinds() -> None:
    world = World()
    plane = world.create_plane(1, (0, 0, 1), 0, "oak")
    for value in ("mass", "inertia"):
        with pytest.raises(WorldError, match=f"physics-{value}"):
            setattr(plane, value, 1)
    box = world.create_box(2, (0, 0, 0), (1, 2, 3), "oak", mass=0)
    box.mass = 12
    np.testing.assert_allclose(np.diag(box.inertia), (13, 10, 5))
    point = world.create_body(3, (0, 0, 0), 0)
    point.mass = 3
    assert point.mass == 3 and not point.inertia.any()
    box.inertia = (1, 2, 3)
    assert np.diag(box.inertia).tolist() == [1, 2, 3]
    box.density = 100
    assert box.mass == 600 and box.inertia[0, 0] == pytest.approx(50)
    for body in (plane, point):
        with pytest.raises(WorldError, match="physics-kind"):
            body.density = 1
    for wrong in (-1, math.nan, "heavy"):
        with pytest.raises(WorldError, match="physics-mass"):
            box.mass = wrong  # type: ignore[assignment]
    assert box.mass == 600
    ball = world.create_sphere(4, (5, 0, 0), 1, "iron")
    union = world.create_union(5, [box, point, ball])
    before = union.inertia
    box.inertia = (2, 3, 4)
    np.testing.assert_allclose(np.trace(union.inertia) - np.trace(before), 9 - 300)


def test_materials_are_set_and_masses_stay() -> None:
    world = World()
    box = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak")
    box.material = "iron"
    assert box.material == world.materials["iron"] and box.mass == 800
    ball = world.create_sphere(2, (2, 0, 0), 1, "oak")
    point = world.create_body(3, (0, 0, 0), 1)
    union = world.create_union(4, [box, ball, point])
    union.material = world.materials["fir"]
    assert box.material == ball.material == union.material == world.materials["fir"]
    with pytest.raises(WorldError, match="physics-kind"):
        point.material = "oak"
    with pytest.raises(WorldError, match="physics-material-unknown"):
        box.material = "jelly"


def test_members_that_columns_change_are_found_and_added_up() -> None:
    world = World()
    pair = [world.create_sphere(1, (x, 0, 0), 0.5, "oak") for x in (0, 2)]
    inner = world.create_union(3, pair)
    union = world.create_union(4, [inner, world.create_box(5, (9, 0, 0), (1, 1, 1), "iron")])
    assert world.differing_unions() == []
    world.member_columns.masses[world.member_columns.sids == pair[0].sid] *= 3
    assert world.differing_unions() == [inner]
    inner.add_up()
    assert world.differing_unions() == []
    assert inner.mass == pair[0].mass + pair[1].mass
    assert union.mass == inner.mass + 7874
    assert inner.position[0] == pytest.approx(0.5) and pair[0].position[0] == pytest.approx(0)
    with pytest.raises(WorldError, match="physics-kind"):
        pair[0].add_up()
    own = world.create_union(6, [world.create_sphere(7, (0, 9, 0), 1, "oak")], mass=5)
    assert world.differing_unions() == [own]
    ground = world.create_plane(8, (0, 0, 1), 0, "oak")
    world.create_union(9, [ground, world.create_sphere(7, (0, 9, 0), 1, "oak")])
    assert world.differing_unions() == [own]


def hinged(kind: str, axis: Any, turn: Any) -> tuple[World, Joint]:
    world = World()
    base = world.create_box(1, (1, 2, 3), (1, 1, 1), "oak")
    base.rotate(*turn)
    arm = world.create_box(2, (2, 2, 3), (1, 1, 1), "oak")
    attach = {"hinge": world.attach_hinge_joint, "slider": world.attach_slider_joint}[kind]
    return world, attach(base, arm, axis=axis, uid=7, name=kind)


@pytest.mark.parametrize("kind", ["hinge", "slider"])
@given(axis=places.filter(any), turn=places, amount=st.floats(-3, 3), rate=small)
def test_coordinates_and_speed_of_one_axis(
    kind: str, axis: Any, turn: Any, amount: float, rate: float
) -> None:
    """A motion along the joint by hand is what it says."""
    _, joint = hinged(kind, axis, turn)
    base, arm = joint.body1, joint.body2
    assert base is not None and arm is not None
    np.testing.assert_allclose(joint.coordinates, [0], atol=1e-9)
    base.linear_velocity, base.angular_velocity = (1, 2, 3), (0.3, 0.2, 0.1)
    outer = rotations.multiply(base.orientation, joint.frame1[1])
    along = rotations.rotate(outer, (0, 0, 1))
    pivot = base.position + rotations.rotate(base.orientation, joint.frame1[0])
    if kind == "hinge":
        swing = rotations.from_axis_angle(along, amount)
        arm.position = pivot + rotations.rotate(swing, arm.position - pivot)
        arm.orientation = rotations.multiply(swing, arm.orientation)
        spin = base.angular_velocity + rate * along
        arm.angular_velocity = spin
        arm.linear_velocity = base.velocity_at(pivot) + np.cross(spin, arm.position - pivot)
    else:
        arm.position = arm.position + amount * along
        arm.angular_velocity = base.angular_velocity
        arm.linear_velocity = base.velocity_at(arm.position) + rate * along
    np.testing.assert_allclose(joint.coordinates, [amount], atol=1e-7)
    np.testing.assert_allclose(joint.speed, [rate], atol=1e-7)


def test_coordinates_of_other_joints() -> None:
    world = World()
    base = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", fixed=True)
    arm = world.create_box(2, (0, 0, 2), (1, 1, 1), "oak", angular_velocity=(1, 2, 3))
    assert world.attach_fixed_joint(base, arm).coordinates.tolist() == []
    ball = world.attach_ball_joint(base, arm)
    arm.orientation = rotations.from_axis_angle((0, 1, 0), 0.5)
    np.testing.assert_allclose(ball.coordinates, (0, 0.5, 0))
    np.testing.assert_allclose(ball.speed, (1, 2, 3))
    general = world.attach_joint(
        None, arm, linear_min=(0, -9, 0), linear_max=(0, 9, 0), angular_min=(-1, -1, -1),
        angular_max=(1, 1, 1),
    )  # fmt: skip
    moment = 1e-6
    arm.linear_velocity = (0, 4, 0)
    start = general.coordinates
    speed = general.speed
    arm.position = arm.position + moment * arm.linear_velocity
    arm.orientation = rotations.multiply(
        rotations.from_axis_angle((1, 2, 3), moment * math.sqrt(14)), arm.orientation
    )
    np.testing.assert_allclose((general.coordinates - start) / moment, speed, rtol=1e-4)
    base.angular_velocity = (9, 9, 9)  # which a fixed body does not have
    np.testing.assert_allclose(ball.speed, (1, 2, 3))


def test_joints_are_found_and_changed() -> None:
    world, joint = hinged("hinge", (0, 0, 1), (0, 0, 0))
    assert world.joint(joint.sid) == joint
    assert world.joints_by_uid(7) == world.joints_by_name("hinge") == [joint]
    assert world.joints_by_uid(8) == world.joints_by_name("door") == []
    joint.angular_min, joint.angular_max = (0, 0, -1), (0, 0, 2)
    assert joint.angular_min.tolist() == [0, 0, -1] and joint.angular_max.tolist() == [0, 0, 2]
    joint.linear_min, joint.linear_max = (0, 0, -3), (0, 0, 3)
    joint.linear_spring, joint.angular_spring = (1, 2, 3), (4, 5, 6)
    assert joint.linear_spring == (1, 2, 3) and joint.angular_spring == (4, 5, 6)
    joint.linear_spring = None
    assert joint.linear_spring == (0, 0, 0)
    for name, wrong in (
        ("angular_min", (0, 0)), ("linear_max", (0, 0, math.nan)), ("angular_spring", (1, 2)),
        ("linear_spring", (1, 2, math.inf)),
    ):  # fmt: skip
        with pytest.raises(WorldError, match="physics-joint-value"):
            setattr(joint, name, wrong)
    for sid in (99, 0, -1, 2**70):
        with pytest.raises(WorldError, match="physics-body-gone"):
            world.joint(sid)


def test_a_position_is_changed_or_refused_never_ignored() -> None:
    world, joint = hinged("hinge", (0, 0, 1), (0, 0, 0))
    body = world.bodies[0]
    for array in (body.position, body.inertia, joint.frame1[0], joint.angular_min,
                  joint.coordinates, joint.speed, body.velocity_at((0, 0, 0)),
                  world.materials.values("density", [0, 1])):  # fmt: skip
        with pytest.raises(ValueError, match="read-only"):
            array[-1] += 5
    body.position = body.position + np.array((0, 0, 5))
    world.positions[0, 2] += 5
    assert body.position[2] == 13

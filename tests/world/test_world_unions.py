"""Unions are the sum of their members, and move them along."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.world import Body, World, rotations

small = st.floats(-5, 5)
places = st.tuples(small, small, small)
members = st.lists(st.tuples(places, places, st.floats(0.3, 3), places, places), min_size=1,
                   max_size=4)  # fmt: skip


def build(world: World, rows: Any) -> list[Body]:
    bodies = []
    for position, angles, size, velocity, spin in rows:
        body = world.create_box(1, position, (size, 2 * size, 0.5), "oak")
        body.rotate(*angles)
        body.linear_velocity, body.angular_velocity = velocity, spin
        bodies.append(body)
    return bodies


def outside(body: Body) -> Any:
    """Inertia about the origin in world axes, by the definition over the volume's corners."""
    inertia = rotations.rotate_tensor(body.orientation, body.inertia)
    x, y, z = body.position
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return inertia - body.mass * cross @ cross


def momentum(body: Body) -> tuple[Any, Any]:
    linear = body.mass * body.linear_velocity
    spin = rotations.rotate_tensor(body.orientation, body.inertia) @ body.angular_velocity
    return linear, np.cross(body.position, linear) + spin


@given(members)
def test_a_union_is_the_sum_of_its_parts(rows: Any) -> None:
    world = World()
    bodies = build(world, rows)
    mass = sum(body.mass for body in bodies)
    center = sum(body.mass * body.position for body in bodies) / mass
    inertia = sum(outside(body) for body in bodies)
    linear = sum(momentum(body)[0] for body in bodies)
    angular = sum(momentum(body)[1] for body in bodies)
    poses = [(body.position, rotations.to_matrix(body.orientation)) for body in bodies]
    union = world.create_union(1, bodies)
    assert math.isclose(union.mass, mass, rel_tol=1e-14)
    assert np.allclose(union.position, center, atol=1e-12)
    assert np.allclose(outside(union), inertia, rtol=1e-9, atol=1e-9 * np.trace(inertia))
    assert np.allclose(momentum(union)[0], linear, atol=1e-9 * mass)
    assert np.allclose(momentum(union)[1], angular, rtol=1e-9, atol=1e-7 * mass)
    for body, (position, matrix) in zip(union.members, poses, strict=True):
        assert np.allclose(body.position, position, atol=1e-12)
        assert np.allclose(rotations.to_matrix(body.orientation), matrix, atol=1e-12)


@given(members, members)
def test_a_nested_union_counts_as_one_body(first: Any, second: Any) -> None:
    nested, flat = World(), World()
    inner = nested.create_union(1, build(nested, first))
    outer = nested.create_union(1, [inner, *build(nested, second)])
    every = flat.create_union(1, [*build(flat, first), *build(flat, second)])
    assert math.isclose(outer.mass, every.mass, rel_tol=1e-13)
    assert np.allclose(outer.position, every.position, atol=1e-12)
    assert np.allclose(outer.inertia, every.inertia, rtol=1e-9, atol=1e-9 * np.trace(outer.inertia))
    assert np.allclose(outer.linear_velocity, every.linear_velocity, atol=1e-9)
    assert np.allclose(outer.angular_velocity, every.angular_velocity, atol=1e-7)
    assert inner.parent == outer and inner.members[0].root == outer


@given(members, places, places)
def test_members_move_with_their_union(rows: Any, shift: Any, angles: Any) -> None:
    world = World()
    inner = world.create_union(1, build(world, rows))
    union = world.create_union(1, [inner, world.create_sphere(1, (9, 9, 9), 1, "fir")])
    member = inner.members[0]
    point, turn = member.position, member.orientation
    center, motion = union.position, rotations.fixed_angles(*angles)
    union.linear_velocity, union.angular_velocity = shift, angles
    velocity = np.array(shift) + np.cross(angles, point - center)
    assert np.allclose(member.linear_velocity, velocity, atol=1e-9)
    assert member.angular_velocity.tolist() == list(angles)
    union.rotate(*angles)
    world.positions += shift
    expected = center + np.array(shift) + rotations.rotate(motion, point - center)
    assert np.allclose(member.position, expected, atol=1e-9)
    assert np.allclose(
        rotations.to_matrix(member.orientation),
        rotations.to_matrix(rotations.multiply(motion, turn)),
        atol=1e-9,
    )


@given(members, places, places)
def test_moving_a_member_is_building_anew(rows: Any, place: Any, angles: Any) -> None:
    world, again = World(), World()
    bodies = build(world, [*rows, rows[0]])
    world.create_union(1, [world.create_union(1, bodies[:-1]), bodies[-1]])
    bodies[0].position = place
    bodies[0].rotate(*angles)
    others = build(again, [*rows, rows[0]])
    others[0].position = place
    others[0].rotate(*angles)
    again.create_union(1, [again.create_union(1, others[:-1]), others[-1]])
    for body, other in zip(bodies, others, strict=True):
        assert np.allclose(body.position, other.position, atol=1e-9)
    union, twin = world.bodies[0], again.bodies[0]
    assert np.allclose(union.position, twin.position, atol=1e-9)
    assert np.allclose(union.inertia, twin.inertia, rtol=1e-8, atol=1e-8 * np.trace(twin.inertia))


def test_a_fixed_member_fixes_the_union() -> None:
    world = World()
    fixed = world.create_sphere(1, (0, 0, 0), 1, "iron", fixed=True)
    union = world.create_union(1, [world.create_sphere(1, (3, 0, 0), 1, "iron"), fixed])
    assert union.fixed and not union.infinite
    assert union.mass > 0 and union.inverse_mass == 0


def test_a_plane_makes_the_union_infinite() -> None:
    world = World()
    plane = world.create_plane(1, (0, 0, 1), None, "iron", position=(2, 3, 4))
    sphere = world.create_sphere(1, (3, 0, 0), 1, "iron")
    inner = world.create_union(1, [sphere, plane])
    union = world.create_union(2, [inner, world.create_sphere(1, (9, 0, 0), 1, "iron")])
    for body in (inner, union):
        assert body.infinite and body.fixed and body.mass == 0 and not body.inertia.any()
    assert union.position.tolist() == [2, 3, 4]
    assert sphere.position.tolist() == [3, 0, 0]
    assert plane.normal.tolist() == [0, 0, 1] and plane.displacement == 4


def test_material_of_a_union_is_that_of_all_members() -> None:
    world = World()
    one = world.create_union(1, [world.create_sphere(1, (i, 0, 0), 1, "iron") for i in (0, 3)])
    assert one.material is world.materials["iron"]
    two = world.create_union(1, [one, world.create_sphere(1, (9, 0, 0), 1, "oak")])
    assert two.material is None


def test_impossible_members_are_refused() -> None:
    world, other = World(), World()
    a, b = (world.create_sphere(1, (i, 0, 0), 1, "iron") for i in (0, 3))
    stranger = other.create_sphere(1, (0, 0, 0), 1, "iron")
    union = world.create_union(1, [a])
    for members in ([], [b, b], [a, b], [stranger]):
        with pytest.raises(WorldError):
            world.create_union(1, members)
    for setter in ("linear_velocity", "angular_velocity", "force", "torque"):
        with pytest.raises(WorldError):
            setattr(a, setter, (1, 2, 3))
    with pytest.raises(WorldError):
        world.destroy(a)
    assert world.bodies[:] == [b, union]


def test_joints_go_over_to_the_union() -> None:
    world = World()
    a, b, c = (world.create_sphere(1, (i, 0, 0), 1, "iron") for i in (0, 3, 6))
    a.rotate(0.1, 0.2, 0.3)
    joint = world.attach_fixed_joint(a, b)
    where = a.position + rotations.rotate(a.orientation, joint.frame1[0])
    facing = rotations.multiply(a.orientation, joint.frame1[1])
    with pytest.raises(WorldError, match="binds two of the members"):
        world.create_union(1, [a, b])
    union = world.create_union(1, [c, a])
    assert joint.body1 == union and joint.body2 == b
    point, turn = joint.frame1
    assert np.allclose(union.position + point, where, atol=1e-12)
    assert np.allclose(turn, facing, atol=1e-12)
    # A joint at a member is a joint at its union.
    direct = world.attach_fixed_joint(c, b)
    assert direct.body1 == union
    world.destroy(union)
    assert len(world.joints) == 0

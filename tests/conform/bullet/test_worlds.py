"""The thesis's test (6.2.1): a World goes to Bullet, is changed there, and comes back."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from lxml import etree
from tests.conform.bullet import bullet_reader
from tests.conform.bullet.rewritten import State, rewrite

import colladaphy
from colladaphy import World
from colladaphy.conform.bullet import for_bullet
from colladaphy.testing import worlds


@pytest.fixture
def world() -> World:
    world = World(gravity=(0, 0, -9.81))
    iron = world.materials["iron"]
    world.create_plane(1, (0, 0, 1), -0.5, iron)
    box = world.create_box(2, (0, 0, 1), (1, 2, 3), iron)
    box.rotate(0.3, 0.2, 0.1)
    capsule = world.create_capsule(3, (5, 0, 1), 0.5, 2, iron)
    capsule.linear_velocity = (1, 2, 3)
    cylinder = world.create_cylinder(4, (8, 0, 1), 0.5, 2, iron)
    cylinder.angular_velocity = (0.1, 0.2, 0.3)
    parts = [
        world.create_sphere(5, (0, 0, 20), 1, iron),
        world.create_capsule(6, (3, 0, 20), 0.5, 1, iron),
    ]
    union = world.create_union(7, parts)
    world.create_sphere(8, (20, 0, 0), 1, iron).fixed = True
    world.attach_fixed_joint(box, capsule)
    world.attach_hinge_joint(union, cylinder, axis=(0, 0, 1))
    return world


def export(world: World) -> bytes:
    buffer = io.BytesIO()
    colladaphy.write(world, buffer)
    return etree.tostring(for_bullet(etree.ElementTree(etree.fromstring(buffer.getvalue())))[0])


def assert_alike(before: World, after: World, tolerance: float) -> None:
    assert len(before.bodies) == len(after.bodies)
    for one, other in zip(before.bodies, after.bodies, strict=True):
        assert (one.kind, one.uid, one.sid, one.fixed) == (
            other.kind,
            other.uid,
            other.sid,
            other.fixed,
        )
        assert np.allclose(one.position, other.position, atol=tolerance)
        turned = abs(float(np.dot(one.orientation, other.orientation)))
        assert turned == pytest.approx(1.0, abs=tolerance)
        assert one.mass == pytest.approx(other.mass, rel=tolerance)
        assert np.allclose(one.linear_velocity, other.linear_velocity, atol=tolerance)
        assert np.allclose(one.angular_velocity, other.angular_velocity, atol=tolerance)
    kinds = [joint.kind for joint in before.joints]
    assert kinds == [joint.kind for joint in after.joints]


def test_bullet_sees_the_bodies_where_they_are(world: World) -> None:
    found = bullet_reader.read(export(world))
    assert len(found.bodies) == len(world.bodies)
    for body, other in zip(world.bodies, found.bodies, strict=True):
        if not body.fixed:
            assert np.allclose(body.position, other.pose[:3, 3])
            assert body.mass == pytest.approx(other.mass)
    assert len(found.constraints) == len(world.joints)


@settings(max_examples=30)
@given(
    world=worlds(
        shapes=["sphere", "box", "plane"], unions=False, joints=False, extreme=False,
        physical=True, max_bodies=5,
    )
)  # fmt: skip
def test_worlds_of_what_bullet_has_come_back(world: World) -> None:
    """Any spheres, boxes and planes: kinds, ids, poses, masses and motions."""
    again = colladaphy.read(export(world), repair=True).load()
    assert_alike(world, again, 1e-6)
    assert np.allclose(world.gravity, again.gravity, rtol=1e-9)


def test_a_world_comes_back_from_bullet_as_it_was(world: World) -> None:
    text = export(world)
    assert_alike(world, colladaphy.read(text, repair=True).load(), 1e-12)
    assert_alike(world, colladaphy.read(rewrite(text), repair=True).load(), 1e-5)


def test_what_bullet_moved_is_where_bullet_put_it(world: World) -> None:
    state = State(position=(0, 1, 5), rotation=(0, 1, 0, 90), velocity=(0, 0, -1))
    saved = rewrite(export(world), {"Body2": state})
    box = colladaphy.read(saved, repair=True).load().bodies[1]
    assert list(box.position) == [0, 1, 5]
    assert np.allclose(box.orientation, [np.sqrt(0.5), 0, np.sqrt(0.5), 0], atol=1e-6)
    assert list(box.linear_velocity) == [0, 0, -1]

"""Joints of all kinds, and where their frames lie."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.world import FREE, Body, Joint, JointKind, World, rotations

places = st.tuples(*[st.floats(-5, 5)] * 3)
directions = places.filter(lambda v: max(map(abs, v)) > 1e-2)


def two(world: World, first: Any, second: Any) -> tuple[Body, Body]:
    a = world.create_box(1, (1, 2, 3), (1, 2, 3), "oak")
    b = world.create_sphere(2, (4, 4, 4), 1, "iron")
    a.rotate(*first)
    b.rotate(*second)
    return a, b


def outside(body: Body | None, frame: Any) -> tuple[Any, Any]:
    """Point and axes of a joint's frame in the world."""
    if body is None:
        return np.array(frame[0]), rotations.to_matrix(frame[1])
    matrix = rotations.to_matrix(body.orientation)
    return body.position + matrix @ frame[0], matrix @ rotations.to_matrix(frame[1])


def coincide(joint: Joint) -> bool:
    one, two = outside(joint.body1, joint.frame1), outside(joint.body2, joint.frame2)
    return all(np.allclose(a, b, atol=1e-9) for a, b in zip(one, two, strict=True))


@given(places, places, places, directions)
def test_frames_coincide_when_attached(first: Any, second: Any, anchor: Any, axis: Any) -> None:
    world = World()
    a, b = two(world, first, second)
    default = world.attach_fixed_joint(a, b)
    assert np.allclose(default.frame2[0], 0, atol=1e-12)
    one = world.attach_fixed_joint(a, b, anchor)
    assert one.frame1[0].tolist() == list(anchor)
    other = world.attach_ball_joint(a, b, anchor2=anchor)
    assert other.frame2[0].tolist() == list(anchor)
    hinge = world.attach_hinge_joint(a, b, anchor, axis=axis)
    slider = world.attach_slider_joint(None, b, anchor, axis=axis)
    assert all(coincide(joint) for joint in (default, one, other, hinge, slider))
    unit = np.array(axis) / np.linalg.norm(axis)
    turned = rotations.rotate(a.orientation, unit)
    assert np.allclose(outside(a, hinge.frame1)[1][:, 2], turned, atol=1e-9)
    assert np.allclose(outside(None, slider.frame1)[1][:, 2], unit, atol=1e-9)


def test_both_anchors_are_stored_as_they_are() -> None:
    world = World()
    a, b = two(world, (0, 0, 0), (0, 0, 0))
    joint = world.attach_fixed_joint(a, b, (1, 2, 3), (4, 5, 6))
    assert joint.frame1[0].tolist() == [1, 2, 3] and joint.frame2[0].tolist() == [4, 5, 6]


def test_kinds_are_recognised_from_limits() -> None:
    world = World()
    a, b = two(world, (0, 0, 0), (0, 0, 0))
    hinge = world.attach_hinge_joint(a, b, axis=(1, 0, 0), limits=(-0.5, 0.25))
    assert hinge.kind is JointKind.HINGE
    assert hinge.angular_min.tolist() == [0, 0, -0.5]
    assert hinge.angular_max.tolist() == [0, 0, 0.25]
    assert world.attach_fixed_joint(a, b).kind is JointKind.FIXED
    slider = world.attach_slider_joint(a, b, axis=(1, 0, 0))
    assert slider.kind is JointKind.SLIDER
    assert slider.linear_max.tolist() == [0, 0, math.inf]
    assert world.attach_ball_joint(a, b).kind is JointKind.BALL
    assert world.attach_joint(a, b, linear_max=FREE).kind is JointKind.GENERAL
    held = world.attach_joint(a, b, linear_min=(1, 1, 1), linear_max=(1, 1, 1))
    assert held.kind is JointKind.FIXED
    two_axes = world.attach_joint(a, b, angular_min=(-1, -1, 0), angular_max=(1, 1, 0))
    assert two_axes.kind is JointKind.GENERAL


def test_everything_given_is_stored() -> None:
    world = World()
    a, _ = two(world, (0, 0, 0), (0, 0, 0))
    joint = world.attach_joint(
        None,
        a,
        frame1=((1, 2, 3), (0.5, 0.5, 0.5, 0.5)),
        frame2=((4, 5, 6), (1, 0, 0, 0)),
        linear_min=(-1, -2, -3),
        linear_max=(1, 2, math.inf),
        angular_min=(-0.1, -0.2, -math.inf),
        angular_max=(0.1, 0.2, 0.3),
        linear_spring=(10, 0.5, 1),
        angular_spring=(20, 0.25, 0.125),
        motor=(3, 7),
        enabled=False,
        interpenetrate=True,
        uid=9,
        sid=12,
        name="knee",
    )
    assert joint == world.joints[0] and joint.sid == 12 and joint.uid == 9
    assert joint.body1 is None and joint.body2 == a
    assert joint.name == "knee" and not joint.enabled and joint.interpenetrate
    assert joint.frame1[1].tolist() == [0.5, 0.5, 0.5, 0.5]
    assert joint.linear_spring == (10, 0.5, 1) and joint.angular_spring == (20, 0.25, 0.125)
    assert joint.linear_max.tolist() == [1, 2, math.inf] and joint.motor == (3, 7)
    joint.enabled, joint.interpenetrate, joint.name, joint.uid = True, False, None, 3
    assert joint.enabled and not joint.interpenetrate and joint.name is None and joint.uid == 3
    assert world.attach_fixed_joint(None, a).sid == 13


def test_joints_are_ordered_and_destroyed() -> None:
    world = World()
    a, b = two(world, (0, 0, 0), (0, 0, 0))
    late = world.attach_fixed_joint(a, b, sid=9)
    early = world.attach_fixed_joint(a, None, sid=3)
    assert list(world.joints) == [early, late] and world.joints[:] == [early, late]
    world.destroy_joint(late)
    assert list(world.joints) == [early]
    with pytest.raises(WorldError):
        _ = late.enabled
    with pytest.raises(WorldError):
        world.destroy_joint(late)
    assert "destroyed" in repr(late) and "fixed joint 3" in repr(early)
    world.destroy(a)
    assert len(world.joints) == 0


def test_impossible_joints_are_refused() -> None:
    world, other = World(), World()
    a, b = two(world, (0, 0, 0), (0, 0, 0))
    stranger = other.create_sphere(1, (0, 0, 0), 1, "iron")
    c = world.create_sphere(1, (0, 0, 0), 1, "iron")
    union = world.create_union(1, [b, c])
    for pair in ((a, a), (None, None), (a, stranger), (b, c), (union, b)):
        with pytest.raises(WorldError):
            world.attach_fixed_joint(*pair)
    for options in (
        {"linear_min": (0, 0, math.nan)},
        {"linear_min": (0, 0)},
        {"linear_spring": (1, math.inf, 0)},
        {"angular_spring": (1, 0)},
        {"motor": (1, -1)},
        {"motor": (math.inf, 1)},
        {"motor": 3},
        {"frame1": ((0, 0, 0), (0, 0, 0, 0))},
        {"uid": 2**64},
        {"sid": 0},
    ):
        with pytest.raises(WorldError):
            world.attach_joint(a, union, **options)
    with pytest.raises(WorldError):
        world.attach_hinge_joint(a, union, axis=(0, 0, 0))
    assert len(world.joints) == 0 and world.joints_of == {}

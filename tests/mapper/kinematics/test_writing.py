"""Joints that are written as kinematics too."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.mapper.kinematics.test_joints import frames_of

import colladaphy
from colladaphy.links.names import COLLADA
from colladaphy.world import World, compare


def written(world: World) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream, options=colladaphy.WriteOptions(kinematics=True))
    return stream.getvalue()


def without_constraints(data: bytes) -> bytes:
    """The document whose joints are in the kinematics alone."""
    root = etree.fromstring(data)
    for name in ("rigid_constraint", "instance_rigid_constraint"):
        for element in list(root.iter(f"{{{COLLADA}}}{name}")):
            element.getparent().remove(element)
    return etree.tostring(root)


_turns = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: max(map(abs, q)) > 0.1)
_places = st.tuples(*[st.floats(-2, 2)] * 3)
_limits = st.sampled_from([(-np.inf, np.inf), (-1.0, 2.0), (-np.inf, 0.5)])


@st.composite
def _jointed(draw: Any) -> World:
    world = World()
    bodies: list[Any] = [
        world.create_box(0, draw(_places), (1, 2, 3), "oak", orientation=draw(_turns))
        for _ in range(draw(st.integers(2, 4)))
    ]
    for number in range(1, len(bodies)):
        ends = [bodies[draw(st.integers(0, number - 1))], bodies[number]]
        if number == 1 and draw(st.booleans()):
            ends[0] = None
        if draw(st.booleans()):
            ends.reverse()
        attach = getattr(world, draw(st.sampled_from([
            "attach_hinge_joint", "attach_slider_joint", "attach_fixed_joint",
        ])))  # fmt: skip
        options: dict[str, Any] = {"name": f"joint {number}"}
        if attach != world.attach_fixed_joint:
            options.update(axis=draw(_places.filter(lambda v: max(map(abs, v)) > 0.1)))
            options["limits"] = draw(_limits)
        attach(*ends, draw(_places), **options)
    return world


@settings(max_examples=40, deadline=None)
@given(_jointed())
def test_the_kinematics_alone_give_the_same_joints(world: World) -> None:
    data = without_constraints(written(world))
    read = colladaphy.read(data)
    again = read.load()
    assert [f.code for f in read.report if f.code.startswith("kinematics-r")] == []
    assert len(again.joints) == len(world.joints)
    by_name = {joint.name: number for number, joint in enumerate(again.joints)}
    for number, joint in enumerate(world.joints):
        other = by_name[joint.name]
        made = again.joints[other]
        pairs = [tuple(body.sid if body else 0 for body in (one.body1, one.body2))
                 for one in (joint, made)]  # fmt: skip
        assert sorted(pairs[0]) == sorted(pairs[1])
        turned = pairs[0] != pairs[1]
        mine, theirs = frames_of(world, number), frames_of(again, other)
        for one, two in zip(mine, theirs[::-1] if turned else theirs, strict=True):
            assert np.allclose(one[:3, 3], two[:3, 3], atol=1e-9)
            if joint.kind.name != "FIXED":
                # Seen from the other body the axis points the other way.
                assert np.allclose(one[:3, 2] * (-1 if turned else 1), two[:3, 2], atol=1e-9)
        assert np.allclose(joint.angular_min, made.angular_min)
        assert np.allclose(joint.angular_max, made.angular_max)
        assert np.allclose(joint.linear_min, made.linear_min)
        assert np.allclose(joint.linear_max, made.linear_max)


@settings(max_examples=15, deadline=None)
@given(_jointed())
def test_with_them_the_world_comes_back_exactly(world: World) -> None:
    assert compare(world, colladaphy.read(written(world)).load(), unused_materials=True) == []


def test_a_loop_is_closed() -> None:
    world = World()
    bodies = [world.create_sphere(0, (x, y, 0), 0.2, "oak") for x, y in ((0, 0), (1, 0), (0, 1))]
    for one, two in ((0, 1), (1, 2), (2, 0)):
        world.attach_hinge_joint(bodies[one], bodies[two], (0, 0, 0), axis=(0, 0, 1))
    data = without_constraints(written(world))
    assert data.count(b"<attachment_full") == 2
    assert data.count(b"<attachment_start") == data.count(b"<attachment_end") == 1
    assert len(colladaphy.read(data).load().joints) == 3


def test_without_the_option_there_are_none() -> None:
    world = World()
    body = world.create_sphere(0, (0, 0, 0), 0.2, "oak")
    world.attach_fixed_joint(body, None)
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    assert b"kinematics" not in stream.getvalue()
    with pytest.raises(TypeError):
        colladaphy.WriteOptions(kinematic=True)  # type: ignore[call-arg]


def test_limits_beyond_all_degrees_are_written_without_a_warning() -> None:
    world = World()
    box = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak")
    joint = world.attach_hinge_joint(box, None, axis=(0, 0, 1))
    joint.angular_max = np.where(np.isfinite(joint.angular_max), joint.angular_max, 1.7e308)
    joint.angular_min = np.where(np.isfinite(joint.angular_min), joint.angular_min, -1.7e308)
    assert compare(colladaphy.read(written(world)).load(), world) == []


def test_what_holds_nothing_is_no_joint_of_a_robot() -> None:
    world = World()
    first, second = (world.create_sphere(n, (0, 0, n), 0.6, "iron") for n in (1, 2))
    free = (np.inf, np.inf, np.inf)
    least = (-np.inf, -np.inf, -np.inf)
    world.attach_joint(first, second, linear_min=least, linear_max=free, angular_min=least,
                       angular_max=free, interpenetrate=True)  # fmt: skip
    data = written(world)
    assert b"<kinematics_model" not in data
    assert compare(world, colladaphy.read(data).load()) == []

"""Joints of a robot that are destroyed stay so when the document is updated and read again."""

from __future__ import annotations

import io

import pytest
from tests.mapper.kinematics.robots import Arm, Segment, document

import colladaphy
from colladaphy.world import compare


def updated(data: bytes, *gone: int) -> tuple[colladaphy.World, bytes, list[str]]:
    """The World without some of its joints, the document with it, and what was noticed."""
    read = colladaphy.read(data)
    world = read.load()
    for joint in [world.joints[number] for number in gone]:
        world.destroy_joint(joint)
    known = len(read.report)
    read.update(world)
    stream = io.BytesIO()
    read.write(stream)
    return world, stream.getvalue(), [found.code for found in read.report.findings[known:]]


@pytest.mark.parametrize("gone", [(0,), (1,), (2,), (0, 2), (0, 1, 2)])
def test_destroyed_joints_do_not_come_back(gone: tuple[int, ...]) -> None:
    data = document(Arm([Segment(limits=(-30, 60)), Segment(kind="prismatic"), Segment()]))
    world, after, codes = updated(data, *gone)
    assert codes == ["store-kinematics-released"]
    document_again = colladaphy.read(after)
    assert compare(world, document_again.load()) == []
    assert "kinematics-not-instanced" in [finding.code for finding in document_again.report]
    # The kinematics themselves, and what put them into effect, are still in the document.
    assert after.count(b"<kinematics_model ") == data.count(b"<kinematics_model ")
    assert after.count(b"<instance_kinematics_scene ") == 1
    assert colladaphy.validate(after).valid


def test_kinematics_stay_in_effect_while_all_joints_are_there() -> None:
    data = document(Arm([Segment(), Segment()]))
    read = colladaphy.read(data)
    world = read.load()
    world.joints[0].name = "elbow"
    read.update(world)
    assert "store-kinematics-released" not in [finding.code for finding in read.report]
    assert compare(world, read.load()) == []
    scene = read.tree.getroot().find("{*}scene")
    assert scene is not None and scene.find("{*}instance_kinematics_scene") is not None


def test_a_joint_whose_link_is_gone_needs_no_release() -> None:
    data = document(Arm([Segment(), Segment()]))
    read = colladaphy.read(data)
    world = read.load()
    world.destroy_joint(world.joints[1])
    world.destroy(world.bodies[2])
    read.update(world)
    assert "store-kinematics-released" not in [finding.code for finding in read.report]
    assert compare(world, read.load()) == []

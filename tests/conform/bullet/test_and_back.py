"""There and back: written for Bullet, perhaps saved by it, and read again with conform."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from lxml import etree
from tests.conform.bullet import bullet_reader, standard_reader
from tests.conform.bullet.conftest import Export
from tests.conform.bullet.rewritten import State, rewrite
from tests.conform.bullet.scenes import scenes
from tests.conform.bullet.test_bullet import constrained
from tests.conform.bullet.test_same_meaning import free

import colladaphy
from colladaphy.conform import conform


def read_again(text: bytes) -> standard_reader.Scene:
    tree, _ = conform(etree.ElementTree(etree.fromstring(text)))
    return standard_reader.read(etree.tostring(tree))


@settings(max_examples=25)
@given(document=scenes())
def test_what_was_written_for_bullet_reads_back(document: bytes, export: Export) -> None:
    text, _ = export(document)
    compare(standard_reader.read(document), read_again(text), 1e-6)


@settings(max_examples=25)
@given(document=scenes())
def test_what_bullet_saved_reads_back(document: bytes, export: Export) -> None:
    text, _ = export(document)
    compare(standard_reader.read(document), read_again(rewrite(text)), 1e-2)


def test_a_joint_to_the_world_comes_back_where_the_body_is(export: Export) -> None:
    turn = "<rotate>0 0 1 90</rotate>"
    nodes = f"<node id='n'><translate>1 2 3</translate>{turn}</node><node id='o'/>"
    places = f"<translate>1 0 0</translate>|<translate>1 3 3</translate>{turn}"
    limits = "<limits><swing_cone_and_twist><min>0 0 -30</min><max>0 0 45</max>"
    limits += "</swing_cone_and_twist></limits>"
    before = constrained("rigid_body='m/b'", "", limits, nodes, places)
    text, _ = export(before)
    want = standard_reader.read(before)
    saved = rewrite(text)
    assert saved.count(b'rigid_body="b"') == 2
    compare(want, read_again(saved), 1e-4)
    moved = read_again(rewrite(text, {"b": State(position=(4, 2, 3))})).constraints[0]
    assert (moved.first, moved.second) == (0, None)
    assert moved.frames[1][:3, 3] == pytest.approx([4, 3, 3], abs=1e-4)


def test_a_body_that_turns_and_was_not_touched_is_not_taken_for_edited(export: Export) -> None:
    """What is compared with the profile has the digits of the file, also where it is converted."""
    world = colladaphy.World()
    for uid, spin in ((1, (0.1, 0.2, 1 / 3)), (2, (0, 0, 0))):
        box = world.create_box(uid, (uid / 3, 2 / 7, 3), (1, 2 / 3, 3), "oak")
        box.rotate(0.0698, 0.2138, 0.2897)
        box.angular_velocity = spin
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    text, _ = export(stream.getvalue())
    document = colladaphy.read(rewrite(text), repair=True)
    again = document.load()
    stale = [finding for finding in document.report if "old-value" in finding.code]
    assert stale == []
    for one, two in zip(world.bodies, again.bodies, strict=True):
        assert one.orientation.tolist() == two.orientation.tolist()
        assert np.allclose(one.angular_velocity, two.angular_velocity, rtol=1e-5, atol=0)
    # What Bullet did turn is.
    edited = text.decode().split("<rotate>")
    turned = "<rotate>".join([edited[0], *("0 0 1 45" + part[part.index("</rotate>"):]
                                           for part in edited[1:])])  # fmt: skip
    document = colladaphy.read(rewrite(turned.encode()), repair=True)
    document.load()
    assert len([finding for finding in document.report if "old-value" in finding.code]) == 2


def oval_and_loose() -> colladaphy.World:
    """What Bullet cannot have: oval solids, a body without shape, a joint that is not enabled."""
    world = colladaphy.World((0, 0, -9.81))
    world.create_cylinder(1, (0, 0, 1), (0.5, 0.8), 2, "iron").rotate(0.1, 0.2, 0.3)
    world.create_ellipsoid(2, (5, 0, 0), (1, 2, 3), "oak")
    bare = world.create_body(3, (0, 3, 0), 2.0, (1, 2, 2.5))
    bare.angular_velocity = (0.5, 0, 0)
    box = world.create_box(4, (0, 0, 9), (1, 2, 3), "fir")
    box.rotate(0.3, 0.2, 0.1)
    world.attach_hinge_joint(world.bodies[1], box, axis=(0, 0, 1), limits=(-0.3, 0.9), name="off",
                             enabled=False)  # fmt: skip
    world.attach_slider_joint(bare, box, axis=(0, 1, 0), limits=(0, 2), name="bare")
    world.attach_hinge_joint(box, None, axis=(1, 0, 0), limits=(-0.2, 0.5), name="on")
    return world


@pytest.mark.parametrize("profile", ["compact", "none"])
@pytest.mark.parametrize("saved", [False, True])
def test_what_bullet_cannot_have_comes_back(export: Export, profile: str, saved: bool) -> None:
    world = oval_and_loose()
    stream = io.BytesIO()
    options = colladaphy.WriteOptions(profile=profile)  # type: ignore[arg-type]
    colladaphy.write(world, stream, options=options)
    text, findings = export(stream.getvalue())
    codes = {finding.code for finding in findings}
    assert {"downgrade-bullet-no-shape", "downgrade-bullet-constraint"} <= codes
    seen = bullet_reader.read(text)
    assert (len(seen.bodies), len(seen.constraints)) == (3, 1)
    again = colladaphy.read(rewrite(text) if saved else text, repair=True).load()
    assert [body.kind for body in again.bodies] == [body.kind for body in world.bodies]
    near = {"rtol": 1e-5, "atol": 1e-5}
    for one, two in zip(world.bodies, again.bodies, strict=True):
        assert np.allclose(one.position, two.position, **near)
        assert np.allclose(one.orientation, two.orientation, **near)
        assert np.allclose(one.inertia, two.inertia, rtol=1e-4, atol=1e-4)
        assert np.allclose(one.angular_velocity, two.angular_velocity, **near)
    assert np.array_equal(again.bodies[0].dimensions, world.bodies[0].dimensions)
    assert len(again.joints) == 3
    by_name = {joint.name: joint for joint in again.joints}
    for joint in world.joints:
        other = by_name[joint.name]
        assert joint.enabled == other.enabled
        for name in ("angular_min", "angular_max", "linear_min", "linear_max"):
            assert np.allclose(getattr(joint, name), getattr(other, name), **near)
        frames = (joint.frame1, other.frame1), (joint.frame2, other.frame2)
        ends = [(joint.body1, other.body1), (joint.body2, other.body2)]
        for (mine, yours), (body, twin) in zip(frames, ends, strict=True):
            assert (body is None) == (twin is None)
            assert np.allclose(mine[0], yours[0], **near)


def compare(want: standard_reader.Scene, got: standard_reader.Scene, tolerance: float) -> None:
    assert np.array_equal(want.gravity, got.gravity)
    assert len(want.bodies) == len(got.bodies)
    for body, again in zip(want.bodies, got.bodies, strict=True):
        assert body.dynamic == again.dynamic
        if body.dynamic:
            assert np.isclose(body.mass, again.mass, rtol=1e-5)
            assert np.allclose(body.center, again.center, atol=tolerance)
            assert np.allclose(body.velocity, again.velocity, rtol=1e-5)
            assert np.allclose(body.angular_velocity, again.angular_velocity, rtol=1e-5)
        for shape, other in zip(body.shapes, again.shapes, strict=True):
            assert shape.kind == other.kind
            assert np.allclose(shape.sizes, other.sizes, rtol=1e-4, atol=1e-5)
            assert np.allclose(shape.pose, other.pose, atol=tolerance)
    assert len(want.constraints) == len(got.constraints)
    for bound, again in zip(want.constraints, got.constraints, strict=True):
        assert (bound.first, bound.second) == (again.first, again.second)
        for frame, place in zip(bound.frames, again.frames, strict=True):
            assert np.allclose(frame, place, atol=tolerance)
        for low, high, a, b in zip(bound.low, bound.high, again.low, again.high, strict=True):
            assert free(low, high) == free(a, b)
            assert free(low, high) or np.allclose([low, high], [a, b], atol=1e-4)

"""Which scenes are planar, in which plane, and every reason why others are not."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from colladaphy.engines.planar import analyse
from colladaphy.engines.plane import Frame
from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.errors import EngineError
from colladaphy.findings import Severity
from colladaphy.world import World, rotations

Edit = Callable[[World], Any]


def flat() -> World:
    """A scene in the plane of x and z, and in no other."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    world.create_sphere(2, (0, 1, 1), 0.5, "iron")
    box = world.create_box(3, (3, 1, 2), (1, 2, 3), "oak", linear_velocity=(1, 0, 1))
    box.rotate(0, 0.3, 0)
    rod = world.create_capsule(4, (6, 1, 4), 0.25, 2, "fir", angular_velocity=(0, 2, 0))
    rod.rotate(0, 1.0, 0)
    wheel = world.create_cylinder(5, (9, 1, 3), 0.5, 0.3, "oak")
    wheel.rotate(0, 0, math.pi / 2)
    block = world.create_cylinder(6, (12, 1, 5), 0.4, 1.0, "oak")
    world.create_union(7, [block, world.create_sphere(8, (12.8, 1, 5), 0.3, "iron")])
    return world


def test_a_planar_scene() -> None:
    world = flat()
    found = analyse(world)
    assert found.findings == []
    assert found.frame.normal.tolist() == [0, 1, 0]
    assert found.frame.offset == 1
    kinds = {sid: [type(o).__name__ for o in outlines] for sid, outlines in found.outlines.items()}
    by_uid = {body.uid: kinds[body.sid] for body in world.bodies}
    assert by_uid == {
        1: ["HalfPlane"], 2: ["Disc"], 3: ["Polygon"], 4: ["Stadium"], 5: ["Disc"],
        7: ["Polygon", "Disc"],
    }  # fmt: skip


REASONS: dict[str, tuple[str, Edit]] = {
    "gravity": ("Gravity", lambda w: setattr(w, "gravity", (0, 1, -9))),
    "centre": ("centre lies out", lambda w: setattr(w.bodies[1], "position", (0, 2, 1))),
    "velocity": (
        "velocity points out",
        lambda w: setattr(w.bodies[1], "linear_velocity", (0, 1, 0)),
    ),
    "force": ("force points out", lambda w: setattr(w.bodies[1], "force", (0, 1, 0))),
    "spin": ("angular velocity", lambda w: setattr(w.bodies[1], "angular_velocity", (1, 1, 0))),
    "torque": ("torque", lambda w: setattr(w.bodies[1], "torque", (0, 1, 1))),
    "tilted box": ("box is tilted", lambda w: w.bodies[2].rotate(0.1, 0, 0)),
    "tilted rod": ("capsule is tilted", lambda w: w.bodies[3].rotate(0.1, 0, 0.2)),
    "inertia": (
        "principal axis",
        lambda w: w.create_sphere(
            9, (20, 1, 0), 1, "oak", mass=1, inertia=[[2, 0.1, 0], [0.1, 2, 0], [0, 0, 2]]
        ),
    ),
    "ellipsoid": ("no ellipsoid", lambda w: w.create_ellipsoid(9, (20, 1, 0), (1, 1, 1), "oak")),
    "mesh": (
        "no mesh",
        lambda w: w.create_mesh(
            9, (20, 1, 0), [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
            [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], "oak", fixed=True,
        ),
    ),
    "slanted plane": ("surface of a plane", lambda w: w.create_plane(9, (0, 1, 1), -9, "oak")),
    "fixed shape": (
        "out of the plane",
        lambda w: w.create_box(9, (20, 3, 0), (1, 1, 1), "oak", fixed=True),
    ),
    "elliptic capsule": (
        "caps of the capsule",
        lambda w: w.create_capsule(9, (20, 1, 0), (0.5, 0.2, 0.2), 1, "oak"),
    ),
    "elliptic wheel": (
        "cylinder is elliptic",
        lambda w: w.create_cylinder(9, (20, 1, 0), (0.5, 0.2), 1, "oak").rotate(0, 0, math.pi / 2),
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", REASONS)
def test_reasons(what: str) -> None:
    text, edit = REASONS[what]
    world = flat()
    edit(world)
    findings = PymunkEngine().check(world)
    errors = [finding for finding in findings if finding.severity is Severity.ERROR]
    assert any(text in finding.message for finding in errors), errors
    assert all(finding.code == "engine-not-planar" for finding in errors)
    with pytest.raises(EngineError, match=text):
        PymunkEngine().load(world)


def test_every_reason_is_listed() -> None:
    world = flat()
    for what in ("centre", "velocity", "tilted box", "ellipsoid", "slanted plane"):
        REASONS[what][1](world)
    messages = " ".join(finding.message for finding in PymunkEngine().check(world))
    for what in ("centre", "velocity", "tilted box", "ellipsoid", "slanted plane"):
        assert REASONS[what][0] in messages


def test_many_bodies_with_one_reason_are_counted() -> None:
    world = flat()
    for i in range(30):
        world.create_ellipsoid(1, (i, 1, 30), (1, 2, 1), "oak")
    messages = [finding.message for finding in PymunkEngine().check(world)]
    assert sum("no ellipsoid" in message for message in messages) == 11
    assert any("20 more bodies" in message for message in messages)


def test_bodies_without_mass_are_refused() -> None:
    world = flat()
    world.create_sphere(1, (20, 1, 0), 1, "oak", mass=0, inertia=(0, 0, 0))
    assert "engine-mass" in {finding.code for finding in PymunkEngine().check(world)}


@pytest.mark.parametrize("normal", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 3), (-0.3, 0.2, 0.1)])
def test_frames_are_right_handed(normal: tuple[float, float, float]) -> None:
    unit = np.array(normal) / np.linalg.norm(normal)
    frame = Frame.across(unit)
    assert np.allclose(np.cross(frame.u, frame.v), unit, atol=1e-15)
    assert np.allclose([frame.u @ frame.v, frame.u @ unit, frame.v @ unit], 0, atol=1e-15)
    vectors = np.random.default_rng(1).normal(size=(5, 3))
    again = frame.lift(frame.flat(vectors), frame.height(vectors))
    assert np.allclose(again, vectors, atol=1e-14)
    if max(normal) == sum(normal):
        assert np.array_equal(again, vectors)


@settings(max_examples=settings().max_examples // 7)
@given(st.tuples(*[st.floats(-3, 3)] * 3), st.tuples(*[st.floats(-3, 3)] * 3))
@example(angles=(0.0, 0.0, 1e-6), shift=(0.0, 0.0, 0.0))  # nearly the first plane that is tried
def test_a_scene_turned_in_space_runs_the_same(angles: Any, shift: Any) -> None:
    """In any plane: the poses after some steps are the turned poses."""
    turn = rotations.fixed_angles(*angles)
    one, two = flat(), flat()
    two.gravity = rotations.rotate(turn, one.gravity)
    two.positions = rotations.rotate(turn, one.positions) + shift
    two.orientations = rotations.multiply(turn, one.orientations)
    two.linear_velocities = rotations.rotate(turn, one.linear_velocities)
    two.angular_velocities = rotations.rotate(turn, one.angular_velocities)
    for world in (one, two):
        engine = PymunkEngine()
        engine.load(world)
        engine.step(60)
        engine.store(world)
    expected = rotations.rotate(turn, one.positions) + shift
    assert np.allclose(two.positions, expected, atol=1e-5)
    matrices = rotations.to_matrix(rotations.multiply(turn, one.orientations))
    assert np.allclose(rotations.to_matrix(two.orientations), matrices, atol=1e-4)
    spin = rotations.rotate(turn, one.angular_velocities)
    assert np.allclose(two.angular_velocities, spin, atol=1e-3)


def test_an_empty_scene_and_one_at_rest() -> None:
    for world in (World(time_step=0.1), World((0, 0, -1), time_step=0.1)):
        world.create_plane(1, (0, 0, 1), 0, "iron")
        engine = PymunkEngine()
        engine.load(world)
        engine.step(3)
        engine.store(world)
        assert world.step_count == 3
    engine.load(empty := World(time_step=0.1))
    engine.step(1)
    engine.store(empty)
    assert empty.time == 0.1

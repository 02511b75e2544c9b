"""Joints in the plane: limits, springs and signs, from either side."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from colladaphy.engines.diagnostics import joint_coordinates
from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.findings import Severity
from colladaphy.world import FREE, LOCKED, Body, World

DT = 1 / 480
UNFREE = tuple(-value for value in FREE)


def scene(gravity: Any = (0, 0, 0)) -> tuple[World, Body]:
    world = World(gravity, time_step=DT)
    return world, world.create_box(1, (1, 0, 0), (2, 0.5, 0.5), "fir")


def run(world: World, steps: int) -> None:
    engine = PymunkEngine()
    engine.load(world)
    engine.step(steps)
    engine.store(world)


def errors(world: World) -> list[str]:
    findings = PymunkEngine().check(world)
    return [finding.message for finding in findings if finding.severity is Severity.ERROR]


def reach(world: World, steps: int, value: Callable[[], float]) -> tuple[float, float]:
    """Smallest and largest of a value during a run."""
    engine = PymunkEngine()
    engine.load(world)
    seen = []
    for _ in range(steps):
        engine.step(1)
        engine.store(world)
        seen.append(value())
    return min(seen), max(seen)


def turned(body: Body) -> float:
    """Angle about y."""
    return 2 * math.atan2(body.orientation[2], body.orientation[0])


@pytest.mark.parametrize("axis", [(0, 1, 0), (0, -1, 0)])
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("spin", [2.0, -2.0])
def test_hinge_limits_from_either_side(axis: Any, reverse: bool, spin: float) -> None:
    world, body = scene()
    limits = (-0.25, 0.75)
    if reverse:
        world.attach_hinge_joint(body, None, (-1, 0, 0), axis=axis, limits=limits)
    else:
        world.attach_hinge_joint(None, body, (0, 0, 0), axis=axis, limits=limits)
    body.angular_velocity = (0, spin, 0)
    body.linear_velocity = (0, 0, -spin)
    least, most = reach(world, 400, lambda: turned(body))
    sign = axis[1] * (-1 if reverse else 1)
    low, high = sorted((sign * limits[0], sign * limits[1]))
    if spin > 0:
        assert most == pytest.approx(high, abs=0.01) and least > low
    else:
        assert least == pytest.approx(low, abs=0.01) and most < high
    assert np.linalg.norm(body.position) == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("axis", [(0, 1, 0), (0, -1, 0)])
@pytest.mark.parametrize("reverse", [False, True])
def test_angular_spring_turns_to_its_target(axis: Any, reverse: bool) -> None:
    world, body = scene()
    inertia = body.inertia[1, 1] + body.mass
    spring = (20.0 * inertia, 4.0 * inertia, 0.4)
    sides = (body, None) if reverse else (None, body)
    anchor = (-1, 0, 0) if reverse else (0, 0, 0)
    joint = world.attach_hinge_joint(*sides, anchor, axis=axis, angular_spring=spring)
    run(world, 2400)
    assert joint_coordinates(joint)[1][2] == pytest.approx(0.4, abs=1e-3)
    sign = axis[1] * (-1 if reverse else 1)
    assert turned(body) == pytest.approx(sign * 0.4, abs=1e-3)


def test_torsion_frequency() -> None:
    world, body = scene()
    stiffness = 30.0
    spring = (stiffness * body.inertia[1, 1], 0.0, 0.0)
    world.attach_hinge_joint(None, body, (1, 0, 0), axis=(0, 1, 0), angular_spring=spring)
    body.angular_velocity = (0, 1, 0)
    engine = PymunkEngine()
    engine.load(world)
    angles = []
    for _ in range(1200):
        engine.step(2)
        engine.store(world)
        angles.append(turned(body))
    track = np.array(angles)
    up = np.flatnonzero((track[:-1] < 0) & (track[1:] >= 0))
    period = float(np.mean(np.diff(up))) * 2 * DT
    assert period == pytest.approx(2 * math.pi / math.sqrt(stiffness), rel=5e-3)
    assert np.abs(track).max() == pytest.approx(1 / math.sqrt(stiffness), rel=0.02)


@pytest.mark.parametrize("reverse", [False, True])
def test_slider_limits_and_target(reverse: bool) -> None:
    world, body = scene()
    body.linear_velocity = (0, 0, 2)
    sides = (body, None) if reverse else (None, body)
    world.attach_slider_joint(*sides, axis=(0, 0, 1), limits=(-0.25, 0.75))
    _, most = reach(world, 400, lambda: float(body.position[2]))
    assert most == pytest.approx(0.25 if reverse else 0.75, abs=0.01)
    assert body.position[0] == pytest.approx(1, abs=1e-3)
    assert turned(body) == pytest.approx(0, abs=1e-3)
    pulled, other = scene()
    sides = (other, None) if reverse else (None, other)
    joint = pulled.attach_slider_joint(
        *sides, axis=(0, 0, 1), linear_spring=(40 * other.mass, 8 * other.mass, 0.5)
    )
    run(pulled, 2400)
    assert joint_coordinates(joint)[0][2] == pytest.approx(0.5, abs=1e-3)
    assert other.position[2] == pytest.approx(-0.5 if reverse else 0.5, abs=1e-3)


def test_locked_at_a_distance_and_an_angle() -> None:
    world, body = scene()
    joint = world.attach_joint(
        None, body,
        linear_min=(1.5, 0, 0.5), linear_max=(1.5, 0, 0.5),
        angular_min=(0, 0.3, 0), angular_max=(0, 0.3, 0),
    )  # fmt: skip
    run(world, 2400)
    shift, turn = joint_coordinates(joint)
    assert shift == pytest.approx([1.5, 0, 0.5], abs=1e-3)
    assert turn == pytest.approx([0, 0.3, 0], abs=1e-3)


def test_ball_turns_freely_and_holds() -> None:
    world, body = scene((0, 0, -9.81))
    world.attach_ball_joint(None, body, (0, 0, 0))
    run(world, 200)
    assert np.linalg.norm(body.position) == pytest.approx(1, abs=2e-3)
    assert body.position[2] < -0.3


def test_free_translation_with_a_spring() -> None:
    world, body = scene()
    world.attach_joint(
        None, body, linear_min=UNFREE, linear_max=FREE, angular_min=UNFREE, angular_max=FREE,
        linear_spring=(40 * body.mass, 8 * body.mass, 0.0),
    )  # fmt: skip
    run(world, 2400)
    assert np.allclose(body.position, 0, atol=1e-3)


def test_a_hinge_in_the_plane_holds_like_a_fixed_joint() -> None:
    world, body = scene((0, 0, -9.81))
    world.attach_hinge_joint(None, body, (0, 0, 0), axis=(1, 0, 0))
    run(world, 480)
    assert np.allclose(body.position, (1, 0, 0), atol=0.01)


def test_disabled_joints_do_nothing_and_interpenetration_is_allowed() -> None:
    for enabled in (True, False):
        world, body = scene()
        other = world.create_box(2, (1.5, 0, 0), (2, 0.5, 0.5), "fir")
        world.attach_joint(
            body, other, interpenetrate=True, enabled=enabled, linear_min=UNFREE, linear_max=FREE,
            angular_min=UNFREE, angular_max=FREE,
        )  # fmt: skip
        run(world, 100)
        apart = other.position[0] - body.position[0]
        assert (apart == 0.5) == enabled


REFUSED: dict[str, tuple[str, dict[str, Any]]] = {
    "box limits": (
        "two directions",
        {"linear_min": (-1, 0, -1), "linear_max": (1, 0, 1)},
    ),
    "slanted hinge": (
        "neither in the plane nor across",
        {
            "frame1": (LOCKED, (0.9238795325112867, 0.3826834323650898, 0, 0)),
            "frame2": (LOCKED, (0.9238795325112867, 0.3826834323650898, 0, 0)),
            "angular_min": (0, -1, 0),
            "angular_max": (0, 1, 0),
        },
    ),
    "slanted slider": (
        "neither in the plane nor across",
        {
            "frame1": (LOCKED, (0.9238795325112867, 0.3826834323650898, 0, 0)),
            "linear_max": (0, 1, 0),
        },
    ),
    "pushed out": ("push the bodies out", {"linear_min": (0, 1, 0), "linear_max": (0, 2, 0)}),
    "turned out": (
        "turn the bodies out",
        {"angular_min": (0.5, 0, 0), "angular_max": (0.7, 0, 0)},
    ),
    "held turned": (
        "turned out of the plane",
        {"angular_min": (0.5, 0, 0), "angular_max": (0.5, 0, 0)},
    ),
    "twisted frames": (
        "turned against each other",
        {"frame2": (LOCKED, (0.9238795325112867, 0.3826834323650898, 0, 0))},
    ),
    "pulled out": (
        "pull the bodies out",
        {"linear_min": UNFREE, "linear_max": FREE, "linear_spring": (1, 0, 0.5)},
    ),
    "sprung out": (
        "spring would turn",
        {"angular_min": UNFREE, "angular_max": FREE, "angular_spring": (1, 0, 0.5)},
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refusals(what: str) -> None:
    text, options = REFUSED[what]
    world, body = scene((0, 0, -9.81))
    # Without this, the scene would be planar in several planes.
    body.angular_velocity = (0, 1, 0)
    world.attach_joint(None, body, **options)
    assert any(text in message for message in errors(world)), errors(world)


def test_joints_between_bodies_that_cannot_move_are_inert() -> None:
    world, body = scene()
    wall = world.create_box(2, (9, 0, 0), (1, 1, 1), "oak", fixed=True)
    world.attach_fixed_joint(None, wall)
    codes = {finding.code for finding in PymunkEngine().check(world)}
    assert "engine-joint-inert" in codes
    body.linear_velocity = (1, 0, 0)
    run(world, 10)
    assert wall.position.tolist() == [9, 0, 0]

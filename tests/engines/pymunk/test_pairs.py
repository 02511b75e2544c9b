"""Restitution and friction of each pair of materials."""

from __future__ import annotations

import math

import pytest

from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.world import World


def run(world: World, steps: int) -> PymunkEngine:
    engine = PymunkEngine()
    engine.load(world)
    engine.step(steps)
    engine.store(world)
    return engine


def test_every_pair_bounces_by_its_own_coefficient() -> None:
    world = World(time_step=1 / 240)
    wanted = {("iron", "oak"): 0.9, ("iron", "fir"): 0.3, ("oak", "oak"): 0.0}
    pairs = []
    for row, ((first, second), restitution) in enumerate(wanted.items()):
        world.set_pair(first, second, restitution=restitution)
        one = world.create_sphere(1, (-1, 0, 5 * row), 0.5, first, linear_velocity=(2, 0, 0))
        two = world.create_sphere(2, (1, 0, 5 * row), 0.5, second, linear_velocity=(-1, 0, 0))
        pairs.append((one, two, restitution))
    run(world, 240)
    for one, two, restitution in pairs:
        apart = (two.linear_velocity - one.linear_velocity)[0]
        assert apart == pytest.approx(3 * restitution, abs=1e-6)


def test_default_materials_bounce_by_a_quarter() -> None:
    world = World(time_step=1 / 240)
    one = world.create_sphere(1, (-1, 0, 0), 0.5, "iron", linear_velocity=(2, 0, 0))
    two = world.create_sphere(2, (1, 0, 0), 0.5, "oak", linear_velocity=(-2, 0, 0))
    run(world, 240)
    assert (two.linear_velocity - one.linear_velocity)[0] == pytest.approx(1.0, abs=1e-6)


def test_every_pair_slides_by_its_own_coefficient() -> None:
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    boxes = {}
    for place, (material, friction) in enumerate((("iron", 0.3), ("oak", 0.6), ("fir", 0.0))):
        world.set_pair("granite", material, dynamic_friction=friction, static_friction=friction)
        boxes[friction] = world.create_box(
            1, (20 * place, 0, 0.25), (2, 1, 0.5), material, linear_velocity=(3, 0, 0)
        )
    run(world, 60)
    for friction, box in boxes.items():
        expected = max(0.0, 3 - friction * 9.81 * 60 / 240)
        assert box.linear_velocity[0] == pytest.approx(expected, abs=0.08)


def test_differing_frictions_are_reported() -> None:
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    world.create_box(1, (0, 0, 0.5), (1, 1, 1), "oak")
    world.create_box(1, (3, 0, 0.5), (1, 1, 1), "fir")
    assert "engine-frictions" not in {finding.code for finding in PymunkEngine().check(world)}
    world.set_pair("granite", "oak", static_friction=0.5)
    found = [f for f in PymunkEngine().check(world) if f.code == "engine-frictions"]
    assert len(found) == 1 and "granite on oak" in found[0].message


@pytest.mark.parametrize("height", [20, 23, 26])
def test_a_fast_body_does_not_fall_through_the_ground(height: float) -> None:
    world = World((0, 0, -9.81), time_step=1 / 60)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    ball = world.create_sphere(1, (0, 0, height), 0.1, "iron", linear_velocity=(0, 0, -600))
    run(world, 600)
    assert ball.position[2] > 0.05


def test_planes_hold_on_both_sides_of_the_scene() -> None:
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0, "granite")
    world.create_plane(1, (1, 0, 0), -2, "granite")
    world.create_plane(1, (-1, 0, 1), -2 / math.sqrt(2) * 2, "granite")
    balls = [world.create_sphere(1, (x, 0, 1), 0.2, "iron", linear_velocity=(8 * x, 0, 0))
             for x in (-1, 1)]  # fmt: skip
    run(world, 2000)
    assert balls[0].position[0] > -1.81 and balls[0].position[2] == pytest.approx(0.2, abs=0.01)
    assert balls[1].position[0] < 5

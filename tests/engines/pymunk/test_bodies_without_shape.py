"""Bodies of mass and inertia that have no shape, in the plane."""

from __future__ import annotations

import numpy as np
import pytest

from colladaphy.engines import create_engine
from colladaphy.world import World


def test_it_flies_and_turns_about_the_normal_and_hits_nothing() -> None:
    world = World(gravity=(0, -10, 0), time_step=0.001)
    body = world.create_body(
        0, (0, 5, 0), 3.0, (7, 8, 2), linear_velocity=(1, 0, 0), angular_velocity=(0, 0, 2)
    )
    body.torque = (0, 0, 500)  # in the first step: 500 · 0.001 / 2 more
    world.create_sphere(0, (0.5, 4, 0), 1.0, "iron", fixed=True)
    engine = create_engine("pymunk")
    engine.load(world)
    engine.step(1000)
    engine.store(world)
    assert np.allclose(body.position, (1, 0, 0), atol=0.02)
    assert body.angular_velocity[2] == pytest.approx(2.25, rel=1e-6)


def test_in_a_union_it_only_weighs() -> None:
    world = World(gravity=(0, -10, 0), time_step=0.001)
    ball = world.create_sphere(0, (0, 0, 0), 1.0, "iron", mass=1.0, inertia=(1, 1, 1))
    union = world.create_union(0, [ball, world.create_body(0, (4, 0, 0), 1.0, (1, 1, 1))])
    engine = create_engine("pymunk")
    engine.load(world)
    engine.step(100)
    engine.store(world)
    assert np.allclose(union.linear_velocity, (0, -1, 0), atol=1e-9)

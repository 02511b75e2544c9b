"""Bodies without a shape, and point masses, in MuJoCo."""

from __future__ import annotations

import numpy as np
import pytest

from colladaphy.engines import create_engine
from colladaphy.world import World

pytest.importorskip("mujoco")


def test_a_body_without_a_shape_flies_and_turns_as_its_mass_and_inertia_say() -> None:
    world = World(gravity=(0, 0, -10), time_step=0.001)
    body = world.create_body(
        0, (0, 0, 100), 3.0, (1, 2, 2.5), linear_velocity=(1, 0, 0), angular_velocity=(0, 0, 2)
    )
    world.create_sphere(0, (0, 0, 99.9), 1.0, "iron", fixed=True)  # which it does not touch
    engine = create_engine("mujoco")
    engine.load(world)
    engine.step(1000)
    engine.store(world)
    assert np.allclose(body.position, (1, 0, 95), atol=0.01)
    assert np.allclose(body.angular_velocity, (0, 0, 2), atol=1e-9)


def test_a_point_mass_on_a_hinge_swings_as_a_pendulum_does() -> None:
    length = 0.5
    world = World(gravity=(0, 0, -9.81), time_step=0.0005)
    amplitude = 0.05
    start = (length * np.sin(amplitude), 0.0, -length * np.cos(amplitude))
    point = world.create_body(0, start, 2.0)
    world.attach_hinge_joint(point, None, anchor2=(0, 0, 0), axis=(0, 1, 0))
    engine = create_engine("mujoco")
    findings = [finding.code for finding in engine.check(world)]
    assert "engine-inertia-assumed" in findings
    engine.load(world)
    # The radius of gyration of a hundredth of the arm slows it by 5e-5 of the period.
    period = 2 * np.pi * np.sqrt(length / 9.81)
    engine.step(round(period / world.time_step))
    engine.store(world)
    assert np.allclose(point.position, start, atol=1e-3)

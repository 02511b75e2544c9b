"""Time steps of any size are run, or refused or stopped with an error of our own."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest

from colladaphy.engines import create_engine
from colladaphy.errors import EngineError
from colladaphy.world import World


@pytest.mark.parametrize("engine", ["pymunk", "mujoco"])
@pytest.mark.parametrize("time_step", [1.7976931348623157e308, 1e200, 1e100, 1e-320])
@pytest.mark.parametrize("speed", [0.0, 1e100, 1e200])
def test_any_time_step(engine: str, time_step: float, speed: float) -> None:
    world = World((0, 0, -9.81), time_step=time_step)
    pair = [world.create_sphere(x, (3 * x, 0, 0), 1, "iron") for x in (0, 1)]
    pair[0].linear_velocity = (speed, 0, 0)
    world.attach_ball_joint(*pair)
    made = create_engine(engine)
    with contextlib.suppress(EngineError):
        made.load(world)
        made.step(2)
        made.store(world)
        assert np.isfinite(world.positions).all()

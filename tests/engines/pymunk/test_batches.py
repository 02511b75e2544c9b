"""All bodies at once are the bodies one by one."""

from __future__ import annotations

import numpy as np
import pymunk
import pytest

from colladaphy.engines.pymunk_engine.batches import Batch


@pytest.mark.parametrize("slowly", [False, True])
def test_state_and_pushes(slowly: bool) -> None:
    space = pymunk.Space()
    bodies = []
    for i in range(7):
        if i == 3:
            space.add(pymunk.Body(body_type=pymunk.Body.STATIC))
        body = pymunk.Body(1.0 + i, 2.0 + i)
        body.position, body.velocity, body.angle = (i, -i), (0.5 * i, 1), 0.1 * i
        body.angular_velocity = -i
        space.add(body)
        bodies.append(body)
    batch = Batch(space, bodies[::-1])
    assert batch._buffer is not None  # this version of pymunk is understood
    if slowly:
        batch._buffer = None
    expected = [[i, -i, 0.1 * i, 0.5 * i, 1, -i] for i in range(7)][::-1]
    np.testing.assert_array_equal(batch.state(), expected)
    forces, torques = np.arange(14.0).reshape(7, 2), np.arange(7.0)
    batch.push(forces, torques)
    for body, force, torque in zip(bodies[::-1], forces, torques, strict=True):
        assert body.force == tuple(force) and body.torque == torque
    space.step(0.25)
    assert bodies[-1].velocity == (3.0 + 0.25 * forces[0, 0] / 7, 1 + 0.25 * forces[0, 1] / 7)
    np.testing.assert_array_equal(batch.state()[0, 3:5], bodies[-1].velocity)

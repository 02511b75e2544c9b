"""Engines and scenes that the tests of engines share."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import pytest

from colladaphy.engines import ENGINES, Engine, create_engine
from colladaphy.world import World


@pytest.fixture(params=list(ENGINES))
def engine(request: pytest.FixtureRequest) -> Engine:
    """Every engine there is, one after the other."""
    module = ENGINES[request.param][0]
    if find_spec(module) is None:
        pytest.skip(f"the engine {request.param} is not part of this build")
    return create_engine(request.param)


Maker = Callable[..., World]


@pytest.fixture
def empty() -> Maker:
    """Makes an empty World with a material "ball" of given restitution and friction."""

    def make(
        gravity: Any = (0.0, 0.0, 0.0),
        *,
        dt: float = 1 / 240,
        restitution: float = 0.0,
        friction: float = 0.0,
    ) -> World:
        world = World(gravity, time_step=dt)
        world.create_material(
            "ball",
            density=1000.0,
            restitution=restitution,
            static_friction=friction / 2,  # of a pair of one material: twice that
            dynamic_friction=friction / 2,
            poisson_ratio=0.3,
            young_modulus=100.0,
            stiffness=100.0,
            damping_normal=0.0,
            damping_tangential=0.0,
        )
        world.set_pair("ball", "ball", restitution=restitution)
        return world

    return make

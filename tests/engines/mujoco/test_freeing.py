"""Free joints that are put into a compiled model make the model that MuJoCo compiles."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.engines import Simulation
from colladaphy.engines.mujoco_engine import MujocoEngine, freeing, model
from colladaphy.engines.mujoco_engine.freeing import can_free, differing
from colladaphy.testing import worlds
from colladaphy.world import BodyColumns, Kind, World, compare


@pytest.fixture
def always(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model, "_FEW", 0)


def compiled(world: World, *, sleep: bool = False) -> Any:
    engine = MujocoEngine(sleep=sleep)
    engine.load(world)
    assert engine._model is not None
    return engine._model.compiled


def spheres(count: int, seed: int = 0) -> World:
    chance = np.random.default_rng(seed)
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(0, (0, 0, 1), 0.0, "iron")
    side = int(np.ceil(count ** (1 / 3)))
    grid = np.stack(np.unravel_index(np.arange(count), (side,) * 3), axis=-1)
    sizes = np.zeros((count, 4))
    sizes[:, 0] = chance.uniform(0.3, 0.5, count)
    world.extend(
        BodyColumns(kinds=np.full(count, Kind.SPHERE), positions=grid * 1.1 + 1.0, dimensions=sizes)
    )
    return world


def test_it_is_known_how_this_version_does_it() -> None:
    assert can_free()


@settings(max_examples=max(20, settings().max_examples // 4))
@given(world=worlds(joints=False, physical=True, max_bodies=12), sleep=st.booleans())
def test_models_are_those_that_mujoco_compiles(world: World, sleep: bool) -> None:
    world.time_step = 1 / 240
    if any(f.severity.name == "ERROR" for f in MujocoEngine(sleep=sleep).check(world)):
        return
    made = {}
    for few in (0, 10**9):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(model, "_FEW", few)
            patch.setattr(model, "_PART", 3)
            made[few] = compiled(world, sleep=sleep)
    assert differing(*made.values()) == []


def test_many_different_bodies_are_compiled_by_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    world = spheres(250)
    assert len(set(world.masses.tolist())) > 2 * freeing._AT_ONCE
    quick = compiled(world)
    monkeypatch.setattr(model, "_FEW", 10**9)
    assert differing(quick, compiled(world)) == []


def test_runs_are_the_same_bit_by_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = []
    for few in (0, 10**9):
        monkeypatch.setattr(model, "_FEW", few)
        world = spheres(120)
        Simulation(world, MujocoEngine()).run(60)
        ends.append(world)
    assert compare(*ends) == []


@pytest.mark.usefixtures("always")
def test_where_models_are_others_mujoco_compiles_all(monkeypatch: pytest.MonkeyPatch) -> None:
    world = spheres(5)
    right = compiled(world)
    monkeypatch.setattr(freeing, "_HEADER", 24)
    can_free.cache_clear()
    assert not can_free()
    assert differing(compiled(world), right) == []
    can_free.cache_clear()
    # Known of the sample, but not of the scene.
    monkeypatch.setattr(freeing, "can_free", lambda: True)
    assert differing(compiled(world), right) == []


@pytest.mark.usefixtures("always")
def test_what_is_jointed_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    world = spheres(3)
    world.attach_ball_joint(world.bodies[1], world.bodies[2])
    monkeypatch.setattr(model, "freed", lambda *_: pytest.fail("it was not compiled"))
    assert compiled(world).njnt == 1 + 1 + 1


def test_thousands_of_bodies_are_set_up_in_proportion() -> None:
    world = spheres(3000)
    assert can_free()
    start = perf_counter()
    engine = MujocoEngine()
    engine.load(world)
    spent = perf_counter() - start
    spec = mujoco.MjSpec()
    for _ in range(3000):
        freeing.add_free_joint(spec.worldbody.add_body(mass=1.0, inertia=[1, 1, 1]))
    start = perf_counter()
    spec.compile()
    assert spent < 1.5 * (perf_counter() - start)

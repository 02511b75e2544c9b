"""A run that goes on from a store is the run that is loaded elsewhere, to the last bit."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.engines.scenes import PLANAR, SCENES
from tests.world.rebuilding import rebuilt

from colladaphy.engines import digest
from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.world import World, compare

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize("scene", PLANAR)
@pytest.mark.parametrize("at", [0, 1, 37, 400, 1500])
def test_the_run_that_goes_on_is_the_run_that_is_loaded(scene: str, at: int) -> None:
    world = SCENES[scene]()
    going, resumed = PymunkEngine(), PymunkEngine()
    going.load(world)
    going.step(at)
    going.store(world)
    going.load(world)
    copy = rebuilt(world)
    resumed.load(copy)
    for _ in range(3):
        for engine, target in ((going, world), (resumed, copy)):
            engine.step(100)
            engine.store(target)
        assert compare(world, copy) == []


def test_bodies_fall_asleep_and_are_woken() -> None:
    world = SCENES["pile"]()
    late = world.create_sphere(20, (0, 0, 60), 0.4, "iron")
    engine = PymunkEngine(sleep=True)
    engine.load(world)
    slept = woken = False
    for _ in range(16):
        engine.step(150)  # bodies that are at rest for half a second sleep
        engine.store(world)
        engine.load(world)
        awake = ~world.sleeping & ~world.fixed
        assert not np.any(world.linear_velocities[world.sleeping])
        assert not np.any(world.angular_velocities[world.sleeping])
        slept = slept or (world.sleeping.any() and not late.sleeping)
        woken = woken or bool(slept and awake.sum() > 1)
    assert slept and woken


RUNNER = """
import pickle, sys
from colladaphy.engines import digest
from colladaphy.engines.pymunk_engine import PymunkEngine
with open(sys.argv[1], "rb") as file:
    world = pickle.load(file)
engine = PymunkEngine()
engine.load(world)
for _ in range(3):
    engine.step(70)
    engine.store(world)
    engine.load(world)
print(digest(world))
"""


@pytest.mark.parametrize("scene", PLANAR)
def test_across_processes(scene: str, tmp_path: Path) -> None:
    world = SCENES[scene]()
    engine = PymunkEngine()
    engine.load(world)
    engine.step(200)
    engine.store(world)
    (tmp_path / "world").write_bytes(pickle.dumps(world))
    engine.load(world)
    for _ in range(3):
        engine.step(70)
        engine.store(world)
        engine.load(world)
    for seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", RUNNER, str(tmp_path / "world")],
            env=os.environ | {"PYTHONHASHSEED": seed}, cwd=ROOT, capture_output=True, text=True,
            check=True,
        )  # fmt: skip
        assert done.stdout.strip() == digest(world)


@settings(max_examples=settings().max_examples // 7)
@given(st.sampled_from(PLANAR), st.lists(st.integers(0, 60), min_size=1, max_size=4))
def test_any_series_of_stores(scene: str, stops: list[int]) -> None:
    worlds = [SCENES[scene](), SCENES[scene]()]
    going = PymunkEngine()
    going.load(worlds[0])
    resumed = PymunkEngine()
    resumed.load(worlds[1])
    for stop in stops:
        for engine, world in zip((going, resumed), worlds, strict=True):
            engine.step(stop)
            engine.store(world)
        going.load(worlds[0])
        worlds[1] = rebuilt(worlds[1])
        resumed = PymunkEngine()
        resumed.load(worlds[1])
    going.step(30)
    resumed.step(30)
    going.store(worlds[0])
    resumed.store(worlds[1])
    assert compare(*worlds) == []


def test_storing_does_not_disturb_and_writes_no_more_than_it_should() -> None:
    world, twin = SCENES["walker"](), SCENES["walker"]()
    one, two = PymunkEngine(), PymunkEngine()
    one.load(world)
    two.load(twin)
    before = rebuilt(world)
    one.store(world)
    world.engine_state = None
    assert compare(world, before) == []
    for _ in range(50):
        one.step(3)
        one.store(world)
        one.contacts()
    two.step(150)
    two.store(twin)
    assert compare(world, twin) == []
    changed = {line.partition(":")[0].split(", ")[-1] for line in compare(world, before)}
    assert changed <= {
        "positions", "orientations", "linear_velocities", "angular_velocities", "step_count",
        "time", "engine_state", "sleeping",
    }  # fmt: skip
    assert world.positions[0].tolist() == before.positions[0].tolist()


def test_contacts_are_in_order_and_in_the_plane() -> None:
    world = World((0, 0, -9.81), time_step=1 / 240)
    ground = world.create_plane(1, (0, 0, 1), 0.25, "granite")
    box = world.create_box(2, (0.5, 7, 0.75), (2, 1, 1), "oak")
    ball = world.create_sphere(3, (0.5, 7, 1.75), 0.5, "oak")
    engine = PymunkEngine()
    engine.load(world)
    assert engine.contacts() == []
    engine.step(60)
    contacts = engine.contacts()
    pairs = [(contact.first, contact.second) for contact in contacts]
    assert pairs == [(ground.sid, box.sid)] * 2 + [(box.sid, ball.sid)]
    for contact in contacts:
        assert contact.normal == pytest.approx((0, 0, 1), abs=1e-3)
        assert contact.position[1] == pytest.approx(7)
        assert abs(contact.distance) < 0.01
    assert sorted(contact.position[0] for contact in contacts) == pytest.approx(
        [-0.5, 0.5, 1.5], abs=0.02
    )
    weight = 9.81 / 240
    below = sum(contact.impulse for contact in contacts[:2])
    assert below == pytest.approx((box.mass + ball.mass) * weight, rel=0.05)
    assert contacts[2].impulse == pytest.approx(ball.mass * weight, rel=0.05)

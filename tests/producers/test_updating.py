"""Worlds of what other programs write go back into their documents, whatever their mixture."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.producers.test_flat import NAMES
from tests.producers.test_robots import SOME_QUIRKS

import colladaphy
from colladaphy.testing.foreign_documents import scenes_of
from colladaphy.testing.producers import flat, robots
from colladaphy.testing.producers.habits import PRODUCERS
from colladaphy.testing.producers.truth import Scene
from colladaphy.world import World, compare

CHANGES = st.fixed_dictionaries(
    {
        "moved": st.lists(st.integers(0, 5), max_size=3),
        "heavier": st.lists(st.integers(0, 5), max_size=2),
        "gone": st.lists(st.integers(0, 5), max_size=1),
        "added": st.booleans(),
    }
)


def check(data: bytes, changes: dict[str, list[int]]) -> None:
    document = colladaphy.read(data, repair=True)
    world: World = document.load()
    chance = np.random.default_rng(len(data))
    bodies = list(world.bodies)
    for place in changes["moved"]:
        if place < len(bodies) and not bodies[place].fixed:
            bodies[place].position = chance.normal(size=3)
            bodies[place].rotate(*chance.normal(size=3))
            bodies[place].linear_velocity = chance.normal(size=3)
    for place in changes["heavier"]:
        if place < len(bodies):
            world.masses[place] *= 2.0
    if not len(world.joints):  # what kinematics say of a joint comes back (`store-inexact`)
        for place in changes["gone"]:
            if place < len(bodies):
                world.destroy(bodies[place])
    if changes["added"]:
        world.create_sphere(3, (1, 2, 3), 0.5, "iron")
    for _ in range(2):
        document.update(world)
    file = io.BytesIO()
    document.write(file, check=False)
    again = colladaphy.read(file.getvalue()).load()
    assert compare(again, world) == []
    assert "store-inexact" not in {finding.code for finding in document.report}


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=15)
@given(data=st.data(), changes=CHANGES)
def test_scenes(name: str, data: st.DataObject, changes: dict[str, list[int]]) -> None:
    producer = PRODUCERS[name]
    scene = data.draw(scenes_of(name))
    quirks = frozenset()
    if producer.may:
        quirks = data.draw(st.sets(st.sampled_from(producer.may)).map(frozenset))
    check(flat.write(scene, producer, quirks), changes)


@settings(max_examples=40)
@given(scene=robots.robots(), producer=st.sampled_from(sorted(robots.TOOLS)), quirks=SOME_QUIRKS,
       changes=CHANGES)  # fmt: skip
def test_robots(
    scene: Scene, producer: str, quirks: frozenset[str], changes: dict[str, list[int]]
) -> None:
    check(robots.write(robots.meant(scene, quirks), producer, quirks), changes)

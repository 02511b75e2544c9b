"""Worlds can be copied and sent to other processes."""

from __future__ import annotations

import copy
import pickle

from hypothesis import given

from colladaphy.testing import worlds
from colladaphy.world import World, compare


@given(worlds(min_bodies=0))
def test_copies_are_equal_and_independent(world: World) -> None:
    pickled, copied = pickle.loads(pickle.dumps(world)), copy.deepcopy(world)
    assert compare(world, pickled, unused_materials=True) == []
    assert compare(world, copied, unused_materials=True) == []
    copied.create_sphere(1, (0, 0, 0), 1, "iron")
    assert len(copied.bodies) == len(world.bodies) + 1
    assert compare(world, pickled) == []

"""Any World can be built anew, bit by bit, from what it gives away."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from tests.world.rebuilding import rebuilt

from colladaphy.testing import worlds
from colladaphy.world import World, compare


@given(worlds(min_bodies=0))
def test_a_world_is_what_its_columns_say(world: World) -> None:
    assert compare(world, world) == []
    assert compare(world, rebuilt(world), unused_materials=True) == []


@given(worlds(min_bodies=0), st.data())
def test_every_changed_number_is_a_difference(world: World, data: st.DataObject) -> None:
    copy = rebuilt(world)
    name = data.draw(
        st.sampled_from(["positions", "orientations", "linear_velocities", "forces", "masses"])
    )
    column = getattr(copy, name).reshape(-1)
    if not len(column):
        return
    place = data.draw(st.integers(0, len(column) - 1))
    column[place] = -0.0 if column[place].hex() == "0x0.0p+0" else np.nextafter(column[place], 0)
    assert len(compare(world, copy)) >= 1

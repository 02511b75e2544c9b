"""The table of pairs against the World's own answer, pair by pair."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.engines.surfaces import used_materials
from colladaphy.world import World
from colladaphy.world.pairing import PairTable

share = st.floats(0, 1)
positive = st.floats(1e-3, 1e3)


@settings(max_examples=50)
@given(st.lists(st.tuples(share, share, share, positive), min_size=1, max_size=5), st.data())
def test_the_table_is_what_the_world_says(materials: list[tuple[float, ...]],
                                          data: st.DataObject) -> None:  # fmt: skip
    world = World()
    for i, (restitution, static, dynamic, stiffness) in enumerate(materials):
        world.create_material(
            f"m{i}", density=1, restitution=restitution, static_friction=static,
            dynamic_friction=dynamic, poisson_ratio=0.3, young_modulus=1, stiffness=stiffness,
            damping_normal=0, damping_tangential=0,
        )  # fmt: skip
    names = [material.name for material in world.materials]
    one, two = data.draw(st.sampled_from(names)), data.draw(st.sampled_from(names))
    world.set_pair(one, two, restitution=data.draw(st.none() | share),
                   dynamic_friction=data.draw(st.none() | share))  # fmt: skip
    ids = [material.id for material in world.materials]
    table = PairTable.of(world.materials, ids)
    for i, first in enumerate(ids):
        for j, second in enumerate(ids):
            pair = world.pair(first, second)
            assert table.restitution[i, j] == pytest.approx(pair.restitution, rel=1e-12)
            assert table.static[i, j] == pair.static_friction
            assert table.dynamic[i, j] == pair.dynamic_friction


def test_only_what_can_meet_counts() -> None:
    world = World()
    world.create_plane(1, (0, 0, 1), 0, "granite")
    world.create_sphere(2, (0, 0, 1), 0.5, "iron")
    world.create_union(
        3, [world.create_sphere(4, (3, 0, 1), 0.5, "oak"),
            world.create_sphere(5, (4, 0, 1), 0.5, "oak")],
    )  # fmt: skip
    used, meets = used_materials(world)
    names = [world.materials[int(id)].name for id in used]
    met = {(names[i], names[j]) for i, j in np.argwhere(meets).tolist()}
    assert ("granite", "iron") in met and ("granite", "granite") not in met
    assert ("iron", "iron") not in met and ("iron", "oak") in met

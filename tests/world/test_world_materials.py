"""Where two materials meet: pe's rules and what is set by hand."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.world import World

positive = st.floats(1e-3, 1e3)
materials = st.fixed_dictionaries(
    {
        "density": positive,
        "restitution": st.floats(0, 1),
        "static_friction": st.floats(0, 10),
        "dynamic_friction": st.floats(0, 10),
        "poisson_ratio": st.floats(-0.9, 0.5),
        "young_modulus": positive,
        "stiffness": positive,
        "damping_normal": st.floats(0, 10),
        "damping_tangential": positive,
    }
)


def test_default_pairs() -> None:
    world = World()
    for first in world.materials:
        for second in world.materials:
            pair = world.pair(first, second)
            assert (pair.restitution, pair.static_friction, pair.dynamic_friction) == (
                0.25, 0.20, 0.20,
            )  # fmt: skip


@given(materials, materials)
def test_custom_pairs(a: dict[str, Any], b: dict[str, Any]) -> None:
    world = World()
    first, second = world.create_material("a", **a), world.create_material("b", **b)
    pair = world.pair(first, second)
    assert pair == world.pair("b", "a")
    assert pair.static_friction == a["static_friction"] + b["static_friction"]
    assert pair.dynamic_friction == a["dynamic_friction"] + b["dynamic_friction"]
    stiffness = 1 / (1 / a["stiffness"] + 1 / b["stiffness"])
    restitution = math.sqrt(
        (a["restitution"] ** 2 / a["stiffness"] + b["restitution"] ** 2 / b["stiffness"])
        * stiffness
    )
    assert math.isclose(pair.restitution, restitution, rel_tol=1e-12, abs_tol=1e-99)
    assert math.isclose(pair.stiffness, stiffness, rel_tol=1e-12)
    young = 1 / (
        (1 - a["poisson_ratio"] ** 2) / a["young_modulus"]
        + (1 - b["poisson_ratio"] ** 2) / b["young_modulus"]
    )
    assert math.isclose(pair.young_modulus, young, rel_tol=1e-12)
    tangential = 1 / (1 / a["damping_tangential"] + 1 / b["damping_tangential"])
    assert math.isclose(pair.damping_tangential, tangential, rel_tol=1e-12)
    if not (a["damping_normal"] and b["damping_normal"]):
        assert pair.damping_normal == 0
    alone = world.pair(first, first)
    assert alone.static_friction == 2 * a["static_friction"]
    assert math.isclose(alone.restitution, a["restitution"], rel_tol=1e-12)


def test_a_default_with_a_custom_material_follows_the_rules() -> None:
    world = World()
    world.create_material(
        "soft", density=1.2, restitution=0.4, static_friction=0.5, dynamic_friction=0.1,
        poisson_ratio=0.2, young_modulus=1, stiffness=8, damping_normal=0, damping_tangential=0,
    )  # fmt: skip
    pair = world.pair("iron", "soft")
    assert pair.static_friction == 0.6
    assert pair.dynamic_friction == 0.2
    stiffness = 1 / (1 / 200 + 1 / 8)
    expected = math.sqrt((0.25 / 200 + 0.16 / 8) * stiffness)
    assert math.isclose(pair.restitution, expected, rel_tol=1e-14)


def test_overrides() -> None:
    world = World()
    before = world.pair("iron", "oak")
    world.set_pair("oak", "iron", restitution=0.9)
    world.set_pair("fir", "fir", static_friction=0.7, dynamic_friction=0.6)
    assert world.pair("iron", "oak").restitution == 0.9
    assert world.pair("iron", "oak").static_friction == before.static_friction
    assert world.pair("fir", "fir").static_friction == 0.7
    assert world.pair("iron", "iron").restitution == 0.25
    assert [(pair.first, pair.second) for pair in world.pair_overrides] == [(0, 3), (4, 4)]
    world.set_pair("iron", "oak")
    assert world.pair("iron", "oak") == before
    for bad in ({"restitution": 1.5}, {"static_friction": -1}, {"dynamic_friction": math.inf}):
        with pytest.raises(WorldError):
            world.set_pair("iron", "oak", **bad)
    with pytest.raises(WorldError):
        world.set_pair("iron", "adamant", restitution=0.1)


def test_explicit_ids_leave_gaps() -> None:
    world = World()
    values = {
        "density": 1, "restitution": 0, "static_friction": 0, "dynamic_friction": 0,
        "poisson_ratio": 0, "young_modulus": 1, "stiffness": 1, "damping_normal": 0,
        "damping_tangential": 0,
    }  # fmt: skip
    far = world.create_material("far", id=40, **values)
    near = world.create_material("near", id=20, **values)
    after = world.create_material("after", **values)
    assert (far.id, near.id, after.id) == (40, 20, 41)
    assert [material.name for material in world.materials][5:] == ["near", "far", "after"]
    assert world.materials[40] is far and far in world.materials and 30 not in world.materials
    assert world.create_sphere(1, (0, 0, 0), 1, far).material is far


def test_values_are_changed_by_column() -> None:
    world = World()
    iron = world.materials["iron"]
    world.materials.change("density", [0, 3], [7000.0, 900.0])
    assert world.materials["iron"].density == 7000 and world.materials["oak"].density == 900
    assert world.materials.values("density").tolist() == [7000, 8920, 2800, 900, 500]
    assert iron.density == 7874 and iron not in world.materials
    box = world.create_box(1, (0, 0, 0), (1, 2, 3), "oak")
    assert box.mass == 5400 and box.material is world.materials["oak"]
    for key, ids, values in (
        ("density", [0], [0.0]),
        ("density", [9], [1.0]),
        ("density", [0, 1], [1.0]),
        ("colour", [0], [1.0]),
        ("restitution", [0], [1.5]),
    ):
        with pytest.raises(WorldError):
            world.materials.change(key, ids, values)
    assert world.materials["iron"].density == 7000

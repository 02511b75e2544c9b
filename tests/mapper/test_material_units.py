"""Materials in Worlds of other units than metres, and what `load(si=True)` makes of them."""

from __future__ import annotations

import io
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import colladaphy
from colladaphy.world import World, compare

PE = {"iron": 7874.0, "copper": 8920.0, "granite": 2800.0, "oak": 800.0, "fir": 500.0}


def stored(world: World) -> io.BytesIO:
    data = io.BytesIO()
    colladaphy.write(world, data)
    data.seek(0)
    return data


@given(st.sampled_from(list(PE)), st.floats(1e-6, 1e6), st.floats(0.01, 100))
def test_the_same_ball_weighs_the_same_in_every_unit(
    name: str, meter: float, radius: float
) -> None:
    world = World(unit=("some", meter))
    ball = world.create_sphere(1, (0, 0, 0), radius / meter, name)
    assert ball.mass == pytest.approx(4 / 3 * math.pi * radius**3 * PE[name])
    assert ball.density == pytest.approx(world.materials[name].density)


def test_an_iron_ball_of_five_centimetres() -> None:
    world = World(unit=("centimeter", 0.01))
    ball = world.create_sphere(1, (0, 0, 0), 5, "iron")
    assert ball.mass == pytest.approx(4.12, abs=0.01)
    held = world.materials["iron"]
    world.unit_meter = 1.0
    assert world.materials["iron"].density == 7874.0 and held not in world.materials
    world.materials.change("density", [0], [7000.0])
    world.unit_meter = 0.01
    assert world.materials["iron"].density == 7000.0  # that of the user stays
    assert world.materials["oak"].density == pytest.approx(8e-4)
    for extreme in (1e-120, 1e120):
        assert World(unit=("far", extreme)).materials["oak"].density == 800.0


@pytest.mark.parametrize("meter", [0.01, 0.3048, 1000.0])
def test_all_values_of_materials_become_si(meter: float) -> None:
    """Each by what it is made of: kg/L³, force/L² = kg/(L s²), force/L = kg/s², kg/s."""
    world = World(unit=("some", meter))
    world.create_material(
        "own", density=2.5, restitution=0.5, static_friction=0.4, dynamic_friction=0.3,
        poisson_ratio=0.25, young_modulus=6.0, stiffness=7.0, damping_normal=0.125,
        damping_tangential=0.375,
    )  # fmt: skip
    for name in ("own", "iron"):
        world.create_box(1, (0, 0, 0), (1, 2, 3), name)
    loaded = colladaphy.read(stored(world)).load()
    assert compare(world, loaded) == []
    si = colladaphy.read(stored(world)).load(si=True)
    own = si.materials["own"]
    assert own.density == pytest.approx(2.5 / meter**3)
    assert own.young_modulus == pytest.approx(6.0 / meter)
    assert (own.stiffness, own.damping_normal, own.damping_tangential) == (7.0, 0.125, 0.375)
    assert (own.restitution, own.static_friction, own.dynamic_friction) == (0.5, 0.4, 0.3)
    assert own.poisson_ratio == 0.25
    for body in si.bodies:
        assert body.material is not None
        assert body.density == pytest.approx(body.material.density)
        assert body.mass == pytest.approx(world.body(body.sid).mass)
    assert si.bodies[1].material == si.materials["iron"] == si.materials[0]
    assert si.materials["iron"].density == pytest.approx(7874)

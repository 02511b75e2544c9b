"""Values that pe itself gives, to the digits that it prints."""

from __future__ import annotations

import math

import numpy as np
import pytest

from colladaphy.world import Body, Kind, World


def printed(value: float) -> str:
    """As pe prints numbers: twelve significant digits."""
    return f"{value:.12g}"


@pytest.fixture
def world() -> World:
    return World(gravity=(0, 0, -9.81))


def check(body: Body, mass: float, inertia: tuple[float, float, float]) -> None:
    assert printed(body.mass) == printed(mass)
    assert [printed(value) for value in np.diag(body.inertia)] == [printed(v) for v in inertia]
    assert np.count_nonzero(body.inertia - np.diag(np.diag(body.inertia))) == 0


def test_sphere(world: World) -> None:
    body = world.create_sphere(1, (0, 0, 0), 0.5, "iron")
    check(body, 4122.81675906, (412.281675906,) * 3)
    assert (body.kind, body.radius) == (Kind.SPHERE, 0.5)


def test_box(world: World) -> None:
    body = world.create_box(1, (0, 0, 0), (1, 2, 3), "oak")
    check(body, 4800, (5200, 4000, 2000))
    assert body.lengths.tolist() == [1, 2, 3]


def test_capsule(world: World) -> None:
    body = world.create_capsule(1, (0, 0, 0), 0.5, 2, "granite")
    check(body, 5864.3062867, (696.386371546, 3903.42887209, 3903.42887209))
    assert (body.radius, body.length, body.radii.tolist()) == (0.5, 2, [0.5, 0.5, 0.5])


def test_cylinder(world: World) -> None:
    body = world.create_cylinder(1, (0, 0, 0), 0.5, 2, "copper")
    check(body, 14011.503235, (1751.43790438, 5546.22003052, 5546.22003052))
    assert (body.radius, body.length, body.radii.tolist()) == (0.5, 2, [0.5, 0.5])


def test_union(world: World) -> None:
    sphere = world.create_sphere(1, (0, 0, 20), 1, "iron")
    box = world.create_box(1, (3, 0, 20), (1, 2, 3), "oak")
    box.rotate(0.3, 0.2, 0.1)
    turned = box.orientation
    union = world.create_union(2, [sphere, box])
    assert printed(union.mass) == printed(37782.5340725)
    assert printed(union.position[0]) == printed(0.381128485781)
    assert union.position[1:].tolist() == [0, 20]
    assert union.orientation.tolist() == [1, 0, 0, 0]
    inertia = union.inertia
    for place, value in {
        (0, 0): 18238.8082053,
        (1, 1): 54764.8959793,
        (2, 2): 53198.836312,
        (0, 1): 234.63149201,
        (0, 2): -641.364277256,
        (1, 2): 491.814654217,
    }.items():
        assert printed(inertia[place]) == printed(value)
        assert inertia[place] == inertia[place[::-1]]
    assert union.members == (sphere, box)
    assert box.orientation.tolist() == turned.tolist()
    assert np.allclose(box.position, (3, 0, 20), rtol=0, atol=1e-12)
    assert np.allclose(box.local_position, (3 - union.position[0], 0, 0), rtol=0, atol=1e-12)


def test_plane_is_fixed_and_infinite(world: World) -> None:
    plane = world.create_plane(1, (0, 3, 4), 2.5, "granite")
    assert plane.normal.tolist() == [0, 0.6, 0.8]
    assert plane.displacement == 2.5
    assert plane.position.tolist() == [0, 1.5, 2]
    assert plane.infinite and plane.fixed and plane.mass == 0
    assert plane.inverse_mass == 0 and not plane.inverse_inertia.any()
    plane.fixed = False
    assert plane.fixed


def test_plane_through_a_point_keeps_the_point(world: World) -> None:
    plane = world.create_plane(1, (0, 0, 1), None, "granite", position=(3, 4, 5))
    assert plane.displacement == 5
    assert plane.position.tolist() == [3, 4, 5]


def test_orientation_of_a_plane_turns_z_onto_its_normal(world: World) -> None:
    plane = world.create_plane(1, (1, 0, 0), 0, "granite")
    assert np.allclose(plane.orientation, (math.sqrt(0.5), 0, math.sqrt(0.5), 0), atol=1e-15)
    assert plane.normal.tolist() == [1, 0, 0]


def test_default_materials(world: World) -> None:
    table = {
        "iron": (7874, 0.24, 200),
        "copper": (8920, 0.33, 117),
        "granite": (2800, 0.25, 55),
        "oak": (800, 0.35, 11),
        "fir": (500, 0.34, 13),
    }
    assert [material.name for material in world.materials] == list(table)
    assert len(world.materials) == 5
    for id, (name, (density, poisson, young)) in enumerate(table.items()):
        material = world.materials[name]
        assert material is world.materials[id]
        assert (material.id, material.density) == (id, density)
        assert (material.poisson_ratio, material.young_modulus) == (poisson, young)
        assert material.stiffness == young
        assert material.restitution == 0.5
        assert (material.static_friction, material.dynamic_friction) == (0.1, 0.1)
        assert (material.damping_normal, material.damping_tangential) == (0, 0)


def test_user_ids_need_not_be_unique_and_system_ids_count(world: World) -> None:
    bodies = [world.create_sphere(7, (i, 0, 0), 1, "iron") for i in range(3)]
    assert [body.uid for body in bodies] == [7, 7, 7]
    sids = [body.sid for body in bodies]
    assert sids == sorted(set(sids))
    world.destroy(bodies[2])
    assert world.create_sphere(7, (0, 0, 0), 1, "iron").sid not in sids


def test_fixed_keeps_mass_and_applies_to_members(world: World) -> None:
    inner = world.create_union(
        1,
        [world.create_sphere(1, (0, 0, 0), 1, "iron"), world.create_sphere(1, (3, 0, 0), 1, "fir")],
    )
    outer = world.create_union(1, [inner, world.create_box(1, (0, 5, 0), (1, 1, 1), "oak")])
    mass, inertia = outer.mass, outer.inertia
    outer.fixed = True
    assert outer.mass == mass and np.array_equal(outer.inertia, inertia)
    assert outer.inverse_mass == 0 and not outer.inverse_inertia.any()
    assert all(member.fixed for member in (*outer.members, *inner.members))
    outer.fixed = False
    assert not inner.members[0].fixed
    assert outer.inverse_mass == 1 / mass
    assert np.allclose(outer.inverse_inertia @ inertia, np.eye(3), atol=1e-12)

"""Chapter 4, the data structures of pe and COLLADA compared."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.mapper.documents import SPHERE, body, collada, instance, model, scene, simple
from tests.thesis.listings import listing_3, listing_4, listing_5
from tests.thesis.worlds import document_of, element_texts, text_of

import colladaphy
from colladaphy.world import JointKind, Kind, World, compare


def test_4_1_each_body_is_one_rigid_body_and_one_instance_in_one_model() -> None:
    """4.1: a simple structure: one model, one rigid_body and one instance for each body."""
    world = World()
    for number in range(3):
        world.create_sphere(number, (number, 0, 0), 1.0, "iron")
    document = document_of(world)
    root = document.tree.getroot()
    assert len(list(root.iter("{*}physics_model"))) == 1
    assert len(list(root.iter("{*}rigid_body"))) == 3
    assert len(list(root.iter("{*}instance_rigid_body"))) == 3


def test_4_1_hierarchies_are_flattened() -> None:
    """4.1: hierarchies of models have no influence on the physics and are flattened."""
    inner = model(body("a"), id="inner")
    nested = f'<instance_physics_model url="#inner">{instance("a")}</instance_physics_model>'
    data = collada(inner + model(body("b"), nested), scene(instance("b")))
    assert len(colladaphy.read(data).load().bodies) == 2


def test_4_1_several_scenes_go_into_one_world() -> None:
    """4.1: pe has only one World, while several scenes can be instantiated."""
    scenes = scene(instance(), values="<gravity>0 0 -1</gravity>") + scene(
        instance(), id="t", values="<gravity>0 0 -2</gravity>"
    )
    document = colladaphy.read(collada(model(body()), scenes, effects=("s", "t")))
    world = document.load()
    assert len(world.bodies) == 2
    assert world.gravity.tolist() == [0.0, 0.0, -1.0]
    assert "physics-several-gravities" in [finding.code for finding in document.report]


def test_4_2_meshes_are_loaded() -> None:
    """4.2: pe had no mesh geometries; a World has."""
    world = World()
    world.create_mesh(
        1, (1, 2, 3), [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
        [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], "iron",
    )  # fmt: skip
    assert compare(world, document_of(world).load()) == []


def test_4_2_elliptical_and_hollow_shapes() -> None:
    """4.2: COLLADA allows elliptical shapes and hollow bodies; so does a World."""
    shape = (
        "<shape><hollow>true</hollow><mass>1</mass>"
        "<capsule><height>2</height><radius>1 1 3</radius></capsule></shape>"
    )
    found = colladaphy.read(simple(shape)).load().bodies[0]
    assert found.hollow
    assert sorted(found.radii.tolist()) == [1.0, 1.0, 3.0]


def plane_world() -> World:
    world = World()
    world.create_plane(9, (0.6, 0.0, 0.8), 0.1, "oak")
    world.bodies[0].position = (1.0, 2.0, -0.625)
    return world


def test_4_2_plane_of_the_custom_profile() -> None:
    """4.2, listing 3: the profile holds normal, anchor and displacement of a plane."""
    world = plane_world()
    text = text_of(world)
    for name in ("normal", "anchor", "displacement"):
        assert f"<pe:{name}>" in text
    again = document_of(world).load()
    assert compare(world, again) == []
    assert again.bodies[0].position.tolist() == [1.0, 2.0, -0.625]


def test_4_2_plane_for_everybody_else() -> None:
    """4.2: the common profile has Ax + By + Cz + D = 0, so that D is the negative displacement."""
    world = World()
    world.create_plane(9, (0.0, 0.0, 1.0), 2.5, "oak")
    (equation,) = element_texts(document_of(world), "plane/equation")
    assert [float(word) for word in equation.split()] == [0.0, 0.0, 1.0, -2.5]
    found = document_of(world, profile="none").load().bodies[0]
    assert found.displacement == 2.5


def test_4_2_the_thesis_own_spelling_of_planes_is_understood() -> None:
    """4.2, listing 3: without a namespace; the displacement is optional."""
    for data in (listing_3(), listing_3(displacement="")):
        found = colladaphy.read(data).load().bodies[0]
        assert found.kind is Kind.PLANE
        assert found.normal.tolist() == [0.0, 0.0, 1.0]
        assert found.displacement == 2.0
        assert found.position.tolist() == [5.0, 6.0, 2.0]


def test_4_2_the_profile_knows_which_side_is_inside() -> None:
    """4.2: the equation loses which side is solid, the profile's normal has it."""
    found = colladaphy.read(
        listing_3(normal="0 0 -1", displacement="<displacement>-2</displacement>")
    )
    plane = found.load().bodies[0]
    assert plane.normal.tolist() == [0.0, 0.0, -1.0]
    assert plane.displacement == -2.0


def test_4_2_an_edited_equation_beats_the_profile() -> None:
    """6.2.1: the profile of a plane can be older than its equation."""
    document = colladaphy.read(listing_3(equation="0 0 1 -7"))
    assert document.load().bodies[0].displacement == 7.0
    assert "profile-old-value" in [finding.code for finding in document.report]


def nested_world() -> World:
    world = World()
    one = world.create_sphere(1, (0, 0, 0), 1.0, "iron")
    two = world.create_box(2, (3, 0, 0), (1, 2, 3), "oak")
    two.rotate(0.1, 0.2, 0.3)
    inner = world.create_union(3, [one, two])
    inner.rotate(0.3, 0.0, 0.1)
    three = world.create_cylinder(4, (0, 4, 0), 0.5, 2.0, "fir")
    world.create_union(5, [inner, three])
    return world


def test_4_3_unions_are_shapes_of_one_rigid_body() -> None:
    """4.3: the hierarchy is flattened; all primitives stand directly under the rigid_body."""
    document = document_of(nested_world())
    assert len(list(document.tree.getroot().iter("{*}rigid_body"))) == 1
    shapes = element_texts(document, "technique_common/shape")
    assert len(shapes) == 3


def test_4_3_unions_in_unions_come_back() -> None:
    """4.3, listing 4: the custom profile groups the shapes in union elements, with user ids."""
    world = nested_world()
    document = document_of(world)
    assert text_of(world).count("<pe:union") == 2
    again = document.load()
    assert compare(world, again) == []
    outer = again.bodies[0]
    assert [member.uid for member in outer.members] == [3, 4]
    assert [member.uid for member in outer.members[0].members] == [1, 2]


def test_4_3_flattened_unions_are_as_faithful_as_can_be() -> None:
    """4.3: without the profile the same primitives are at the same places, with the same mass."""
    world = nested_world()
    flat = document_of(world, profile="none").load().bodies[0]
    whole = world.bodies[0]
    leaves = [*whole.members[0].members, whole.members[1]]
    assert flat.mass == pytest.approx(whole.mass)
    assert np.allclose(flat.position, whole.position)
    for member, leaf in zip(flat.members, leaves, strict=True):
        assert member.kind is leaf.kind
        assert np.allclose(member.position, leaf.position)
        assert abs(float(member.orientation @ leaf.orientation)) == pytest.approx(1.0)
    assert np.allclose(flat.inertia, whole.inertia)


def test_4_3_inertia_is_diagonal_in_its_mass_frame() -> None:
    """4.3: COLLADA's inertia is a diagonal in the mass frame; pe's tensor is full."""
    world = nested_world()
    document = document_of(world, profile="none")
    (moments,) = element_texts(document, "technique_common/inertia")
    expected = np.linalg.eigvalsh(world.bodies[0].inertia)
    assert np.allclose(sorted(map(float, moments.split())), expected)


def test_4_3_a_single_shape_is_no_union() -> None:
    """4.3: with only one shape it is unnecessary to wrap the body in a union."""
    assert colladaphy.read(simple()).load().bodies[0].kind is Kind.SPHERE


def test_4_3_the_thesis_own_spelling_of_unions_is_understood() -> None:
    """4.3, listing 4: unions can be translated and rotated as a whole, and have a user id."""
    outer = colladaphy.read(listing_4()).load().bodies[0]
    assert outer.uid == 7
    assert [member.kind for member in outer.members] == [Kind.BOX, Kind.UNION]
    inner = outer.members[1]
    assert inner.uid == 8
    places = [member.position[0] for member in (outer.members[0], *inner.members)]
    assert places == pytest.approx([0.0, 10.0, 16.0])
    assert outer.mass == 6.0
    assert outer.position[0] == pytest.approx(26.0 / 3.0)


def test_4_4_user_ids_are_in_the_profile() -> None:
    """4.3: the user ids of all bodies are part of the custom scheme."""
    world = World()
    world.create_sphere(12345, (0, 0, 0), 1.0, "iron")
    assert 'uid="12345"' in text_of(world)
    assert document_of(world).load().bodies[0].uid == 12345


def test_4_4_materials_have_their_extra_values() -> None:
    """4.4, listing 5: the values that COLLADA does not know are in an extra element."""
    world = World()
    world.create_material(
        "Mustard", density=1.2, restitution=0.4, static_friction=0.5, dynamic_friction=0.1,
        poisson_ratio=0.2, young_modulus=1, stiffness=8, damping_normal=0, damping_tangential=0,
    )  # fmt: skip
    world.create_sphere(1, (0, 0, 0), 1.0, "Mustard")
    document = document_of(world)
    assert element_texts(document, "physics_material/technique_common/restitution") == ["0.4"]
    for name in ("density", "poisson_ratio", "young_modulus", "stiffness", "damping_normal",
                 "damping_tangential"):  # fmt: skip
        path = f"physics_material/extra/technique/material/{name}"
        assert len(element_texts(document, path)) == 1
    assert compare(world, document.load()) == []


def test_4_4_the_thesis_own_spelling_of_materials_is_understood() -> None:
    """4.4, listing 5."""
    found = colladaphy.read(listing_5()).load().bodies[0]
    material = found.material
    assert material is not None
    assert material.name == "Mustard"
    assert (material.density, material.poisson_ratio, material.stiffness) == (1.2, 0.2, 8.0)
    assert (material.dynamic_friction, material.restitution) == (0.1, 0.4)
    assert found.mass == pytest.approx(1.2 * 4 / 3 * math.pi)


def test_4_4_names_are_made_unique_by_a_number() -> None:
    """4.4: local materials are extended in scope; their names get a numerical index."""
    shapes = "".join(
        '<shape><mass>1</mass><physics_material name="clay"><technique_common>'
        f"<restitution>{value}</restitution></technique_common></physics_material>{SPHERE}</shape>"
        for value in (0.1, 0.2)
    )
    world = colladaphy.read(simple(shapes)).load()
    assert {"clay", "clay_1"} <= {material.name for material in world.materials}


def test_4_4_the_same_material_in_several_densities() -> None:
    """4.4: bodies of one material with varying densities need duplicates of it."""
    material = '<physics_material id="x" name="x"><technique_common/></physics_material>'
    use = '<instance_physics_material url="#x"/>'
    shapes = "".join(
        f"<shape><density>{density}</density>{use}{SPHERE}</shape>" for density in (1, 2, 2, 3)
    )
    world = colladaphy.read(simple(shapes, materials=material)).load()
    densities = [m.material.density for m in world.bodies[0].members if m.material]
    assert densities == [1.0, 2.0, 2.0, 3.0]
    assert len(world.materials) == 5 + 3


def test_4_4_a_body_without_material_has_standard_values() -> None:
    """4.4: the only remedy is to use standard values; the report says so."""
    document = colladaphy.read(simple())
    material = document.load().bodies[0].material
    assert material is not None
    assert "load-material-assumed" in [finding.code for finding in document.report]


def test_4_5_a_fixed_joint_has_limits_of_zero() -> None:
    """4.5: the fixed joint corresponds to all-zero limits."""
    world = World()
    one, two = (world.create_sphere(n, (3 * n, 0, 0), 1.0, "iron") for n in range(2))
    world.attach_fixed_joint(one, two)
    again = document_of(world, profile="none").load()
    assert again.joints[0].kind is JointKind.FIXED
    assert not np.any(again.joints[0].linear_max)
    assert not np.any(again.joints[0].angular_max)


def test_4_5_any_constraint_is_a_joint() -> None:
    """4.5: limits and springs emulate any of pe's joints, and others."""
    world = World()
    one, two = (world.create_sphere(n, (3 * n, 0, 0), 1.0, "iron") for n in range(2))
    world.attach_joint(
        one, two, linear_min=(-1, -2, -3), linear_max=(1, 2, 3), angular_min=(-0.1, 0, 0),
        angular_max=(0.1, 0, 0), linear_spring=(1.0, 2.0, 3.0), interpenetrate=True, enabled=False,
    )  # fmt: skip
    assert compare(world, document_of(world).load()) == []

"""Chapter 5, the implementation: reading, writing, materials, what is logged."""

from __future__ import annotations

import logging

import numpy as np
import pytest
from tests.mapper.documents import SPHERE, body, collada, instance, model, scene, simple
from tests.thesis.worlds import document_of, element_texts, text_of

import colladaphy
from colladaphy.conform import conform
from colladaphy.world import Kind, World, compare


def test_5_2_scenes_and_models_are_what_the_user_sees() -> None:
    """5.2: a handler lists scenes, a scene its models."""
    data = collada(model(body()), scene(instance()))
    document = colladaphy.read(data)
    (found,) = document.scenes
    assert found.id == "s"
    (inner,) = found.models
    assert inner.id == "m"


def test_5_3_single_scenes_and_models_can_be_loaded() -> None:
    """5.3: the user selects scenes, and models of a scene."""
    instances = "".join(
        f'<instance_physics_model url="#m{k}">{instance()}</instance_physics_model>'
        for k in range(2)
    )
    data = collada(model(body(), id="m0") + model(body(), id="m1"), scene(instances))
    document = colladaphy.read(data)
    assert len(document.scenes["s"].load().bodies) == 2
    assert len(document.scenes["s"].models["m1"].load().bodies) == 1


def test_5_3_subordinate_models_are_loaded_as_well() -> None:
    """5.3: the method calls itself recursively."""
    data = collada(
        model(body(), id="a")
        + model(f'<instance_physics_model url="#a">{instance()}</instance_physics_model>', id="b")
        + model('<instance_physics_model url="#b"/>', id="c"),
        scene("", url="#c"),
    )
    assert len(colladaphy.read(data).load().bodies) == 1


def test_5_3_a_foreign_geometry_is_reported_and_the_rest_loaded() -> None:
    """5.3: if the geometry is foreign, a message is logged and the next body is read."""
    spline = (
        '<geometry id="g"><spline><source id="x"><float_array id="y" count="0"/></source>'
        '<control_vertices><input semantic="POSITION" source="#x"/></control_vertices></spline>'
        "</geometry>"
    )
    shape = '<shape><mass>1</mass><instance_geometry url="#g"/></shape>'
    data = collada(
        model(body("a", shape), body("b")), scene(instance("a"), instance("b")), geometries=spline
    )
    document = colladaphy.read(data)
    assert [each.kind for each in document.load().bodies] == [Kind.SPHERE]
    assert "load-no-geometry" in [finding.code for finding in document.report]


def test_5_3_mass_and_material_of_compounds_are_redistributed() -> None:
    """5.3: in compound bodies some values are balanced between the body and its components."""
    shapes = f"<shape><mass>1</mass>{SPHERE}</shape><shape><mass>2</mass>{SPHERE}</shape>"
    material = '<physics_material id="x" name="x"><technique_common/></physics_material>'
    moves = '<mass>6</mass><instance_physics_material url="#x"/>'
    union = colladaphy.read(simple(shapes, moves=moves, materials=material)).load().bodies[0]
    assert [member.mass for member in union.members] == [2.0, 4.0]
    assert {member.material.name for member in union.members if member.material} == {"x"}


def two_bodies() -> World:
    world = World(gravity=(0, 0, -9.81))
    sphere = world.create_sphere(1, (1, 2, 3), 0.5, "iron")
    sphere.linear_velocity = (0, -0.4, 0)
    sphere.angular_velocity = (np.pi, 0, 0)
    sphere.rotate(0, 0, np.pi / 2)
    world.create_box(2, (4, 5, 6), (2, 2, 2), "oak", fixed=True)
    return world


def test_5_4_rigid_bodies_are_numbered_by_their_system_ids() -> None:
    """5.4: the sid is numbered by the system id; its instance refers to it."""
    world = two_bodies()
    world.create_sphere(3, (0, 0, 0), 1.0, "iron", sid=77)
    root = document_of(world).tree.getroot()
    sids = [element.get("sid") for element in root.iter("{*}rigid_body")]
    assert sids == ["Body1", "Body2", "Body77"]
    assert [element.get("body") for element in root.iter("{*}instance_rigid_body")] == sids


def test_5_4_shapes_state_mass_and_material() -> None:
    """5.4: each shape has its geometry, its mass, and a reference to the material."""
    document = document_of(two_bodies())
    assert len(element_texts(document, "shape/mass")) == 2
    assert len(element_texts(document, "shape/instance_physics_material")) == 2
    assert element_texts(document, "rigid_body/technique_common/mass") == []


def test_5_4_or_their_density() -> None:
    """5.4: either its mass or its density, dependent on configuration."""
    document = document_of(two_bodies(), shape_weight="density")
    assert element_texts(document, "shape/mass") == []
    densities = [float(text) for text in element_texts(document, "shape/density")]
    assert densities == pytest.approx([7874.0, 800.0])
    assert compare(two_bodies(), document.load()) == []


def test_5_4_dynamic_is_always_there() -> None:
    """5.4: we create a dynamic element."""
    document = document_of(two_bodies())
    assert element_texts(document, "rigid_body/technique_common/dynamic") == ["true", "false"]


def test_5_4_redundant_data_on_request() -> None:
    """5.4: we may choose to repeat some information on the level of the body."""
    document = document_of(two_bodies(), redundant=True)
    assert len(element_texts(document, "rigid_body/technique_common/mass")) == 2
    assert compare(two_bodies(), document.load()) == []


def test_5_4_velocity_in_the_instance() -> None:
    """5.4: the velocity is specified in the instance; angular velocity in degrees a second."""
    document = document_of(two_bodies())
    (velocity,) = element_texts(document, "instance_rigid_body/technique_common/velocity")
    assert [float(word) for word in velocity.split()] == [0.0, -0.4, 0.0]
    (turning,) = element_texts(document, "instance_rigid_body/technique_common/angular_velocity")
    assert [float(word) for word in turning.split()] == pytest.approx([180.0, 0.0, 0.0])


def test_5_4_position_and_orientation_in_the_node() -> None:
    """5.4: a node, referred to by the instance, has position and orientation."""
    root = document_of(two_bodies()).tree.getroot()
    node = next(root.iter("{*}node"))
    instanced = next(root.iter("{*}instance_rigid_body"))
    assert instanced.get("target") == f"#{node.get('id')}"
    translate, rotate = node
    assert translate.text == "1 2 3"
    assert [float(word) for word in (rotate.text or "").split()] == pytest.approx([0, 0, 1, 90])


def test_5_4_shapes_of_unions_are_relative_to_the_centre_of_mass() -> None:
    """5.4: shapes include translation and rotation relative to the body's centre of mass."""
    world = World()
    members = [world.create_sphere(n, (4.0 * n, 0, 0), 1.0, "iron") for n in range(2)]
    world.create_union(5, members)
    document = document_of(world)
    assert element_texts(document, "shape/translate") == ["-2 0 0", "2 0 0"]
    assert element_texts(document, "node/translate") == ["2 0 0"]


def test_5_4_only_materials_in_use_are_stored() -> None:
    """5.4: only the materials which are actually used are stored; the id is the material's."""
    root = document_of(two_bodies()).tree.getroot()
    found = [(each.get("id"), each.get("name")) for each in root.iter("{*}physics_material")]
    assert found == [("Material0", "iron"), ("Material3", "oak")]
    root = document_of(two_bodies(), materials="all").tree.getroot()
    assert len(list(root.iter("{*}physics_material"))) == 5


def test_5_4_primitives_as_meshes_on_request() -> None:
    """5.4, 6.2.2: for readers without primitives; the profile keeps what they are."""
    world = two_bodies()
    document = document_of(world, tessellate=True)
    assert len(element_texts(document, "shape/instance_geometry")) == 2
    assert compare(world, document.load()) == []
    seen = document.load(prefer="common")
    assert [each.kind for each in seen.bodies] == [Kind.MESH, Kind.MESH]
    assert seen.bodies[1].mesh.volume == pytest.approx(8.0)


def test_5_4_bodies_in_models_that_the_user_chooses() -> None:
    """4.1, 5.4: a structure of models requires control by the user."""
    world = two_bodies()
    world.attach_fixed_joint(*world.bodies)
    document = document_of(world, group=lambda each: each.kind.name)
    root = document.tree.getroot()
    names = [element.get("name") for element in root.iter("{*}physics_model")]
    assert names == ["SPHERE", "BOX"]
    assert compare(world, document.load()) == []


def test_5_4_output_is_deterministic() -> None:
    """5.4: equal Worlds give equal files."""
    assert text_of(two_bodies()) == text_of(two_bodies())


def test_5_5_references_are_not_searched_for() -> None:
    """5.5: ids that stand in libraries are found without an index of the whole document."""
    document = colladaphy.read(simple())
    resource = document.scenes[0].root
    assert len(document.load().bodies) == 1
    assert "ids" not in vars(resource)
    assert {"m", "n"} <= resource.ids.keys() and "nowhere" not in resource.ids


def test_5_5_materials_are_deduplicated_by_value() -> None:
    """5.5: comparing the values to the existing ones allows to reuse materials."""
    count = 30
    materials = "".join(
        f'<physics_material id="x{n}" name="x{n}"><technique_common/></physics_material>'
        for n in range(count)
    )
    bodies = "".join(
        body(
            f"b{n}",
            f"<shape><density>{1 + n % 2}</density>"
            f'<instance_physics_material url="#x{n}"/>{SPHERE}</shape>',
        )
        for n in range(count)
    )
    data = collada(
        model(bodies), scene(*(instance(f"b{n}") for n in range(count))), materials=materials
    )
    world = colladaphy.read(data).load()
    assert len(world.bodies) == count
    assert len(world.materials) == 5 + 2


def test_5_5_distinct_materials_stay_distinct() -> None:
    """5.5: subsuming data-distinct materials is not a decision the import can make."""
    world = World()
    for name in ("a", "b"):
        world.create_material(
            name, density=1, restitution=0.4, static_friction=0.5, dynamic_friction=0.1,
            poisson_ratio=0.2, young_modulus=1, stiffness=8, damping_normal=0,
            damping_tangential=0,
        )  # fmt: skip
        world.create_sphere(1, (0, 0, 0), 1.0, name)
    assert [each.material.name for each in document_of(world).load().bodies] == ["a", "b"]


def test_5_6_bullets_ways_are_understood_at_the_door() -> None:
    """5.6: Bullet's sids, plane equation and limits; a compatibility mode makes them ours."""
    plane = "<shape><plane><equation>0 0 1 2</equation></plane></shape>"
    data = simple(plane)
    ours = colladaphy.read(data).load().bodies[0]
    assert ours.displacement == -2.0
    document = colladaphy.read(data, repair=True, convention="bullet")
    assert document.load().bodies[0].displacement == 2.0
    assert callable(conform)


def test_important_steps_are_logged(caplog: pytest.LogCaptureFixture) -> None:
    """6: content of the logfile, which contains entries from important steps."""
    with caplog.at_level(logging.INFO, logger="colladaphy"):
        document_of(two_bodies()).load()
    text = caplog.text
    assert "stored 2 bodies" in text
    assert "loaded 2 bodies" in text

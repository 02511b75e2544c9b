"""Chapter 3, the COLLADA standard: addressing, techniques, precedence, the example."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.mapper.documents import SPHERE, body, collada, instance, model, scene, simple
from tests.thesis.listings import LISTING_2

import colladaphy
from colladaphy.links.addresses import split_reference
from colladaphy.world import Kind, World


@pytest.mark.parametrize(
    ("reference", "parts"),
    [
        ("#id", ("", "id", [])),
        ("file.dae#id", ("file.dae", "id", [])),
        ("id/one/two", ("", "id", ["one", "two"])),
        ("./one", ("", ".", ["one"])),
        ("sub%20folder/file.dae#a", ("sub folder/file.dae", "a", [])),
        ("file.dae#id/one", ("file.dae", "id", ["one"])),
    ],
)
def test_3_1_two_ways_of_addressing(reference: str, parts: tuple[str, str, list[str]]) -> None:
    """3.1: URI addressing with a hash sign, SID addressing by a path from an id or a dot."""
    assert split_reference(reference) == parts


def test_3_1_instances_stand_for_what_they_refer_to() -> None:
    """3.1: an instance element references a definition, and allows to transform it."""
    nodes = '<node id="n"/><node id="k"><translate>1 2 3</translate></node>'
    data = collada(model(body()), scene(instance(), instance(target="#k")), nodes)
    world = colladaphy.read(data).load()
    assert [each.position.tolist() for each in world.bodies] == [[0, 0, 0], [1, 2, 3]]


def test_3_2_the_common_technique_is_the_fallback() -> None:
    """3.2: where a technique is unusable, technique_common provides the data."""
    other = '<technique profile="other"><mass>9</mass></technique>'
    assert colladaphy.read(simple(after=other)).load().bodies[0].mass == 1.0


def test_3_2_extras_are_kept() -> None:
    """3.2: extra elements allow for any data to be stored."""
    kept = '<extra><technique profile="x"><anything a="b">text</anything></technique></extra>'
    document = colladaphy.read(simple(after=kept))
    assert document.tree.getroot().find(".//{*}anything") is not None


def test_3_3_only_instantiated_scenes_are_in_effect() -> None:
    """3.3: a scene must be instantiated in the global scene element to be in effect."""
    data = collada(model(body()), scene(instance()) + scene(instance(), id="t"), effects=("t",))
    document = colladaphy.read(data)
    assert [each.is_instantiated for each in document.scenes] == [False, True]
    assert len(document.load().bodies) == 1


def test_3_3_gravity_and_time_step() -> None:
    """3.3: scenes feature a gravity property and a time step."""
    values = "<gravity>1 2 3</gravity><time_step>0.01</time_step>"
    world = colladaphy.read(collada(model(body()), scene(instance(), values=values))).load()
    assert world.gravity.tolist() == [1.0, 2.0, 3.0]
    assert world.time_step == 0.01


def test_3_3_several_shapes_form_a_compound() -> None:
    """3.3: if a rigid_body has several shape elements, they form a compound shape."""
    shape = f"<shape><mass>1</mass>{SPHERE}</shape>"
    assert colladaphy.read(simple(shape * 2)).load().bodies[0].kind is Kind.UNION
    assert colladaphy.read(simple(shape)).load().bodies[0].kind is Kind.SPHERE


def test_3_3_instance_over_body_over_shape() -> None:
    """3.3: instance data takes precedence over the body's, that over the shape's."""
    shape = f"<shape><mass>1</mass>{SPHERE}</shape>"
    body_mass, instance_mass = "<mass>2</mass>", "<mass>3</mass>"
    masses = [
        colladaphy.read(simple(shape, values=values, moves=moves)).load().bodies[0].mass
        for values, moves in (("", ""), (body_mass, ""), (body_mass, instance_mass))
    ]
    assert masses == [1.0, 2.0, 3.0]


def test_3_3_bodies_observe_the_coordinate_system_of_their_node() -> None:
    """3.3: the coordinates of the body are given in the node's coordinate system."""
    node = '<node id="n"><rotate>0 0 1 90</rotate><translate>1 0 0</translate></node>'
    shape = f"<shape><mass>1</mass>{SPHERE}<translate>1 0 0</translate></shape>"
    found = colladaphy.read(simple(shape, nodes=node)).load().bodies[0]
    assert np.allclose(found.position, [0.0, 2.0, 0.0])


def test_3_3_and_so_do_whole_models() -> None:
    """3.3: optionally, this can also be done for entire instances of models."""
    nodes = '<node id="n"/><node id="p"><translate>0 0 7</translate></node>'
    instanced = (
        f'<instance_physics_model url="#m" parent="#p">{instance()}</instance_physics_model>'
    )
    world = colladaphy.read(collada(model(body()), scene(instanced), nodes)).load()
    assert world.bodies[0].position.tolist() == [0.0, 0.0, 7.0]


def test_3_3_materials_in_place_or_in_the_library() -> None:
    """3.3: a physics_material stands in the body or shape, or in the library."""
    common = "<technique_common><restitution>0.5</restitution></technique_common>"
    in_place = simple(values=f"<physics_material>{common}</physics_material>")
    library = simple(
        values='<instance_physics_material url="#x"/>',
        materials=f'<physics_material id="x">{common}</physics_material>',
    )
    for data in (in_place, library):
        material = colladaphy.read(data).load().bodies[0].material
        assert material is not None
        assert material.restitution == 0.5


def test_3_3_constraint_on_a_body_instanced_twice_is_refused() -> None:
    """3.3: which of several instances is meant is problematic to determine; we refuse."""
    element = (
        '<rigid_constraint sid="c"><ref_attachment rigid_body="./a"/>'
        '<attachment rigid_body="./b"/><technique_common/></rigid_constraint>'
    )
    started = '<instance_rigid_constraint constraint="c"/>'
    data = collada(
        model(body("a"), body("b"), element),
        scene(instance("a"), instance("a"), instance("b"), started),
    )
    with pytest.raises(colladaphy.DocumentError) as caught:
        colladaphy.read(data).load()
    assert caught.value.findings[0].code == "link-body-twice"


def load_listing_2() -> tuple[World, colladaphy.Document]:
    document = colladaphy.read(LISTING_2, repair=True)
    return document.load(), document


def test_3_4_the_listing_is_not_valid_and_is_understood() -> None:
    """3.4: paths in @body, attachment first, mass after the shape, a sphere of three radii."""
    with pytest.raises(colladaphy.SchemaError):
        colladaphy.read(LISTING_2)
    world, document = load_listing_2()
    assert len(world.bodies) == 2
    assert len(world.joints) == 1
    assert document.report.valid


def test_3_4_what_the_text_says_of_the_listing() -> None:
    """3.4: sizes, the node's place, precedence of masses, gravity, limits."""
    world, _ = load_listing_2()
    box, ellipsoid = world.bodies
    assert box.lengths.tolist() == [4.0, 4.0, 2.8]
    assert box.position.tolist() == [0.0, 10.5, 0.0]
    assert box.mass == 3.0
    assert box.angular_velocity[1] == pytest.approx(math.radians(0.238))
    assert not box.fixed
    assert ellipsoid.fixed
    assert ellipsoid.mass == 1.0
    assert ellipsoid.kind is Kind.ELLIPSOID
    assert ellipsoid.radii.tolist() == [2.0, 2.0, 3.0]
    assert np.allclose(ellipsoid.inertia, np.diag((2.6, 2.6, 1.6)), rtol=1e-15)
    assert ellipsoid.position.tolist() == [0.0, 0.0, 0.0]
    assert world.gravity.tolist() == [0.0, -9.81, 0.0]
    assert box.material is ellipsoid.material
    assert box.material is not None
    assert (box.material.dynamic_friction, box.material.restitution) == (0.7, 1.0)
    joint = world.joints[0]
    assert joint.body1 == ellipsoid
    assert joint.body2 == box
    assert joint.linear_min.tolist() == [-20.0] * 3
    assert joint.linear_max.tolist() == [20.0] * 3
    assert not joint.interpenetrate

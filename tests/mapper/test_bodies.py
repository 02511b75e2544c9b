"""Precedence, defaults, masses, frames and hollow shapes of rigid bodies (thesis 3.3, 4.3)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.mapper.documents import SPHERE, body, collada, instance, model, scene, simple

import colladaphy
from colladaphy.world import Body, Kind

MATERIALS = "".join(
    f'<physics_material id="{name}"><technique_common><dynamic_friction>{value}'
    "</dynamic_friction></technique_common></physics_material>"
    for name, value in (("one", 0.1), ("two", 0.2), ("three", 0.3))
)


def only(data: bytes) -> Body:
    world = colladaphy.read(data).load()
    assert len(world.bodies) == 1
    return world.bodies[0]


def use(name: str) -> str:
    return f'<instance_physics_material url="#{name}"/>'


def test_instance_beats_body_beats_shape() -> None:
    shape = f"<shape><mass>1</mass>{use('one')}{SPHERE}</shape>"
    in_shape = simple(shape, materials=MATERIALS)
    in_body = simple(shape, values=f"<mass>2</mass>{use('two')}", materials=MATERIALS)
    everywhere = simple(
        shape,
        values=f"<dynamic>true</dynamic><mass>2</mass>{use('two')}",
        moves=f"<dynamic>false</dynamic><mass>3</mass><inertia>4 5 6</inertia>{use('three')}",
        materials=MATERIALS,
    )
    found = [only(data) for data in (in_shape, in_body, everywhere)]
    assert [each.mass for each in found] == [1.0, 2.0, 3.0]
    materials = [each.material for each in found]
    assert [m.dynamic_friction for m in materials if m] == [0.1, 0.2, 0.3]
    assert [each.fixed for each in found] == [False, False, True]
    assert np.array_equal(found[2].inertia, np.diag([4.0, 5.0, 6.0]))
    assert np.allclose(found[1].inertia, np.eye(3) * 0.8)


def test_instance_shapes_replace_those_of_the_body() -> None:
    box = "<shape><mass>2</mass><box><half_extents>1 2 3</half_extents></box></shape>"
    found = only(simple(moves=box))
    assert found.kind is Kind.BOX
    assert found.mass == 2.0


def test_defaults() -> None:
    found = only(simple(f"<shape>{SPHERE}</shape>", moves="<velocity/>"))
    assert not found.fixed
    assert found.mass == pytest.approx(4 / 3 * math.pi)  # density one
    assert found.linear_velocity.tolist() == [0.0, 0.0, 0.0]
    assert found.uid == 0
    assert found.sid == 1


def test_defaults_are_reported() -> None:
    document = colladaphy.read(simple(f"<shape>{SPHERE}</shape>"))
    document.load()
    codes = [finding.code for finding in document.report]
    assert sorted(codes) == ["load-density-assumed", "load-material-assumed"]
    assert all(finding.path and finding.line for finding in document.report)


def test_density_makes_mass() -> None:
    found = only(simple(f"<shape><density>2</density>{SPHERE}</shape>"))
    assert found.mass == pytest.approx(8 / 3 * math.pi)
    assert found.material is not None
    assert found.material.density == 2.0


def test_mass_beats_density() -> None:
    found = only(simple(f"<shape><mass>5</mass><density>2</density>{SPHERE}</shape>"))
    assert found.mass == 5.0


def test_mass_of_a_compound_is_shared_by_its_shapes() -> None:
    shapes = (
        f"<shape><mass>1</mass>{SPHERE}</shape>"
        f"<shape><mass>3</mass>{SPHERE}<translate>4 0 0</translate></shape>"
    )
    found = only(simple(shapes, moves="<mass>8</mass>"))
    assert found.kind is Kind.UNION
    assert found.mass == 8.0
    assert [member.mass for member in found.members] == [2.0, 6.0]
    assert found.position.tolist() == [3.0, 0.0, 0.0]
    assert [member.position[0] for member in found.members] == [0.0, 4.0]


def test_compound_without_masses_is_shared_by_volume() -> None:
    shapes = (
        f"<shape>{SPHERE}</shape>"
        "<shape><sphere><radius>2</radius></sphere><translate>9 0 0</translate></shape>"
    )
    found = only(simple(shapes, values="<mass>18</mass>"))
    assert [member.mass for member in found.members] == pytest.approx([2.0, 16.0])
    assert found.position[0] == pytest.approx(8.0)


def test_mass_frame_moves_the_centre_of_mass() -> None:
    values = (
        "<mass>2</mass><mass_frame><translate>1 0 0</translate><rotate>0 0 1 90</rotate>"
        "</mass_frame><inertia>1 2 3</inertia>"
    )
    node = '<node id="n"><translate>0 0 5</translate><rotate>0 1 0 90</rotate></node>'
    found = only(simple(values=values, nodes=node))
    assert found.kind is Kind.UNION  # the sphere's own centre is somewhere else
    assert np.allclose(found.position, [0.0, 0.0, 4.0])
    assert np.allclose(found.members[0].position, [0.0, 0.0, 5.0])
    assert np.allclose(found.inertia, np.diag([2.0, 1.0, 3.0]))


def test_inertia_is_turned_into_the_frame_of_the_shape() -> None:
    shapes = (
        "<shape><mass>1</mass><cylinder><height>2</height><radius>1 1</radius></cylinder></shape>"
    )
    found = only(simple(shapes, values="<inertia>1 2 3</inertia>"))
    # The World's cylinder lies along x, COLLADA's along y.
    assert np.allclose(found.inertia, np.diag([2.0, 1.0, 3.0]))
    assert np.allclose(colladaphy.world.rotations.rotate(found.orientation, (1, 0, 0)), (0, 1, 0))


def test_hollow_shape_has_its_mass_on_the_surface() -> None:
    found = only(simple(f"<shape><hollow>true</hollow><mass>3</mass>{SPHERE}</shape>"))
    assert found.hollow
    assert np.allclose(found.inertia, np.eye(3) * 2.0)  # 2/3 m r²


def test_elliptic_shapes() -> None:
    capsule = "<capsule><height>4</height><radius>1 2 3</radius></capsule>"
    found = only(simple(f"<shape><mass>1</mass>{capsule}<rotate>0 0 1 -90</rotate></shape>"))
    assert found.kind is Kind.CAPSULE
    assert found.radii.tolist() == [2.0, 1.0, 3.0]  # along the axis, then across
    assert found.length == 4.0
    assert found.orientation.tolist() == [1.0, 0.0, 0.0, 0.0]
    cylinder = "<cylinder><height>4</height><radius>1 2</radius></cylinder>"
    found = only(simple(f"<shape><mass>1</mass>{cylinder}<rotate>0 0 1 -90</rotate></shape>"))
    assert found.radii.tolist() == [1.0, 2.0]
    flat = "<capsule><height>0</height><radius>1 2 3</radius></capsule>"
    found = only(simple(f"<shape><mass>1</mass>{flat}</shape>"))
    assert found.kind is Kind.ELLIPSOID
    assert found.radii.tolist() == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    "geometry",
    [
        "<sphere><radius>0</radius></sphere>",
        "<box><half_extents>1 0 1</half_extents></box>",
        "<box><half_extents>1 -1 1</half_extents></box>",
        "<capsule><height>1</height><radius>0 0 0</radius></capsule>",
        "<cylinder><height>0</height><radius>1 1</radius></cylinder>",
        "<sphere><radius>INF</radius></sphere>",
        "<sphere><radius>NaN</radius></sphere>",
        "<plane><equation>0 0 0 1</equation></plane>",
    ],
)
def test_bodies_without_volume_are_skipped_and_reported(geometry: str) -> None:
    document = colladaphy.read(simple(f"<shape>{geometry}</shape>"))
    assert len(document.load().bodies) == 0
    assert [finding.code for finding in document.report] == [
        "load-empty-shape", "load-body-skipped",
    ]  # fmt: skip


def test_impossible_values_skip_only_their_body() -> None:
    bodies = [body(name, values=f"<mass>{mass}</mass>") for name, mass in (("a", -1), ("b", 2))]
    data = collada(model(*bodies), scene(instance("a"), instance("b")))
    document = colladaphy.read(data)
    world = document.load()
    assert [each.mass for each in world.bodies] == [2.0]
    assert "load-bad-value" in [finding.code for finding in document.report]


def test_plane_stands_where_its_node_puts_it() -> None:
    plane = "<plane><equation>0 0 2 -4</equation></plane>"  # z = 2
    node = '<node id="n"><translate>0 0 1</translate><rotate>1 0 0 90</rotate></node>'
    found = only(simple(f"<shape>{plane}</shape>", nodes=node))
    assert found.fixed
    assert found.mass == 0.0
    assert np.allclose(found.normal, [0.0, -1.0, 0.0])
    assert found.displacement == pytest.approx(2.0)


def test_angular_velocity_is_in_degrees() -> None:
    found = only(simple(moves="<angular_velocity>0 180 0</angular_velocity>"))
    assert found.angular_velocity.tolist() == [0.0, math.pi, 0.0]


def test_local_materials_get_names_of_their_own() -> None:
    shapes = "".join(
        f'<shape><mass>1</mass><physics_material name="m"><technique_common><restitution>0.{n}'
        f"</restitution></technique_common></physics_material>{SPHERE}</shape>"
        for n in (1, 2, 3, 2)
    )
    world = colladaphy.read(simple(shapes)).load()
    names = [member.material.name for member in world.bodies[0].members if member.material]
    assert names == ["m", "m_1", "m_2", "m_1"]


def test_many_materials_of_the_same_value_are_one() -> None:
    materials = "".join(
        f'<physics_material id="m{n}"><technique_common><restitution>0.5</restitution>'
        "</technique_common></physics_material>"
        for n in range(20)
    )
    bodies = [
        body(f"b{n}", f"<shape><mass>1</mass>{use(f'm{n}')}{SPHERE}</shape>") for n in range(20)
    ]
    data = collada(
        model(*bodies), scene(*(instance(f"b{n}") for n in range(20))), materials=materials
    )
    assert len(colladaphy.read(data).load().materials) == 6


def test_values_out_of_range_are_moved_into_it() -> None:
    material = (
        '<physics_material id="bad"><technique_common><dynamic_friction>-1</dynamic_friction>'
        "<restitution>7</restitution></technique_common></physics_material>"
    )
    document = colladaphy.read(simple(values=use("bad"), materials=material))
    found = document.load().bodies[0].material
    assert found is not None
    assert (found.dynamic_friction, found.restitution) == (0.0, 1.0)
    assert [f.code for f in document.report] == ["physics-material-range"] * 2


def test_an_impossible_member_skips_only_its_union() -> None:
    good = f"<shape><mass>1</mass>{SPHERE}</shape>"
    bad = f"<shape><mass>-1</mass>{SPHERE}</shape>"
    bodies = [body("a", good + bad), body("b", good + good)]
    document = colladaphy.read(collada(model(*bodies), scene(instance("a"), instance("b"))))
    world = document.load()
    assert [each.mass for each in world.bodies] == [2.0]
    assert len(world.member_columns.sids) == 2
    assert "load-bad-value" in [finding.code for finding in document.report]

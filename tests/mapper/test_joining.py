"""Loading into a World that has bodies already (thesis 5.3, 6.1), and changing units and axes."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy
from colladaphy.mapper.loading.creation import free_ids
from colladaphy.world import World, compare, rotations


def document_of(world: World) -> colladaphy.Document:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return colladaphy.read(stream.getvalue())


def three() -> World:
    world = World(gravity=(0, 0, -9.81))
    soft = world.create_material(
        "soft", density=1.2, restitution=0.4, static_friction=0.5, dynamic_friction=0.1,
        poisson_ratio=0.2, young_modulus=1, stiffness=8, damping_normal=0, damping_tangential=0,
    )  # fmt: skip
    one = world.create_sphere(1, (0, 0, 1), 1.0, soft, sid=3)
    two = world.create_sphere(2, (0, 0, 4), 1.0, world.materials["iron"], sid=5, name="two")
    world.create_union(3, [world.create_box(4, (5, 5, 5), (1, 1, 1), soft, sid=7)], sid=9)
    world.attach_fixed_joint(one, two)
    world.set_pair(soft, "iron", restitution=0.125)
    return world


def test_into_an_empty_world_keeps_everything_but_the_scene() -> None:
    world = World(gravity=(0, 0, -9.81))
    assert compare(three(), document_of(three()).load(world)) == []


def test_system_ids_are_kept_where_they_are_free() -> None:
    world = World(gravity=(1, 2, 3))
    world.create_sphere(0, (0, 0, 0), 1.0, "iron", sid=4)
    document = document_of(three())
    assert document.load(world) is world
    assert [each.sid for each in world.bodies] == [3, 4, 5, 9]
    assert world.gravity.tolist() == [1.0, 2.0, 3.0]
    assert [finding.code for finding in document.report] == []


def test_the_order_of_system_ids_is_always_kept() -> None:
    world = three()
    document = document_of(three())
    document.load(world)
    assert len(world.bodies) == 6
    loaded = [each for each in world.bodies if each.uid in (1, 2) and each.sid not in (3, 5)]
    assert [each.uid for each in loaded] == [1, 2]
    assert len(world.joints) == 2
    second = world.joints[1]
    assert second.body1 in loaded
    assert second.body2 in loaded
    assert world.materials["soft"].id == 5
    assert len(world.materials) == 6
    codes = {finding.code for finding in document.report}
    assert codes == {"load-system-id-taken"}


def test_a_material_of_the_same_name_gets_a_number() -> None:
    world = World()
    names = (
        "density", "restitution", "static_friction", "dynamic_friction", "poisson_ratio",
        "young_modulus", "stiffness", "damping_normal", "damping_tangential",
    )  # fmt: skip
    values = dict.fromkeys(names, 0.25)
    world.create_material("soft", **values)
    document = document_of(three())
    document.load(world)
    assert {each.name for each in world.materials} >= {"soft", "soft_1"}
    assert world.pair("soft_1", "iron").restitution == 0.125
    assert "load-material-renamed" in [finding.code for finding in document.report]


@given(
    st.lists(st.none() | st.integers(1, 30), max_size=12), st.sets(st.integers(1, 30), max_size=10)
)
def test_free_ids(wanted: list[int | None], taken: set[int]) -> None:
    given_ids = free_ids(wanted, taken)
    assert len(set(given_ids)) == len(wanted)
    assert not set(given_ids) & taken
    known = sorted((sid, place) for place, sid in enumerate(wanted) if sid is not None)
    in_order = [given_ids[place] for _, place in known]
    assert in_order == sorted(in_order)
    rest = [given_ids[place] for place, sid in enumerate(wanted) if sid is None]
    assert rest == sorted(rest)
    if len(set(wanted)) == len(wanted) and not taken & {sid for sid in wanted if sid}:
        assert all(got == sid for got, sid in zip(given_ids, wanted, strict=True) if sid)


CENTIMETRES = '<unit meter="0.01" name="centimeter"/>'


def centimetres(up_axis: str = "Y_UP") -> bytes:
    box = "<shape><mass>2</mass><box><half_extents>50 100 150</half_extents></box></shape>"
    plane = "<shape><plane><equation>0 1 0 -200</equation></plane></shape>"
    return collada(
        model(body("b", box), body("p", plane)),
        scene(
            instance("b", values="<velocity>0 100 0</velocity>"),
            instance("p", "#k"),
            values="<gravity>0 -981 0</gravity>",
        ),
        '<node id="n"><translate>100 200 300</translate></node><node id="k"/>',
        unit=CENTIMETRES,
        up_axis=up_axis,
    )


def test_values_stay_in_the_documents_unit_and_axes() -> None:
    world = colladaphy.read(centimetres()).load()
    assert (world.unit_name, world.unit_meter, world.up_axis) == ("centimeter", 0.01, "Y_UP")
    assert world.gravity.tolist() == [0.0, -981.0, 0.0]
    assert world.bodies[0].position.tolist() == [100.0, 200.0, 300.0]


def test_si() -> None:
    world = colladaphy.read(centimetres()).load(si=True)
    box, plane = world.bodies
    assert (world.unit_name, world.unit_meter) == ("meter", 1.0)
    assert np.allclose(world.gravity, [0, -9.81, 0])
    assert np.allclose(box.position, [1, 2, 3])
    assert np.allclose(box.lengths, [1, 2, 3])
    assert box.mass == 2.0
    assert np.allclose(np.diag(box.inertia), 2.0 / 12.0 * np.array([13.0, 10.0, 5.0]))
    assert np.allclose(box.linear_velocity, [0, 1, 0])
    assert plane.displacement == pytest.approx(2.0)


def test_up_axis() -> None:
    world = colladaphy.read(centimetres()).load(up_axis="Z_UP")
    box, plane = world.bodies
    assert world.up_axis == "Z_UP"
    assert np.allclose(world.gravity, [0, 0, -981])
    assert np.allclose(box.position, [100, -300, 200])
    assert np.allclose(box.linear_velocity, [0, 0, 100])
    assert np.allclose(rotations.rotate(box.orientation, (0, 1, 0)), [0, 0, 1])
    assert np.allclose(plane.normal, [0, 0, 1])
    assert plane.displacement == pytest.approx(200.0)


def test_there_and_back_again() -> None:
    document = colladaphy.read(centimetres())
    turned = document.load(up_axis="X_UP")
    again = document_of(turned).load(up_axis="Y_UP")
    assert np.allclose(again.positions, document.load().positions)
    with pytest.raises(ValueError, match="up axis"):
        document.load(up_axis="W_UP")


def test_an_existing_world_keeps_its_unit_and_axes() -> None:
    world = World(up_axis="Z_UP")
    colladaphy.read(centimetres()).load(world)
    assert np.allclose(world.bodies[0].position, [1, -3, 2])


@settings(max_examples=20)
@given(st.sampled_from(["X_UP", "Y_UP", "Z_UP"]), st.sampled_from(["X_UP", "Y_UP", "Z_UP"]))
def test_up_goes_up(one: str, other: str) -> None:
    up = {"X_UP": "1 0 0", "Y_UP": "0 1 0", "Z_UP": "0 0 1"}
    data = collada(
        model(body()), scene(instance(values=f"<velocity>{up[one]}</velocity>")), up_axis=one
    )
    world = colladaphy.read(data).load(up_axis=other)
    assert np.allclose(world.bodies[0].linear_velocity, [float(x) for x in up[other].split()])

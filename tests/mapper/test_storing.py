"""What a World says as columns; that it comes back exactly is for `test_round_trip`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

import colladaphy
from colladaphy.columns.writing import document_bytes
from colladaphy.errors import SchemaError
from colladaphy.links.names import COLLADA, PE
from colladaphy.mapper import WriteOptions, store
from colladaphy.mapper.storing import columns_of
from colladaphy.mapper.storing.checking import faults_of, has_unique_ids
from colladaphy.mapper.storing.turns import mass_frames
from colladaphy.testing import worlds
from colladaphy.world import Body, Kind, World, rotations

C, P = f"{{{COLLADA}}}", f"{{{PE}}}"
Quaternion = tuple[float, ...]


def tree_of(world: World, **options: Any) -> etree._Element:
    return etree.fromstring(store(world, WriteOptions(**options)))


def numbers(element: etree._Element, path: str) -> list[float]:
    found = element.find(path)
    assert found is not None
    return [float(word) for word in (found.text or "").split()]


# --- unions: the scalar way, with what is not given left alone


def leaves_of(body: Body, position: Any = None, turn: Any = None) -> list[tuple[Body, Any, Any]]:
    """The primitives of a union in their order, each with its pose in it."""
    if body.kind is not Kind.UNION:
        return [(body, position, turn)]
    found = []
    for member in body.members:
        place = tuple(member.local_position.tolist())
        own = tuple(member.local_orientation.tolist())
        inner_place = None if same(place, (0.0, 0.0, 0.0)) else place
        inner_turn = None if same(own, rotations.IDENTITY) else rotations.normalize(own).tolist()
        moved = position
        if inner_place is not None:
            moved = inner_place if turn is None else turned(turn, inner_place)
            if position is not None:
                moved = tuple(a + b for a, b in zip(position, moved, strict=True))
        whole = turn if inner_turn is None else inner_turn
        if turn is not None and inner_turn is not None:
            whole = product(turn, inner_turn)
        found += leaves_of(member, moved, whole)
    return found


def same(one: Any, other: Any) -> bool:
    return [float(x).hex() for x in one] == [float(x).hex() for x in other]


def turned(q: Quaternion, v: tuple[float, ...]) -> tuple[float, ...]:
    w, x, y, z = q
    tx, ty, tz = (
        2.0 * (y * v[2] - z * v[1]),
        2.0 * (z * v[0] - x * v[2]),
        2.0 * (x * v[1] - y * v[0]),
    )
    return (
        v[0] + w * tx + y * tz - z * ty,
        v[1] + w * ty + z * tx - x * tz,
        v[2] + w * tz + x * ty - y * tx,
    )


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    (p, q, r, s), (w, x, y, z) = a, b
    return (
        p * w - q * x - r * y - s * z,
        p * x + q * w + r * z - s * y,
        p * y - q * z + r * w + s * x,
        p * z + q * y - r * x + s * w,
    )


@settings(max_examples=60)
@given(worlds(min_bodies=0))
def test_members_stand_in_the_outermost_union_to_the_last_bit(world: World) -> None:
    root = tree_of(world)
    for body, element in zip(world.bodies, root.iter(f"{C}rigid_body"), strict=True):
        if body.kind is not Kind.UNION:
            continue
        shapes = element.findall(f"{C}technique_common/{C}shape")
        leaves = leaves_of(body)
        assert len(shapes) == len(leaves)
        for shape, (leaf, position, turn) in zip(shapes, leaves, strict=True):
            if leaf.kind is Kind.PLANE:
                assert shape.find(f"{C}translate") is None and shape.find(f"{C}rotate") is None
                continue
            steps = [step.tag for step in shape if step.tag in (f"{C}translate", f"{C}rotate")]
            said = position is not None
            assert (steps[:1] == [f"{C}translate"]) >= said
            if said:
                assert same(numbers(shape, f"{C}translate"), position)
            if turn is not None and not same(turn, rotations.IDENTITY):
                axis, angle = rotations.to_axis_angle(np.array([turn]))
                values = [*axis[0].tolist(), math.degrees(angle[0])]
                assert same(numbers(shape, f"{C}rotate"), values)
        masses = sum((leaf.mass for leaf, _, _ in leaves), 0.0)
        stated = element.find(f"{C}technique_common/{C}mass")
        assert (stated is None) == same([masses], [body.mass])
        outline = element.find(f"{C}technique/{P}body/{P}union")
        assert outline is not None
        sids = [int(inner.get("sid", "")) for inner in outline.iter(f"{P}shape")]
        assert sids == [leaf.sid for leaf, _, _ in leaves]


# --- inertias

tensors = st.lists(
    st.tuples(*[st.floats(-1e3, 1e3) | st.just(0.0)] * 9).map(
        lambda values: np.array(values).reshape(3, 3)
    ),
    min_size=1,
    max_size=5,
).map(np.array)


@settings(max_examples=100)
@given(tensors)
def test_principal_moments_in_their_frames_are_the_inertia(inertias: Any) -> None:
    every = np.ones(len(inertias), bool)
    frames = mass_frames(inertias, every)
    for row, inertia in enumerate(inertias):
        alone = mass_frames(inertia[None], every[:1])
        for name in ("there", "framed", "turned", "turns", "moments"):
            assert getattr(alone, name)[0].tobytes() == getattr(frames, name)[row].tobytes()
        assert frames.there[row] == bool(inertia.any())
        symmetric = 0.5 * inertia + 0.5 * inertia.T
        turn = rotations.from_axis_angle(frames.turns[row, :3], np.radians(frames.turns[row, 3]))
        matrix = rotations.to_matrix(turn) if frames.turned[row] else np.eye(3)
        again = matrix @ np.diag(frames.moments[row]) @ matrix.T
        if frames.there[row]:
            np.testing.assert_allclose(again, symmetric, atol=1e-9 * np.abs(inertia).max())


def test_what_no_number_can_say_is_left_to_the_profile() -> None:
    inertias = np.array([np.full((3, 3), np.inf), np.zeros((3, 3)), np.eye(3), np.eye(3)])
    frames = mass_frames(inertias, np.array([True, True, True, False]))
    assert frames.there.tolist() == [False, False, True, False]
    assert not frames.framed.any()


# --- options


def test_shapes_that_are_too_thin_for_a_mesh_stay_what_they_are() -> None:
    world = World()
    world.create_box(1, (0, 0, 0), (1e30, 1.0, 1e-40), "iron", mass=1, inertia=np.eye(3))
    world.create_box(2, (9, 0, 0), (1, 2, 3), "iron")
    root = tree_of(world, tessellate=True)
    assert len(root.findall(f".//{C}box")) == 1
    assert [each.get("url") for each in root.iter(f"{C}instance_geometry")] == ["#Shape2"]


def test_a_mesh_stands_for_all_primitives_like_it() -> None:
    world = World()
    for number in range(4):
        world.create_sphere(number, (3.0 * number, 0, 0), 1 + number // 2, "iron")
    world.create_union(9, [world.create_sphere(5, (0, 9, 0), 1.0, "iron")])
    root = tree_of(world, tessellate=True, group=lambda body: str(-body.sid))
    ids = [geometry.get("id") for geometry in root.iter(f"{C}geometry")]
    assert ids == ["Shape1", "Shape3", "Shape5"]
    urls = {
        body.get("sid"): body.find(f".//{C}instance_geometry").get("url")  # type: ignore[union-attr]
        for body in root.iter(f"{C}rigid_body")
    }
    assert urls == {
        "Body1": "#Shape1", "Body2": "#Shape1", "Body3": "#Shape3", "Body4": "#Shape3",
        "Body6": "#Shape5",
    }  # fmt: skip


def test_models_hold_their_bodies_and_joints() -> None:
    world = World()
    bodies = [world.create_sphere(n, (3.0 * n, 0, 0), 1.0, "iron") for n in (1, 0, 1, 0)]
    world.attach_fixed_joint(bodies[2], bodies[0])
    world.attach_fixed_joint(None, bodies[1])
    models = columns_of(world, WriteOptions(group=lambda body: "ab"[body.uid]))
    models = models.library_physics_models.physics_model
    assert (models.id, models.name) == (["Model1", "Model2"], ["b", "a"])
    assert models.rigid_body.sid == ["Body1", "Body3", "Body2", "Body4"]
    assert models.rigid_body.owner.tolist() == [0, 0, 1, 1]
    assert models.rigid_constraint.sid == ["Joint1", "Joint2"]
    assert models.rigid_constraint.owner.tolist() == [0, 1]
    assert models.rigid_constraint.ref_attachment.rigid_body == ["Model1/Body3", None]
    assert models.rigid_constraint.attachment.rigid_body == ["Model1/Body1", "Model2/Body2"]


def test_a_union_has_the_material_that_all_in_it_have() -> None:
    world = World()
    names = ("iron", "iron", "oak")
    balls = [world.create_sphere(n, (3.0 * n, 0, 0), 1.0, m) for n, m in enumerate(names)]
    world.create_union(5, [world.create_union(4, balls[:1]), balls[1]])
    mixed = world.create_union(6, [world.bodies[1], balls[2]])
    root = tree_of(world, redundant=True)
    assert root.find(f".//{C}rigid_body/{C}technique_common/{C}instance_physics_material") is None
    world.destroy(mixed)
    ball = world.create_sphere(7, (0, 0, 0), 1.0, "oak")
    world.create_union(8, [world.create_union(8, [ball])])
    found = tree_of(world, redundant=True).find(
        f".//{C}rigid_body/{C}technique_common/{C}instance_physics_material"
    )
    assert found is not None and found.get("url") == "#Material3"


def test_the_unit_is_stated_though_it_is_the_default() -> None:
    unit = tree_of(World()).find(f"{C}asset/{C}unit")
    assert unit is not None and dict(unit.attrib) == {"meter": "1", "name": "meter"}


# --- the gate


def test_what_is_not_valid_is_not_stored() -> None:
    with pytest.raises(SchemaError) as caught:
        store(World(), WriteOptions(created="yesterday"))
    assert [finding.code for finding in caught.value.findings] == ["schema-invalid-value"] * 2


def test_ids_that_are_there_twice_are_found() -> None:
    world = World()
    world.create_sphere(1, (0, 0, 0), 1.0, "iron")
    columns = columns_of(world)
    assert has_unique_ids(columns)
    assert faults_of(document_bytes(columns), unique_ids=True) == []
    columns.library_visual_scenes.visual_scene.node.id = ["Scene1"]
    assert not has_unique_ids(columns)
    faults = faults_of(document_bytes(columns), unique_ids=False)
    assert [finding.code for finding in faults] == ["schema-duplicate-id"]


def test_an_empty_world_is_a_document() -> None:
    document = colladaphy.read(store(World()))
    assert len(document.load().bodies) == 0

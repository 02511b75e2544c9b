"""Unions, joints, materials and meshes made many at once: to the bit as one by one."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.testing import worlds
from colladaphy.world import (
    BodyColumns,
    JointColumns,
    Kind,
    MemberColumns,
    Mesh,
    World,
    compare,
    rotations,
)
from colladaphy.world.columns import JOINT_FIELDS, MEMBER_FIELDS
from colladaphy.world.materials import VALUES
from colladaphy.world.shapes import NEEDED
from colladaphy.world.unions import sums


def taken(columns: Any, rows: Any) -> Any:
    """Some rows of columns, in another order."""
    names = columns.names and [columns.names[row] for row in rows]
    arrays = {
        field.name: getattr(columns, field.name)[rows]
        for field in dataclasses.fields(columns)
        if field.name != "names"
    }
    return type(columns)(**arrays, names=names)


def in_order(world: World, data: st.DataObject) -> MemberColumns:
    """The members of a World, those of each union in their order, the unions in any."""
    columns = world.member_columns
    places = {sid: row for row, sid in enumerate(columns.sids.tolist())}
    unions = data.draw(st.permutations(sorted(world.children)))
    rows = [places[sid] for union in unions for sid in world.children[union]]
    return taken(columns, np.array(rows, dtype=int))


def empty_twin(world: World) -> World:
    """A World of equal settings and materials without bodies."""
    twin = World(
        world.gravity,
        unit=(world.unit_name, world.unit_meter),
        up_axis=world.up_axis,
        time_step=world.time_step,
        name=world.name,
    )
    twin.time, twin.step_count = world.time, world.step_count
    twin.engine_state = world.engine_state
    ids = world.materials.ids[len(twin.materials) :]
    names = [world.materials.names[id] for id in ids.tolist()]
    columns = {key: world.materials.values(key, ids) for key in VALUES}
    assert twin.materials.extend(names, columns, ids).tolist() == ids.tolist()
    for pair in world.pair_overrides:
        twin.set_pair(
            pair.first, pair.second, pair.restitution, pair.static_friction, pair.dynamic_friction
        )
    meshes = world.meshes
    sources = [(mesh.vertices, mesh.faces, mesh.convex) for mesh in meshes.values()]
    twin.add_meshes(sources, list(meshes))
    return twin


@given(worlds(min_bodies=0), st.data())
def test_a_world_is_its_columns_and_members(world: World, data: st.DataObject) -> None:
    twin = empty_twin(world)
    twin.extend(world.columns(), in_order(world, data))
    twin.extend_joints(
        taken(world.joint_columns, data.draw(st.permutations(range(len(world.joints)))))
    )
    twin.next_body_sid, twin.next_joint_sid = world.next_body_sid, world.next_joint_sid
    assert compare(world, twin, unused_materials=True) == []
    for sid, joints in world.joints_of.items():
        assert sorted(twin.joints_of[sid]) == sorted(joints)
    assert twin.joints_of.keys() == world.joints_of.keys()
    for body in world.bodies:
        assert twin.body(body.sid).infinite == body.infinite
    if len(world.bodies):
        with pytest.raises(WorldError, match="in use"):
            twin.extend(world.columns(), in_order(world, data))
        world.destroy(world.bodies[0])
        twin.destroy(twin.bodies[0])
        assert compare(world, twin, unused_materials=True) == []


def nest() -> tuple[BodyColumns, MemberColumns]:
    """A sphere (1) and a union (2) of a box (5) and of a union (4) of a sphere (6)."""
    columns = BodyColumns(
        kinds=np.array([Kind.SPHERE, Kind.UNION]),
        sids=np.array([1, 2]),
        positions=np.array([(0.0, 0, 0), (5, 0, 0)]),
        orientations=np.tile(rotations.IDENTITY, (2, 1)),
        masses=np.array([1.0, 2.0]),
        inertias=np.tile(np.eye(3), (2, 1, 1)),
        material_ids=np.array([0, -1]),
        dimensions=np.array([(1.0, 0, 0, 0), (0, 0, 0, 0)]),
    )
    members = MemberColumns(
        kinds=np.array([Kind.SPHERE, Kind.BOX, Kind.UNION]),
        sids=np.array([6, 5, 4]),
        uids=np.zeros(3, dtype=int),
        parents=np.array([4, 2, 2]),
        positions=np.zeros((3, 3)),
        orientations=np.tile(rotations.IDENTITY, (3, 1)),
        masses=np.ones(3),
        inertias=np.tile(np.eye(3), (3, 1, 1)),
        material_ids=np.array([1, 2, -1]),
        dimensions=np.array([(1.0, 0, 0, 0), (1, 1, 1, 0), (0, 0, 0, 0)]),
        hollow=np.zeros(3, dtype=bool),
        mesh_ids=np.full(3, -1),
        names=["core", None, "shell"],
    )
    return columns, members


def test_members_of_a_union_keep_their_order() -> None:
    world = World()
    assert world.extend(*nest()).tolist() == [1, 2]
    union = world.bodies[1]
    assert [member.sid for member in union.members] == [5, 4]
    assert [member.name for member in union.members] == [None, "shell"]
    assert union.members[1].members[0].name == "core" and world.next_body_sid == 7
    assert union.mass == 2 and not union.infinite and not union.fixed


def test_a_plane_anywhere_makes_the_unions_above_infinite() -> None:
    world = World()
    columns, members = nest()
    members.kinds[0], members.dimensions[0] = Kind.PLANE, (0, 0, 1, 0)
    world.extend(columns, members)
    assert world.bodies[1].infinite and world.bodies[1].fixed and world.body(4).infinite
    assert not world.bodies[0].fixed


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("parents", [4, 2, 3]),
        ("parents", [4, 2, 1]),
        ("parents", [4, 2, 4]),
        ("parents", [2, 2, 2]),
        ("parents", [2, 4, 4]),
        ("sids", [6, 5, 1]),
        ("sids", [6, 6, 4]),
        ("material_ids", [1, 2, 0]),
        ("material_ids", [-1, 2, -1]),
        ("mesh_ids", [-1, -1, 0]),
        ("positions", None),
        ("masses", [1, 1, np.nan]),
        ("inertias", np.full((3, 3, 3), np.inf)),
        ("orientations", np.zeros((3, 4))),
        ("kinds", [0, 1, 8]),
        ("names", ["one"]),
        ("names", [1, 2, 3]),
    ],
)
def test_bad_members_create_nothing(name: str, value: Any) -> None:
    world = World()
    columns, members = nest()
    value = np.array(value) if name != "names" and value is not None else value
    setattr(members, name, value)
    with pytest.raises(WorldError):
        world.extend(columns, members)
    assert compare(world, World(), unused_materials=True) == []


@pytest.mark.parametrize("name", ["sids", "positions", "orientations", "masses", "inertias"])
def test_unions_need_complete_rows(name: str) -> None:
    world = World()
    columns, members = nest()
    setattr(columns, name, None)
    with pytest.raises(WorldError):
        world.extend(columns, members)
    assert len(world.bodies) == 0


# --- how members add up


@given(st.integers(0, 2**32 - 1), st.integers(1, 8), st.integers(0, 20))
def test_sums_do_not_depend_on_what_lies_beside_them(seed: int, count: int, more: int) -> None:
    rng = np.random.default_rng(seed)
    owner = rng.permutation(np.concatenate([np.arange(count), rng.integers(0, count, more)]))
    parts = len(owner)
    tensors = rng.normal(size=(parts, 3, 3))
    columns: list[NDArray[Any]] = [
        rng.normal(size=(parts, 3)),
        rng.normal(size=(parts, 4)),
        np.where(rng.random(parts) < 0.3, 0.0, rng.random(parts)),
        tensors + np.swapaxes(tensors, 1, 2),
        rng.random(parts) < 0.1,
    ]
    together = sums(owner, count, *columns)
    for union in range(count):
        rows = np.flatnonzero(owner == union)
        alone = sums(np.zeros(len(rows), int), 1, *(column[rows] for column in columns))
        plain = added(*(column[rows] for column in columns))
        for many, one, expected in zip(together, alone, plain, strict=True):
            assert many[union].tobytes() == one[0].tobytes() == np.asarray(expected).tobytes()


def added(positions: Any, orientations: Any, masses: Any, inertias: Any, infinite: Any) -> Any:
    """One part after the other, by the parallel-axis theorem."""
    if infinite.any():
        chosen = positions[infinite]
        return 0.0, sum(chosen, np.zeros(3)) / len(chosen), np.zeros((3, 3))
    mass = float(sum(masses))
    if len(masses) == 1:
        center = positions[0]
    elif mass > 0:
        center = sum((m * p for m, p in zip(masses, positions, strict=True)), np.zeros(3)) / mass
    else:
        center = sum(positions, np.zeros(3)) / len(masses)
    total = np.zeros((3, 3))
    for position, turn, own, tensor in zip(positions, orientations, masses, inertias, strict=True):
        offset = position - center
        total += rotations.rotate_tensor(turn, tensor)
        total += own * (float(offset @ offset) * np.eye(3) - np.outer(offset, offset))
    return mass, center, 0.5 * (total + total.T)


# --- joints


def pair() -> World:
    world = World()
    for x in (0, 3, 6):
        world.create_sphere(1, (x, 0, 0), 1, "iron")
    world.create_union(1, [world.bodies[0], world.bodies[1]])
    return world


def test_joints_have_the_defaults_of_a_single_one() -> None:
    many, single = pair(), pair()
    sids = many.extend_joints(JointColumns(bodies=np.array([(3, 4), (0, 3)]), names=["knee", None]))
    single.attach_joint(single.body(3), single.body(4), name="knee")
    single.attach_joint(None, single.body(3))
    assert sids.tolist() == [1, 2] and compare(many, single) == []
    assert many.joints_of == single.joints_of and many.joints[0].name == "knee"
    assert many.joint_columns.names == ["knee", None]
    assert many.extend_joints(JointColumns(bodies=np.zeros((0, 2), dtype=int))).tolist() == []


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("bodies", [(3, 4), (3, 3)]),
        ("bodies", [(3, 4), (0, 0)]),
        ("bodies", [(3, 4), (3, 9)]),
        ("bodies", [(3, 4), (3, 1)]),
        ("bodies", [3, 4]),
        ("bodies", None),
        ("bodies", [(3.5, 4), (4, 3)]),
        ("sids", [1, 1]),
        ("sids", [0, 1]),
        ("sids", [1, 7]),
        ("positions", np.full((2, 2, 3), np.nan)),
        ("orientations", np.zeros((2, 2, 4))),
        ("linear_limits", np.full((2, 2, 3), np.nan)),
        ("angular_limits", np.zeros((2, 3))),
        ("linear_springs", np.full((2, 3), np.inf)),
        ("angular_springs", [["a"] * 3] * 2),
        ("motors", [(1.0, -1.0)] * 2),
        ("motors", np.full((2, 2), np.inf)),
        ("enabled", ["yes", "no"]),
        ("names", ["knee"]),
    ],
)
def test_bad_joint_columns_create_nothing(name: str, value: Any) -> None:
    world = pair()
    world.attach_fixed_joint(world.body(3), None, sid=7)
    columns = JointColumns(bodies=np.array([(3, 4), (0, 3)]))
    setattr(columns, name, value)
    with pytest.raises(WorldError):
        world.extend_joints(columns)
    assert len(world.joints) == 1 and world.joint_names == {} and world.next_joint_sid == 8


# --- materials


def numbers(count: int) -> dict[str, NDArray[np.float64]]:
    rng = np.random.default_rng(5)
    columns = {key: rng.uniform(0.01, 0.5, count) for key in VALUES}
    columns["density"] *= 1e3
    return columns


def test_materials_at_once_are_as_one_by_one() -> None:
    many, single = World(), World()
    columns = numbers(9)
    ids = [30, 12, 7, 40, 41, 5, 6, 99, 8]
    many.materials.extend([f"m{id}" for id in ids], columns, ids)
    for row, id in enumerate(ids):
        values = {key: float(columns[key][row]) for key in VALUES}
        single.create_material(f"m{id}", id=id, **values)
    assert compare(many, single, unused_materials=True) == []
    assert list(many.materials) == list(single.materials)
    assert many.materials.ids.tolist() == [0, 1, 2, 3, 4, *sorted(ids)]
    assert (
        many.materials.values("density", [99, 30]).tolist() == columns["density"][[7, 0]].tolist()
    )
    assert many.materials["m7"] is many.materials[7] and many.materials[7] in many.materials
    assert many.create_material("last", **dict.fromkeys(VALUES, 0.25)).id == 100
    copied = many.materials.copy()
    many.create_material("later", **dict.fromkeys(VALUES, 0.25))
    assert len(copied) == len(many.materials) - 1 and copied[7] is many.materials[7]


@pytest.mark.parametrize(
    ("names", "ids", "changed"),
    [
        (["a", "a"], None, {}),
        (["a", "iron"], None, {}),
        (["a", 3], None, {}),
        (["a", "b"], [5, 5], {}),
        (["a", "b"], [5, 4], {}),
        (["a", "b"], [5, -1], {}),
        (["a", "b"], [5], {}),
        (["a", "b"], None, {"density": [1, 0]}),
        (["a", "b"], None, {"restitution": [1, np.nan]}),
        (["a", "b"], None, {"poisson_ratio": [0.51, 0]}),
        (["a", "b"], None, {"stiffness": [1, np.inf]}),
        (["a", "b"], None, {"stiffness": ["1", "2"]}),
        (["a", "b"], None, {"stiffness": [1]}),
    ],
)
def test_bad_materials_add_nothing(names: Any, ids: Any, changed: dict[str, Any]) -> None:
    world = World()
    with pytest.raises(WorldError):
        world.materials.extend(names, {**numbers(2), **changed}, ids)
    assert compare(world, World(), unused_materials=True) == [] and len(world.materials) == 5
    with pytest.raises(WorldError):
        world.materials.values("density", [0, 77])
    with pytest.raises(WorldError):
        world.materials.values("colour")


# --- meshes


def cone(corners: int, rng: np.random.Generator) -> tuple[Any, Any]:
    """A closed surface around any number of corners."""
    angle = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(corners)], axis=1)
    points = np.concatenate([ring, [(0, 0, -1), (0.2, 0, 2)]]) * rng.uniform(0.5, 2, 3)
    following = np.roll(np.arange(corners), -1)
    faces = [(row, following[row], corners + 1) for row in range(corners)]
    faces += [(following[row], row, corners) for row in range(corners)]
    return points + rng.normal(size=3), np.array(faces)


def same(one: Mesh, two: Mesh) -> bool:
    return one.same_as(two) and all(
        np.asarray(a).tobytes() == np.asarray(b).tobytes()
        for a, b in [
            (one.volume, two.volume),
            (one.center, two.center),
            (one.mean_squares(False), two.mean_squares(False)),
            (one.center_of(True), two.center_of(True)),
            (one.mean_squares(True), two.mean_squares(True)),
            (one.inertia(3.0), two.inertia(3.0)),
        ]
    )


@given(st.integers(0, 2**32 - 1), st.lists(st.integers(3, 150), max_size=6))
def test_meshes_at_once_are_as_alone(seed: int, sizes: list[int]) -> None:
    rng = np.random.default_rng(seed)
    sources = [(*cone(size, rng), bool(size % 2)) for size in sizes]
    world, single = World(), World()
    made = world.add_meshes(sources)
    for source, mesh in zip(sources, made, strict=True):
        alone = single.add_mesh(source[0], source[1], convex=source[2])
        assert mesh.id == alone.id and world.meshes[mesh.id] is mesh
        assert same(mesh, alone) and same(Mesh(source[0], source[1], convex=source[2]), mesh)
    count = len(made)
    hollow = np.arange(2 * count) % 2 == 0
    world.extend(
        BodyColumns(
            kinds=np.full(2 * count, Kind.MESH), mesh_ids=np.repeat(np.arange(count), 2),
            hollow=hollow, material_ids=np.arange(2 * count) % 5,
        )
    )  # fmt: skip
    for row in range(2 * count):
        material = single.materials[row % 5]
        single.create_mesh(
            0, (0, 0, 0), single.meshes[row // 2], None, material, hollow=bool(hollow[row])
        )
    assert compare(world, single) == []


def test_bad_meshes_add_nothing() -> None:
    good = cone(5, np.random.default_rng(1))
    world = World()
    for bad in (
        (good[0], good[1] + 6),
        (good[0], good[1].astype(float)),
        (good[0] * (1, 1, 0), good[1]),
        ("points", good[1]),
        (good[0], None),
        ([[1, 2, 3], [4]], good[1]),
    ):
        with pytest.raises(WorldError):
            world.add_meshes([(*good, True), (*bad, False)])
    for ids in ([1, 1], [-1, 1], [1]):
        with pytest.raises(WorldError):
            world.add_meshes([(*good, True), (*good, False)], ids)
    assert world.meshes == {}


TETRAHEDRON = ([(0, 0, 0), (4, 0, 0), (0, 1, 0), (0, 0, 1)],
               [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])  # fmt: skip


def test_hollow_meshes_have_the_centre_of_their_surface() -> None:
    mesh = Mesh(*TETRAHEDRON)
    assert mesh.center_of(False) == pytest.approx([1, 0.25, 0.25])
    # Three right triangles at the axes and the slanted one, each with its centroid.
    slanted = float(np.linalg.norm(np.cross((-4, 1, 0), (-4, 0, 1)))) / 2
    areas = np.array([2.0, 2.0, 0.5, slanted])
    centers = np.array([(4, 1, 0), (4, 0, 1), (0, 1, 1), (4, 1, 1)]) / 3
    expected = areas @ centers / areas.sum()
    assert mesh.center_of(True) == pytest.approx(expected, rel=1e-14)
    assert round(float(expected[0]), 2) == 1.24
    body = World().create_mesh(1, (7, 8, 9), *TETRAHEDRON, "iron", hollow=True, mass=2.0)
    points = mesh.body_vertices_of(True)
    # The inertia from points spread evenly over each face, to the order that they allow.
    steps = 400
    u, v = (grid.ravel() for grid in np.meshgrid(*[(np.arange(steps) + 0.5) / steps] * 2))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    second = np.zeros((3, 3))
    for face in mesh.faces:
        a, b, c = points[face]
        spread = a + u[:, None] * (b - a) + v[:, None] * (c - a)
        area = float(np.linalg.norm(np.cross(b - a, c - a))) / 2
        second += area * spread.T @ spread / len(spread)
    second *= 2.0 / areas.sum()
    assert body.inertia == pytest.approx(np.trace(second) * np.eye(3) - second, rel=1e-3, abs=1e-3)
    assert body.position.tolist() == [7, 8, 9]


# --- hollow primitives, which are grouped by equal dimensions


@pytest.mark.parametrize("kind", [kind for kind in Kind if kind in NEEDED])
def test_hollow_bodies_at_once_are_as_one_by_one(kind: Kind) -> None:
    many, single = World(), World()
    count = 70
    dimensions = np.random.default_rng(2).uniform(0.5, 2, (count, 4))
    dimensions[::2, 2] = dimensions[::2, 1]  # round sections
    dimensions[-5:] = dimensions[:5]
    dimensions[:, [axis for axis in range(4) if axis not in NEEDED[kind]]] = 0
    columns = {
        "kinds": np.full(count, kind),
        "dimensions": dimensions,
        "hollow": np.arange(count) % 9 > 0,
    }
    many.extend(BodyColumns(**columns))
    for row in range(count):
        single.extend(BodyColumns(**{name: column[row][None] for name, column in columns.items()}))
    assert compare(many, single) == []


def test_planes_at_once_are_as_one_by_one() -> None:
    many, single = World(), World()
    normals = np.random.default_rng(4).normal(size=(40, 3))
    normals[:3] = (0, 0, -1), (0, 1e-9, -1), (0, 0, 1)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    displacements = np.linspace(-3, 3, 40)
    for normal, displacement in zip(normals, displacements, strict=True):
        single.create_plane(0, normal, displacement, "iron")
    dimensions = np.column_stack([normals, displacements])
    many.extend(BodyColumns(kinds=np.full(40, Kind.PLANE), dimensions=dimensions))
    assert compare(many, single) == []
    for world in (many, single):
        world.positions += (1, 2, 3)
    moved = [plane.dimensions.tolist() for plane in single.bodies]
    assert many.dimensions.tolist() == moved
    expected = displacements + normals @ (1, 2, 3)
    assert many.dimensions[:, 3] == pytest.approx(expected, abs=1e-12)


def test_fields_and_columns_name_the_same() -> None:
    names = {field.name for field in dataclasses.fields(JointColumns)}
    assert names == {*JOINT_FIELDS, "sids", "names"}
    names = {field.name for field in dataclasses.fields(MemberColumns)}
    assert names == {*MEMBER_FIELDS, "sids", "names"}

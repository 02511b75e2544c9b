"""Shapes, masses, frictions and refusals of the MuJoCo engine."""

from __future__ import annotations

import math
from time import perf_counter
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.engines.scenes import SCENES

from colladaphy.engines import Simulation, create_engine
from colladaphy.engines.mujoco_engine.convexity import is_convex
from colladaphy.engines.mujoco_engine.inertia import principal
from colladaphy.engines.mujoco_engine.refusals import check
from colladaphy.errors import EngineError
from colladaphy.world import BodyColumns, Kind, Mesh, World, rotations

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE_FACES = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]


def codes(world: World) -> list[str]:
    return [finding.code for finding in check(world)]


def loaded(world: World) -> Any:
    engine = create_engine("mujoco")
    engine.load(world)
    mujoco.mj_forward(engine._model.compiled, engine._data)
    return engine


def mass_matrix(engine: Any) -> np.ndarray:
    compiled = engine._model.compiled
    matrix = np.zeros((compiled.nv, compiled.nv))
    mujoco.mj_fullM(compiled, engine._data, matrix)
    return matrix


def test_masses_and_inertias_are_those_of_the_world() -> None:
    """MuJoCo's own mass matrix, against the World's numbers, union and mesh included."""
    world = SCENES["general"]()
    for joint in list(world.joints):
        world.destroy_joint(joint)
    engine = loaded(world)
    matrix = mass_matrix(engine)
    moving = np.flatnonzero(~world.fixed)
    for row, start in zip(moving, range(0, 6 * len(moving), 6), strict=True):
        block = matrix[start : start + 6, start : start + 6]
        np.testing.assert_allclose(block[:3, :3], world.masses[row] * np.eye(3), rtol=1e-12)
        scale = np.abs(world.inertias[row]).max()
        np.testing.assert_allclose(block[3:, 3:], world.inertias[row], atol=1e-9 * scale)


@settings(max_examples=50)
@given(
    st.lists(st.floats(0.1, 10), min_size=3, max_size=3),
    st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(
        lambda q: sum(x * x for x in q) > 0.1
    ),
)
def test_principal_axes_give_the_tensor_back(masses: list[float], turn: tuple[float, ...]) -> None:
    a, b, c = masses
    tensor = rotations.rotate_tensor(turn, np.diag([b + c, a + c, a + b]))
    moments, axes = principal(tensor)
    np.testing.assert_allclose(rotations.rotate_tensor(axes, np.diag(moments)), tensor, atol=1e-9)
    ordered = np.sort(moments)
    assert ordered[0] + ordered[1] >= ordered[2]


def resting_height(world: World, sid: int) -> float:
    Simulation(world, "mujoco").run(480)
    return float(world.body(sid).position[2])


def table() -> World:
    world = World((0, 0, -9.81), time_step=1 / 240)
    world.create_plane(1, (0, 0, 1), 0.25, "granite")
    return world


@pytest.mark.parametrize(
    ("make", "height"),
    [
        (lambda w: w.create_sphere(2, (0, 0, 1), 0.5, "oak"), 0.5),
        (lambda w: w.create_box(2, (0, 0, 1), (1.0, 1.5, 0.6), "oak"), 0.3),
        (lambda w: w.create_capsule(2, (0, 0, 1), 0.3, 1.0, "oak"), 0.3),
        (lambda w: w.create_cylinder(2, (0, 0, 1), 0.4, 1.0, "oak"), 0.4),
        (lambda w: w.create_ellipsoid(2, (0, 0, 1), (0.5, 0.6, 0.2), "oak"), 0.2),
        (lambda w: w.create_cylinder(2, (0, 0, 1), (0.6, 0.3), 1.0, "oak"), 0.3),
        (lambda w: w.create_capsule(2, (0, 0, 1), (0.2, 0.6, 0.3), 1.0, "oak"), 0.3),
        (lambda w: w.create_mesh(2, (0, 0, 1), CUBE, CUBE_FACES, "oak"), 0.5),
    ],
)
def test_shapes_rest_at_their_height(make: Any, height: float) -> None:
    """The capsule and cylinder lie along x; every shape touches where its surface is."""
    world = table()
    body = make(world)
    assert resting_height(world, body.sid) == pytest.approx(0.25 + height, abs=0.01)


def test_members_of_unions_are_where_they_are() -> None:
    world = table()
    inner = world.create_union(
        2,
        [
            world.create_sphere(3, (0, 0, 1), 0.2, "oak"),
            world.create_box(4, (1, 0, 1), (0.4, 0.4, 0.4), "oak"),
        ],
    )
    union = world.create_union(5, [inner, world.create_sphere(6, (0, 1, 1), 0.2, "oak")])
    union.rotate(0.0, 0.0, 0.5)
    engine = loaded(world)
    compiled, data = engine._model.compiled, engine._data
    expected = sorted(tuple(np.round(world.body(sid).position, 9)) for sid in (2, 3, 5))
    got = sorted(
        tuple(np.round(data.geom_xpos[i], 9) + 0.0)
        for i in range(compiled.ngeom)
        if engine._model.geom_sids[i] == union.sid
    )
    np.testing.assert_allclose(got, expected, atol=1e-9)


# A pyramid: the centre of its volume is at a quarter of its height, that of its surface of base 2
# and height 1 at sqrt(2)/(1 + sqrt(2))/3, as its sides have 4 sqrt(2)/(4 + 4 sqrt(2)) of the area.
PYRAMID = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)], dtype=float)
SLOPES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 2, 1), (0, 3, 2)]
CENTRES = {False: 0.25, True: math.sqrt(2) / (1 + math.sqrt(2)) / 3}


@pytest.mark.parametrize("hollow", [False, True])
@pytest.mark.parametrize("member", [False, True])
def test_meshes_are_about_their_own_centres(hollow: bool, member: bool) -> None:
    """Of a surface or a volume: it stands on the ground where the closed form says."""
    height = 0.25 + CENTRES[hollow]  # of a table of 0.25
    world = table()
    body = world.create_mesh(2, (0, 0, height), PYRAMID, SLOPES, "oak", hollow=hollow)
    if member:
        other = world.create_mesh(3, (3, 0, height), body.mesh, None, "oak", hollow=hollow)
        world.create_union(4, [body, other])
    engine = loaded(world)
    compiled, data = engine._model.compiled, engine._data
    for geom in np.flatnonzero(np.asarray(compiled.geom_dataid) >= 0).tolist():
        mesh = compiled.geom_dataid[geom]
        start, count = compiled.mesh_vertadr[mesh], compiled.mesh_vertnum[mesh]
        vertices = np.array(compiled.mesh_vert[start : start + count], dtype=float)
        places = vertices @ np.reshape(data.geom_xmat[geom], (3, 3)).T + data.geom_xpos[geom]
        assert places[:, 2].min() == pytest.approx(0.25, abs=1e-6)
        assert places[:, 2].max() == pytest.approx(1.25, abs=1e-6)
    assert engine._data.ncon == 0 or np.abs(data.contact.dist).max() < 1e-6
    Simulation(world, "mujoco").run(240)
    assert body.position[2] == pytest.approx(height, abs=2e-3)
    assert body.velocity_at((0, 0, 0)) == pytest.approx(np.zeros(3), abs=1e-2)


def test_convex_hulls_are_reported_only_where_they_differ() -> None:
    world = World(time_step=0.01)
    world.create_mesh(1, (0, 0, 0), CUBE, CUBE_FACES, "oak")
    assert "engine-mesh-hull" not in codes(world)
    dented = np.concatenate([CUBE, [(0.5, 0.5, 0.2)]])
    faces = [face for face in CUBE_FACES if set(face) not in ({1, 5, 7}, {1, 7, 3})]
    faces += [(1, 5, 8), (5, 7, 8), (7, 3, 8), (3, 1, 8)]
    body = world.create_mesh(2, (3, 0, 0), dented, faces, "oak")
    assert body.volume < 1.0
    assert "engine-mesh-hull" in codes(world)


def test_elliptic_sections_are_approximated() -> None:
    world = World(time_step=0.01)
    world.create_cylinder(1, (0, 0, 0), (0.5, 0.4), 1.0, "oak")
    assert "engine-shape-approximated" in codes(world)


def slide(world: World, sid: int) -> float:
    """Deceleration of a body that slides along x, from its velocity after half a second."""
    simulation = Simulation(world, "mujoco")
    simulation.run(12)
    before = world.body(sid).linear_velocity[0]
    simulation.run(120)
    return float((before - world.body(sid).linear_velocity[0]) / 0.5)


@pytest.mark.parametrize(("override", "expected"), [(None, 0.5), (0.1, 0.1), (0.0, 0.0)])
def test_friction_is_that_of_the_pair(override: float | None, expected: float) -> None:
    """pe: the sum of the two materials, or what was set; never the larger one."""
    world = World((0, 0, -9.81), time_step=1 / 240)
    for name, friction in (("a", 0.3), ("b", 0.2)):
        world.create_material(
            name, density=1000, restitution=0, static_friction=friction,
            dynamic_friction=friction, poisson_ratio=0.3, young_modulus=1, stiffness=1,
            damping_normal=0, damping_tangential=0,
        )  # fmt: skip
    if override is not None:
        world.set_pair("a", "b", static_friction=override, dynamic_friction=override)
    world.create_plane(1, (0, 0, 1), 0, "a")
    body = world.create_box(2, (0, 0, 0.25), (2, 2, 0.5), "b", linear_velocity=(3.0, 0, 0))
    assert slide(world, body.sid) == pytest.approx(expected * 9.81, rel=0.05, abs=0.01)


def test_frictions_that_differ_are_named() -> None:
    world = table()
    world.create_sphere(2, (0, 0, 1), 0.5, "oak")
    world.set_pair("granite", "oak", static_friction=0.5)
    found = {finding.code: finding.message for finding in check(world)}
    assert "granite on oak" in found["engine-frictions"]


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"mass": 0.0}, "engine-mass"),
        ({"inertia": (0.0, 1.0, 1.0)}, "engine-mass"),
        ({"inertia": (1.0, 1.0, 2.5)}, "engine-inertia-triangle"),
        ({"mass": 1e-20, "inertia": (1.0, 1.0, 1.0)}, "engine-size"),
        ({"linear_velocity": (1e11, 0.0, 0.0)}, "engine-size"),
    ],
)
def test_bodies_that_cannot_move_are_refused(options: dict[str, Any], code: str) -> None:
    world = World(time_step=0.01)
    body = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", **options)
    assert code in codes(world)
    with pytest.raises(EngineError, match=code):
        Simulation(world, "mujoco")
    body.fixed = True
    body.linear_velocity = (0, 0, 0)
    Simulation(world, "mujoco").run(1)


def test_inertia_at_the_very_limit_runs() -> None:
    """A flat disc: A + B = C, which rounding breaks."""
    world = World(time_step=0.01)
    body = world.create_box(
        1, (0, 0, 0), (1, 1, 0.01), "oak", mass=1.0, inertia=(0.1, 0.2, 0.1 + 0.2 + 1e-12)
    )
    body.rotate(0.3, 0.2, 0.1)
    Simulation(world, "mujoco").run(1)


def test_every_refusal_is_listed() -> None:
    world = World(time_step=0.01)
    for i in range(3):
        world.create_box(i, (3 * i, 0, 0), (1, 1, 1), "oak", mass=0.0)
    with pytest.raises(EngineError) as caught:
        Simulation(world, "mujoco")
    assert len(caught.value.findings) == 3


def test_a_scene_that_mujoco_itself_refuses_is_an_engine_error() -> None:
    world = World(time_step=0.01)
    flat = 1e-7 * CUBE
    world.create_mesh(1, (0, 0, 0), flat, CUBE_FACES, "oak", mass=1.0, inertia=(1, 1, 1))
    try:
        Simulation(world, "mujoco")
    except EngineError as error:
        assert "engine-library" in str(error)


def test_empty_world_and_world_of_fixed_bodies() -> None:
    world = World((0, 0, -9.81), time_step=0.01)
    assert Simulation(world, "mujoco").run(3).step_count == 3
    world.create_sphere(1, (0, 0, 0), 0.5, "oak", fixed=True)
    before = np.array(world.positions)
    assert Simulation(world, "mujoco").run(3).bodies == 0
    np.testing.assert_array_equal(world.positions, before)


def test_contacts_say_where_and_how_hard() -> None:
    world = table()
    ball = world.create_sphere(2, (0, 0, 0.75), 0.5, "oak", linear_velocity=(1, 0, 0))
    simulation = Simulation(world, "mujoco")
    simulation.run(24)
    (contact,) = simulation.contacts()
    assert (contact.first, contact.second) == (1, ball.sid)
    np.testing.assert_allclose(contact.normal, (0, 0, 1), atol=1e-9)
    np.testing.assert_allclose(contact.position[1:], (0, 0.25), atol=1e-2)
    assert contact.distance == pytest.approx(0.0, abs=1e-2)
    total = 0.0
    for _ in range(60):
        simulation.run(1)
        total += sum(contact.impulse for contact in simulation.contacts())
    assert total == pytest.approx(ball.mass * 9.81 * 60 / 240, rel=0.1)


def test_many_bodies_at_once() -> None:
    world = World((0, 0, -9.81), time_step=1 / 240)
    count = 2000
    place = np.stack([np.arange(count) * 2.0, np.zeros(count), np.zeros(count)], axis=-1)
    world.extend(
        BodyColumns(
            kinds=np.full(count, Kind.SPHERE),
            positions=place,
            dimensions=np.tile([0.5, 0, 0, 0], (count, 1)),
        )
    )
    Simulation(world, "mujoco").run(3)
    fall = 9.81 / 240**2 * 6
    np.testing.assert_allclose(world.positions[:, 2], -fall, rtol=1e-9)


def test_contacts_beyond_memory_are_an_error_not_a_loss(monkeypatch: pytest.MonkeyPatch) -> None:
    from colladaphy.engines.mujoco_engine import model

    monkeypatch.setattr(model, "_MEMORY", 40_000)
    monkeypatch.setattr(model, "_MEMORY_PER_SHAPE", 0)
    world = World((0, 0, -9.81), time_step=1 / 240)
    for i in range(12):
        world.create_box(i, (0.1 * i, 0, 0), (1, 1, 1), "oak")
    before = np.array(world.positions)
    with pytest.raises(EngineError, match="engine-library"):
        Simulation(world, "mujoco").run(3)
    np.testing.assert_array_equal(world.positions, before)


def ball_mesh(count: int, dent: float = 0.0) -> tuple[Any, Any]:
    """A sphere of `count` rings, dented at one vertex."""
    around = 2 * count
    angles = np.linspace(0, np.pi, count + 1)[1:-1]
    turns = np.linspace(0, 2 * np.pi, around, endpoint=False)
    rings = np.stack([
        np.outer(np.sin(angles), np.cos(turns)), np.outer(np.sin(angles), np.sin(turns)),
        np.repeat(np.cos(angles)[:, None], around, axis=1),
    ], axis=-1)  # fmt: skip
    rings[count // 2, 0] *= 1.0 - dent
    points = np.concatenate([rings.reshape(-1, 3), [(0, 0, 1), (0, 0, -1)]])
    number = np.arange((count - 1) * around).reshape(count - 1, around)
    beside = np.roll(number, -1, axis=1)
    faces = [
        np.stack([number[:-1], number[1:], beside[1:]], axis=-1).reshape(-1, 3),
        np.stack([number[:-1], beside[1:], beside[:-1]], axis=-1).reshape(-1, 3),
        np.stack([np.full(around, len(points) - 2), number[0], beside[0]], axis=-1),
        np.stack([np.full(around, len(points) - 1), beside[-1], number[-1]], axis=-1),
    ]
    return points, np.concatenate(faces)


@pytest.mark.parametrize("count", [20, 120])
@pytest.mark.parametrize("inside_out", [False, True])
def test_convexity_of_small_and_large_meshes(count: int, inside_out: bool) -> None:
    for dent, convex in ((0.0, True), (0.05, False)):
        points, faces = ball_mesh(count, dent)
        mesh = Mesh(points, faces[:, ::-1] if inside_out else faces)
        start = perf_counter()
        assert is_convex(mesh) is convex
        assert perf_counter() - start < 2.0  # 29,000 vertices took half a minute


def test_a_scene_is_looked_through_once(monkeypatch: pytest.MonkeyPatch) -> None:
    from colladaphy.engines.mujoco_engine import refusals

    looked: list[int] = []
    look = refusals._shapes
    monkeypatch.setattr(refusals, "_shapes", lambda world: looked.append(1) or look(world))
    world = SCENES["general"]()
    simulation = Simulation(world, "mujoco")
    simulation.run(2)
    assert len(looked) == 1
    world.masses[3] *= 2
    simulation.run(2)
    assert len(looked) == 2

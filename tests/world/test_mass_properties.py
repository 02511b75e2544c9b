"""Masses and inertias against fine meshes, and against each other."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.world import Body, Mesh, World, rotations

lengths = st.floats(0.2, 5)


def skin(points: Any) -> tuple[Any, Any]:
    """Close a grid of points (rings, around, 3) to a surface; the first and last ring are poles."""
    rings, around, _ = points.shape
    faces = []
    for ring in range(rings - 1):
        for step in range(around):
            a, b = ring * around + step, ring * around + (step + 1) % around
            faces += [(a, b, a + around), (b, b + around, a + around)]
    return points.reshape(-1, 3), np.array(faces)


def turned(profile: list[tuple[float, float]], y: float, z: float, around: int = 400) -> Mesh:
    """The surface of (x, r) rings, each an ellipse of semi-axes r·y and r·z about x."""
    angle = np.arange(around) * (2 * math.pi / around)
    rings = [
        np.stack([np.full(around, x), r * y * np.cos(angle), r * z * np.sin(angle)], axis=-1)
        for x, r in profile
    ]
    return Mesh(*skin(np.stack(rings)))


def arc(start: float, stop: float, scale: float, shift: float) -> list[tuple[float, float]]:
    """Rings of a round cap; finer than the error that the tests allow."""
    return [(shift + scale * math.sin(a), math.cos(a)) for a in np.linspace(start, stop, 200)]


def oracle(kind: str, dims: Any) -> Mesh:
    """A fine mesh of a primitive."""
    x, y, z, length = dims
    half = length / 2
    if kind == "ellipsoid":
        return turned(arc(-math.pi / 2, math.pi / 2, x, 0), y, z)
    if kind == "cylinder":
        return turned([(-half, 0), (-half, 1), (half, 1), (half, 0)], y, z)
    caps = arc(-math.pi / 2, 0, x, -half) + arc(0, math.pi / 2, x, half)
    return turned(caps, y, z)


def create(world: World, kind: str, dims: Any, **options: Any) -> Body:
    x, y, z, length = dims
    if kind == "ellipsoid":
        return world.create_ellipsoid(1, (0, 0, 0), (x, y, z), "oak", **options)
    if kind == "cylinder":
        return world.create_cylinder(1, (0, 0, 0), (y, z), length, "oak", **options)
    return world.create_capsule(1, (0, 0, 0), (x, y, z), length, "oak", **options)


@settings(max_examples=settings().max_examples // 8)
@given(
    st.sampled_from(["ellipsoid", "cylinder", "capsule"]),
    st.tuples(lengths, lengths, lengths, lengths),
    st.booleans(),
)
def test_round_bodies_agree_with_fine_meshes(kind: str, dims: Any, hollow: bool) -> None:
    body = create(World(), kind, dims, hollow=hollow)
    mesh = oracle(kind, dims)
    assert math.isclose(body.mass, 800 * mesh.volume, rel_tol=3e-4)
    expected = mesh.inertia(body.mass, hollow=True) if hollow else mesh.inertia(body.mass)
    assert np.allclose(body.inertia, expected, rtol=1e-3, atol=1e-6 * expected.max())


@given(st.tuples(lengths, lengths, lengths), st.booleans())
def test_boxes_agree_with_their_meshes(sides: Any, hollow: bool) -> None:
    body = World().create_box(1, (0, 0, 0), sides, "oak", hollow=hollow)
    mesh = box_mesh(sides)
    expected = mesh.inertia(body.mass, hollow=True) if hollow else mesh.inertia(body.mass)
    assert math.isclose(body.mass, 800 * mesh.volume, rel_tol=1e-12)
    assert np.allclose(body.inertia, expected, rtol=1e-12, atol=1e-12 * expected.max())


@given(lengths, lengths)
def test_round_sections_are_the_special_case(radius: float, length: float) -> None:
    world = World()
    for hollow in (False, True):
        sphere = world.create_sphere(1, (0, 0, 0), radius, "oak", hollow=hollow)
        ball = world.create_ellipsoid(1, (0, 0, 0), [radius] * 3, "oak", hollow=hollow)
        assert math.isclose(sphere.mass, ball.mass, rel_tol=1e-14)
        assert np.allclose(sphere.inertia, ball.inertia, rtol=1e-12)
    mass = 3.0
    shell = world.create_sphere(1, (0, 0, 0), radius, "oak", hollow=True, mass=mass)
    assert np.allclose(np.diag(shell.inertia), 2 / 3 * mass * radius**2, rtol=1e-12)
    tube = world.create_cylinder(1, (0, 0, 0), radius, length, "oak", hollow=True, mass=mass)
    wall, disc = 2 * math.pi * radius * length, math.pi * radius**2
    axial = mass / (wall + 2 * disc) * (wall * radius**2 + 2 * disc * radius**2 / 2)
    assert math.isclose(tube.inertia[0, 0], axial, rel_tol=1e-12)


def test_given_mass_and_inertia_are_kept() -> None:
    world = World()
    by_mass = world.create_box(1, (0, 0, 0), (1, 2, 3), "oak", mass=12)
    assert by_mass.mass == 12
    assert np.diag(by_mass.inertia).tolist() == [13, 10, 5]
    tensor = [[3, 0.1, 0.2], [0.1, 4, 0.3], [0.2, 0.3, 5]]
    both = world.create_box(1, (0, 0, 0), (1, 2, 3), "oak", mass=0.1, inertia=tensor)
    assert both.inertia.tolist() == tensor
    diagonal = world.create_sphere(1, (0, 0, 0), 1, "oak", inertia=(1, 2, 3))
    assert diagonal.inertia.tolist() == np.diag([1.0, 2, 3]).tolist()
    assert diagonal.mass == world.create_sphere(1, (0, 0, 0), 1, "oak").mass


# --- meshes


def box_mesh(sides: Any, shift: Any = (0, 0, 0)) -> Mesh:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    faces = [
        (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
        (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
    ]  # fmt: skip
    return Mesh(corners * sides + shift, faces)


tetrahedra = st.tuples(*[st.tuples(*[st.floats(-10, 10)] * 3)] * 4)
TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


@given(tetrahedra)
def test_tetrahedra_have_their_closed_forms(corners: Any) -> None:
    a, b, c, d = points = np.array(corners)
    volume = abs(float(np.dot(b - a, np.cross(c - a, d - a)))) / 6
    if volume < 1e-2:
        return
    mesh = Mesh(points, TETRAHEDRON)
    assert math.isclose(mesh.volume, volume, rel_tol=1e-9)
    assert np.allclose(mesh.center, points.mean(axis=0), atol=1e-9 * max(1, 1 / volume))
    # The second moments of a tetrahedron: V/20 Σ over its corners, about the centre.
    local = points - points.mean(axis=0)
    second = volume / 20 * np.einsum("ki,kj->ij", local, local)
    mass = 2.5
    inertia = mass / volume * (np.trace(second) * np.eye(3) - second)
    assert np.allclose(mesh.inertia(mass), inertia, rtol=1e-6, atol=1e-6 * np.trace(inertia))


@given(tetrahedra, st.tuples(*[st.floats(-3, 3)] * 3), st.tuples(*[st.floats(-50, 50)] * 3))
def test_a_mesh_turned_and_moved_turns_its_inertia(corners: Any, angle: Any, shift: Any) -> None:
    points = np.array(corners)
    if abs(np.linalg.det(points[1:] - points[0])) < 0.1:
        return
    turn = rotations.fixed_angles(*angle)
    mesh = Mesh(points, TETRAHEDRON)
    moved = Mesh(rotations.rotate(turn, points) + shift, TETRAHEDRON)
    expected = rotations.rotate_tensor(turn, mesh.inertia(1))
    assert np.allclose(moved.inertia(1), expected, rtol=1e-6, atol=1e-8 * np.trace(expected))
    assert np.allclose(moved.center, rotations.rotate(turn, mesh.center) + shift, atol=1e-6)
    assert math.isclose(moved.volume, mesh.volume, rel_tol=1e-9)


def test_winding_inside_out_does_not_matter() -> None:
    mesh = box_mesh((1, 2, 3), (7, 8, 9))
    flipped = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    assert flipped.volume == mesh.volume
    assert np.allclose(flipped.inertia(1), mesh.inertia(1), rtol=1e-14)


def test_the_position_of_a_mesh_body_is_its_centre_of_mass() -> None:
    world = World()
    mesh = box_mesh((1, 2, 3), (7, 8, 9))
    body = world.create_mesh(1, (0, 0, 4), mesh.vertices, mesh.faces, "oak", convex=True)
    assert body.position.tolist() == [0, 0, 4]
    assert math.isclose(body.mass, 4800, rel_tol=1e-12)
    assert np.allclose(body.inertia, np.diag([5200, 4000, 2000]), atol=1e-8)
    assert np.allclose(body.mesh.center, (7, 8, 9), atol=1e-13)
    assert np.allclose(body.mesh.body_vertices.mean(axis=0), 0, atol=1e-13)
    again = world.create_mesh(2, (9, 0, 4), body.mesh, None, "fir")
    assert again.mesh is body.mesh and len(world.meshes) == 1
    with pytest.raises(ValueError, match="read-only"):
        body.mesh.vertices[0] = 0


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], TETRAHEDRON),
        ([(0, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0)], TETRAHEDRON),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 4)]),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, -1)]),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, math.inf)], TETRAHEDRON),
        ([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], []),
        (np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]) * 1e-200, TETRAHEDRON),
    ],
)
def test_surfaces_without_volume_are_refused(vertices: Any, faces: Any) -> None:
    with pytest.raises(WorldError) as caught:
        World().create_mesh(1, (0, 0, 0), vertices, faces, "iron")
    assert caught.value.findings[0].code == "physics-mesh"

"""Geometries of every kind of polygon, and convex hulls (COLLADA 1.5 §mesh, §convex_mesh)."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mapper.documents import simple

import colladaphy
from colladaphy.mapper.hull import convex_hull
from colladaphy.mapper.tessellation import extent, tessellate
from colladaphy.world import Body, Kind, Mesh, compare

CUBE = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1"
QUADS = ["0 3 2 1", "4 5 6 7", "0 1 5 4", "2 3 7 6", "1 2 6 5", "0 4 7 3"]
VERTEX = '<input semantic="VERTEX" source="#v" offset="0"/>'


def fan(quad: str) -> list[str]:
    a, b, c, d = quad.split()
    return [f"{a} {b} {c}", f"{a} {c} {d}"]


TRIANGLES = [triangle for quad in QUADS for triangle in fan(quad)]

GROUPS = {
    "triangles": f'<triangles count="12">{VERTEX}<p>{" ".join(TRIANGLES)}</p></triangles>',
    "polylist": f'<polylist count="6">{VERTEX}<vcount>{"4 " * 6}</vcount>'
    f"<p>{' '.join(QUADS)}</p></polylist>",
    "polygons": f'<polygons count="6">{VERTEX}'
    + "".join(f"<p>{quad}</p>" for quad in QUADS)
    + "</polygons>",
    "trifans": f'<trifans count="6">{VERTEX}'
    + "".join(f"<p>{quad}</p>" for quad in QUADS)
    + "</trifans>",
    "tristrips": f'<tristrips count="6">{VERTEX}'
    + "".join("<p>{0} {1} {3} {2}</p>".format(*quad.split()) for quad in QUADS)
    + "</tristrips>",
    "two groups": f'<triangles count="6">{VERTEX}<p>{" ".join(TRIANGLES[:6])}</p></triangles>'
    f'<triangles count="6">{VERTEX}<p>{" ".join(TRIANGLES[6:])}</p></triangles>',
    "with normals": f'<triangles count="12">{VERTEX}'
    '<input semantic="NORMAL" source="#src" offset="1"/><p>'
    + " ".join(f"{index} 0" for triangle in TRIANGLES for index in triangle.split())
    + "</p></triangles>",
}


def geometry(group: str, name: str = "mesh", points: str = CUBE, attributes: str = "") -> str:
    count = len(points.split())
    return (
        f'<geometry id="g"><{name}{attributes}><source id="src">'
        f'<float_array id="a" count="{count}">{points}</float_array><technique_common>'
        f'<accessor source="#a" count="{count // 3}" stride="3"><param name="X" type="float"/>'
        '<param name="Y" type="float"/><param name="Z" type="float"/></accessor>'
        '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#src"/>'
        f"</vertices>{group}</{name}></geometry>"
    )


SHAPE = '<shape><density>2</density><instance_geometry url="#g"/></shape>'


def only(data: bytes) -> Body:
    world = colladaphy.read(data).load()
    assert len(world.bodies) == 1
    return world.bodies[0]


@pytest.mark.parametrize("group", list(GROUPS.values()), ids=list(GROUPS))
def test_every_kind_of_polygon(group: str) -> None:
    found = only(simple(SHAPE, geometries=geometry(group)))
    assert found.kind is Kind.MESH
    assert found.mass == pytest.approx(2.0)
    assert np.allclose(found.position, [0.5, 0.5, 0.5])
    assert np.allclose(found.inertia, np.eye(3) / 3.0)
    assert len(found.mesh.faces) == 12
    assert not found.mesh.convex


def test_concave_polygons_are_cut_into_ears() -> None:
    # An L of two by two without one corner, one high: volume 3.
    ring = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    points = " ".join(f"{x} {y} {z}" for z in (0, 1) for x, y in ring)
    sides = [f"{k} {(k + 1) % 6} {(k + 1) % 6 + 6} {k + 6}" for k in range(6)]
    faces = ["5 4 3 2 1 0", "6 7 8 9 10 11", *sides]
    polygons = "".join(f"<p>{face}</p>" for face in faces)
    group = f'<polygons count="8">{VERTEX}{polygons}</polygons>'
    assert only(simple(SHAPE, geometries=geometry(group, points=points))).mass == pytest.approx(6.0)


def test_convex_mesh_and_hull() -> None:
    found = only(simple(SHAPE, geometries=geometry(GROUPS["triangles"], "convex_mesh")))
    assert found.mesh.convex
    hull = '<geometry id="h"><convex_mesh convex_hull_of="#g"/></geometry>'
    data = simple(SHAPE.replace("#g", "#h"), geometries=geometry(GROUPS["triangles"]) + hull)
    document = colladaphy.read(data)
    world = document.load()
    assert world.bodies[0].mass == pytest.approx(2.0)
    assert world.bodies[0].mesh.convex
    assert "load-hull" in [finding.code for finding in document.report]
    points = only(simple(SHAPE, geometries=geometry("", "convex_mesh")))
    assert points.mass == pytest.approx(2.0)


def test_shared_geometry_is_one_mesh() -> None:
    shape = (
        '<shape><mass>1</mass><instance_geometry url="#g"/><translate>{} 0 0</translate></shape>'
    )
    data = simple(shape.format(0) + shape.format(5), geometries=geometry(GROUPS["triangles"]))
    world = colladaphy.read(data).load()
    assert len(world.meshes) == 1
    union = world.bodies[0]
    assert np.allclose(union.position, [3.0, 0.5, 0.5])


@pytest.mark.parametrize(
    "geometries",
    [
        geometry(""),
        geometry(f'<triangles count="1">{VERTEX}<p>0 1 2</p></triangles>'),
        geometry(f'<triangles count="1">{VERTEX}<p>0 1 99</p></triangles>'),
        geometry(f'<lines count="1">{VERTEX}<p>0 1</p></lines>'),
        geometry("", "convex_mesh", attributes=' convex_hull_of="#g"'),
        geometry("", "convex_mesh", points="0 0 0 1 0 0 0 1 0 1 1 0"),
        geometry(GROUPS["triangles"], points="0 0 0 1 0 0"),
    ],
    ids=["empty", "flat", "beyond", "lines", "itself", "flat points", "too few"],
)
def test_geometries_that_enclose_nothing_are_skipped(geometries: str) -> None:
    document = colladaphy.read(simple(SHAPE, geometries=geometries))
    assert len(document.load().bodies) == 0
    codes = [finding.code for finding in document.report]
    assert codes[0] in ("load-no-geometry", "load-empty-shape")
    assert codes[1:] == ["load-body-skipped"]


def edges_of(mesh: Mesh) -> list[tuple[int, int]]:
    return [(face[k], face[(k + 1) % 3]) for face in mesh.faces.tolist() for k in range(3)]


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.integers(4, 40), st.booleans())
def test_hull_holds_all_points(seed: int, count: int, grid: bool) -> None:
    generator = np.random.default_rng(seed)
    points = generator.normal(size=(count, 3))
    if grid:
        points = np.round(points * 2.0)
    hull = convex_hull(points)
    if hull is None:
        return
    mesh = Mesh(*hull, convex=True)
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    distances = points @ normals.T - np.einsum("fi,fi->f", normals, corners[:, 0])
    assert distances.max() < 1e-7
    edges = edges_of(mesh)
    assert len(set(edges)) == len(edges)
    assert all((b, a) in edges for a, b in edges)
    assert all(any((vertex == point).all() for point in points) for vertex in mesh.vertices)


def test_hull_of_a_cube_has_its_volume() -> None:
    corners = np.array([float(x) for x in CUBE.split()]).reshape(-1, 3)
    inner = np.random.default_rng(0).uniform(0.1, 0.9, (100, 3))
    hull = convex_hull(np.concatenate([corners, inner, corners]))
    assert hull is not None
    assert Mesh(*hull).volume == pytest.approx(1.0)
    assert len(hull[0]) == 8


@pytest.mark.parametrize(
    ("kind", "dimensions", "volume"),
    [
        (Kind.SPHERE, (1.0, 0.0, 0.0, 0.0), 4 / 3 * math.pi),
        (Kind.BOX, (1.0, 2.0, 3.0, 0.0), 6.0),
        (Kind.CAPSULE, (0.5, 0.5, 0.5, 2.0), math.pi * (0.5 + 1 / 6)),
        (Kind.CYLINDER, (0.0, 0.5, 1.0, 2.0), math.pi),
        (Kind.ELLIPSOID, (1.0, 2.0, 3.0, 0.0), 8 * math.pi),
    ],
)
def test_tessellations_are_closed_convex_and_large_enough(
    kind: Kind, dimensions: tuple[float, ...], volume: float
) -> None:
    mesh = tessellate(kind, dimensions, 0)
    assert 0.9 * volume < mesh.volume <= volume * (1 + 1e-9)
    hull = convex_hull(mesh.vertices)
    assert hull is not None
    assert Mesh(*hull).volume == pytest.approx(mesh.volume)
    size = extent(kind, dimensions)
    assert size is not None
    assert np.allclose(np.abs(mesh.vertices).max(axis=0), size)
    edges = edges_of(mesh)
    assert len(set(edges)) == len(edges)
    assert all((b, a) in set(edges) for a, b in edges)


def test_a_comment_inside_an_array_does_not_cut_it_short() -> None:
    world = colladaphy.World()
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    world.create_mesh(1, (0, 0, 0), vertices, faces, "iron")
    stored = io.BytesIO()
    colladaphy.write(world, stored)
    data = stored.getvalue().replace(b"<p>0 2", b"<p>0 <!-- here -->2")
    data = data.replace(b' count="12">0 0', b' count="12">0 <!-- here -->0')
    assert data.count(b"<!-- here -->") == 2
    assert compare(colladaphy.read(data).load(), world) == []

"""Numbers that were wrong once, against values worked out by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy
from colladaphy.world import World


def load(shapes: str, values: str = "", **options: Any) -> tuple[World, list[str]]:
    data = collada(model(body(shapes=shapes, values=values)), scene(instance()), **options)
    document = colladaphy.read(data)
    world = document.load()
    return world, [finding.code for finding in document.report.findings]


def mesh(points: str, faces: str) -> str:
    count = len(points.split())
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return (
        f'<geometry id="g"><mesh><source id="p"><float_array id="a" count="{count}">{points}'
        f'</float_array><technique_common><accessor source="#a" count="{count // 3}" stride="3">'
        f'{axes}</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" '
        f'source="#p"/></vertices>{faces}</mesh></geometry>'
    )


INPUT = '<input semantic="VERTEX" source="#v" offset="0"/>'
SHAPE = '<shape><density>{}</density><instance_geometry url="#g"/></shape>'


def test_the_inertia_of_an_off_centre_frame_goes_with_the_mass_of_the_body() -> None:
    shape = "<shape><box><half_extents>1 1 1</half_extents></box></shape>"
    frame = "<mass_frame><translate>0 -0.5 0</translate></mass_frame>"
    (made,) = load(shape, f"<mass>10</mass>{frame}")[0].bodies
    # 10/12 · 8 about its own centre, and 10 · 0.25 for half a unit to the side.
    assert np.allclose(made.inertia, np.diag((55 / 6, 20 / 3, 55 / 6)), rtol=1e-12)
    assert np.allclose(made.position, (0, -0.5, 0))


@pytest.mark.parametrize("more", ["", "<shape><sphere><radius>1</radius></sphere></shape>"])
def test_a_frame_without_a_translation_stands_at_the_origin(more: str) -> None:
    shape = (
        "<shape><mass>1</mass><box><half_extents>1 1 1</half_extents></box>"
        "<translate>5 0 0</translate></shape>"
    )
    frame = "<mass_frame><rotate>0 0 1 90</rotate></mass_frame>"
    (made,) = load(shape + more, f"<mass>3</mass>{frame}<inertia>1 2 3</inertia>")[0].bodies
    assert made.position.tolist() == [0.0, 0.0, 0.0]
    assert np.allclose(made.inertia, np.diag((2, 1, 3)), atol=1e-12)


def test_a_hollow_mesh_has_the_centre_of_its_surface() -> None:
    faces = f'<triangles count="4">{INPUT}<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>'
    geometry = mesh("0 0 0 4 0 0 0 1 0 0 0 1", faces)
    shape = '<shape><hollow>true</hollow><mass>1</mass><instance_geometry url="#g"/></shape>'
    (made,) = load(shape, geometries=geometry)[0].bodies
    corners = np.array([(0, 0, 0), (4, 0, 0), (0, 1, 0), (0, 0, 1)], dtype=float)
    triangles = corners[[(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]]
    areas = np.linalg.norm(
        np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1
    )
    center = (areas[:, None] * triangles.mean(axis=1)).sum(axis=0) / areas.sum()
    assert np.allclose(made.position, center, rtol=1e-12)
    assert made.position[0] == pytest.approx(1.24, abs=0.005)


def test_holes_of_polygons_are_holes() -> None:
    points = " ".join(
        f"{x} {y} {z}"
        for z in (0, 3)
        for size in (1.0, 0.5)
        for x, y in ((-size, -size), (size, -size), (size, size), (-size, size))
    )
    sides = "".join(
        f"<p>{text}</p>"
        for text in ("3 0 8 11", "4 7 15 12", "2 3 11 10", "7 6 14 15", "1 2 10 9", "6 5 13 14",
                     "0 1 9 8", "5 4 12 13")
    )  # fmt: skip
    ends = "<ph><p>3 2 1 0</p><h>4 5 6 7</h></ph><ph><p>8 9 10 11</p><h>15 14 13 12</h></ph>"
    geometry = mesh(points, f'<polygons count="10">{INPUT}{sides}{ends}</polygons>')
    world, codes = load(SHAPE.format(100), geometries=geometry)
    (made,) = world.bodies
    assert made.mass == pytest.approx(900, rel=1e-12)
    assert np.allclose(made.position, (0, 0, 1.5), atol=1e-12)
    assert np.allclose(made.inertia, np.diag((1050, 1050, 750)), atol=1e-9)
    assert "load-mesh-open" not in codes


def test_the_hull_of_a_mesh_that_is_not_closed_counts_and_that_is_said() -> None:
    points = " ".join(
        f"{x} {y} {z}" for x in (-0.5, 0.5) for y in (-0.25, 0.25) for z in (-0.75, 0.75)
    )
    faces = "0 1 3 0 3 2 4 6 7 4 7 5 0 4 5 0 5 1 2 3 7 2 7 6 0 2 6 0 6 4"  # without the top
    geometry = mesh(points, f'<triangles count="10">{INPUT}<p>{faces}</p></triangles>')
    world, codes = load(SHAPE.format(1000), geometries=geometry)
    (made,) = world.bodies
    assert made.mass == pytest.approx(750, rel=1e-12)
    assert np.allclose(made.position, 0, atol=1e-12)
    assert np.allclose(made.inertia, np.diag((156.25, 203.125, 78.125)), atol=1e-9)
    assert "load-mesh-open" in codes


@pytest.mark.parametrize(
    ("up", "position", "velocity"),
    [("Y_UP", (-5, 4, 6), (-2, 1, 3)), ("Z_UP", (-5, -6, 4), (-2, -3, 1))],
)
def test_what_is_right_of_x_up_stays_right(up: str, position: Any, velocity: Any) -> None:
    data = collada(
        model(body()), scene(instance(values="<velocity>1 2 3</velocity>")),
        '<node id="n"><translate>4 5 6</translate></node>', up_axis="X_UP",
    )  # fmt: skip
    (made,) = colladaphy.read(data).load(up_axis=up).bodies
    assert np.allclose(made.position, position)
    assert np.allclose(made.linear_velocity, velocity)

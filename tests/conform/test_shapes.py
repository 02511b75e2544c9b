"""Shapes that 1.5 spells otherwise, or not at all."""

from __future__ import annotations

import numpy as np
import pytest
from lxml import etree
from tests.conform.documents import (
    BOX,
    MESH,
    C,
    codes,
    document,
    kept,
    mended,
    names,
    physics,
    words,
)


def shape(inner: str) -> str:
    return f"<shape>{inner}</shape>"


@pytest.mark.parametrize(
    ("old", "new"),
    [("0.5 0.5", "0.5 0.5 0.5"), ("0.5", "0.5 0.5 0.5"), ("0.5 0.25", "0.5 0.5 0.25")],
)
def test_a_capsule_of_1_4_gets_three_radii(old: str, new: str) -> None:
    solid = f"<capsule><height>2</height><radius>{old}</radius></capsule>"
    root, findings = mended(physics(shape(solid), version="1.4.1"))
    assert " ".join(words(root, "capsule/radius")) == new
    assert "upgrade-capsule-radius" in codes(findings)


def test_equal_radii_of_a_sphere_are_one() -> None:
    root, findings = mended(physics(shape("<sphere><radius>2.0 2.0 2.0</radius></sphere>")))
    assert words(root, "sphere/radius") == ["2.0"]
    assert codes(findings) == {"repair-sphere-radius"}


def mesh_of(root: etree._Element, url: str) -> tuple[np.ndarray, np.ndarray]:
    geometry = next(g for g in root.iter(C + "geometry") if g.get("id") == url.lstrip("#"))
    points = np.array((geometry.findtext(f".//{C}float_array") or "").split(), float).reshape(-1, 3)
    faces = np.array((geometry.findtext(f".//{C}p") or "").split(), int).reshape(-1, 3)
    return points, faces


def volume(points: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (points[faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def is_closed(faces: np.ndarray) -> bool:
    edges = {(int(f[i]), int(f[(i + 1) % 3])) for f in faces for i in range(3)}
    return len(edges) == 3 * len(faces) and all((b, a) in edges for a, b in edges)


@pytest.mark.parametrize(
    ("solid", "exact", "top", "bottom"),
    [
        (
            "<tapered_cylinder><height>2</height><radius1>1 1</radius1><radius2>3 3</radius2>"
            "</tapered_cylinder>",
            np.pi * 2 / 3 * (1 + 3 + 9),
            1.0,
            -1.0,
        ),
        (
            "<tapered_cylinder><height>3</height><radius1>0 0</radius1><radius2>1 2</radius2>"
            "</tapered_cylinder>",
            np.pi * 1 * 2,
            1.5,
            -1.5,
        ),
        (
            "<tapered_capsule><height>2</height><radius1>1 1</radius1><radius2>1 1</radius2>"
            "</tapered_capsule>",
            np.pi * (2 + 4 / 3),
            2.0,
            -2.0,
        ),
    ],
)
def test_solids_without_an_element_become_closed_convex_meshes(
    solid: str, exact: float, top: float, bottom: float
) -> None:
    root, findings = mended(physics(shape(solid), version="1.4.1"))
    url = next(root.iter(C + "instance_geometry")).get("url", "")
    points, faces = mesh_of(root, url)
    assert is_closed(faces)
    assert exact * 0.97 < volume(points, faces) < exact
    assert (points[:, 1].max(), points[:, 1].min()) == pytest.approx((top, bottom))
    assert etree.QName(etree.fromstring(solid)).localname in kept(root)
    assert any("#" in finding.message for finding in findings)
    assert "upgrade-tapered-shape" in codes(findings)


@pytest.mark.parametrize(
    ("solid", "code"),
    [
        ("<sphere><radius>1 2 3</radius></sphere>", "repair-sphere-radius"),
        ("<ellipsoid><size>2 4 6</size></ellipsoid>", "repair-inline-mesh"),
    ],
)
def test_ellipsoids_become_capsules_without_height(solid: str, code: str) -> None:
    root, findings = mended(physics(shape(solid), version="1.4.1"))
    capsule = next(root.iter(C + "capsule"))
    assert float(capsule.findtext(C + "height") or "") == 0.0
    assert [float(word) for word in (capsule.findtext(C + "radius") or "").split()] == [1, 2, 3]
    assert etree.QName(etree.fromstring(solid)).localname in kept(root)
    assert code in codes(findings)


def test_a_tapered_capsule_is_the_hull_of_its_caps() -> None:
    solid = (
        "<tapered_capsule><height>4</height><radius1>1 1</radius1><radius2>2 2</radius2>"
        "</tapered_capsule>"
    )
    root, _ = mended(physics(shape(solid), version="1.4.1"))
    points, _ = mesh_of(root, next(root.iter(C + "instance_geometry")).get("url", ""))
    on_upper = np.abs(np.linalg.norm(points - [0, 2, 0], axis=1) - 1) < 1e-9
    on_lower = np.abs(np.linalg.norm(points - [0, -2, 0], axis=1) - 2) < 1e-9
    assert np.all(on_upper | on_lower)
    assert points[on_upper & ~on_lower][:, 1].min() >= 2 - 1e-9 + 0.25  # the cone touches above
    assert (points[:, 1].max(), points[:, 1].min()) == pytest.approx((3, -4))


def test_an_instance_inside_a_mesh_comes_out_of_it() -> None:
    solid = '<mesh><instance_geometry url="#g"/></mesh>'
    root, findings = mended(physics(shape(solid), version="1.4.1"))
    assert names(root, "shape") == ["instance_geometry"]
    assert "repair-inline-mesh" in codes(findings)


def test_a_mesh_in_a_shape_becomes_a_geometry() -> None:
    root, findings = mended(physics(shape(f"<mesh>{MESH.format('m')}</mesh>"), version="1.4.1"))
    url = next(root.iter(C + "instance_geometry")).get("url", "")
    assert mesh_of(root, url)[0].shape == (4, 3)
    assert "repair-inline-mesh" in codes(findings)


def test_one_number_is_taken_for_all() -> None:
    solids = shape("<box><half_extents>2</half_extents></box>") + shape(
        "<cylinder><radius>1.5</radius><height>2</height></cylinder>"
    )
    root, findings = mended(physics(solids))
    assert words(root, "half_extents") == ["2", "2", "2"]
    assert words(root, "cylinder/radius") == ["1.5", "1.5"]
    assert codes(findings) == {"repair-shape-size", "repair-child-order"}


def test_half_extents_are_often_misspelt() -> None:
    solid = shape("<box><half_extends>1 2 3</half_extends></box>")
    root, findings = mended(physics(solid))
    assert words(root, "box/half_extents") == ["1", "2", "3"]
    assert codes(findings) == {"repair-misspelt-element"}


def test_an_empty_shape_beside_others_goes() -> None:
    root, findings = mended(physics(BOX + "<shape/>"))
    assert names(root, "rigid_body/technique_common") == ["shape"]
    assert codes(findings) == {"repair-empty-shape"}


def test_a_shape_of_two_geometries_becomes_two() -> None:
    inner = (
        "<hollow>false</hollow><sphere><radius>1</radius></sphere>"
        "<sphere><radius>2</radius></sphere><translate>1 2 3</translate>"
    )
    root, findings = mended(physics(shape(inner)))
    assert [radius.text for radius in root.iter(C + "radius")] == ["1", "2"]
    assert [t.text for t in root.iter(C + "translate")] == ["1 2 3", "1 2 3"]
    assert codes(findings) == {"repair-shape-split"}


VISUAL = (
    '<library_geometries><geometry id="g"><mesh>' + MESH.format("g") + "</mesh></geometry>"
    "</library_geometries>"
)


def test_a_body_without_a_shape_gets_the_geometry_of_its_node() -> None:
    tree = physics(
        "<mass>3</mass>",
        nodes='<node id="n1"><translate>9 9 9</translate><node><translate>1 0 0</translate>'
        '<instance_geometry url="#g"/></node></node>',
    )
    root = tree.getroot()
    library = document(VISUAL).getroot()[1]
    root.insert(1, library)
    result, findings = mended(tree)
    assert names(result, "rigid_body/technique_common") == ["mass", "shape"]
    assert names(result, "shape") == ["instance_geometry", "translate", "extra"]
    assert words(result, "shape/translate") == ["1", "0", "0"]
    assert "assumed" in kept(result)
    assert [f.code for f in findings] == ["repair-missing-shape"]
    assert "#g" in findings[0].message


def test_a_body_without_anything_to_show_gets_a_marked_hull_of_nothing() -> None:
    bodies = "".join(
        f'<rigid_body sid="b{i}"><technique_common><mass>3</mass></technique_common></rigid_body>'
        for i in (1, 2)
    )
    root, findings = mended(physics(bodies=bodies))
    assert list(root.iter(C + "sphere")) == []
    (geometry,) = root.iter(C + "geometry")
    assert [len(hull) for hull in geometry.iterchildren(C + "convex_mesh")] == [0]
    shapes = list(root.iter(C + "shape"))
    assert [shape.find(C + "instance_geometry").get("url") for shape in shapes] == [
        f"#{geometry.get('id')}"
    ] * 2
    assumed = root.findall(".//{urn:colladaphy:conform:1}assumed")
    assert [mark.get("from") for mark in assumed] == ["nothing", "nothing"]
    assert [f.code for f in findings] == ["repair-missing-shape"] * 2


def test_a_geometry_without_content_stays_referable() -> None:
    root, findings = mended(document('<library_geometries><geometry id="g"/></library_geometries>'))
    assert names(root, "geometry") == ["convex_mesh"]
    assert codes(findings) == {"repair-empty-geometry"}


def test_a_body_whose_only_shape_cannot_be_read_stays_a_body() -> None:
    root, findings = mended(physics(shape("<sphere><radius>big</radius></sphere>")))
    assert [body.get("sid") for body in root.iterfind(f".//{C}physics_model/{C}rigid_body")] == [
        "b1"
    ]
    assert "big" in kept(root)
    assert "assumed" in kept(root)
    assert codes(findings) >= {"repair-unreadable-value", "repair-missing-element"}

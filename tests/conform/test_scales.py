"""Scaled and mirrored nodes: the scale goes to shapes, and what is shown stays where it was."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from tests.conform.bullet.standard_reader import visuals
from tests.conform.documents import BOX, MESH, C, codes, document, mended, physics, words

from colladaphy.conform.frames import Matrix, transform_of

CORNERS = np.array([(x, y, z, 1) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
USER = '<instance_rigid_body body="b{0}" target="#n{0}"><technique_common/></instance_rigid_body>'


def with_mesh(tree: etree._ElementTree, mesh: str | None = None) -> etree._ElementTree:
    content = mesh or MESH.format("g")
    library = document(
        f'<library_geometries><geometry id="g"><mesh>{content}</mesh></geometry>'
        "</library_geometries>"
    ).getroot()[1]
    tree.getroot().insert(1, library)
    return tree


def world(node: etree._Element) -> Matrix:
    """The transform of a node, all above it included."""
    above = [node, *node.iterancestors(C + "node")]
    result = np.eye(4)
    for one in reversed(above):
        result = result @ transform_of(one)
    return result


def node_of(root: etree._Element, name: str = "n1") -> etree._Element:
    return root.find(f".//{C}node[@id='{name}']")


def corners(root: etree._Element) -> Matrix:
    """The corners of the only box, in the world."""
    size = [float(word) for word in words(root, "half_extents")]
    shape = root.find(f".//{C}shape")
    points = CORNERS * [*size, 1.0]
    return points @ (world(node_of(root)) @ transform_of(shape)).T


def same_points(one: Matrix, other: Matrix) -> bool:
    return all(np.abs(other - point).max(axis=1).min() < 1e-6 for point in one)


number = st.floats(-3, 3).map(lambda value: round(value, 3))
moves = st.tuples(number, number, number).map(
    lambda t: f"<translate>{t[0]} {t[1]} {t[2]}</translate>"
)
turns = st.tuples(st.integers(-9, 9), st.integers(-180, 180)).map(
    lambda t: f"<rotate>1 {t[0]} 2 {t[1]}</rotate>"
)
sizes = st.sampled_from([0.01, 0.5, 2.0, -1.0, 25.0])
scales = sizes.map(lambda s: f"<scale>{s} {s} {s}</scale>")
matrices = st.tuples(sizes, number).map(
    lambda t: f"<matrix>0 {-t[0]} 0 {t[1]} {t[0]} 0 0 1 0 0 {t[0]} 2 0 0 0 1</matrix>"
)
transforms = st.lists(st.one_of(moves, turns, scales, matrices), max_size=4).map("".join)


@given(transforms, transforms, moves)
def test_shapes_are_where_they_were_seen_and_nodes_are_rigid(
    outer: str, inner: str, place: str
) -> None:
    nodes = (
        f'<node id="top">{outer}<instance_geometry url="#g"/><node id="n1">{inner}'
        '<instance_geometry url="#g"/><node id="x"><translate>1 0 0</translate>'
        '<instance_geometry url="#g"/></node></node></node>'
    )
    shape = f"<shape><box><half_extents>1 2 3</half_extents></box>{place}</shape>"
    tree = with_mesh(physics(shape, nodes=nodes))
    before = corners(tree.getroot())
    seen = visuals(tree.getroot())
    root, _ = mended(tree)
    assert same_points(before, corners(root))
    linear = world(node_of(root))[:3, :3]
    assert linear.T @ linear == pytest.approx(np.eye(3), abs=1e-6)
    assert np.linalg.det(linear) > 0
    rest = visuals(root)
    assert len(rest) == len(seen)
    for url, where in seen:
        assert any(url == u and np.allclose(where, w, atol=1e-6) for u, w in rest)


def test_the_scale_of_a_parent_counts() -> None:
    nodes = (
        '<node><scale>0.01 0.01 0.01</scale><node id="n1"><translate>100 0 0</translate></node>'
        "</node>"
    )
    root, findings = mended(physics(BOX, nodes=nodes))
    assert world(node_of(root))[:3, 3] == pytest.approx([1, 0, 0])
    assert [float(w) for w in words(root, "half_extents")] == pytest.approx([0.01, 0.02, 0.03])
    assert codes(findings) == {"repair-scaled-node"}
    assert "0.01" in findings[0].message


SOLIDS = [
    ("<box><half_extents>1 2 3</half_extents></box>", "half_extents", [2, 6, 12]),
    ("<cylinder><height>1</height><radius>1 3</radius></cylinder>", "radius", [2, 12]),
    ("<cylinder><height>1</height><radius>1 3</radius></cylinder>", "height", [3]),
    ("<capsule><height>1</height><radius>1 1 3</radius></capsule>", "radius", [2, 3, 12]),
    ("<plane><equation>0 1 0 -6</equation></plane>", "equation", [0, 1 / 3, 0, -6]),
]


@pytest.mark.parametrize(("solid", "name", "numbers"), SOLIDS)
def test_a_scale_that_differs_by_axis(solid: str, name: str, numbers: list[float]) -> None:
    body = (
        "<mass>1</mass><mass_frame><translate>1 1 1</translate></mass_frame>"
        f"<shape>{solid}<translate>1 1 1</translate></shape>"
    )
    root, findings = mended(physics(body, nodes='<node id="n1"><scale>2 3 4</scale></node>'))
    assert [float(w) for w in words(root, name)] == pytest.approx(numbers)
    for path in ("shape/translate", "mass_frame/translate"):
        assert [float(w) for w in words(root, path)] == [2, 3, 4]
    assert codes(findings) == {"repair-scaled-node"}


def test_a_sphere_becomes_an_ellipsoid() -> None:
    sphere = "<shape><sphere><radius>2</radius></sphere><translate>1 0 0</translate></shape>"
    root, _ = mended(physics(sphere, nodes='<node id="n1"><scale>2 -3 4</scale></node>'))
    assert [float(word) for word in words(root, "capsule/radius")] == [4, 6, 8]
    assert words(root, "capsule/height") == ["0"]
    assert words(root, "shape/translate")[0] == "2"
    root, _ = mended(physics(sphere, nodes='<node id="n1"><scale>-2 2 2</scale></node>'))
    assert words(root, "sphere/radius") == ["4"]


def volume(root: etree._Element, url: str) -> float:
    geometry = root.find(f".//{C}geometry[@id='{url[1:]}']")
    points = np.array(geometry.findtext(f".//{C}float_array").split(), float).reshape(-1, 3)
    faces = np.array(geometry.findtext(f".//{C}p").split(), int).reshape(-1, 3)
    a, b, c = np.moveaxis(points[faces], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("factor", ["-1 1 1", "2 2 2", "-2 -2 -2", "1 2 3"])
def test_meshes_are_copied_scaled_and_keep_their_outside(factor: str) -> None:
    numbers = np.array(factor.split(), float)
    shape = '<shape><instance_geometry url="#g"/><translate>1 2 3</translate></shape>'
    nodes = f'<node id="n1"><scale>{factor}</scale><instance_geometry url="#g"/></node>'
    tree = with_mesh(physics(shape, nodes=nodes))
    before = volume(tree.getroot(), "#g")
    root, findings = mended(tree)
    url = root.find(f".//{C}shape/{C}instance_geometry").get("url")
    assert url != "#g"
    assert before > 0
    assert volume(root, url) == pytest.approx(before * abs(np.prod(numbers)))
    assert volume(root, "#g") == before
    assert root.find(f".//{C}node//{C}instance_geometry").get("url") == "#g"
    assert [float(w) for w in words(root, "shape/translate")] == (numbers * (1, 2, 3)).tolist()
    assert codes(findings) == {"repair-scaled-node"}


def test_anchors_of_joints_are_scaled_with_their_bodies() -> None:
    joint = (
        '<rigid_constraint sid="j"><ref_attachment rigid_body="pm/b1"><translate>1 0 0</translate>'
        '</ref_attachment><attachment rigid_body="pm/b2"><translate>-1 0 0</translate>'
        "</attachment><technique_common/></rigid_constraint>"
    )
    bodies = "".join(
        f'<rigid_body sid="b{i}"><technique_common>{BOX}</technique_common></rigid_body>'
        for i in (1, 2)
    )
    nodes = (
        '<node id="n1"><scale>5 5 5</scale></node><node id="n2"><translate>6 0 0</translate></node>'
    )
    instances = USER.format(1) + USER.format(2)
    root, _ = mended(physics(bodies=bodies, more=joint, instances=instances, nodes=nodes))
    places = [
        world(node_of(root, name)) @ transform_of(root.find(f".//{C}{end}"))
        for name, end in (("n1", "ref_attachment"), ("n2", "attachment"))
    ]
    assert places[0][:3, 3] == pytest.approx(places[1][:3, 3])


@pytest.mark.parametrize(
    ("nodes", "body"),
    [
        ('<node id="n1"><scale>1 2 1</scale><rotate>0 0 1 30</rotate></node>', BOX),
        ('<node id="n1"><skew>45 1 0 0 0 1 0</skew><scale>2 2 2</scale></node>', BOX),
        ('<node id="n1"><scale>0 1 1</scale></node>', BOX),
        (
            '<node id="n1"><scale>1 2 1</scale></node>',
            BOX.replace("</shape>", "<rotate>0 0 1 30</rotate></shape>"),
        ),
    ],
)
def test_what_cannot_be_scaled_stays_for_the_reader_to_see(nodes: str, body: str) -> None:
    tree = physics(body, nodes=nodes)
    root, findings = mended(tree)
    assert etree.tostring(root) == etree.tostring(tree.getroot())
    assert findings == []


def test_a_body_that_is_there_in_two_sizes_is_left() -> None:
    nodes = '<node id="n1"><scale>2 2 2</scale></node><node id="n2"><scale>3 3 3</scale></node>'
    users = USER.format(1) + USER.format(1).replace("#n1", "#n2")
    root, findings = mended(physics(BOX, nodes=nodes, instances=users))
    assert words(root, "half_extents") == ["1", "2", "3"]
    assert findings == []


def test_a_scale_of_one_is_none() -> None:
    nodes = '<node id="n1"><scale>1 1 1</scale><instance_node url="#n2"/></node><node id="n2"/>'
    assert mended(physics(BOX, nodes=nodes))[1] == []


def test_a_scale_goes_through_the_only_instance_of_a_node() -> None:
    nodes = '<node id="top"><scale>2 2 2</scale><instance_node url="#n1"/></node>'
    library = (
        '<library_nodes><node id="n1"><translate>1 0 0</translate>'
        '<instance_geometry url="#g"/></node></library_nodes>'
    )
    tree = with_mesh(physics(BOX, nodes=nodes))
    tree.getroot().insert(1, document(library).getroot()[1])
    seen = visuals(tree.getroot())
    root, findings = mended(tree)
    assert [float(w) for w in words(root, "half_extents")] == [2, 4, 6]
    assert codes(findings) == {"repair-scaled-node"}
    top, node = node_of(root, "top"), node_of(root)
    assert transform_of(top) == pytest.approx(np.eye(4))
    assert transform_of(node)[:3, 3] == pytest.approx([2, 0, 0])
    assert [url for url, _ in visuals(root)] == [url for url, _ in seen]
    assert visuals(root)[0][1] == pytest.approx(seen[0][1])


def test_a_node_that_is_there_twice_in_two_sizes_is_left() -> None:
    nodes = (
        '<node><scale>2 2 2</scale><instance_node url="#n1"/></node>'
        '<node><instance_node url="#n1"/></node>'
    )
    tree = physics(BOX, nodes=nodes)
    tree.getroot().insert(
        1, document('<library_nodes><node id="n1"/></library_nodes>').getroot()[1]
    )
    root, findings = mended(tree)
    assert words(root, "half_extents") == ["1", "2", "3"]
    assert findings == []

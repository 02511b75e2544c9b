from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from lxml import etree
from tests.conform.bullet import bullet_reader
from tests.conform.bullet.conftest import Export
from tests.conform.bullet.scenes import NS15

from colladaphy.conform.bullet import MARK, for_bullet, rules
from colladaphy.findings import Rule

N = {"c": "http://www.collada.org/2005/11/COLLADASchema"}
BOX = "<shape><box><half_extents>1 1 1</half_extents></box></shape>"
USER = "<instance_rigid_body body='b' target='#n'><technique_common/></instance_rigid_body>"


def body(shapes: str = BOX, before: str = "", after: str = "", sid: str = "b") -> str:
    return (
        f"<rigid_body sid='{sid}'><technique_common>{before}{shapes}</technique_common>{after}"
        "</rigid_body>"
    )


def document(
    bodies: str = "",
    users: str = USER,
    nodes: str = "<node id='n'/>",
    libraries: str = "",
    asset: str = "",
    constraints: str = "",
) -> bytes:
    return (
        f"<COLLADA xmlns='{NS15}' version='1.5.0'><asset><created>2024-01-01T00:00:00Z</created>"
        f"<modified>2024-01-01T00:00:00Z</modified>{asset}</asset>{libraries}"
        f"<library_physics_models><physics_model id='m'>{bodies or body()}{constraints}"
        "</physics_model></library_physics_models><library_visual_scenes><visual_scene id='v'>"
        f"{nodes}</visual_scene></library_visual_scenes><library_physics_scenes>"
        f"<physics_scene id='s'><instance_physics_model url='#m'>{users}</instance_physics_model>"
        "<technique_common><gravity>0 -9.81 0</gravity></technique_common></physics_scene>"
        "</library_physics_scenes><scene><instance_physics_scene url='#s'/>"
        "<instance_visual_scene url='#v'/></scene></COLLADA>"
    ).encode()


def codes(findings: list[Any]) -> list[str]:
    return [finding.code.removeprefix("downgrade-bullet-") for finding in findings]


def test_a_plain_scene_needs_no_change(export: Export) -> None:
    text, findings = export(
        document(
            nodes="<node id='n'><translate sid='t'>0 0.1 3</translate><rotate>0 0 1 30</rotate>"
            "<instance_geometry url='#g'/></node>",
            asset="<up_axis>Z_UP</up_axis>",
            bodies=body(before="<dynamic>true</dynamic><mass>2</mass>"),
        )
    )
    assert findings == []
    assert b'<translate sid="t">0 0.1 3</translate><rotate>0 0 1 30</rotate>' in text
    root = etree.fromstring(text)
    assert [mark.text for mark in root.iter(MARK)] == ["Bullet"]


def test_the_mark_replaces_that_of_a_convention_turned_back(export: Export) -> None:
    mark = "<convention xmlns='urn:colladaphy:conform:1'>bullet</convention>"
    extra = f"<extra><technique profile='colladaphy'>{mark}</technique></extra>"
    text, _ = export(document(asset=extra))
    assert b"convention" not in text


def test_the_instanced_scene_is_the_only_one(export: Export) -> None:
    other = (
        "<library_physics_scenes><physics_scene id='x'><technique_common>"
        "<gravity>9 9 9</gravity></technique_common></physics_scene></library_physics_scenes>"
    )
    data = document(libraries=other).replace(
        b"<scene>", b"<scene><instance_physics_scene url='#s'/><instance_physics_scene url='#x'/>"
    )
    text, findings = export(
        data.replace(b"<instance_physics_scene url='#s'/><instance_vis", b"<instance_vis")
    )
    world = bullet_reader.read(text)
    assert list(world.gravity) == [0, -9.81, 0]
    assert len(world.bodies) == 1
    assert "scene-removed" in codes(findings)
    assert etree.fromstring(text).xpath("count(//c:instance_physics_scene)", namespaces=N) == 1
    assert etree.fromstring(text).xpath("count(//c:library_physics_scenes)", namespaces=N) == 1


def test_a_document_without_physics(export: Export) -> None:
    data = (
        f"<COLLADA xmlns='{NS15}' version='1.5.0'><asset><created>2024-01-01T00:00:00Z</created>"
        "<modified>2024-01-01T00:00:00Z</modified></asset></COLLADA>"
    )
    _, findings = export(data.encode())
    assert codes(findings) == ["no-scene"]


def test_gravity_and_unit_are_said(export: Export) -> None:
    data = document(asset="<unit name='centimeter' meter='0.01'/>")
    text, findings = export(data.replace(b"<gravity>0 -9.81 0</gravity>", b""))
    assert {"gravity", "unit"} <= {*codes(findings)}
    assert not bullet_reader.read(text).gravity.any()
    assert etree.fromstring(text).findtext("c:asset/c:up_axis", None, N) == "Y_UP"


def test_a_body_instanced_twice_becomes_two(export: Export) -> None:
    twice = USER + USER.replace("#n", "#o").replace(
        "<technique_common/>", "<technique_common><mass>5</mass></technique_common>"
    )
    text, findings = export(
        document(
            users=twice, nodes="<node id='n'/><node id='o'><translate>9 0 0</translate></node>"
        )
    )
    first, second = bullet_reader.read(text).bodies
    assert (first.sid, second.sid) == ("b", "b-2")
    assert (first.mass, second.mass) == (8.0, 5.0)
    assert second.pose[0, 3] == 9
    assert "body-copied" in codes(findings)


def test_what_is_not_there_is_left_out(export: Export) -> None:
    users = USER + USER.replace("'b'", "'gone'")
    users += "<instance_rigid_constraint constraint='gone'/>"
    data = document(users=users).replace(
        b"</instance_physics_model>",
        b"</instance_physics_model><instance_physics_model url='other.dae#m'/>",
    )
    text, findings = export(data)
    world = bullet_reader.read(text)
    assert len(world.bodies) == 1
    assert world.lost == []
    assert {"no-body", "constraint", "external"} <= {*codes(findings)}


def test_a_model_that_holds_itself_ends(export: Export) -> None:
    text, findings = export(document(constraints="<instance_physics_model url='#m'/>"))
    assert len(bullet_reader.read(text).bodies) == 1
    assert "external" in codes(findings)


# -- bodies -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("before", "shape", "mass", "code"),
    [
        ("<mass>INF</mass>", BOX, 0.0, "static"),
        ("<mass>0</mass>", BOX, 1.0, "mass-unknown"),
        ("", BOX.replace("<box", "<density>INF</density><box"), 0.0, "static"),
        ("", BOX.replace("1 1 1", "0 1 1"), 1.0, "mass-unknown"),
        ("", BOX, 8.0, "mass"),
        ("", "<shape><plane><equation>0 1 0 0</equation></plane></shape>", 0.0, "static"),
    ],
)
def test_masses(export: Export, before: str, shape: str, mass: float, code: str) -> None:
    text, findings = export(document(bodies=body(shape, before)))
    assert bullet_reader.read(text).bodies[0].mass == mass
    assert code in codes(findings)


def test_the_density_of_a_material_of_the_pe_profile(export: Export) -> None:
    material = (
        "<library_physics_materials><physics_material id='iron'><technique_common/>"
        "<technique profile='pe'><density>7874</density></technique></physics_material>"
        "</library_physics_materials>"
    )
    shape = BOX.replace("<shape>", "<shape><instance_physics_material url='#iron'/>")
    text, findings = export(document(bodies=body(shape), libraries=material))
    assert bullet_reader.read(text).bodies[0].mass == 8 * 7874
    assert "ignored" in codes(findings)


def test_a_centre_of_mass_beside_the_shape_makes_a_compound(export: Export) -> None:
    frame = "<mass_frame><translate>0 0.5 0</translate></mass_frame><inertia>1 2 3</inertia>"
    text, _ = export(document(bodies=body(before="<mass>1</mass>" + frame)))
    found = bullet_reader.read(text).bodies[0]
    assert found.compound
    assert list(found.pose[:3, 3]) == [0, 0.5, 0]
    assert np.allclose(found.pose @ found.shapes[0].local, np.eye(4))
    moved = etree.fromstring(text).find(".//c:mass_frame/c:translate", N)
    assert moved is not None
    assert [float(x) for x in (moved.text or "").split()] == [0, 0, 0]


def test_an_inertia_keeps_its_axes_when_the_frame_turns(export: Export) -> None:
    shape = BOX.replace("</shape>", "<rotate>0 0 1 90</rotate></shape>")
    text, _ = export(document(bodies=body(shape, "<mass>1</mass><inertia>1 2 3</inertia>")))
    root = etree.fromstring(text)
    assert not bullet_reader.read(text).bodies[0].compound
    turned = root.findtext(".//c:mass_frame/c:rotate", "", N)
    assert [float(x) for x in turned.split()] == pytest.approx([0, 0, -1, 90])


def test_kinematic_is_renamed(export: Export) -> None:
    extra = (
        "<extra><technique profile='PhysX'><kinematic a='1'>true</kinematic></technique></extra>"
    )
    text, findings = export(document(bodies=body(before="<mass>1</mass>", after=extra)))
    assert bullet_reader.read(text).bodies[0].mass == 1.0
    assert "kinematic" in codes(findings)
    assert b"<kinematic" not in text
    assert b'name="kinematic"' in text


# -- nodes ------------------------------------------------------------------------------------


def test_a_node_of_two_bodies_and_a_joint_node_get_company(export: Export) -> None:
    users = USER + USER.replace("'b'", "'c'") + USER.replace("'b'", "'d'").replace("#n", "#j")
    nodes = (
        "<node id='n'><translate>1 0 0</translate></node>"
        "<node><translate>0 5 0</translate><node id='j' type='JOINT'/></node>"
    )
    bodies = body() + body(sid="c") + body(sid="d")
    text, findings = export(document(bodies=bodies, users=users, nodes=nodes))
    places = [list(b.pose[:3, 3]) for b in bullet_reader.read(text).bodies]
    assert places == [[1, 0, 0], [1, 0, 0], [0, 5, 0]]
    assert codes(findings).count("node-added") == 2
    joint = etree.fromstring(text).find(".//c:node/c:node[@id='j']", N)
    assert joint is not None


def test_a_target_that_is_not_there(export: Export) -> None:
    users = USER.replace("#n", "other.dae#n")
    text, findings = export(document(users=users))
    assert np.array_equal(bullet_reader.read(text).bodies[0].pose, np.eye(4))
    assert "no-node" in codes(findings)


def test_a_document_without_visual_scenes_gets_one(export: Export) -> None:
    data = document(users=USER.replace("#n", "#l"))
    start, end = data.index(b"<library_visual"), data.index(b"<library_physics_scenes>")
    node = b"<library_nodes><node id='l'><translate>1 2 3</translate></node></library_nodes>"
    data = data[:start] + node + data[end:]
    text, _ = export(data.replace(b"<instance_visual_scene url='#v'/>", b""))
    assert list(bullet_reader.read(text).bodies[0].pose[:3, 3]) == [1, 2, 3]


def test_the_parent_of_an_instance_counts_once(export: Export) -> None:
    nodes = (
        "<node id='p'><translate>0 0 1</translate><node id='n'><translate>1 0 0</translate></node>"
        "</node><node id='o'><translate>0 1 0</translate></node>"
    )
    users = USER + USER.replace("'b'", "'c'").replace("#n", "#o")
    data = document(bodies=body() + body(sid="c"), users=users, nodes=nodes)
    data = data.replace(b"_model url='#m'>", b"_model url='#m' parent='#p'>")
    text, findings = export(data)
    assert [list(b.pose[:3, 3]) for b in bullet_reader.read(text).bodies] == [[1, 0, 1], [0, 1, 1]]
    assert b"parent=" not in text
    assert "ignored" in codes(findings)


def test_an_animated_node_is_reported(export: Export) -> None:
    animation = (
        "<library_animations><animation><sampler id='sam'><input semantic='INPUT' source='#x'/>"
        "</sampler><channel source='#sam' target='n/t.X'/></animation></library_animations>"
    )
    nodes = "<node id='n'><rotate>0 0 1 9</rotate><translate sid='t'>1 0 0</translate></node>"
    _, findings = export(document(nodes=nodes, libraries=animation))
    assert "animated" in codes(findings)


def test_a_scale_stays_with_what_is_shown(export: Export) -> None:
    nodes = "<node id='n'><scale>2 2 2</scale><instance_geometry url='#g'/></node>"
    text, findings = export(document(nodes=nodes))
    assert list(bullet_reader.read(text).bodies[0].shapes[0].sizes) == [1, 1, 1]
    assert etree.fromstring(text).find(".//c:node/c:node/c:instance_geometry", N) is not None
    assert "scale" in codes(findings)


# -- shapes -----------------------------------------------------------------------------------


def points(text: bytes) -> np.ndarray[Any, np.dtype[np.float64]]:
    (shape,) = bullet_reader.read(text).bodies[0].shapes
    assert shape.kind in ("hull", "triangles")
    return shape.sizes


@pytest.mark.parametrize(
    ("shape", "extents", "volume"),
    [
        ("<cylinder><height>2</height><radius>1 3</radius></cylinder>", (1, 1, 3), 6 * math.pi),
        (
            "<capsule><height>2</height><radius>1 2 3</radius></capsule>",
            (1, 3, 3),
            math.pi * 3 * (2 + 8 / 3),
        ),
    ],
)
def test_different_radii_become_a_hull(
    export: Export, shape: str, extents: tuple[float, ...], volume: float
) -> None:
    text, findings = export(document(bodies=body(f"<shape>{shape}</shape>")))
    assert np.allclose(np.abs(points(text)).max(axis=0), extents)
    assert bullet_reader.read(text).bodies[0].mass == pytest.approx(volume)
    assert "tessellated" in codes(findings)


CORNERS = "0 0 0 2 0 0 0 2 0 0 0 2"
FACES = "0 2 1 0 1 3 1 2 3 0 3 2"


def geometry(content: str, numbers: str = CORNERS, accessor: str = "") -> str:
    accessor = accessor or "count='4' stride='3'"
    return (
        "<library_geometries><geometry id='g'>"
        f"<mesh><source id='p'><float_array id='a' count='{len(numbers.split())}'>{numbers}"
        f"</float_array><technique_common><accessor source='#a' {accessor}/></technique_common>"
        "</source><vertices id='vx'><input semantic='POSITION' source='#p'/></vertices>"
        f"{content}</mesh></geometry></library_geometries>"
    )


def faces(kind: str, inner: str, count: int = 4) -> str:
    corner = "<input semantic='VERTEX' source='#vx' offset='0'/>"
    return f"<{kind} count='{count}'>{corner}{inner}</{kind}>"


TRIANGLES = faces("triangles", f"<p>{FACES}</p>")
MESH_SHAPE = "<shape><instance_geometry url='#g'/></shape>"
TETRAHEDRON = 8 / 6


@pytest.mark.parametrize(
    "content",
    [
        TRIANGLES,
        faces("triangles", "<p>0 2 1</p>", 1) + faces("triangles", "<p>0 1 3 1 2 3 0 3 2</p>", 3),
        faces("polylist", f"<vcount>3 3 3 3</vcount><p>{FACES}</p>"),
        faces("polygons", "<p>0 2 1</p><p>0 1 3</p><p>1 2 3</p><p>0 3 2</p>"),
        faces("trifans", "<p>3 0 1 2 0</p><p>0 2 1</p>", 2),
        faces("tristrips", "<p>0 2 1 3 0 2</p>", 1),
    ],
)
@pytest.mark.parametrize("dynamic", ["true", "false"])
def test_meshes_in_every_form(export: Export, content: str, dynamic: str) -> None:
    data = document(
        bodies=body(MESH_SHAPE, f"<dynamic>{dynamic}</dynamic>"), libraries=geometry(content)
    )
    text, findings = export(data)
    found = points(text)
    assert len(found) == 12
    assert {tuple(point) for point in found} == {
        (0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2),
    }  # fmt: skip
    (made,) = bullet_reader.read(text).bodies
    assert ("convex" in codes(findings)) == (dynamic == "true")
    assert ("geometry" in codes(findings)) == (content != TRIANGLES)
    if dynamic == "true":
        assert made.mass == pytest.approx(TETRAHEDRON)
        assert made.pose[:3, 3] == pytest.approx([0.5, 0.5, 0.5])


def test_positions_that_are_not_plain_are_copied(export: Export) -> None:
    numbers = "9 0 0 0 1 2 0 0 1 0 2 0 1 0 0 2 1"
    mesh = geometry(TRIANGLES, numbers, "count='4' stride='4' offset='1'")
    text, findings = export(document(bodies=body(MESH_SHAPE), libraries=mesh))
    assert points(text).max() == 2
    assert "geometry" in codes(findings)


@pytest.mark.parametrize("content", ["", TRIANGLES])
def test_points_without_faces_become_a_hull(export: Export, content: str) -> None:
    still = "<dynamic>false</dynamic>"
    text, _ = export(document(bodies=body(MESH_SHAPE, still), libraries=geometry(content)))
    assert bullet_reader.read(text).bodies[0].shapes[0].kind == ("triangles" if content else "hull")


@pytest.mark.parametrize("url", ["#g", "g", "#h1"])
def test_hulls_of_other_geometries(export: Export, url: str) -> None:
    hulls = (
        "<geometry><convex_mesh convex_hull_of='#g'/></geometry>"
        "<geometry id='h1'><convex_mesh convex_hull_of='#g'/></geometry>"
        f"<geometry id='h2'><convex_mesh convex_hull_of='{url}'/></geometry></library_geometries>"
    )
    library = geometry(TRIANGLES).replace("</library_geometries>", hulls)
    shape = MESH_SHAPE.replace("#g", "#h2")
    text, findings = export(document(bodies=body(shape), libraries=library))
    assert len(points(text)) == 4
    assert ("geometry" in codes(findings)) == (url != "#g")
    assert "convex" not in codes(findings)


def test_a_shape_without_a_mesh_is_left_out(export: Export) -> None:
    gone = MESH_SHAPE.replace("#g", "#gone")
    text, findings = export(
        document(
            bodies=body(gone + BOX) + body(gone, sid="c"),
            users=USER + USER.replace("'b'", "'c'").replace("#n", "#o"),
            nodes="<node id='n'/><node id='o'/>",
        )
    )
    world = bullet_reader.read(text)
    assert [found.sid for found in world.bodies] == ["b"]
    assert world.lost == []
    assert {"shape", "no-shape"} <= {*codes(findings)}


# -- constraints ------------------------------------------------------------------------------


def constrained(
    reference: str, other: str, common: str = "", nodes: str = "", places: str = ""
) -> bytes:
    ref_steps, _, steps = places.partition("|")
    return document(
        bodies=body(before="<mass>1</mass>") + body(before="<mass>1</mass>", sid="c"),
        users=USER
        + USER.replace("'b'", "'c'").replace("#n", "#o")
        + "<instance_rigid_constraint constraint='j'/>",
        nodes=nodes or "<node id='n'/><node id='o'><translate>5 0 0</translate></node>",
        constraints=f"<rigid_constraint sid='j'><ref_attachment {reference}>{ref_steps}"
        f"</ref_attachment><attachment {other}>{steps}</attachment>"
        f"<technique_common>{common}</technique_common></rigid_constraint>",
    )


B, C = "rigid_body='m/b'", "rigid_body='m/c'"


@pytest.mark.parametrize("form", ["b", "./b", "m/b", "#b", "#m/b", "#n", "#body-id"])
def test_attachments_in_every_form(export: Export, form: str) -> None:
    data = constrained(f"rigid_body='{form}'", C)
    data = data.replace(b"<rigid_body sid='b'>", b"<rigid_body id='body-id' sid='b'>")
    text, _ = export(data)
    (found,) = bullet_reader.read(text).constraints
    assert found.second is not None
    assert (found.first.sid, found.second.sid) == ("b", "c")
    assert (found.low, found.high) == ([0.0] * 6, [0.0] * 6)


LINEAR = "<limits><linear><min>-1 -INF 2</min><max>3 4 INF</max></linear></limits>"
ANGULAR = (
    "<limits><swing_cone_and_twist><min>-30 -INF 2</min><max>INF 45 1</max>"
    "</swing_cone_and_twist></limits>"
)


def test_one_sided_limits_stay_limits(export: Export) -> None:
    (found,) = bullet_reader.read(export(constrained(B, C, LINEAR))[0]).constraints
    assert list(zip(found.low, found.high, strict=True))[:3] == [
        (-1, 3),
        (-999999, 4),
        (2, 999999),
    ]
    text, findings = export(constrained(B, C, ANGULAR))
    (found,) = bullet_reader.read(text).constraints
    assert found.low[3:] == pytest.approx([-math.pi, math.radians(-45), 1])
    assert found.high[3:] == pytest.approx([math.radians(30), math.pi, 0])
    assert codes(findings).count("one-sided") == 2


def test_bullet_measures_minus_the_angle(export: Export) -> None:
    """A hinge turned by +0.5 rad between -0.3 and 0.9: to Bullet -0.5 between -0.9 and 0.3."""
    limits = (
        "<limits><swing_cone_and_twist><min>0 0 -17.188733853924695</min><max>0 0 "
        "51.56620156177409</max></swing_cone_and_twist></limits>"
    )
    turned = "<node id='n'/><node id='o'><rotate>0 0 1 28.64788975654116</rotate></node>"
    (found,) = bullet_reader.read(export(constrained(B, C, limits, turned))[0]).constraints
    assert found.low[5] == pytest.approx(-0.9)
    assert found.high[5] == pytest.approx(0.3)
    assert found.second is not None
    relative = (found.first.pose @ found.frames[0])[:3, :3].T @ (
        found.second.pose @ found.frames[1]
    )[:3, :3]
    measured = -math.atan2(relative[1, 0], relative[0, 0])
    assert measured - found.low[5] == pytest.approx(0.9 - 0.5)
    assert found.high[5] - measured == pytest.approx(0.5 + 0.3)


@pytest.mark.parametrize(("node", "second"), [("#o", "c"), ("#n", None)])
def test_a_node_is_the_body_that_it_moves_and_beside_that_body_the_world(
    export: Export, node: str, second: str | None
) -> None:
    text, _ = export(constrained(B, f"rigid_body='{node}'"))
    (found,) = bullet_reader.read(text).constraints
    assert found.first.sid == "b"
    assert (None if found.second is None else found.second.sid) == second


def test_a_constraint_to_the_world(export: Export) -> None:
    text, findings = export(constrained(B, "", LINEAR))
    (found,) = bullet_reader.read(text).constraints
    assert found.first.sid == "b"
    assert found.second is None
    assert found.low[0] == -1
    assert "world-frame" not in codes(findings)


def test_the_world_as_reference_is_turned_round(export: Export) -> None:
    nodes = "<node id='n'><translate>1 0 0</translate></node><node id='o'/>"
    data = constrained("", B, LINEAR, nodes, places="<translate>1 0 0</translate>|")
    text, findings = export(data)
    (found,) = bullet_reader.read(text).constraints
    assert found.second is None
    assert (found.low[0], found.high[0]) == (-3, 1)
    assert "swapped" in codes(findings)
    assert "world-frame" not in codes(findings)


def test_a_world_frame_elsewhere_is_reported(export: Export) -> None:
    data = constrained(B, "", LINEAR, places="|<translate>0 0 9</translate>")
    assert "world-frame" in codes(export(data)[1])
    data = constrained(B, "rigid_body='#v2'", nodes="<node id='n'/><node id='o'/><node id='v2'/>")
    assert "world-frame" not in codes(export(data)[1])


@pytest.mark.parametrize(
    ("reference", "other", "common"),
    [
        (B, C, "<enabled>false</enabled>"),
        ("", "", ""),
        (B, "rigid_body='m/gone'", ""),
    ],
)
def test_constraints_that_bullet_must_not_see(
    export: Export, reference: str, other: str, common: str
) -> None:
    text, findings = export(constrained(reference, other, common))
    assert bullet_reader.read(text).constraints == []
    assert "constraint" in codes(findings)


def test_springs_are_reported_and_interpenetrate_stays(export: Export) -> None:
    common = "<interpenetrate>true</interpenetrate><spring><linear/></spring>"
    text, findings = export(constrained(B, C, common))
    (found,) = bullet_reader.read(text).constraints
    assert not found.collide
    assert "spring" in codes(findings)


def test_models_that_nothing_instances_follow_the_same_convention(export: Export) -> None:
    spare = (
        "<library_physics_models><physics_model><rigid_body sid='x'><technique_common>"
        "<shape><plane><equation>0 0 2 6</equation></plane></shape></technique_common></rigid_body>"
        "</physics_model></library_physics_models>"
    )
    text, _ = export(document(libraries=spare))
    root = etree.fromstring(text)
    assert root.findtext(".//c:equation", "", N).split() == ["0.0", "0.0", "1.0", "-3.0"]
    assert all(model.get("id") for model in root.iter(f"{{{N['c']}}}physics_model"))


def test_many_bodies_and_constraints(export: Export) -> None:
    count = 400
    bodies = "".join(body(sid=f"b{i}") for i in range(count))
    users = "".join(USER.replace("'b'", f"'b{i}'").replace("#n", f"#n{i}") for i in range(count))
    links = "".join(f"<instance_rigid_constraint constraint='c{i}'/>" for i in range(count - 1))
    constraints = "".join(
        f"<rigid_constraint sid='c{i}'><ref_attachment rigid_body='m/b{i}'/>"
        f"<attachment rigid_body='m/b{i + 1}'/><technique_common/></rigid_constraint>"
        for i in range(count - 1)
    )
    nodes = "".join(f"<node id='n{i}'><translate>{i} 0 0</translate></node>" for i in range(count))
    data = document(bodies=bodies, users=users + links, nodes=nodes, constraints=constraints)
    new, _ = for_bullet(etree.ElementTree(etree.fromstring(data)))
    world = bullet_reader.read(etree.tostring(new))
    assert len(world.bodies) == count
    assert len(world.constraints) == count - 1


def test_every_rule_is_listed_once() -> None:
    listed = [rule.code for rule in rules.RULES]
    assert len({*listed}) == len(listed)
    assert all(code.startswith("downgrade-bullet-") for code in listed)
    declared = {rule.code for rule in vars(rules).values() if isinstance(rule, Rule)}
    assert declared == {*listed}


def test_what_a_shape_weighs_that_is_left_out_stays_with_the_body(export: Export) -> None:
    box = BOX.replace("<box>", "<mass>2</mass><box>")
    lost = (
        "<shape><mass>6</mass><instance_geometry url='#none'/><translate>4 0 0</translate></shape>"
    )
    text, findings = export(document(body(box + lost)))
    assert codes(findings)[:2] == ["mass", "shape"]
    read = bullet_reader.read(text)
    assert read.bodies[0].mass == 8.0
    # Six eighths of the way to the shape that is not there, which is where it weighs.
    assert np.allclose(read.bodies[0].pose[:3, 3], (3.0, 0.0, 0.0))

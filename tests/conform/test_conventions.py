"""What producers mean otherwise than the standard."""

from __future__ import annotations

import io

import numpy as np
import pytest
from lxml import etree
from tests.conform.documents import (
    ASSET,
    BOX,
    MESH,
    NS_1_5,
    C,
    codes,
    document,
    mended,
    physics,
    words,
)

import colladaphy
from colladaphy.conform import conform
from colladaphy.conform.conventions import CONVENTIONS
from colladaphy.conform.frames import transform_of
from colladaphy.world import rotations


def asset(tool: str, unit: str = "") -> str:
    contributor = f"<contributor><authoring_tool>{tool}</authoring_tool></contributor>"
    return ASSET.replace("<asset>", "<asset>" + contributor).replace("</asset>", unit + "</asset>")


def robot(mass_frame: str, shape: str, tool: str = "OpenRAVE") -> etree._ElementTree:
    """Two links; the second hangs 1 along x and 2 up, turned by 90 degrees about z."""
    geometry = '<instance_geometry url="#g"/>'
    nodes = (
        f'<node id="root"><translate>50 0 0</translate><node id="n1">{geometry}'
        "<node id='n2'><translate>1 0 2</translate><rotate>0 0 1 90</rotate>"
        f"<node><translate>0 0 0.5</translate>{geometry}</node></node></node></node>"
    )
    bodies = "".join(
        f'<rigid_body sid="b{i}"><technique_common><mass>1</mass>{frame}<inertia>1 2 3</inertia>'
        f'<shape><instance_geometry url="#g"/>{place}</shape></technique_common></rigid_body>'
        for i, frame, place in ((1, "", ""), (2, f"<mass_frame>{mass_frame}</mass_frame>", shape))
    )
    instances = "".join(
        f'<instance_rigid_body body="b{i}" target="#n{i}"><technique_common/></instance_rigid_body>'
        for i in (1, 2)
    )
    tree = physics(bodies=bodies, instances=instances, nodes=nodes, asset=asset(tool))
    tree.getroot().find(f".//{C}instance_physics_model").set("parent", "#root")
    library = document(
        f'<library_geometries><geometry id="g"><mesh>{MESH.format("g")}</mesh></geometry>'
        "</library_geometries>"
    ).getroot()[1]
    tree.getroot().insert(1, library)
    return tree


IN_MODEL = "<translate>1 0 2.5</translate><rotate>0 0 1 90</rotate>"
IN_BODY = "<translate>0 0 0.5</translate>"


def places(root: etree._Element) -> tuple[np.ndarray, np.ndarray]:
    body = root.findall(f".//{C}rigid_body")[1]
    common = body.find(C + "technique_common")
    return transform_of(common.find(C + "mass_frame")), transform_of(common.find(C + "shape"))


@pytest.mark.parametrize("tool", ["OpenRAVE 0.9", "URDF Collada Writer", "OpenHRP3"])
def test_frames_in_the_models_space_come_into_the_bodys(tool: str) -> None:
    root, findings = mended(robot(IN_MODEL, IN_MODEL, tool))
    expected = np.eye(4)
    expected[2, 3] = 0.5
    for place in places(root):
        assert place == pytest.approx(expected, abs=1e-12)
    assert codes(findings) == {"convention-chosen", "convention-frames"}
    assert "1 fit the model's space" in findings[1].message


def test_frames_that_are_local_stay_as_they_are() -> None:
    root, findings = mended(robot(IN_BODY, IN_BODY))
    for place in places(root):
        assert place[:3, 3] == pytest.approx([0, 0, 0.5])
    assert codes(findings) == {"convention-chosen", "convention-frames-local"}


def test_mass_frames_and_shapes_are_judged_apart() -> None:
    root, findings = mended(robot(IN_MODEL, IN_BODY))
    for place in places(root):
        assert place[:3, 3] == pytest.approx([0, 0, 0.5])
    assert codes(findings) >= {"convention-frames", "convention-frames-local"}


def test_a_named_convention_is_obeyed_with_a_warning() -> None:
    root, findings = mended(robot(IN_BODY, IN_BODY, "something"), convention="openrave")
    assert places(root)[0][:3, 3] == pytest.approx([0, 1, -1.5])
    assert "convention-frames-doubtful" in codes(findings)


def test_none_takes_the_standards_meaning() -> None:
    root, findings = mended(robot(IN_MODEL, IN_MODEL), convention="none")
    assert places(root)[0][:3, 3] == pytest.approx([1, 0, 2.5])
    assert findings == []


def test_other_names_are_refused() -> None:
    with pytest.raises(ValueError, match="openrave"):
        conform(physics(BOX), convention="opnrave")


LIMITS = (
    '<rigid_constraint sid="j"><ref_attachment rigid_body=""/><attachment rigid_body="pm/b1"/>'
    "<technique_common><limits><swing_cone_and_twist><min>{0}</min><max>{1}</max>"
    "</swing_cone_and_twist><linear><min>0 1 0</min><max>0 0 0</max></linear></limits>"
    "</technique_common></rigid_constraint>"
)
MOVING = (
    '<instance_rigid_body body="b1" target="#n1"><technique_common><angular_velocity>0 3.5 0'
    "</angular_velocity></technique_common></instance_rigid_body>"
)


def test_bullets_radians_planes_and_heights() -> None:
    shapes = (
        "<shape><plane><equation>0 0 2 6</equation></plane></shape>"
        "<shape><cylinder><height>1.5</height><radius>1 1</radius></cylinder></shape>"
    )
    tree = physics(
        shapes,
        more=LIMITS.format("-0.5 1 0", "1 -1 200"),
        instances=MOVING,
        asset=asset("Bullet ColladaConverter (BulletColladaConverter)"),
    )
    root, findings = mended(tree)
    assert words(root, "equation") == ["0", "0", "2", "-12"]
    assert words(root, "height") == ["3"]
    assert [float(v) for v in words(root, "angular_velocity")] == [0, np.degrees(3.5), 0]
    low, high = words(root, "swing_cone_and_twist/min"), words(root, "swing_cone_and_twist/max")
    # Bullet measures minus the angle: its -0.5 to 1 is -1 to 0.5.
    assert [float(v) for v in low] == [-np.degrees(1), -np.inf, -np.inf]
    assert [float(v) for v in high] == [np.degrees(0.5), np.inf, 0]
    assert words(root, "linear/min") == ["0", "-INF", "0"]
    assert codes(findings) == {
        "convention-chosen", "convention-angle-unit", "convention-plane-sign",
        "convention-half-height", "convention-free-limits",
    }  # fmt: skip


def test_bullets_centre_of_mass_is_the_nodes_origin() -> None:
    moved = BOX.replace("</shape>", "<translate>5 0 0</translate></shape>")
    bodies = "".join(
        f'<rigid_body sid="b{i}"><technique_common><dynamic>true</dynamic><mass>1</mass>{content}'
        "</technique_common></rigid_body>"
        for i, content in (
            (1, moved),
            (2, BOX),
            (3, f"<mass_frame><translate>1 1 1</translate></mass_frame>{moved}"),
        )
    )
    root, findings = mended(physics(bodies=bodies, asset=asset("BulletColladaConverter")))
    frames = [b.findtext(f".//{C}mass_frame/{C}translate") for b in root.iter(C + "rigid_body")]
    assert frames == ["0 0 0", None, "1 1 1"]
    assert codes(findings) == {"convention-chosen", "convention-mass-centre"}


def test_a_joint_of_bullets_with_one_body_at_both_ends_is_to_the_world() -> None:
    joint = (
        '<rigid_constraint sid="j"><ref_attachment rigid_body="b1"><translate>1 0 0</translate>'
        '</ref_attachment><attachment rigid_body="b1"><translate>1 0 0</translate></attachment>'
        "<technique_common/></rigid_constraint>"
    )
    nodes = '<node id="n1"><translate>0 5 0</translate><rotate>0 0 1 90</rotate></node>'
    for tool in ("BulletColladaConverter", "hand"):
        root, findings = mended(physics(BOX, more=joint, nodes=nodes, asset=asset(tool)))
        second = root.find(f".//{C}attachment")
        if tool == "hand":
            assert second.get("rigid_body") == "pm/b1"
            continue
        assert second.get("rigid_body") == ""
        place = transform_of(second)
        assert place[:3, 3] == pytest.approx([0, 6, 0])
        assert place[:3, 0] == pytest.approx([0, 1, 0])
        assert "convention-world-joint" in codes(findings)


SAVED = (
    '<node id="n1"><translate>1.23457 0 0.5</translate><rotate>0.267261 0.534522 0.801784 33.3333'
    "</rotate></node>"
)


@pytest.mark.parametrize(
    ("tool", "nodes", "version", "rewritten"),
    [
        ("Blender v:242 - Illusoft Collada Exporter", SAVED, "1.4.1", True),
        ("Blender v:242 - Illusoft Collada Exporter", SAVED, "1.5.0", False),
        ("hand", SAVED, "1.4.1", False),
        ("Maya 7.0", SAVED.replace("<rotate>", '<rotate sid="rotateX">'), "1.4.1", False),
        ("Maya 7.0", SAVED.replace("1.23457", "1.2345678"), "1.4.1", False),
    ],
)
def test_what_bullet_saved_under_another_name_is_known_by_its_numbers(
    tool: str, nodes: str, version: str, rewritten: bool
) -> None:
    moving = MOVING.replace("</technique_common>", "<velocity>0 0 0</velocity></technique_common>")
    tree = physics(
        BOX,
        more=LIMITS.format("-10 0 0", "30 0 0"),
        instances=moving,
        nodes=nodes,
        version=version,
        asset=asset(tool),
    )
    root, findings = mended(tree)
    spin = float(words(root, "angular_velocity")[1])
    assert spin == pytest.approx(np.degrees(3.5) if rewritten else 3.5)
    # The limits are still those of the other tool.
    assert words(root, "swing_cone_and_twist/min")[0] == "-10"
    if rewritten:
        assert "bullet-rewritten" in " ".join(f.message for f in findings)


def test_the_digits_of_what_is_converted_are_kept_in_mind() -> None:
    moving = MOVING.replace("0 3.5 0", "0.1 0.2 0.333333")
    root, _ = mended(physics(BOX, instances=moving, asset=asset("BulletColladaConverter")))
    (note,) = root.iter("{urn:colladaphy:conform:1}convention")
    assert note.get("digits") == "6"


def test_bullet_leaves_the_shapes_of_what_it_only_edits() -> None:
    shapes = "<shape><plane><equation>0 0 1 6</equation></plane></shape>"
    extra = (
        '</physics_model><physics_model id="Bullet-PhysicsModel"><rigid_body sid="x">'
        f"<technique_common>{shapes}</technique_common></rigid_body>"
    )
    tool = asset("ColladaMaya v0.89", '<unit meter="0.01"/>')
    root, findings = mended(physics(shapes, more=extra, asset=tool))
    assert [e.text for e in root.iter(C + "equation")] == ["0 0 1 6", "0 0 1 -6"]
    assert words(root, "gravity") == ["0", "0", "-981"]
    assert [f.code for f in findings].count("convention-chosen") == 2


def test_axes_with_min_above_max_are_free_whoever_wrote_them() -> None:
    root, findings = mended(physics(BOX, more=LIMITS.format("5 0 0", "-5 0 0")))
    assert words(root, "swing_cone_and_twist/min") == ["-INF", "0", "0"]
    assert codes(findings) == {"convention-free-limits"}


def test_nxustreams_angular_velocity_and_restitution() -> None:
    spring = (
        LIMITS.format("0 0 0", "0 0 0")
        .replace(
            "</limits>",
            "</limits><spring><angular><target_value>0.5</target_value></angular></spring>",
        )
        .replace("0 1 0", "0 0 0")
        .replace("<angular>", "<angular><stiffness>0</stiffness>")
    )
    root, findings = mended(
        physics(BOX, more=spring, instances=MOVING, asset=asset("NxuStream2 2.3"))
    )
    assert float(words(root, "angular_velocity")[1]) == np.degrees(3.5)
    assert root.find(f".//{C}spring/{C}angular/{C}target_value") is None
    assert codes(findings) >= {"convention-angle-unit", "convention-restitution"}


def test_nxustream_is_known_by_its_author_and_its_still_springs_cost_no_constraint() -> None:
    spring = (
        "</limits><spring><angular><stiffness>0</stiffness><target_value>0.5</target_value>"
        "</angular><linear><stiffness>0</stiffness><target_value>INF</target_value></linear>"
        "</spring>"
    )
    joint = LIMITS.format("0 0 0", "0 0 0").replace("</limits>", spring).replace("0 1 0", "0 0 0")
    contributor = "<contributor><author>NxuStream2 converter - http://example</author>"
    who = asset("PhysX Viewer").replace("<contributor>", contributor)
    use = '<instance_rigid_constraint constraint="j"/>'
    root, findings = mended(physics(BOX, more=joint, instances=MOVING + use, asset=who))
    assert float(words(root, "angular_velocity")[1]) == np.degrees(3.5)
    assert root.find(f".//{C}spring//{C}target_value") is None
    assert root.find(f".//{C}rigid_constraint//{C}stiffness").text == "0"
    assert codes(findings) == {
        "convention-chosen", "convention-angle-unit", "convention-restitution",
        "convention-inert-spring",
    }  # fmt: skip


@pytest.mark.parametrize(
    "sign",
    [
        '<technique profile="PhysX"><kinematic>false</kinematic></technique>',
        "<spring><linear><stiffness>0</stiffness><target_value>INF</target_value></linear></spring>",
        "",
    ],
    ids=["profile", "springs", "none"],
)
def test_nxustream_without_a_name_is_known_by_its_profile_or_its_springs(sign: str) -> None:
    joint = LIMITS.format("0 0 0", "0 0 0").replace("0 1 0", "0 0 0")
    joint = joint.replace("</limits>", f"</limits>{sign if 'spring' in sign else ''}")
    shape = BOX
    extra = f"<extra>{sign}</extra>" if "profile" in sign else ""
    root, findings = mended(
        physics(shape, more=joint + extra, instances=MOVING, asset=asset("PhysX Viewer"))
    )
    turned = float(words(root, "angular_velocity")[1])
    assert turned == (np.degrees(3.5) if sign else 3.5)
    assert ("convention-chosen" in codes(findings)) == bool(sign)


def test_a_stiff_spring_keeps_its_target() -> None:
    spring = "</limits><spring><linear><stiffness>2</stiffness><target_value>0.5</target_value>"
    joint = LIMITS.format("0 0 0", "0 0 0").replace("</limits>", spring + "</linear></spring>")
    root, _ = mended(physics(BOX, more=joint))
    assert words(root, "target_value") == ["0.5"]


def test_colladamayas_gravity_and_hollow_shapes() -> None:
    hollow = BOX.replace("<shape>", "<shape><hollow>true</hollow>")
    heavy = BOX.replace("<shape>", "<shape><hollow>true</hollow><mass>2</mass>")
    tree = physics(
        hollow + heavy, asset=asset("Maya 7.0 | ColladaMaya v0.89", '<unit meter="0.01"/>')
    )
    root, findings = mended(tree)
    assert words(root, "gravity") == ["0", "0", "-981"]
    assert [h.text for h in root.iter(C + "hollow")] == ["false", "true"]
    assert codes(findings) == {"convention-chosen", "convention-gravity-unit", "convention-hollow"}


def blender_solid(solid: str, low: str, high: str) -> etree._ElementTree:
    tree = physics(
        f"<shape>{solid}</shape>",
        nodes='<node id="n1"><instance_geometry url="#g"/></node>',
        asset=asset("Blender v:249 - Illusoft Collada Exporter v:0.3"),
    )
    mesh = MESH.format("g").replace("0 0 0 1 0 0 0 1 0 0 0 1", f"{low} {high} {low} {high}")
    library = document(
        f'<library_geometries><geometry id="g"><mesh>{mesh}</mesh></geometry></library_geometries>'
    ).getroot()[1]
    tree.getroot().insert(1, library)
    return tree


@pytest.mark.parametrize(
    ("high", "height", "turned"),
    [("1 1 1.5", "3", True), ("1 1 0.75", "1.5", True), ("1 0.75 1", "1.5", False)],
)
def test_blenders_cylinders_are_read_as_they_are_shown(
    high: str, height: str, turned: bool
) -> None:
    solid = "<cylinder><height>1.5</height><radius>1 1</radius></cylinder>"
    low = " ".join(f"-{value}" for value in high.split())
    root, findings = mended(blender_solid(solid, low, high))
    assert words(root, "height") == [height]
    assert (root.find(f".//{C}shape/{C}rotate") is not None) == turned
    assert ("convention-axis" in codes(findings)) == turned


def test_the_thesis_profile_without_a_namespace_is_recognised() -> None:
    extra = '<extra><technique profile="pe"><uid>5</uid></technique></extra>'
    root, findings = mended(document(extra))
    assert root.find(f".//{C}uid").text == "5"
    assert codes(findings) == {"convention-chosen"}


def test_every_convention_can_be_named() -> None:
    for convention in CONVENTIONS:
        _, findings = mended(physics(BOX), convention=convention.name)
        assert codes(findings) == {"convention-chosen"}
        assert convention.name in findings[0].message


def test_what_was_written_for_bullet_comes_back() -> None:
    shapes = "<shape><plane><equation>0 0 1 6</equation></plane></shape>"
    tree = physics(shapes, instances=MOVING)
    mark = (
        f'<extra xmlns="{NS_1_5}"><technique profile="colladaphy"><written_for '
        'xmlns="urn:colladaphy:conform:1">Bullet</written_for></technique></extra>'
    )
    tree.getroot().append(etree.fromstring(mark))
    root, findings = mended(tree)
    assert words(root, "equation") == ["0", "0", "1", "-6"]
    assert float(words(root, "angular_velocity")[1]) == np.degrees(3.5)
    assert "written_for" not in etree.tostring(root, encoding="unicode")
    assert "written for Bullet" in findings[0].message


@pytest.mark.parametrize("number", ["NaN", "INF", "-INF", "1e308", "-1e308", "1e-320", "0", "x"])
@pytest.mark.parametrize("tag", ["translate", "rotate", "inertia", "float_array", "mass"])
@pytest.mark.parametrize("convention", ["auto", "openrave", "blender", "bullet", "colladamaya"])
def test_no_number_is_too_odd(number: str, tag: str, convention: str) -> None:
    tree = robot(IN_MODEL, IN_MODEL)
    for element in tree.getroot().iter(C + tag):
        element.text = " ".join([number] * len((element.text or "").split()))
    mended(tree, convention=convention)


@pytest.mark.parametrize("number", ["NaN", "INF", "-INF", "1e308", "-1e308", "1e-320", "0", "x"])
def test_no_size_is_too_odd(number: str) -> None:
    solids = "".join(
        f"<shape>{solid}</shape>"
        for solid in (
            f"<tapered_cylinder><height>{number}</height><radius1>{number} 1</radius1>"
            f"<radius2>1 {number}</radius2></tapered_cylinder>",
            f"<tapered_capsule><height>{number}</height><radius1>{number} 1</radius1>"
            f"<radius2>1 {number}</radius2></tapered_capsule>",
            f"<sphere><radius>1 {number} 2</radius></sphere>",
            f"<capsule><height>1</height><radius>{number} 1</radius></capsule>",
            f"<ellipsoid><size>1 {number} 2</size></ellipsoid>",
            f"<plane><equation>0 {number} 1 {number}</equation></plane>",
        )
    )
    body = (
        f"<inertia>1 0 {number} 0 1 0 {number} 0 1</inertia><mass_frame><matrix>"
        + f"{number} 1 " * 8
        + f"</matrix></mass_frame>{solids}"
    )
    for convention in ("auto", "bullet", "blender"):
        mended(physics(body, version="1.4.1"), convention=convention)


def apart(limits: str) -> etree._ElementTree:
    """Two bodies 3 apart, one of them turned, whose frames are apart by that and a little more."""
    nodes = (
        '<node id="n1"><translate>1 0 0</translate><rotate>0 0 1 90</rotate></node>'
        '<node id="n2"><translate>1 3 0</translate></node>'
    )
    bodies = "".join(
        f'<rigid_body sid="b{i}"><technique_common><mass>1</mass>{BOX}</technique_common>'
        "</rigid_body>"
        for i in (1, 2)
    )
    constraint = (
        '<rigid_constraint sid="c"><ref_attachment rigid_body="pm/b1"><translate>0 0 1</translate>'
        '<rotate>1 0 0 90</rotate></ref_attachment><attachment rigid_body="pm/b2">'
        f"<translate>0.5 0 0</translate></attachment><technique_common>{limits}</technique_common>"
        "</rigid_constraint>"
    )
    instances = "".join(
        f'<instance_rigid_body body="b{i}" target="#n{i}"><technique_common/></instance_rigid_body>'
        for i in (1, 2)
    )
    return physics(
        bodies=bodies, more=constraint, nodes=nodes,
        instances=instances + '<instance_rigid_constraint constraint="c"/>',
    )  # fmt: skip


def test_limits_count_from_the_current_distance_where_that_is_asked_for() -> None:
    limits = "<limits><linear><min>-20 0 -5</min><max>20 0 5</max></linear></limits>"
    text = etree.tostring(apart(limits))
    name = "thesis-current-distance"
    plain, moved = (
        colladaphy.read(text, repair=True, convention=convention) for convention in ("auto", name)
    )
    found = [document.load() for document in (plain, moved)]
    # The standard compares the frames, which are apart by what lies between the bodies.
    shift = np.array([joint_shift(world) for world in found])
    assert np.allclose(np.linalg.norm(shift, axis=1), [np.sqrt(3**2 + 0.5**2 + 1), 0], atol=1e-12)
    for world in found:
        (joint,) = world.joints
        assert joint.linear_min.tolist() == [-20, 0, -5]
        assert joint.linear_max.tolist() == [20, 0, 5]
    turns = [world.joints[0].frame1[1] for world in found]
    assert np.allclose(*turns, atol=1e-15)
    assert [f.code for f in moved.report if "distance" in f.code] == ["convention-current-distance"]
    again = colladaphy.read(colladaphy_bytes(moved), repair=True, convention=name)
    assert not any("distance" in finding.code for finding in again.report)


def joint_shift(world: colladaphy.World) -> np.ndarray:
    """How far the frames of the only joint are apart, in the world."""
    (joint,) = world.joints
    ends = []
    for body, (point, _) in ((joint.body1, joint.frame1), (joint.body2, joint.frame2)):
        assert body is not None
        ends.append(body.position + rotations.rotate(body.orientation, point))
    return ends[1] - ends[0]


def colladaphy_bytes(document: colladaphy.Document) -> bytes:
    stream = io.BytesIO()
    document.write(stream)
    return stream.getvalue()

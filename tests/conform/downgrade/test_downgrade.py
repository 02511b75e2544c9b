from __future__ import annotations

from typing import Any

import pytest
from lxml import etree
from tests.conform.downgrade.conftest import NS14, NS15, Downgrade, document

from colladaphy.conform.downgrade import rules

N = {"c": NS14, "k": NS15}
KEPT = "c:extra/c:technique[@profile='colladaphy-1.5']"


def codes(findings: list[Any]) -> list[str]:
    return [finding.code for finding in findings]


def test_what_both_versions_say_alike_is_only_renamed(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<!-- before --><library_cameras><camera><optics><technique_common><perspective>"
            "<yfov sid='f'>45</yfov><znear>1</znear><zfar>1e3</zfar></perspective>"
            "</technique_common></optics></camera></library_cameras><?pi data?>"
        )
    )
    root = new.getroot()
    assert findings == []
    assert root.tag == f"{{{NS14}}}COLLADA"
    assert root.get("version") == "1.4.1"
    assert root.nsmap == {None: NS14}
    assert root.xpath("string(//c:yfov/@sid)", namespaces=N) == "f"
    assert [type(n).__name__ for n in root if not isinstance(n.tag, str)] == [
        "_Comment",
        "_ProcessingInstruction",
    ]
    assert NS15 not in etree.tostring(new).decode()


def prefixed(text: str) -> str:
    return text.replace("xmlns=", "xmlns:dae=").replace("<", "<dae:").replace("<dae:/", "</dae:")


def test_comments_around_the_root_stay_and_its_prefix_goes(downgrade: Downgrade) -> None:
    new, _ = downgrade(f"<!--a--><?b c?>{prefixed(document(''))}<!--d-->")
    text = etree.tostring(new)
    assert text.startswith(b"<!--a--><?b c?><COLLADA xmlns=")
    assert text.endswith(b"</COLLADA><!--d-->")
    assert b"dae" not in text


def test_foreign_content_keeps_its_namespaces_declared_where_it_begins(
    downgrade: Downgrade,
) -> None:
    content = '<p:a xmlns:p="urn:p" p:q="1"><b xmlns=""><p:c/></b></p:a><d xmlns=""/>'
    outer = prefixed(document('<extra><technique profile="x">@</technique></extra>'))
    outer = outer.replace("version=", 'xmlns:o="urn:o" version=')
    new, _ = downgrade(outer.replace("@", content + "<o:e/>"))
    root = etree.fromstring(etree.tostring(new))
    assert root.nsmap == {None: NS14}
    technique = root.find(f".//{{{NS14}}}technique")
    assert [e.tag for e in technique.iterdescendants()] == [
        "{urn:p}a",
        "b",
        "{urn:p}c",
        "d",
        "{urn:o}e",
    ]


@pytest.mark.parametrize(
    ("library", "content"),
    [
        ("library_joints", "<joint id='j'><revolute sid='a'><axis>1 0 0</axis></revolute></joint>"),
        (
            "library_formulas",
            "<formula id='f'><target><param>x</param></target><technique_common>"
            "<m:math xmlns:m='http://www.w3.org/1998/Math/MathML'/></technique_common></formula>",
        ),
        ("library_kinematics_scenes", "<kinematics_scene id='k'/>"),
        (
            "library_kinematics_models",
            "<kinematics_model id='m'><technique_common><link sid='l'/></technique_common>"
            "</kinematics_model>",
        ),
    ],
)
def test_libraries_of_1_5_are_kept_whole(downgrade: Downgrade, library: str, content: str) -> None:
    text = document(f"<{library}>{content}</{library}>")
    new, findings = downgrade(text)
    (kept,) = new.getroot().findall(f"{KEPT}/k:{library}", N)
    old = etree.fromstring(text)[1]
    assert etree.tostring(kept, method="c14n", exclusive=True) == etree.tostring(
        old, method="c14n", exclusive=True
    )
    assert codes(findings) == [rules.LIBRARY_KEPT.code]
    assert findings[0].path == f"/COLLADA/{library}"


def test_the_asset_gives_its_new_parts_to_the_root(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document("", "<extra><technique profile='x'><y/></technique></extra>").replace(
            "<created>",
            "<contributor><author_email>a@b.c</author_email><comments>c</comments></contributor>"
            "<coverage/><created>",
            1,
        )
    )
    root = new.getroot()
    assert root.findtext(f"{KEPT}/k:asset/k:contributor/k:author_email", None, N) == "a@b.c"
    assert root.find(f"{KEPT}/k:asset/k:coverage", N) is not None
    assert root.find(f"{KEPT}/k:asset/k:extra/k:technique/k:y", N) is not None
    assert len(root.findall("c:extra", N)) == 1
    assert codes(findings) == [rules.ELEMENT_KEPT.code] * 3


def test_names_become_ncnames(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<library_nodes name='a lib'><node name='1 two:three'/><node name='ok'/>"
            "</library_nodes>"
        ).replace("</asset>", "<unit name='1.x' meter='1'/></asset>")
    )
    names = new.getroot().xpath("//@name")
    assert names == ["1.x", "a_lib", "_1_two_three", "ok"]
    assert codes(findings) == [rules.NAME_CHANGED.code] * 2
    assert findings[1].path == "/COLLADA/library_nodes/node[1]"


def test_instance_node_proxy_and_sampler_behaviour_are_kept(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<library_animations><animation><sampler id='s' pre_behavior='CYCLE'>"
            "<input semantic='INPUT' source='#x'/></sampler><channel source='#s' target='n/t'/>"
            "</animation></library_animations>"
            "<library_nodes><node><instance_node url='#n' proxy='#p'/></node></library_nodes>"
        )
    )
    root = new.getroot()
    animation = root.find(".//c:animation", N)
    assert animation is not None
    kept = animation.find(f"{KEPT}/k:sampler", N)
    assert kept is not None
    assert dict(kept.attrib) == {"id": "s", "pre_behavior": "CYCLE"}
    assert root.find(f".//c:instance_node/{KEPT}/k:instance_node[@proxy='#p']", N) is not None
    assert codes(findings) == [rules.ATTRIBUTE_KEPT.code] * 2


LAYERS = "<render camera_node='#c'><layer>a</layer></render>"
EVALUATIONS = [
    (f"<evaluate_scene name='e'>{LAYERS}</evaluate_scene>", 1, 0),
    (f"<evaluate_scene id='e' enable='true'>{LAYERS}</evaluate_scene>", 1, 1),
    (f"<evaluate_scene enable='false'>{LAYERS}</evaluate_scene>", 0, 1),
    ("<evaluate_scene/>", 0, 1),
    ("<evaluate_scene><render/></evaluate_scene>", 0, 1),
    (
        "<evaluate_scene><render camera_node='#c'><instance_material url='#m'/></render>"
        "</evaluate_scene>",
        0,
        1,
    ),
]


@pytest.mark.parametrize(("evaluation", "stays", "found"), EVALUATIONS)
def test_evaluate_scene_stays_where_1_4_can_say_it(
    downgrade: Downgrade, evaluation: str, stays: int, found: int
) -> None:
    new, findings = downgrade(
        document(
            "<library_visual_scenes><visual_scene><node/>"
            f"{evaluation}</visual_scene></library_visual_scenes>"
        )
    )
    scene = new.getroot().find(".//c:visual_scene", N)
    assert scene is not None
    assert len(scene.findall("c:evaluate_scene", N)) == stays
    assert len(scene.findall(f"{KEPT}/k:evaluate_scene", N)) == found
    assert len(findings) == found


def test_a_brep_leaves_an_empty_convex_mesh(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<library_geometries><geometry id='g'><brep><source id='s'/><vertices id='v'>"
            "<input semantic='POSITION' source='#s'/></vertices></brep></geometry>"
            "</library_geometries>"
        )
    )
    geometry = new.getroot().find(".//c:geometry", N)
    assert geometry is not None
    assert geometry.find("c:convex_mesh", N) is not None
    assert geometry.find(f"{KEPT}/k:brep/k:vertices", N) is not None
    assert codes(findings) == [rules.BREP_KEPT.code]


def mesh(sources: str) -> str:
    return document(
        f"<library_geometries><geometry><mesh>{sources}<vertices id='v'>"
        "<input semantic='POSITION' source='#s'/></vertices></mesh></geometry></library_geometries>"
    )


def test_sid_references_become_names(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        mesh(
            "<source id='s'><SIDREF_array id='a' count='2'>skeleton/hip ./hip/knee.X</SIDREF_array>"
            "<technique_common><accessor source='#a' count='2'><param type='SIDREF'/></accessor>"
            "</technique_common></source>"
            "<source id='t'><token_array id='b' count='2'>one two</token_array></source>"
        )
    )
    root = new.getroot()
    assert [a.text for a in root.iter(f"{{{NS14}}}Name_array")] == ["one two", "hip knee"][::-1]
    assert root.xpath("string(//c:param/@type)", namespaces=N) == "name"
    kept = root.find(".//c:source/c:technique[@profile='colladaphy-1.5']/k:SIDREF_array", N)
    assert kept is not None
    assert kept.text == "skeleton/hip ./hip/knee.X"
    assert codes(findings) == [rules.ARRAY_CHANGED.code] * 2


def test_an_array_of_what_are_no_names_is_kept(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        mesh("<source id='s'><token_array count='1'>1+1</token_array></source>")
    )
    kept = new.getroot().find(".//c:source/c:technique/k:token_array", N)
    assert kept is not None
    assert codes(findings) == [rules.ARRAY_KEPT.code]


PHYSICS = """<library_physics_models><physics_model id="m">
  <rigid_body id="b-id" sid="b"><technique_common>
    <shape><capsule><height>2</height><radius>{radius}</radius></capsule></shape>
  </technique_common></rigid_body>
  <rigid_constraint sid="c"><ref_attachment rigid_body="#b-id"/><attachment rigid_body="m/b"/>
    <technique_common/></rigid_constraint>
</physics_model></library_physics_models>
<library_physics_scenes><physics_scene id="s"><instance_physics_model url="#m">
  <instance_rigid_body body="b" target="#n"><technique_common><dynamic/></technique_common>
  </instance_rigid_body></instance_physics_model><technique_common/></physics_scene>
</library_physics_scenes>"""


@pytest.mark.parametrize(("radius", "found"), [("1 1 1.0", 0), ("1 2 3", 1)])
def test_physics(downgrade: Downgrade, radius: str, found: int) -> None:
    new, findings = downgrade(document(PHYSICS.format(radius=radius)))
    root = new.getroot()
    first, _, third = radius.split()
    assert root.findtext(".//c:capsule/c:radius", None, N) == f"{first} {third}"
    body = root.find(".//c:rigid_body", N)
    assert body is not None
    assert dict(body.attrib) == {"sid": "b"}
    assert body.find(f"{KEPT}/k:rigid_body[@id='b-id']", N) is not None
    assert root.xpath("//c:rigid_constraint/*/@rigid_body", namespaces=N) == ["b", "m/b"]
    assert root.findtext(".//c:dynamic", None, N) == "true"
    assert codes(findings).count(rules.CAPSULE_RADIUS.code) == found
    assert codes(findings).count(rules.BODY_ID.code) == 2


def test_foreign_techniques_move_to_the_new_namespace(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<extra><technique profile='X'> <kinematic>true</kinematic>\n<!--c-->"
            "<y xmlns='urn:y' xmlns:z='urn:z'><z:z a='1'/><plain xmlns=''/></y></technique></extra>"
        )
    )
    technique = new.getroot().find("c:extra/c:technique", N)
    assert technique is not None
    assert [e.tag for e in technique.iter(etree.Element)] == [
        f"{{{NS14}}}technique",
        f"{{{NS14}}}kinematic",
        "{urn:y}y",
        "{urn:z}z",
        "plain",
    ]
    assert technique.text == " "
    assert technique[0].tail == "\n"
    assert findings == []


def test_foreign_content_with_names_of_1_4_stays_in_the_old_namespace(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<extra><technique profile='X'><my><translate>not three floats</translate></my>"
            "<own/></technique></extra>"
        )
    )
    technique = new.getroot().find("c:extra/c:technique", N)
    assert technique is not None
    assert technique[0].tag == f"{{{NS15}}}my"
    assert technique[1].tag == f"{{{NS14}}}own"
    assert codes(findings) == [rules.CONTENT_LEFT.code]


def test_hints_at_the_1_5_schema_are_left_out(downgrade: Downgrade) -> None:
    xsi = "xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance'"
    new, findings = downgrade(
        document(
            "<library_nodes><node><translate xsi:type='translate_type'>0 0 0</translate></node>"
            "</library_nodes><extra><technique profile='x'>"
            "<v xmlns:xs='http://www.w3.org/2001/XMLSchema' xsi:type='xs:int'>1</v>"
            "</technique></extra>",
            attributes=xsi,
        )
    )
    assert new.getroot().xpath("count(//@*[name()='xsi:type'])") == 1
    assert codes(findings) == [rules.SCHEMA_HINT.code]


def test_many_findings_cost_linear_time(downgrade: Downgrade) -> None:
    count = 20_000
    nodes = "".join(f"<node name='n {i}'/>" for i in range(count))
    _, findings = downgrade(document(f"<library_nodes>{nodes}</library_nodes>"))
    assert len(findings) == count
    assert findings[-1].path == f"/COLLADA/library_nodes/node[{count}]"

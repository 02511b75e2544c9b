"""Ids, sids and references as real files write them."""

from __future__ import annotations

import io

import collada as pycollada
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

BODIES = "".join(
    f'<rigid_body sid="b{i}" id="body{i}" name="Body {i}"><technique_common>{BOX}'
    "</technique_common></rigid_body>"
    for i in (1, 2)
)


def constraint(ref: str, att: str) -> str:
    return (
        f'<rigid_constraint sid="j"><ref_attachment rigid_body="{ref}"/>'
        f'<attachment rigid_body="{att}"/><technique_common/></rigid_constraint>'
    )


@pytest.mark.parametrize(
    ("written", "standard"),
    [
        ("b1", "pm/b1"),
        ("./b1", "pm/b1"),
        ("#b1", "pm/b1"),
        ("#pm/b1", "pm/b1"),
        ("pm/b1", "pm/b1"),
        ("pm0/b1", "pm/b1"),
        ("#body1", "pm/b1"),
        ("Body 1", "pm/b1"),
        ("#n1", "pm/b1"),  # the body that it moves
        ("n1", "pm/b1"),
        ("#n9", "#n9"),
        ("", ""),
    ],
)
def test_attachments_have_one_form(written: str, standard: str) -> None:
    nodes = '<node id="n1"/><node id="n2"/><node id="n9"/>'
    root, findings = mended(physics(bodies=BODIES, more=constraint(written, "pm/b2"), nodes=nodes))
    attachment = next(root.iter(C + "ref_attachment"))
    assert attachment.get("rigid_body") == standard
    assert codes(findings) == (set() if written == standard else {"repair-attachment-reference"})


def test_a_body_of_an_instanced_model_is_reached_through_the_instance() -> None:
    more = constraint("inner/b9", "b1") + '<instance_physics_model url="#other" sid="inner"/>'
    other = (
        '</physics_model><physics_model id="other"><rigid_body sid="b9"><technique_common>'
        f"{BOX}</technique_common></rigid_body>"
    )
    root, _ = mended(physics(bodies=BODIES, more=more + other))
    assert next(root.iter(C + "ref_attachment")).get("rigid_body") == "pm/inner/b9"


def test_a_missing_attachment_is_the_world() -> None:
    joint = '<rigid_constraint sid="j"><attachment rigid_body="pm/b1"/></rigid_constraint>'
    root, findings = mended(physics(BOX, more=joint))
    assert names(root, "rigid_constraint") == ["ref_attachment", "attachment", "technique_common"]
    assert next(root.iter(C + "ref_attachment")).get("rigid_body") == ""
    assert codes(findings) == {"repair-missing-attachment", "repair-missing-element"}


@pytest.mark.parametrize(
    "written", ["pm/b1", "#b1", "./b1", "#pm/b1", "body1", "Body 1", "Model:b1", "a/b/b1"]
)
def test_the_body_of_an_instance_is_its_plain_sid(written: str) -> None:
    instance = (
        f'<instance_rigid_body body="{written}" target="#n1"><technique_common/>'
        "</instance_rigid_body>"
    )
    root, findings = mended(physics(bodies=BODIES, instances=instance))
    assert next(root.iter(C + "instance_rigid_body")).get("body") == "b1"
    assert codes(findings) == {"repair-body-reference"}
    assert written in findings[0].message


def test_bodies_and_instances_without_any_name() -> None:
    bodies = BODIES.replace('sid="b1" ', "").replace('sid="b2" id="body2" name="Body 2"', "")
    instances = '<instance_rigid_body target="#n1"/><instance_rigid_body target="#n2"/>'
    root, findings = mended(physics(bodies=bodies, instances=instances))
    sids = [body.get("sid") for body in root.iter(C + "rigid_body")]
    assert sids == ["Body_1", "pm-rigid_body"]
    assert [user.get("body") for user in root.iter(C + "instance_rigid_body")] == sids
    assert {"repair-missing-sid", "repair-missing-body"} <= codes(findings)


def test_an_instance_without_a_body_takes_the_one_named_as_its_target() -> None:
    bodies = BODIES.replace('name="Body 2"', 'name="n1"')
    instances = '<instance_rigid_body target="#n1"><technique_common/></instance_rigid_body>'
    root, _ = mended(physics(bodies=bodies, instances=instances))
    assert next(root.iter(C + "instance_rigid_body")).get("body") == "b2"


def test_an_instance_without_a_target_gets_a_node_at_the_origin() -> None:
    instances = '<instance_rigid_body body="b1"><technique_common/></instance_rigid_body>'
    root, findings = mended(physics(BOX, instances=instances))
    target = next(root.iter(C + "instance_rigid_body")).get("target")
    assert [f"#{node.get('id')}" for node in root.iterfind(f"{C}library_nodes/{C}node")] == [target]
    assert codes(findings) == {"repair-missing-target"}


def test_instances_in_the_scene_itself_get_their_model() -> None:
    bare = '<instance_rigid_body body="b1" target="#n1"><technique_common/></instance_rigid_body>'
    root, findings = mended(physics(BOX, instances="", scene=bare + "<technique_common/>"))
    owner = next(root.iter(C + "instance_rigid_body")).getparent()
    assert (owner.tag, owner.get("url")) == (C + "instance_physics_model", "#pm")
    assert codes(findings) == {"repair-bare-instance"}


def test_duplicate_sids_are_told_apart_in_order() -> None:
    bodies = BODIES.replace("b2", "b1")
    instances = "".join(
        f'<instance_rigid_body body="b1" target="#n{i}"><technique_common/></instance_rigid_body>'
        for i in (1, 2)
    )
    root, findings = mended(physics(bodies=bodies, instances=instances))
    sids = [body.get("sid") for body in root.iter(C + "rigid_body")]
    assert sids == ["b1", "b1-2"]
    assert [user.get("body") for user in root.iter(C + "instance_rigid_body")] == sids
    assert codes(findings) == {"repair-duplicate-sid"}


def test_sids_that_are_paths_or_have_blanks() -> None:
    bodies = BODIES.replace('sid="b1"', 'sid="Model 1/Body 1"')
    instance = (
        '<instance_rigid_body body="Model 1/Body 1" target="#n1"><technique_common/>'
        "</instance_rigid_body>"
    )
    root, findings = mended(
        physics(bodies=bodies, instances=instance, more=constraint("Model 1/Body 1", "pm/b2"))
    )
    sid = next(root.iter(C + "rigid_body")).get("sid")
    assert sid == "Model_1_Body_1"
    assert next(root.iter(C + "instance_rigid_body")).get("body") == sid
    assert next(root.iter(C + "ref_attachment")).get("rigid_body") == f"pm/{sid}"
    assert "repair-sid-form" in codes(findings)


def test_ids_that_are_no_names_take_their_references_along() -> None:
    tree = physics(BOX, nodes='<node id="1 node"/><node id="n1"/>')
    tree.getroot().find(f".//{C}instance_rigid_body").set("target", "#1 node")
    root, findings = mended(tree)
    name = next(root.iter(C + "node")).get("id")
    assert name == "_1_node"
    assert next(root.iter(C + "instance_rigid_body")).get("target") == f"#{name}"
    assert codes(findings) == {"repair-id-form"}


def test_every_mesh_may_call_its_vertices_vertices() -> None:
    mesh = "".join(
        f'<geometry id="g{i}"><mesh>'
        + MESH.format(f"g{i}").replace(f"g{i}-v", "vertices")
        + "</mesh></geometry>"
        for i in range(3)
    )
    root, findings = mended(document(f"<library_geometries>{mesh}</library_geometries>"))
    for geometry in root.iter(C + "geometry"):
        vertices = next(geometry.iter(C + "vertices")).get("id")
        assert geometry.find(f".//{C}triangles/{C}input").get("source") == f"#{vertices}"
    assert len({v.get("id") for v in root.iter(C + "vertices")}) == 3
    assert codes(findings) == {"repair-duplicate-id"}


def test_references_without_a_hash() -> None:
    root, findings = mended(
        document(
            '<library_geometries><geometry id="g"><mesh>' + MESH.format("g") + "</mesh></geometry>"
            '<geometry id="h"><convex_mesh convex_hull_of="g"/></geometry></library_geometries>'
        )
    )
    assert root.findall(f".//{C}convex_mesh")[0].get("convex_hull_of") == "#g"
    assert codes(findings) == {"repair-url-hash"}


def test_the_only_physics_scene_is_meant() -> None:
    tree = physics(BOX)
    tree.getroot().find(f".//{C}instance_physics_scene").set("url", "#other")
    root, findings = mended(tree)
    assert root.find(f".//{C}instance_physics_scene").get("url") == "#ps"
    assert codes(findings) == {"repair-dangling-scene"}


@pytest.mark.parametrize("where", ["shape", "mass_frame", "attachment"])
def test_a_matrix_becomes_translate_and_rotate(where: str) -> None:
    matrix = "<matrix>0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1</matrix>"
    joint = constraint("", "pm/b1").replace(
        '<attachment rigid_body="pm/b1"/>',
        f'<attachment rigid_body="pm/b1">{matrix}</attachment>',
    )
    body = {
        "shape": BOX.replace("</shape>", matrix + "</shape>"),
        "mass_frame": f"<mass_frame>{matrix}</mass_frame>{BOX}",
        "attachment": BOX,
    }[where]
    root, findings = mended(physics(body, more=joint if where == "attachment" else ""))
    holder = next(root.iter(C + where))
    assert [holder.findtext(C + "translate"), holder.findtext(C + "rotate")] == [
        "5 6 7",
        "0 0 1 90",
    ]
    assert codes(findings) == {"repair-matrix"}


def test_scale_in_a_matrix_is_said_to_be_lost_and_kept() -> None:
    matrix = "<matrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</matrix>"
    root, findings = mended(physics(BOX.replace("</shape>", matrix + "</shape>")))
    assert "lost" in findings[0].message
    assert "2 0 0 0 0 2" in kept(root)


def test_an_empty_mass_frame_goes() -> None:
    root, findings = mended(physics("<mass_frame/>" + BOX))
    assert names(root, "rigid_body/technique_common") == ["shape"]
    assert codes(findings) == {"repair-empty-mass-frame"}


def test_inertia_as_a_matrix_turns_the_mass_frame() -> None:
    root, findings = mended(physics("<inertia>2 0 0 0 3 1 0 1 3</inertia>" + BOX))
    values = [float(v) for v in (next(root.iter(C + "inertia")).text or "").split()]
    assert sorted(values) == pytest.approx([2, 2, 4])
    assert names(root, "mass_frame") == ["translate", "rotate"]
    assert words(root, "mass_frame/translate") == ["0", "0", "0"]
    assert codes(findings) == {"repair-inertia-matrix"}


def test_names_on_attachments_are_kept_aside() -> None:
    joint = constraint("", "pm/b1").replace("<attachment ", '<attachment name="left" ')
    root, findings = mended(physics(BOX, more=joint))
    assert next(root.iter(C + "attachment")).get("name") is None
    assert "left" in kept(root)
    assert codes(findings) == {"repair-unknown-attribute"}


def test_sids_and_ids_in_foreign_content_are_its_own() -> None:
    foreign = '<f:a xmlns:f="urn:f" sid="s" id="i"/><f:b xmlns:f="urn:f" sid="s" id="i"/>'
    tree = document(f'<extra><technique profile="x">{foreign}</technique></extra>')
    root, findings = mended(tree)
    assert [e.get("sid") for e in root.iter("{urn:f}*")] == ["s", "s"]
    assert findings == []


@pytest.mark.parametrize(
    ("ends", "meant"),
    [
        (("b1", "#n2"), ("pm/b1", "pm/b2")),
        (("b1", "#n1"), ("pm/b1", "#n1")),  # beside its own body, a node is a place of the world
        (("#n2", "b1"), ("pm/b2", "pm/b1")),
        (("#n2", "#n2"), ("pm/b2", "#n2")),
        (("#n1", "#n2"), ("pm/b1", "pm/b2")),
    ],
)
def test_a_node_in_an_attachment_is_the_body_that_moves_it(
    ends: tuple[str, str], meant: tuple[str, str]
) -> None:
    instances = "".join(
        f'<instance_rigid_body body="b{i}" target="#n{i}"><technique_common/></instance_rigid_body>'
        for i in (1, 2)
    )
    tree = physics(bodies=BODIES, more=constraint(*ends), instances=instances)
    root, _ = mended(tree)
    found = [next(root.iter(C + name)) for name in ("ref_attachment", "attachment")]
    assert tuple(end.get("rigid_body") for end in found) == meant


def test_a_node_that_moves_several_bodies_is_none_of_them() -> None:
    instances = "".join(
        f'<instance_rigid_body body="b{i}" target="#n1"><technique_common/></instance_rigid_body>'
        for i in (1, 2)
    )
    root, findings = mended(physics(bodies=BODIES, more=constraint("", "#n1"), instances=instances))
    assert next(root.iter(C + "attachment")).get("rigid_body") == "#n1"
    assert findings == []


ESCAPES = [
    ("#My%2EModel-1", "My.Model-1", "#My.Model-1"),
    ("#My%20Model", "My Model", "#My_Model"),
    ("#m%C3%B6del", "m\u00f6del", "#m\u00f6del"),
    ("#%70m", "pm", "#pm"),
]


@pytest.mark.parametrize(("written", "name", "meant"), ESCAPES)
def test_escapes_in_references_are_understood(written: str, name: str, meant: str) -> None:
    tree = physics(BOX)
    tree.getroot().find(f".//{C}physics_model").set("id", name)
    tree.getroot().find(f".//{C}instance_physics_model").set("url", written)
    root, findings = mended(tree)
    assert root.find(f".//{C}instance_physics_model").get("url") == meant
    assert root.find(f".//{C}physics_model").get("id") == meant[1:]
    assert "repair-escaped-reference" in codes(findings)
    assert root.find(f".//{C}instance_rigid_body") is not None


def test_escapes_are_understood_in_targets_bodies_attachments_and_inputs() -> None:
    bodies = BODIES.replace('sid="b1"', 'sid="Left Wheel"')
    mesh = MESH.format("g").replace('source="#g-p"', 'source="#%67-p"')
    tree = physics(
        bodies=bodies,
        more=constraint("", "pm/Left%20Wheel"),
        instances='<instance_rigid_body body="Left%20Wheel" target="#my%20node"><technique_common/>'
        "</instance_rigid_body>",
        nodes='<node id="my node"><translate>2 0 0</translate></node>',
    )
    library = document(f'<library_geometries><geometry id="g"><mesh>{mesh}</mesh></geometry>'
                       "</library_geometries>").getroot()[1]  # fmt: skip
    tree.getroot().insert(1, library)
    root, _ = mended(tree)
    user = root.find(f".//{C}instance_rigid_body")
    assert (user.get("body"), user.get("target")) == ("Left_Wheel", "#my_node")
    assert root.find(f".//{C}attachment").get("rigid_body") == "pm/Left_Wheel"
    assert root.find(f".//{C}vertices/{C}input").get("source") == "#g-p"
    assert root.find(f"{C}library_nodes") is None


@pytest.mark.parametrize("url", ["other%20file.dae#pm", "#100%25"])
def test_other_escapes_stay(url: str) -> None:
    tree = physics(BOX, more=f'<instance_physics_model url="{url}"/>')
    _, findings = mended(tree)
    assert "repair-escaped-reference" not in codes(findings)


def test_inputs_by_a_path_mean_the_vertices_of_their_geometry() -> None:
    """OpenRAVE gives all vertices the same id."""
    meshes = "".join(
        f'<geometry id="geom{i}"><mesh>'
        + MESH.format(f"g{i}")
        .replace(f'id="g{i}-v"', 'id="vertices"')
        .replace(f'source="#g{i}-v"', f'source="#geom{i}/vertices"')
        + "</mesh></geometry>"
        for i in range(3)
    )
    root, findings = mended(document(f"<library_geometries>{meshes}</library_geometries>"))
    for geometry in root.iter(C + "geometry"):
        vertices = geometry.find(f".//{C}vertices").get("id")
        assert geometry.find(f".//{C}triangles/{C}input").get("source") == f"#{vertices}"
    assert len({vertices.get("id") for vertices in root.iter(C + "vertices")}) == 3
    assert codes(findings) == {"repair-duplicate-id", "repair-input-path"}
    mesh = pycollada.Collada(io.BytesIO(etree.tostring(root).replace(b"2008/03", b"2005/11")))
    assert [len(geometry.primitives[0]) for geometry in mesh.geometries] == [4, 4, 4]
    assert mesh.errors == []


def test_the_suffix_that_an_instance_gives_its_ids_is_understood() -> None:
    extra = '<extra type="idsuffix" name=".visual1"/>'
    nodes = (
        f'<node id="top"><instance_node url="#v1">{extra}</instance_node></node><node id="v1">'
        '<node id="v1.node0"><translate>1 2 3</translate></node></node>'
    )
    user = '<instance_rigid_body body="b1" target="#v1.node0.visual1"><technique_common/>'
    root, findings = mended(physics(BOX, nodes=nodes, instances=user + "</instance_rigid_body>"))
    assert root.find(f".//{C}instance_rigid_body").get("target") == "#v1.node0"
    assert "repair-suffixed-reference" in codes(findings)
    assert root.find(f"{C}library_nodes") is None


def test_a_suffix_may_lead_to_the_file_that_is_instanced() -> None:
    extra = '<extra type="idsuffix" name=".visual1"/>'
    nodes = f'<node id="top"><instance_node url="arm.dae#v1">{extra}</instance_node></node>'
    user = '<instance_rigid_body body="b1" target="#v1.node0.visual1"><technique_common/>'
    root, _ = mended(physics(BOX, nodes=nodes, instances=user + "</instance_rigid_body>"))
    assert root.find(f".//{C}instance_rigid_body").get("target") == "arm.dae#v1.node0"

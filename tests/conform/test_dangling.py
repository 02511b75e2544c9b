"""What refers to nothing is set aside, and says so; what may lead somewhere stays."""

from __future__ import annotations

import pytest
from lxml import etree
from tests.conform.documents import BOX, C, codes, kept, mended, physics

from colladaphy import read, validate

INSTANCE = '<instance_rigid_body body="b1" target="#n1"><technique_common/></instance_rigid_body>'
JOINT = (
    '<rigid_constraint sid="j"><ref_attachment rigid_body="{}"/><attachment rigid_body="pm/b1"/>'
    "<technique_common/></rigid_constraint>"
)
USE = '<instance_rigid_constraint constraint="j"/>'
TWO_SCENES = '<physics_scene id="other"><technique_common/></physics_scene>'


def lead_nowhere() -> dict[str, tuple[etree._ElementTree, str]]:
    """Documents by what is wrong with them, and the elements that go."""
    scenes = physics(BOX)
    instance = scenes.getroot().find(f".//{C}instance_physics_scene")
    instance.set("url", "#nowhere")
    other = etree.fromstring(f'<x xmlns="{C[1:-1]}">{TWO_SCENES}</x>')[0]
    scenes.getroot().find(f".//{C}library_physics_scenes").append(other)
    model = physics(BOX)
    model.getroot().find(f".//{C}instance_physics_model").set("url", "#nowhere")
    node = physics(BOX)
    node.getroot().find(f".//{C}instance_physics_model").set("url", "#n1")
    return {
        "scene": (scenes, "instance_physics_scene"),
        "model": (model, "instance_physics_model"),
        "no model": (node, "instance_physics_model"),
        "body": (physics(BOX, instances=INSTANCE.replace("b1", "b7")), "instance_rigid_body"),
        "constraint": (physics(BOX, instances=INSTANCE + USE), "instance_rigid_constraint"),
        "attachment": (
            physics(BOX, more=JOINT.format("pm/b7"), instances=INSTANCE + USE),
            "rigid_constraint",
        ),
    }


@pytest.mark.parametrize("what", sorted(lead_nowhere()))
def test_what_leads_nowhere_is_set_aside(what: str) -> None:
    tree, gone = lead_nowhere()[what]
    assert not validate(etree.tostring(tree)).valid
    root, findings = mended(tree)
    assert "repair-dangling-instance" in codes(findings)
    assert f"<{gone}" in kept(root)
    written = etree.tostring(root)
    assert validate(written).valid
    read(written).load()


@pytest.mark.parametrize("reference", ["", "#n2", "pm/b1"])
def test_what_may_lead_somewhere_stays(reference: str) -> None:
    root, findings = mended(physics(BOX, more=JOINT.format(reference), instances=INSTANCE + USE))
    assert findings == []
    assert kept(root) == ""


def test_models_within_models_hold_bodies_too() -> None:
    tree = physics(
        BOX,
        more=JOINT.format("pm/use/b9") + '<instance_physics_model sid="use" url="#inner"/>',
        instances=INSTANCE.replace("b1", "b9") + INSTANCE + USE,
    )
    library = tree.getroot().find(f".//{C}library_physics_models")
    inner = etree.fromstring(
        f'<x xmlns="{C[1:-1]}"><physics_model id="inner"><rigid_body sid="b9"><technique_common>'
        f"{BOX}</technique_common></rigid_body></physics_model></x>"
    )[0]
    library.append(inner)
    assert mended(tree)[1] == []


def test_references_to_what_is_moved_away_are_noticed() -> None:
    """A node that has no place where it stands takes what refers to it along."""
    tree = physics(BOX, nodes="")
    node = etree.fromstring(f'<x xmlns="{C[1:-1]}"><node id="n1"/></x>')[0]
    tree.getroot().find(f".//{C}physics_model").insert(0, node)
    root, findings = mended(tree)
    assert "repair-dangling-target" in codes(findings)
    assert validate(etree.tostring(root)).valid


@pytest.mark.parametrize("reference", ["", "pm/b1"])
def test_a_constraint_on_a_body_that_is_there_twice_is_set_aside(reference: str) -> None:
    tree = physics(BOX, more=JOINT.format(reference), instances=2 * INSTANCE + USE)
    root, findings = mended(tree)
    assert codes(findings) == {"repair-ambiguous-constraint"}
    assert "<instance_rigid_constraint" in kept(root)
    assert len(read(etree.tostring(root)).load().bodies) == 2


def test_other_constraints_of_that_model_stay() -> None:
    joint = JOINT.format("").replace("pm/b1", "pm/b2")
    bodies = "".join(
        f'<rigid_body sid="{sid}"><technique_common>{BOX}</technique_common></rigid_body>'
        for sid in ("b1", "b2")
    )
    other = INSTANCE.replace("b1", "b2")
    tree = physics(bodies=bodies, more=joint, instances=2 * INSTANCE + other + USE)
    assert mended(tree)[1] == []


def test_an_instance_of_a_node_that_is_no_node_is_set_aside() -> None:
    uses = '<instance_node url="#ps"/><instance_node url="#n2"/>'
    nodes = f'<node id="n1">{uses}</node><node id="n2"/>'
    root, findings = mended(physics(BOX, nodes=nodes))
    node = root.find(f".//{C}node")
    assert [child.get("url") for child in node.iterchildren(C + "instance_node")] == ["#n2"]
    assert 'url="#ps"' in kept(root)
    assert codes(findings) == {"repair-dangling-instance"}
    assert "<physics_scene>" in findings[0].message

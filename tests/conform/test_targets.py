"""Nodes and sources that references mean, where they lead elsewhere or nowhere."""

from __future__ import annotations

import io

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import BOX, MESH, C, codes, document, kept, mended, physics

import colladaphy
from colladaphy.conform import conform


def instance(target: str) -> str:
    return (
        f'<instance_rigid_body body="b1" target="{target}"><technique_common/>'
        "</instance_rigid_body>"
    )


def targets(root: etree._Element) -> list[str | None]:
    return [user.get("target") for user in root.iter(C + "instance_rigid_body")]


def loads(root: etree._Element) -> int:
    """How many bodies load from the document, which must be right in every respect."""
    data = etree.tostring(root)
    report = colladaphy.validate(data)
    assert report.valid, list(report)
    return len(colladaphy.read(io.BytesIO(data)).load().bodies)


@pytest.mark.parametrize("written", ["#Zoltan", "Zoltan", "#vs/Zoltan"])
def test_a_node_that_is_not_there_is_added_empty(written: str) -> None:
    root, findings = mended(physics(BOX, instances=instance(written)))
    added = root.findall(f"{C}library_nodes/{C}node")
    assert [(node.get("id"), len(node)) for node in added] == [("Zoltan", 0)]
    assert targets(root) == ["#Zoltan"]
    assert codes(findings) == {"repair-dangling-target"}
    assert "identity" in findings[0].message
    assert loads(root) == 1


def test_a_target_of_another_kind_gets_a_node_of_another_id() -> None:
    root, findings = mended(physics(BOX, instances=instance("#pm")))
    assert targets(root) == ["#pm-node"]
    assert codes(findings) == {"repair-dangling-target"}
    assert loads(root) == 1


def test_bodies_with_the_same_missing_node_share_one_and_each_is_reported() -> None:
    root, findings = mended(physics(BOX, instances=2 * instance("#Zoltan")))
    assert targets(root) == ["#Zoltan", "#Zoltan"]
    assert len(root.findall(f"{C}library_nodes/{C}node")) == 1
    assert [finding.code for finding in findings] == 2 * ["repair-dangling-target"]


def test_the_only_node_of_that_name_is_taken() -> None:
    nodes = '<node id="n1" name="Cube"/><node id="n2" name="Ball"/><node id="n3" name="Ball"/>'
    users = instance("#Cube") + instance("#Ball")
    root, findings = mended(physics(BOX, nodes=nodes, instances=users))
    assert targets(root) == ["#n1", "#Ball"]
    assert len(findings) == 2


@pytest.mark.parametrize("written", ["#n1", "#vs/inner", "other.dae#n9", "vs/inner", ""])
def test_a_target_that_is_there_stays(written: str) -> None:
    nodes = '<node id="n1"><node id="n2" sid="inner"/></node>'
    root, findings = mended(physics(BOX, nodes=nodes, instances=instance(written)))
    assert targets(root) == [written]
    assert findings == []


def test_other_references_to_an_added_node_find_it_and_those_of_other_kinds_do_not() -> None:
    nodes = '<node id="n1"><instance_geometry url="Cube"/><instance_node url="Cube"/></node>'
    root, findings = mended(physics(BOX, nodes=nodes, instances=instance("#Cube")))
    assert next(root.iter(C + "instance_node")).get("url") == "#Cube"
    assert next(root.iter(C + "instance_geometry")).get("url") == "Cube"
    assert codes(findings) == {"repair-dangling-target", "repair-url-hash"}


@pytest.mark.parametrize(
    ("parent", "stays"), [("#pm", False), ("#nowhere", False), ("#n1", True), ("x.dae#n", True)]
)
def test_the_parent_of_a_model_is_a_node(parent: str, stays: bool) -> None:
    tree = physics(BOX)
    next(tree.getroot().iter(C + "instance_physics_model")).set("parent", parent)
    root, findings = mended(tree)
    assert next(root.iter(C + "instance_physics_model")).get("parent") == (
        parent if stays else None
    )
    assert codes(findings) == (set() if stays else {"repair-parent"})
    assert (f'name="parent" value="{parent}"' in kept(root)) != stays


def test_inputs_that_name_arrays() -> None:
    mesh = MESH.format("g").replace('source="#g-p"', 'source="#g-a"')
    mesh = mesh.replace('source="#g-v"', 'source="#g-a"')
    root, findings = mended(
        document(
            f'<library_geometries><geometry id="g"><mesh>{mesh}</mesh></geometry>'
            "</library_geometries>"
        )
    )
    assert [i.get("source") for i in root.iter(C + "input")] == ["#g-p", "#g-v"]
    assert next(root.iter(C + "accessor")).get("source") == "#g-a"
    assert codes(findings) == {"repair-input-array"}
    assert len(findings) == 2


def test_a_reference_goes_to_the_definition_of_the_kind_it_expects() -> None:
    geometry = '<geometry id="same"><mesh>' + MESH.format("g") + "</mesh></geometry>"
    effect = (
        '<effect id="same"><profile_COMMON><technique sid="t"><constant/></technique>'
        "</profile_COMMON></effect>"
    )
    shown = '<node id="n"><instance_geometry url="#same"/></node>'
    tree = document(
        f"<library_effects>{effect}</library_effects>"
        f"<library_geometries>{geometry}</library_geometries>"
        '<library_materials><material id="m"><instance_effect url="#same"/></material>'
        "</library_materials>"
        f'<library_visual_scenes><visual_scene id="vs">{shown}</visual_scene>'
        "</library_visual_scenes>"
    )
    root, findings = mended(tree)
    for kind in ("geometry", "effect"):
        user = next(root.iter(f"{C}instance_{kind}"))
        assert user.get("url") == f"#{next(root.iter(C + kind)).get('id')}"
    assert codes(findings) == {"repair-duplicate-id"}


def test_of_the_definitions_of_that_kind_the_nearest_counts() -> None:
    def mesh(name: str) -> str:
        inner = MESH.format(name).replace(f"{name}-v", "same").replace(f"{name}-p", "same")
        return f'<geometry id="{name}"><mesh>{inner}</mesh></geometry>'

    root, _ = mended(document(f"<library_geometries>{mesh('a')}{mesh('b')}</library_geometries>"))
    for geometry in root.iter(C + "geometry"):
        source = next(geometry.iter(C + "source")).get("id")
        vertices = next(geometry.iter(C + "vertices")).get("id")
        users = [user.get("source") for user in geometry.iter(C + "input")]
        assert users == [f"#{source}", f"#{vertices}"]


REFERENCES = st.text("#./n1vsx :%é", max_size=6)


@settings(max_examples=50)
@given(target=REFERENCES, parent=REFERENCES)
def test_any_reference_ends_well(target: str, parent: str) -> None:
    tree = physics(BOX)
    next(tree.getroot().iter(C + "instance_rigid_body")).set("target", target)
    next(tree.getroot().iter(C + "instance_physics_model")).set("parent", parent)
    result, _ = conform(tree)
    again, more = conform(result)
    assert more == []
    assert etree.tostring(again) == etree.tostring(result)

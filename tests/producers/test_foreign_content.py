"""Content that is a profile's own affair, and references that lead nowhere, stop nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy
from colladaphy.errors import DocumentError
from colladaphy.findings import Severity

SHADOW = (
    '<extra><technique profile="other"><node id="n"><translate>9 9 9</translate></node>'
    '<instance_node url=""/><rigid_body sid="b"/></technique></extra>'
)
NODE = f'<node id="top">{SHADOW}</node><node id="n"><translate>1 2 3</translate></node>'


def test_ids_and_instances_of_a_profile_are_no_others_business() -> None:
    shadowed = f'<physics_model id="m">{body()}{SHADOW}</physics_model>'
    world = colladaphy.read(collada(shadowed, scene(instance()), NODE)).load()
    (only,) = world.bodies
    assert only.position.tolist() == [1, 2, 3]


def test_an_id_in_a_profile_is_no_target() -> None:
    nodes = f'<node id="top">{SHADOW}</node>'
    data = collada(model(body()), scene(instance()), nodes)
    assert [f.code for f in colladaphy.validate(data)] == ["link-missing"]
    with pytest.raises(DocumentError):
        colladaphy.read(data).load()


@pytest.mark.parametrize(
    "shape",
    [
        "<sphere><radius>1</radius>EXTRA</sphere>",
        "<plane><equation>0 0 1 0</equation>EXTRA</plane>",
        "<box><!-- half --><half_extents>1 1 1</half_extents>EXTRA</box>",
    ],
)
def test_a_primitive_may_have_extras(shape: str) -> None:
    extra = '<extra><technique profile="x"><a>some words</a></technique></extra>'
    shapes = f"<shape>{shape.replace('EXTRA', extra)}</shape>"
    data = collada(model(body(shapes=shapes)), scene(instance()))
    assert len(colladaphy.read(data).load().bodies) == 1


def test_a_missing_material_is_assumed_and_reported_once() -> None:
    values = '<instance_physics_material url="#nowhere"/>'
    shapes = "<shape><sphere><radius>1</radius></sphere></shape>" * 3
    data = collada(model(body(shapes=shapes, values=f"<mass>2</mass>{values}")), scene(instance()))
    document = colladaphy.read(data)
    assert len(document.load().bodies) == 1
    found = [finding for finding in document.report if finding.code == "link-missing"]
    assert [finding.severity for finding in found] == [Severity.WARNING]


@pytest.mark.parametrize("numbers", ["", "1", "1 2 3", "1 2 3 4 5"])
def test_transforms_with_too_few_numbers_are_no_fault_of_ours(numbers: str) -> None:
    data = collada(
        model(body()), scene(instance()), f'<node id="n"><rotate>{numbers}</rotate></node>'
    ).replace(b"<asset>", b"<asset><contributor><authoring_tool>OpenRAVE</authoring_tool>"
              b"</contributor>")  # fmt: skip
    document = colladaphy.read(data, repair=True)
    assert document.report.findings
    assert len(document.load().bodies) == 1


def test_the_tool_decides_nothing_about_paths(tmp_path: Path) -> None:
    """A reference to another file stays, whether that file is there or not."""
    data = collada(model(body()), scene(instance(), url="parts.dae#m"))
    path = tmp_path / "scene.dae"
    path.write_bytes(data)
    document = colladaphy.read(path, repair=True)
    assert "parts.dae#m" in document.tree.getroot().xpath("//@url")
    (tmp_path / "parts.dae").write_bytes(data.replace(b"parts.dae#m", b"#m"))
    assert len(colladaphy.read(path, repair=True).load().bodies) == 1


@pytest.mark.parametrize("blank", ["", " ", "\t"])
def test_a_blank_target_is_none(blank: str) -> None:
    data = collada(model(body()), scene(instance(target=blank)))
    (only,) = colladaphy.read(data).load().bodies
    assert only.position.tolist() == [0, 0, 0]

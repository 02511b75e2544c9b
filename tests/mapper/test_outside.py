"""Files that a document refers to and that cannot be reached cost what is in them, no more."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.mapper.documents import SPHERE, body, collada, instance, model, scene, simple

import colladaphy
from colladaphy.findings import Severity
from colladaphy.world import JointKind

UNREACHABLE = [
    "not-here.dae",
    "file:///home/me/not-here.dae",
    "openrave:/not-here.dae",
    "package://robots/not-here.dae",
    r"C:\robots\not-here.dae",
    "../not-here.dae",
    "http://example.org/not-here.dae",
]
BOX = "<shape><mass>2</mass><box><half_extents>1 1 1</half_extents></box></shape>"
NODES = '<node id="n"><translate>0 1 0</translate></node>'


def read(tmp_path: Path, data: bytes, *, repair: bool) -> tuple[colladaphy.World, list]:
    """The World, and what was found at the door and about what is outside."""
    folder = tmp_path / "folder"
    folder.mkdir(exist_ok=True)
    (folder / "main.dae").write_bytes(data)
    assert colladaphy.validate(folder / "main.dae").valid
    document = colladaphy.read(folder / "main.dae", repair=repair)
    world = document.load()
    findings = [finding for finding in document.report if finding.stage in ("io", "link")]
    assert all(finding.severity is Severity.WARNING for finding in findings)
    return world, findings


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize("file", UNREACHABLE)
def test_the_rest_loads_with_one_warning_a_file(tmp_path: Path, file: str, repair: bool) -> None:
    other = f'<instance_physics_model url="{file}#m">{instance("b", "#n")}</instance_physics_model>'
    here = f'<instance_physics_model url="#m">{instance("b")}</instance_physics_model>'
    data = collada(model(body("b", BOX)), scene(here + other * 3), NODES)
    world, findings = read(tmp_path, data, repair=repair)
    assert world.positions.tolist() == [[0.0, 1.0, 0.0]]
    (finding,) = findings
    assert finding.code in ("io-reference-missing", "io-reference-refused")
    assert finding.line and finding.path == (
        "/COLLADA/library_physics_scenes/physics_scene/instance_physics_model[2]"
    )
    told = colladaphy.validate(tmp_path / "folder" / "main.dae")
    assert [found.code for found in told if found.stage == "io"] == [finding.code]


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize("file", UNREACHABLE[:2])
def test_nodes_geometries_and_materials_elsewhere(tmp_path: Path, file: str, repair: bool) -> None:
    material = f'<instance_physics_material url="{file}#wood"/>'
    mesh = f'<shape><mass>1</mass><instance_geometry url="{file}#mesh"/></shape>'
    data = collada(
        model(
            body("a", f"<shape><mass>1</mass>{material}{SPHERE}</shape>"),
            body("b", mesh + BOX),
            body("c", BOX, f"<mass>3</mass>{material}"),
        ),
        scene(instance("a") + instance("b", f"{file}#node") + instance("c")),
        f'<node id="n"><translate>0 1 0</translate><instance_node url="{file}#node"/></node>',
    )
    world, findings = read(tmp_path, data, repair=repair)
    assert [finding.code[:12] for finding in findings] == ["io-reference"]
    assert world.masses.tolist() == [1.0, 2.0, 3.0]
    # A body whose node is out of reach stands where one without a node does.
    assert world.bodies[0].position.tolist() == [0.0, 1.0, 0.0]
    assert not world.bodies[1].position.any()
    assert world.bodies[0].material.name == world.bodies[2].material.name == "unspecified"


@pytest.mark.parametrize("repair", [False, True])
def test_each_file_is_told_of(tmp_path: Path, repair: bool) -> None:
    parent = f'<instance_physics_model url="#m" parent="a.dae#up">{instance()}'
    data = collada(
        model(body()),
        scene(
            f"{parent}</instance_physics_model>"
            '<instance_physics_model url="b.dae#m"/><instance_physics_model url="b.dae#k"/>'
        ),
        NODES,
        effects=("s",),
    ).replace(b"<scene>", b'<scene><instance_physics_scene url="c.dae#s"/>')
    world, findings = read(tmp_path, data, repair=repair)
    assert len(world.bodies) == 1
    names = sorted(finding.message.split("'")[1] for finding in findings)
    assert names == ["a.dae", "b.dae", "c.dae"]


@pytest.mark.parametrize("repair", [False, True])
def test_a_joint_to_a_place_out_of_reach_is_skipped_and_said(tmp_path: Path, repair: bool) -> None:
    joint = (
        '<rigid_constraint sid="j"><ref_attachment rigid_body="a.dae#n"/>'
        '<attachment rigid_body="m/b"/><technique_common/></rigid_constraint>'
    )
    data = collada(
        model(body(), joint),
        scene(instance() + '<instance_rigid_constraint constraint="j"/>'),
    )
    (tmp_path / "main.dae").write_bytes(data)
    document = colladaphy.read(tmp_path / "main.dae", repair=repair)
    assert not len(document.load().joints)
    codes = [finding.code for finding in document.report if "assumed" not in finding.code]
    assert codes == ["io-reference-missing", "load-constraint-skipped"]


def test_a_file_that_is_there_but_broken(tmp_path: Path) -> None:
    (tmp_path / "broken.dae").write_bytes(b"<COLLADA")
    other = '<instance_physics_model url="broken.dae#m"/>'
    here = f'<instance_physics_model url="#m">{instance("b")}</instance_physics_model>'
    data = collada(model(body("b", BOX)), scene(here + 3 * other))
    (tmp_path / "main.dae").write_bytes(data)
    with pytest.raises(colladaphy.XmlError):
        colladaphy.read(tmp_path / "main.dae").load()
    document = colladaphy.read(tmp_path / "main.dae", repair=True)
    assert len(document.load().bodies) == 1
    assert [found.code for found in document.report if found.stage == "xml"] == ["xml-truncated"]


def attached(first: str, second: str, nodes: str = "") -> bytes:
    joint = (
        f'<rigid_constraint sid="j"><ref_attachment rigid_body="{first}">'
        f'<translate>0 1 0</translate></ref_attachment><attachment rigid_body="{second}"/>'
        "<technique_common/></rigid_constraint>"
    )
    return collada(
        model(body("a", BOX), body("b", BOX), body("c", BOX), joint),
        scene(
            instance("a", "#n1") + instance("b", "#n2") + instance("c", "#n2")
            if nodes
            else instance("a", "#n1") + instance("b", "#n2") + instance("c", "#n3"),
        ).replace(
            "</instance_physics_model>",
            '<instance_rigid_constraint constraint="j"/></instance_physics_model>',
        ),
        '<node id="n1"/><node id="n2"><translate>0 5 0</translate></node><node id="n3"/>'
        '<node id="n4"><translate>0 7 0</translate></node>',
    )


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize(
    ("first", "second", "shared", "bound"),
    [
        ("m/a", "#n2", False, [0, 1]),  # the body that the node moves
        ("#n2", "m/a", False, [1, 0]),
        ("#n1", "#n2", False, [0, 1]),
        ("m/b", "#n2", False, [1, None]),  # its own node: a place of the world
        ("#n2", "m/b", False, [None, 1]),
        ("m/a", "#n4", False, [0, None]),  # moves nothing
        ("m/a", "#n2", True, [0, None]),  # moves two, so neither is meant
    ],
)
def test_a_node_in_an_attachment_is_the_body_that_it_moves(
    first: str, second: str, shared: bool, bound: list[int | None], repair: bool
) -> None:
    document = colladaphy.read(attached(first, second, "shared" if shared else ""), repair=repair)
    world = document.load()
    (joint,) = world.joints
    assert joint.kind is JointKind.FIXED
    assert [joint.body1, joint.body2] == [None if at is None else world.bodies[at] for at in bound]
    # Whatever it is attached to, the joint is where the file has it.
    position, _ = joint.frame1
    if joint.body1 is not None:
        position = position + joint.body1.position
    assert position.tolist() == [0.0, 1.0 + 5.0 * (first in ("#n2", "m/b")), 0.0]


def test_a_body_of_a_simple_document_is_no_less(tmp_path: Path) -> None:
    world, findings = read(tmp_path, simple(), repair=False)
    assert len(world.bodies) == 1 and not findings

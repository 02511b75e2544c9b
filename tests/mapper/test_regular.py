"""Which bodies the quick path takes, and that nothing can make it take another one's values."""

from __future__ import annotations

import io

import pytest
from lxml import etree

import colladaphy
from colladaphy.document.names import c
from colladaphy.mapper.columns.bodies import BodyTable
from colladaphy.mapper.columns.motions import MotionTable
from colladaphy.mapper.columns.nodes import NodeTable
from colladaphy.mapper.load import load
from colladaphy.world import World, compare


def spheres(count: int = 4) -> bytes:
    world = World()
    for number in range(count):
        world.create_sphere(
            number,
            (number, 2, 3),
            1.0 + number,
            "iron",
            orientation=(0.5, 0.5, 0.5, 0.5),
            linear_velocity=(number, 0, 0),
            angular_velocity=(0.1, number, 0.3),
        )
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return stream.getvalue()


def element(root: etree._Element, name: str) -> etree._Element:
    return next(root.iter(c(name)))


def regular(data: bytes) -> tuple[list[bool], list[bool], int]:
    root = etree.fromstring(data)
    bodies = BodyTable(element(root, "physics_model"))
    motions = MotionTable(element(root, "instance_physics_model"))
    return bodies.regular.tolist(), motions.regular.tolist(), len(NodeTable(root).rows)


def check_both_paths(data: bytes) -> World:
    quick, slow = colladaphy.read(data), colladaphy.read(data)
    one, other = load(quick), load(slow, columns=False)
    assert compare(one, other) == []
    assert [f.code for f in quick.report] == [f.code for f in slow.report]
    return one


def test_what_is_stored_is_regular() -> None:
    assert regular(spheres()) == ([True] * 4, [True] * 4, 4)


def test_indented_files_are_regular_too() -> None:
    root = etree.fromstring(spheres())
    etree.indent(root)
    assert regular(etree.tostring(root)) == ([True] * 4, [True] * 4, 4)
    assert compare(check_both_paths(etree.tostring(root)), check_both_paths(spheres())) == []


BODY = b'<rigid_body sid="Body2"'
SHAPE = b"<sphere><radius>2</radius></sphere>"
ODD_BODIES = {
    "an attribute": (BODY, b'<rigid_body id="x" sid="Body2"', True),
    "a step": (SHAPE, SHAPE + b"<translate>1 0 0</translate>", False),
    "a density": (b"</mass>", b"</mass><density>3</density>", False),
    "an extra": (SHAPE, SHAPE + b'<extra><technique profile="a"/></extra>', False),
    "another technique": (
        b'<technique profile="pe"><pe:body uid="1"/>',
        b'<technique profile="a"/><technique profile="pe"><pe:body uid="1"/>',
        False,
    ),
    "a system id": (b'<pe:body uid="1"/>', b'<pe:body uid="1" sid="77"/>', False),
    "two bodies in the profile": (
        b'<pe:body uid="1"/>',
        b'<pe:body uid="1"/><pe:body uid="9"/>',
        False,
    ),
}


@pytest.mark.parametrize("name", ODD_BODIES)
def test_bodies_with_something_more(name: str) -> None:
    old, new, is_regular = ODD_BODIES[name]
    first, second = spheres().split(BODY)
    data = first + (BODY + second).replace(old, new, 1)
    assert regular(data)[0] == [True, is_regular, True, True]
    check_both_paths(data)


# What hides a record, or looks like one: nothing of it may be taken for a body.
DECOYS = {
    "a comment": b"<!-- %s -->",
    "an unclosed comment": b"<!-- </rigid_body></instance_rigid_body></node> -->",
    "CDATA": b'<extra><technique profile="a"><note><![CDATA[%s]]></note></technique></extra>',
    "an instruction": b"<?note %s?>",
    "a nested record": b'<extra><technique profile="a">%s</technique></extra>',
    "a nested record of no namespace": (
        b'<extra><technique profile="a"><a xmlns="">%s</a></technique></extra>'
    ),
    "an attribute": b'<extra name="&lt;/rigid_body&gt;"><technique profile="a"/></extra>',
}
RECORDS = {
    "rigid_body": (
        b'<rigid_body sid="Body2"><technique_common><dynamic>true</dynamic><shape><mass>5</mass>'
        b'<instance_physics_material url="#Material0"/><sphere><radius>9</radius></sphere></shape>'
        b'</technique_common><technique profile="pe"><pe:body uid="99"/></technique></rigid_body>'
    ),
    "instance_rigid_body": (
        b'<instance_rigid_body body="Body2" target="#Node2"><technique_common/>'
        b"</instance_rigid_body>"
    ),
    "node": b'<node id="Other"><translate>7 7 7</translate></node>',
}


@pytest.mark.parametrize("record", RECORDS)
@pytest.mark.parametrize("decoy", DECOYS)
def test_decoys_change_nothing(record: str, decoy: str) -> None:
    data = spheres()
    hidden = DECOYS[decoy]
    if b"%s" in hidden:
        hidden = hidden % RECORDS[record]
    end = f"</{record}>".encode()
    first, second, rest = data.split(end, 2)
    changed = first + end + second + hidden + end + rest
    assert compare(check_both_paths(changed), check_both_paths(data)) == []


def test_prefixes_are_left_to_the_other_path() -> None:
    data = spheres()
    root = etree.fromstring(data)
    fresh = etree.Element(
        root.tag, root.attrib, nsmap={"c": root.nsmap[None], "pe": root.nsmap["pe"]}
    )
    fresh.extend(list(root))
    etree.cleanup_namespaces(fresh, keep_ns_prefixes=["pe"])
    changed = etree.tostring(fresh)
    assert regular(changed) == ([False] * 4, [False] * 4, 4)
    assert compare(check_both_paths(changed), check_both_paths(data)) == []


def test_a_broken_target_is_reported_once() -> None:
    data = spheres().replace(b'target="#Node3"', b'target="#Node77"')
    document = colladaphy.read(data)
    with pytest.raises(colladaphy.DocumentError) as caught:
        load(document)
    assert [finding.code for finding in caught.value.findings] == ["link-missing"]


def test_edited_common_values_win() -> None:
    data = spheres().replace(b"<translate>2 2 3</translate>", b"<translate>2.5 2 3</translate>")
    first, second, *rest = data.split(b"<rotate>")
    _, end = second.split(b"</rotate>", 1)
    data = b"<rotate>".join([first, b"1 0 0 90</rotate>" + end, *rest])
    world = check_both_paths(data)
    assert world.positions[2].tolist() == [2.5, 2.0, 3.0]
    assert world.orientations[0].tolist() == pytest.approx([0.5**0.5, 0.5**0.5, 0.0, 0.0])


def test_materials_are_made_in_the_order_of_their_use() -> None:
    world = World()
    values = {"restitution": 0.1, "static_friction": 0.2, "dynamic_friction": 0.3}
    others = {"poisson_ratio": 0.2, "young_modulus": 1.0, "stiffness": 1.0}
    others |= {"damping_normal": 0.0, "damping_tangential": 0.0}
    made = [world.create_material(f"m{i}", density=1.0 + i, **values, **others) for i in range(4)]
    for number in (2, 0, 3, 1):
        if number % 3:
            world.create_sphere(number, (0, 0, number), 1.0, made[number])
        else:
            world.create_plane(number, (0, 0, 1), number, made[number])
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    # Without our own spelling of ids, materials are numbered as they are first used.
    check_both_paths(stream.getvalue().replace(b"Material", b"Stuff"))

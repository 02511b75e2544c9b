"""What is called settled is what `conform` leaves alone."""

from __future__ import annotations

import io
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st
from lxml import etree
from tests.mapper.documents import body, collada, instance, model, scene

import colladaphy
from colladaphy.columns.reading import Document
from colladaphy.conform import conform
from colladaphy.conform.numerals import may_lack_digits
from colladaphy.gate import gate, is_valid_text
from colladaphy.links.settled import is_settled
from colladaphy.testing import documents, worlds
from colladaphy.world import World

CONVENTIONS = ["auto", "none"]


def check(data: bytes, convention: str = "auto") -> bool:
    """Whether a valid document is settled; the long way then changes nothing."""
    tree = etree.ElementTree(etree.fromstring(data))
    settled = is_settled(Document.of(data), convention)
    if settled:
        result, findings = conform(tree, convention=convention)
        assert [str(finding) for finding in findings] == []
        assert etree.tostring(result) == etree.tostring(tree)
    return settled


def is_valid(data: bytes) -> bool:
    """What `colladaphy.gate.accepts` says of a document of any size."""
    return (
        is_valid_text(data)
        and not may_lack_digits(data)
        and not gate(etree.ElementTree(etree.fromstring(data)))
    )


def stored(world: World) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return stream.getvalue()


def plain_world() -> World:
    world = World()
    ball = world.create_sphere(1, (0, 0, 0), 1, "iron")
    box = world.create_box(
        2, (0, 3, 0), (1, 2, 3), "oak", inertia=((1, 0.1, 0), (0.1, 1, 0), (0, 0, 1))
    )
    world.create_capsule(3, (9, 3, 0), (1, 1, 1), 3, "oak")
    world.create_plane(4, (0, 0, 1), -9, "granite", fixed=True)
    world.create_union(5, [world.create_sphere(6, (5, 0, 0), 1, "fir"),
                           world.create_box(7, (6, 0, 0), (1, 1, 1), "iron")])  # fmt: skip
    box.rotate(0.3, 0.2, 0.1)
    ball.linear_velocity = (1, 2, 3)
    world.attach_hinge_joint(ball, box, axis=(0, 0, 1))
    world.attach_joint(box, None, angular_min=(0, -1, 0), angular_max=(0, 1, 0),
                       angular_spring=(1, 2, 0.1))  # fmt: skip
    world.attach_fixed_joint(box, None)
    return world


FRAMED = collada(
    model(
        body("a", values="<mass>2</mass><mass_frame><translate>1 0 0</translate><rotate>0 0 1 9"
             "</rotate></mass_frame><inertia>1 1 1</inertia>"),
        body("b"),
            '<rigid_constraint sid="j"><ref_attachment rigid_body="m/a"/><attachment '
        'rigid_body="m/b"/><technique_common><limits><swing_cone_and_twist><min>0 0 0</min>'
        "<max>0 0 0</max></swing_cone_and_twist><linear><min>-1 0 0</min><max>1 0 0</max></linear>"
        "</limits><spring><linear><stiffness>0</stiffness><target_value>1</target_value></linear>"
        "</spring></technique_common></rigid_constraint>",
    ),
    scene(
        instance("a", "#n") + instance("b", "#k")
        + '<instance_rigid_constraint constraint="j"/>',
    ),
    '<node id="n" sid="s"><translate>1 2 3</translate></node><node id="k" sid="t"/>',
)  # fmt: skip
BASES = [stored(plain_world()), FRAMED]


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_plain_worlds_are_settled(convention: str) -> None:
    for base in BASES:
        assert is_valid(base) and check(base, convention)


@given(worlds())
@settings(max_examples=40)
def test_any_world(world: World) -> None:
    event(f"settled: {check(stored(world))}")


@given(documents(size=40), st.sampled_from(CONVENTIONS))
@settings(max_examples=40)
def test_documents_of_the_whole_schema(data: bytes, convention: str) -> None:
    check(data, convention)


@given(documents(areas=["physics"], size=40), st.sampled_from(CONVENTIONS))
@settings(max_examples=40)
def test_documents_of_physics(data: bytes, convention: str) -> None:
    check(data, convention)


NAMES = ["id", "sid", "url", "target", "parent", "body", "constraint", "rigid_body", "profile",
         "name", "type", "version"]  # fmt: skip
VALUES = ["n", "k", "#n", "#k", "m", "#m", "m/a", "m/b", "#s", "s", "a", "b", "", " a", "a b", "j",
          "#%6E", "other.dae#n", "other.dae", "./a", "#m/a", "#none", "#Body1-Node", "OpenRAVE",
          "·", "a·b", "ä", "-INF", "INF", "0", "1 0 0", "3 3 3", "-1 -1 -1"]  # fmt: skip
PIECES = [
    '<extra type="idsuffix"><technique profile="OpenRAVE"/></extra>',
    '<extra><technique profile="OpenRAVE"/></extra>',
    "<extra><technique profile=\"pe\"><mass>1</mass></technique></extra>",
    '<extra><technique profile="pe"><pe:body xmlns:pe="urn:colladaphy:pe:1"/></technique></extra>',
    '<extra><technique profile="pe"><pe:odd xmlns:pe="urn:colladaphy:pe:1"/></technique></extra>',
    "<scale>2 2 2</scale>", "<rotate>0 0 1 5</rotate>", "<translate>0 0 1</translate>",
    "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>", '<instance_node url="#k"/>',
    "<mass_frame><rotate>0 0 1 5</rotate></mass_frame>",
    '<instance_physics_model url="#m"/>',
    "<contributor><authoring_tool>Bullet Physics</authoring_tool></contributor>",
    "<contributor><author>AGEIA</author></contributor>",
]  # fmt: skip


@st.composite
def edited(draw: st.DrawFn) -> bytes:
    """A plain document after a few edits of its attributes, texts and elements."""
    root = etree.fromstring(draw(st.sampled_from(BASES)))
    for _ in range(draw(st.integers(1, 3))):
        every = [element for element in root.iter(etree.Element) if element is not root]
        element = draw(st.sampled_from(every))
        kind = draw(st.sampled_from(["attribute", "text", "drop", "copy", "piece", "unset"]))
        if kind == "attribute":
            names = sorted(str(key) for key in element.attrib) or NAMES
            name = draw(st.one_of(st.sampled_from(names), st.sampled_from(NAMES)))
            element.set(name, draw(st.sampled_from(VALUES)))
        elif kind == "unset" and element.attrib:
            del element.attrib[draw(st.sampled_from(sorted(str(key) for key in element.attrib)))]
        elif kind == "text" and not len(element):
            element.text = draw(st.sampled_from(VALUES))
        elif kind == "drop":
            element.getparent().remove(element)
        elif kind == "copy":
            twin = etree.fromstring(etree.tostring(element, with_tail=False))
            element.addnext(twin)
        elif kind == "piece":
            text = draw(st.sampled_from(PIECES))
            piece = etree.fromstring(f'<x xmlns="{etree.QName(root).namespace}">{text}</x>')[0]
            element.insert(draw(st.integers(0, len(element))), piece)
    return etree.tostring(root)


@given(edited(), st.sampled_from(CONVENTIONS))
@settings(max_examples=300, suppress_health_check=[HealthCheck.filter_too_much])
def test_edits_that_leave_a_plain_document_valid(data: bytes, convention: str) -> None:
    assume(is_valid(data))
    event(f"settled: {check(data, convention)}")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('id="k"', 'id="k·"'),
        ('id="k"', 'id=" k"'),
        ('sid="t"', 'sid="s"'),
        ('sid="b"', 'sid="a"'),
        ('target="#k"', 'target="k"'),
        ('target="#k"', 'target="#%6B"'),
        ('target="#k"', 'target="#m"'),
        ('url="#s"', 'url="#none"'),
        ('<instance_physics_scene url="#s"/>', ""),
        ('rigid_body="m/b"', 'rigid_body="b"'),
        ('rigid_body="m/b"', 'rigid_body="#k"'),
        ('body="b"', 'body="a"'),
        ("<max>1 0 0</max>", "<max>-2 0 0</max>"),
        ("<target_value>1</target_value>", "<target_value>INF</target_value>"),
        ("<translate>1 0 0</translate><rotate>", "<rotate>"),
        ("<translate>1 2 3</translate>", "<scale>1 2 3</scale>"),
        ("<asset>", "<asset><contributor><authoring_tool>Bullet Physics</authoring_tool>"
         "</contributor>"),
    ],
)  # fmt: skip
def test_what_is_mended_is_not_settled(old: str, new: str) -> None:
    """Each condition counts: without it, one of these would be taken for settled."""
    text = FRAMED.decode()
    assert old in text
    data = text.replace(old, new).encode()
    assert is_valid(data)
    tree = etree.ElementTree(etree.fromstring(data))
    result, findings = conform(tree)
    assert findings and etree.tostring(result) != etree.tostring(tree)
    assert not check(data)


def test_converted_files_of_the_corpus(corpus_dir: Path) -> None:
    for file in sorted(corpus_dir.glob("*.dae")):
        try:
            tree = etree.parse(file)
        except etree.XMLSyntaxError:
            continue
        data = etree.tostring(conform(tree)[0])
        check(data)
        check(re.sub(rb"<conform:convention[^>]*/>", b"", data))

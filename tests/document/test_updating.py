"""`Document.update`: a World is written back into its document, and nothing else is lost."""

from __future__ import annotations

import io
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from tests.thesis.listings import listing_3, listing_4, listing_5
from tests.world.changing import change

import colladaphy
from colladaphy.document import Document
from colladaphy.errors import DocumentError
from colladaphy.testing import worlds
from colladaphy.world import BodyColumns, Kind, World, compare
from colladaphy.world.materials import VALUES

COLLADA = "http://www.collada.org/2008/03/COLLADASchema"
NS = {"c": COLLADA, "pe": "urn:colladaphy:pe:1"}


def stored(world: World) -> Document:
    file = io.BytesIO()
    colladaphy.write(world, file)
    return colladaphy.read(file.getvalue())


def reread(document: Document) -> Document:
    file = io.BytesIO()
    document.write(file, check=False)
    return colladaphy.read(file.getvalue())


def reads_back(document: Document, world: World) -> None:
    """The document is valid, and gives the World to the last bit, with no finding about it."""
    assert compare(reread(document).load(), world) == []
    assert [f for f in document.report if f.code in ("store-inexact", "profile-old-value")] == []


def find(document: Document, path: str) -> list[Any]:
    found: list[Any] = document.tree.getroot().xpath(path, namespaces=NS)
    return found


def scene(
    nodes: str, bodies: str, instances: str, extra: str = "", constraints: str = "",
    attributes: str = "", libraries: str = "",
) -> Document:  # fmt: skip
    """A document of one model, as other programs write them."""
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<COLLADA xmlns="{COLLADA}" version="1.5.0">
  <asset><created>2020-01-01T00:00:00Z</created><modified>2020-01-01T00:00:00Z</modified>
    <up_axis>Z_UP</up_axis></asset>
  {libraries}
  <library_physics_models>
    <physics_model id="model">
      {bodies}
      {constraints}
    </physics_model>
  </library_physics_models>
  <library_physics_scenes>
    <physics_scene id="physics">
      <instance_physics_model url="#model"{attributes}>
        {instances}
      </instance_physics_model>
      {extra}
      <technique_common/>
    </physics_scene>
  </library_physics_scenes>
  <library_visual_scenes>
    <visual_scene id="visual">
      <!-- what is seen -->
      {nodes}
    </visual_scene>
  </library_visual_scenes>
  <scene>
    <instance_physics_scene url="#physics"/>
    <instance_visual_scene url="#visual"/>
  </scene>
</COLLADA>"""
    return colladaphy.read(text.encode())


def body(sid: str, shape: str = "<sphere><radius>1</radius></sphere>", inside: str = "") -> str:
    return f"""<rigid_body sid="{sid}"><technique_common><mass>2</mass>
        <shape>{shape}{inside}</shape></technique_common>
        <extra><technique profile="other"><note xmlns="urn:other">of {sid}</note></technique>
        </extra></rigid_body>"""


def instance(sid: str, node: str) -> str:
    return f'<instance_rigid_body body="{sid}" target="#{node}"><technique_common/>' \
           "</instance_rigid_body>"  # fmt: skip


def two(nodes: str, **options: str) -> Document:
    """Two bodies at the nodes `a` and `b`."""
    return scene(nodes, body("one") + body("two"), instance("one", "a") + instance("two", "b"),
                 **options)  # fmt: skip


# --- any World


@given(worlds(min_bodies=0), st.randoms(use_true_random=False))
def test_any_world_becomes_any_other_of_its_bodies(world: World, random: Any) -> None:
    """Poses, velocities, forces, clock, engine state; bodies and joints that go."""
    document = stored(world)
    changed: World = document.load()
    change(changed, random)
    document.update(changed)
    reads_back(document, changed)


@given(worlds(min_bodies=0), worlds(min_bodies=0))
def test_any_world_takes_the_place_of_another(first: World, second: World) -> None:
    """All that a World can say can change, bodies, unions, joints and materials included."""
    first.unit_name, first.unit_meter = second.unit_name, second.unit_meter
    first.up_axis = second.up_axis
    document = stored(first)
    document.update(second)
    reads_back(document, stored(second).load())


@given(worlds(min_bodies=0))
def test_what_did_not_change_is_not_touched(world: World) -> None:
    document = stored(world)
    before = etree.tostring(document.tree)
    document.update(document.load())
    assert etree.tostring(document.tree) == before


def test_a_way_in_steps_ends_where_the_direct_way_does() -> None:
    world = World()
    for place in range(3):
        world.create_box(place, (place, 0, 0), (1, 2, 3), "iron", orientation=(0.6, 0.8, 0, 0))
    direct, stepwise = stored(world), stored(world)
    moved: World = direct.load()
    for _ in range(3):
        moved.positions += 0.1
        moved.linear_velocities -= 1.0
        for each in moved.bodies:
            each.rotate(0.1, 0.2, 0.3)
        stepwise.update(moved)
    direct.update(moved)
    assert etree.tostring(direct.tree) == etree.tostring(stepwise.tree)


# --- what stays


def test_all_else_of_the_document_stays() -> None:
    cameras = """<library_cameras><camera id="eye"><optics><technique_common><perspective>
      <xfov>45</xfov><znear>1</znear><zfar>9</zfar></perspective></technique_common></optics></camera>
      </library_cameras>"""
    nodes = """<node id="a" name="A"><translate sid="location">1 2 3</translate>
      <instance_camera url="#eye"/><node id="seen"/></node><node id="b"/>"""
    document = two(nodes, libraries=cameras)
    world = document.load()
    world.bodies[0].position = (4, 5, 6)
    document.update(world)
    reads_back(document, world)
    assert len(find(document, "//c:instance_camera")) == len(find(document, "//c:camera")) == 1
    assert find(document, "//c:node[@id='a']/c:translate/@sid") == ["location"]
    assert find(document, "//c:node[@id='a']/c:translate/text()") == ["4 5 6"]
    assert "what is seen" in etree.tostring(document.tree, encoding="unicode")
    assert [note.text for note in find(document, "//*[local-name()='note']")] == [
        "of one",
        "of two",
    ]
    assert find(document, "//c:instance_rigid_body/@target") == ["#a", "#b"]
    assert all(finding.code.startswith("load-") for finding in document.report)


def test_the_root_is_taken_anew() -> None:
    document = two('<node id="a"/><node id="b"/>')
    document.find("#visual").name = "edited"
    world = document.load()
    world.positions += 1.0
    document.update(world)
    assert document.find("#visual").name == "edited"
    reads_back(document, world)


# --- nodes


@pytest.mark.parametrize(
    "nodes",
    [
        '<node id="a"><translate>1 2 3</translate><node id="b"><translate>4 5 6</translate></node>'
        "</node>",
        '<node id="r"><rotate>0 0 1 30</rotate><translate>9 8 7</translate><node id="a"/>'
        '<node id="m"><translate>0.1 0.2 0.3</translate><node id="b"><rotate>1 1 0 70</rotate>'
        "</node></node></node>",
        '<node id="a"><matrix sid="transform">0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1</matrix></node>'
        '<node id="b"><translate>1 0 0</translate><rotate>0 0 1 5</rotate><translate>1 0 0'
        "</translate></node>",
        '<node id="a"><translate sid="t">1 2 3</translate><rotate sid="x">1 0 0 20</rotate>'
        '<rotate sid="y">0 1 0 40</rotate></node><node id="b"><rotate sid="axis">0 0 1 10</rotate>'
        "</node>",
        '<node id="a"><lookat>1 2 3 4 5 6 0 0 1</lookat><node id="b"><translate>1 1 1</translate>'
        "</node></node>",
        '<node id="up"><scale>2 3 4</scale><node id="a"><translate>1 2 3</translate></node></node>'
        '<node id="b"><scale sid="s">2 2 2</scale></node>',
    ],
)
@pytest.mark.parametrize("which", [(0,), (1,), (0, 1)])
def test_nodes_take_their_content_where_the_body_goes(nodes: str, which: tuple[int, ...]) -> None:
    document = two(nodes)
    for name in "ab":
        (node,) = find(document, f"//c:node[@id='{name}']")
        etree.SubElement(node, f"{{{COLLADA}}}node", id=f"mark-{name}")
    sids = [step for step in find(document, "//c:node/*/@sid") if step not in ("transform",)]
    world = document.load()
    for place in which:
        moved = world.bodies[place]
        moved.position = (moved.position[0] + 1.0, -2.0, 3.5)
        moved.rotate(0.3, -0.4, 0.5)
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:instance_rigid_body/@target") == ["#a", "#b"]
    assert set(sids) <= set(find(document, "//c:node/*/@sid"))
    for name, row in zip("ab", range(2), strict=True):
        # What stood in the node of a body is still there, and so is where the body is.
        assert find(document, f"//c:node[@id='{name}']//c:node[@id='mark-{name}']")
        again = scene_of(document, f"mark-{name}")
        assert again.bodies[0].position == pytest.approx(world.bodies[row].position)


def scene_of(document: Document, node: str) -> World:
    """The World of the same document whose first body is at another node, by nodes alone."""
    copy = reread(document)
    tree = copy.tree
    for place, target in enumerate(tree.iter(f"{{{COLLADA}}}instance_rigid_body")):
        if place == 0:
            target.set("target", f"#{node}")
        for motion in target.iterchildren(f"{{{COLLADA}}}technique"):
            target.remove(motion)
    world: World = copy.load()
    return world


def test_a_shared_node_stays_for_the_others() -> None:
    document = two('<node id="a"><translate>1 2 3</translate></node>'
                   '<node id="c"/>').tree  # fmt: skip
    target = document.getroot().xpath("//c:instance_rigid_body", namespaces=NS)[1]
    target.set("target", "#a")
    shared = Document(document)
    world = shared.load()
    world.bodies[0].position = (7, 7, 7)
    shared.update(world)
    reads_back(shared, world)
    assert find(shared, "//c:node[@id='a']/c:translate/text()") == ["1 2 3"]
    assert [f.code for f in shared.report if f.code.startswith("store-")] == ["store-node-added"]


def test_a_node_that_is_instanced_twice_stays() -> None:
    library = '<library_nodes><node id="a"><translate>1 0 0</translate></node></library_nodes>'
    nodes = '<node id="x"><instance_node url="#a"/></node><node id="b"/>' \
            '<node id="y"><instance_node url="#a"/></node>'  # fmt: skip
    document = two(nodes, libraries=library)
    world = document.load()
    world.positions += 1.0
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:library_nodes/c:node/c:translate/text()") == ["1 0 0"]


def test_parents_of_instances_are_in_the_way_or_move_along() -> None:
    nodes = """<node id="p"><translate>10 0 0</translate><rotate>0 0 1 90</rotate></node>
      <node id="a"><translate>1 0 0</translate></node><node id="b"/>"""
    document = two(nodes, attributes=' parent="#p"')
    world = document.load()
    world.bodies[1].position = (1, 2, 3)
    document.update(world)
    reads_back(document, world)
    assert not [f for f in document.report if f.code == "store-node-added"]


def test_a_body_without_a_target_gets_a_node() -> None:
    document = two('<node id="a"/><node id="b"/>')
    tree = document.tree
    tree.getroot().xpath("//c:instance_rigid_body", namespaces=NS)[0].set("target", "")
    world = document.load()
    world.bodies[0].position = (1, 2, 3)
    document.update(world)
    reads_back(document, world)


# --- shapes beside the origin of the node


def off_center() -> Document:
    shape = "<box><half_extents>1 2 3</half_extents></box>"
    away = "<translate>0 0 3</translate><rotate>1 0 0 30</rotate>"
    nodes = '<node id="a"><translate>1 0 0</translate><instance_geometry url="#g"/><node id="b"/>' \
            "</node>"  # fmt: skip
    mesh = """<library_geometries><geometry id="g"><mesh><source id="s">
      <float_array id="f" count="3">0 0 0</float_array><technique_common>
      <accessor source="#f" count="1" stride="3"><param name="X" type="float"/>
      <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
      </source><vertices id="v"><input semantic="POSITION" source="#s"/></vertices></mesh>
      </geometry></library_geometries>"""
    return scene(nodes, body("one", shape, away) + body("two"),
                 instance("one", "a") + instance("two", "b"), libraries=mesh)  # fmt: skip


def test_the_node_carries_its_content_beside_the_centre() -> None:
    document = off_center()
    world = document.load()
    world.bodies[0].position = (5, 5, 5)
    document.update(world)
    reads_back(document, world)
    (text,) = find(document, "//c:node[@id='a']/c:translate/text()")
    # The box stands 3 above the origin of its node.
    assert [float(value) for value in text.split()] == pytest.approx([5, 5, 2])


def test_changed_values_leave_what_is_seen_where_it_was() -> None:
    document = off_center()
    world = document.load()
    world.masses[0] = 5.0
    document.update(world)
    reads_back(document, world)
    (note, _) = find(document, "//*[local-name()='note']")
    assert note.text == "of one"
    (geometry,) = find(document, "//c:instance_geometry")
    frame = np.eye(4)
    for step in geometry.xpath("ancestor::c:node/c:translate | ancestor::c:node/c:rotate | "
                               "ancestor::c:node/c:matrix", namespaces=NS):  # fmt: skip
        frame = frame @ step_of(step)
    assert frame == pytest.approx(np.array(
        [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]))  # fmt: skip


def step_of(step: Any) -> Any:
    values = [float(value) for value in step.text.split()]
    made = np.eye(4)
    if step.tag.endswith("matrix"):
        return np.array(values).reshape(4, 4)
    if step.tag.endswith("translate"):
        made[:3, 3] = values
        return made
    x, y, z = np.array(values[:3]) / np.linalg.norm(values[:3])
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(values[3])
    made[:3, :3] = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return made


# --- other scenes, other spellings


def test_bodies_of_other_scenes_stay_where_they_are() -> None:
    document = two('<node id="a"><translate>1 2 3</translate></node><node id="b"/>')
    library = find(document, "//c:library_physics_scenes")[0]
    other = etree.fromstring(etree.tostring(library[0]))
    other.set("id", "other")
    library.append(other)
    before = document.scenes["other"].load()
    world = document.load()
    world.positions += 1.0
    world.masses *= 2.0
    document.update(world)
    reads_back(document, world)
    assert compare(reread(document).scenes["other"].load(), before) == []


@pytest.mark.parametrize("listing", [listing_3, listing_4, listing_5])
def test_the_profile_in_the_spelling_of_the_thesis(listing: Any) -> None:
    document = colladaphy.read(listing())
    world = document.load()
    for moved in world.bodies:
        if not moved.fixed:
            moved.position = (1, 2, 3)
            moved.rotate(0.1, 0.2, 0.3)
            moved.linear_velocity = (1, 2, 3)
    world.time = 1.0
    document.update(world)
    reads_back(document, world)
    assert len(reread(document).load().member_columns.kinds) == len(world.member_columns.kinds)


def test_bodies_of_mass_alone() -> None:
    world = World()
    world.create_body(1, (1, 2, 3), 4.0, (1, 2, 3))
    document = stored(world)
    for _ in range(3):
        loaded = document.load()
        loaded.masses *= 2.0
        loaded.create_body(2, (3, 2, 1), 1.0, (1, 1, 1))
        document.update(loaded)
        reads_back(document, loaded)
    assert len(find(document, "//c:geometry")) == 1


def test_joints_at_nodes_of_the_world() -> None:
    joint = '<instance_rigid_constraint constraint="hinge"/>'
    nodes = (
        '<node id="a"><node id="b"><translate>0 0 1</translate></node></node>'
        '<node id="c"><translate>0 0 1</translate></node>'
    )
    constraint = JOINT.replace("model/two", "#c")
    instances = instance("one", "a") + instance("two", "b") + joint
    document = scene(nodes, body("one") + body("two"), instances, constraints=constraint)
    world = document.load()
    assert world.joints[0].body2 is None
    world.positions += 1.0
    document.update(world)
    reads_back(document, world)


def test_joints_at_the_nodes_of_bodies() -> None:
    joint = '<instance_rigid_constraint constraint="hinge"/>'
    nodes = '<node id="a"/><node id="b"><translate>0 0 1</translate></node>'
    constraint = JOINT.replace("model/two", "#b")
    instances = instance("one", "a") + instance("two", "b") + joint
    document = scene(nodes, body("one") + body("two"), instances, constraints=constraint)
    world = document.load()
    assert world.joints[0].body2 == world.bodies[1]
    world.positions += 1.0
    document.update(world)
    reads_back(document, world)


# --- values, bodies and joints


def test_changed_values_of_foreign_bodies() -> None:
    document = two('<node id="a"/><node id="b"/>')
    world = document.load()
    first, _ = world.bodies
    first.fixed, first.name = True, "first"
    world.masses[0] = 7.0
    values = {name: getattr(world.materials["iron"], name) for name in VALUES}
    rubber = world.create_material("rubber", **{**values, "restitution": 0.9})
    world.material_ids[1] = rubber.id
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:rigid_body/@sid") == ["one", "two"]
    assert len(find(document, "//c:extra//*[local-name()='note']")) == 2


def test_bodies_that_are_gone_and_new() -> None:
    document = two('<node id="a"/><node id="b"><node id="seen"/></node>')
    world = document.load()
    first, second = world.bodies
    third = world.create_sphere(9, (0, 0, 9), 1.0, "iron", name="third")
    world.attach_hinge_joint(second, third, axis=(0, 0, 1), name="new")
    world.destroy(first)
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:rigid_body/@sid") == ["two", "Body3"]
    # The node that only said where the first was is gone, the other one is not.
    assert find(document, "//c:visual_scene/c:node/@id") == ["b", "Node3"]
    world.destroy(world.bodies[-1])
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:rigid_body/@sid") == ["two"]
    assert not find(document, "//c:rigid_constraint | //c:instance_rigid_constraint")


def test_a_document_without_physics_takes_a_world() -> None:
    document = two('<node id="a"/><node id="b"/>')
    root = document.tree.getroot()
    for name in ("library_physics_models", "library_physics_scenes"):
        root.remove(root.find(f"{{{COLLADA}}}{name}"))
    effect = root.find(f"{{{COLLADA}}}scene")
    effect.remove(effect[0])
    world = document.load()
    world.create_sphere(1, (1, 2, 3), 1.0, "iron")
    world.gravity = (0, 0, -9)
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:visual_scene/c:node/@id") == ["a", "b", "Node1"]


JOINT = """<rigid_constraint sid="hinge"><ref_attachment rigid_body="model/one"><translate>0 0 1
  </translate></ref_attachment><attachment rigid_body="model/two"/><technique_common/>
  <technique profile="other"><note xmlns="urn:other">of the joint</note></technique>
  </rigid_constraint>"""


def test_changed_joints_stand_where_they_stood() -> None:
    joint = '<instance_rigid_constraint constraint="hinge"/>'
    away = "<translate>0 0 3</translate>"
    instances = instance("one", "a") + instance("two", "b") + joint
    document = scene('<node id="a"/><node id="b"/>', body("one", inside=away) + body("two"),
                     instances, constraints=JOINT)  # fmt: skip
    world = document.load()
    columns = world.joint_columns
    assert columns.angular_limits is not None and columns.positions is not None
    columns.angular_limits[0] = ((-1, 0, 0), (1, 0, 0))
    columns.positions[0, 0] = (0.5, 0.25, 0.125)
    document.update(world)
    reads_back(document, world)
    assert find(document, "//c:rigid_constraint/@sid") == ["hinge"]
    assert find(document, "//c:ref_attachment/@rigid_body") == ["model/one"]
    assert len(find(document, "//c:rigid_constraint//*[local-name()='note']")) == 1
    world.masses[0] = 3.0  # the rigid_body gets the frame of the body
    document.update(world)
    reads_back(document, world)


# --- models that describe several bodies


def twice() -> Document:
    """A model of two bodies that are joined, instanced twice."""
    joint = '<instance_rigid_constraint constraint="hinge"/>'
    inside = instance("one", "a") + instance("two", "b") + joint
    again = instance("one", "c") + instance("two", "d") + joint
    nodes = "".join(f'<node id="{name}"><translate>{at} 0 0</translate></node>'
                    for at, name in enumerate("abcd"))  # fmt: skip
    extra = f'<instance_physics_model url="#model">{again}</instance_physics_model>'
    return scene(nodes, body("one") + body("two"), inside, extra=extra, constraints=JOINT)


def test_one_of_two_instances_of_a_model_moves_in_place() -> None:
    document = twice()
    world = document.load()
    assert len(world.bodies) == 4 and len(world.joints) == 2
    world.positions += 1.0
    document.update(world)
    reads_back(document, world)
    assert len(find(document, "//c:physics_model")) == 1


@pytest.mark.parametrize("place", [0, 3])
def test_one_of_two_instances_of_a_model_changes(place: int) -> None:
    document = twice()
    world = document.load()
    world.masses[place] = 11.0
    document.update(world)
    reads_back(document, world)
    assert len(find(document, "//c:physics_model")) == 2
    assert "store-copied" in {finding.code for finding in document.report}
    world.destroy(world.bodies[1])
    document.update(world)
    reads_back(document, world)


def test_models_within_a_model_that_is_instanced_twice() -> None:
    outer = f"""<physics_model id="outer"><instance_physics_model url="#model">
      {instance("one", "a")}{instance("two", "b")}</instance_physics_model></physics_model>"""
    nodes = """<node id="p"/><node id="q"><translate>0 5 0</translate></node>
      <node id="a"/><node id="b"><translate>1 0 0</translate></node>"""
    document = two(nodes)
    tree = document.tree
    library = tree.getroot().find(f"{{{COLLADA}}}library_physics_models")
    library.append(
        etree.fromstring(outer.replace("<physics_model ", f'<physics_model xmlns="{COLLADA}" ', 1))
    )
    effect = tree.getroot().xpath("//c:physics_scene/c:instance_physics_model", namespaces=NS)[0]
    for inner in list(effect):
        effect.remove(inner)
    effect.set("url", "#outer")
    effect.set("parent", "#p")
    again = etree.Element(effect.tag, url="#outer", parent="#q")
    effect.addnext(again)
    world = document.load()
    assert len(world.bodies) == 4
    world.bodies[2].position = (3, 3, 3)
    world.masses[1] = 9.0
    document.update(world)
    reads_back(document, world)


# --- other documents


def parts(folder: Path) -> Path:
    """A master document that instances a model and a node of another one."""
    part = two('<node id="a"><translate>1 0 0</translate></node><node id="b"/>')
    root = part.tree.getroot()
    for name in ("library_physics_scenes", "scene"):
        root.remove(root.find(f"{{{COLLADA}}}{name}"))
    materials = etree.SubElement(root, f"{{{COLLADA}}}library_physics_materials")
    root.insert(1, materials)
    made = etree.SubElement(materials, f"{{{COLLADA}}}physics_material", id="rubber")
    etree.SubElement(made, f"{{{COLLADA}}}technique_common")
    for mass in list(root.iter(f"{{{COLLADA}}}mass")):
        shape = mass.getnext()
        etree.SubElement(shape, f"{{{COLLADA}}}instance_physics_material", url="#rubber")
        shape.insert(0, shape[-1])
    (folder / "sub").mkdir()
    part.write(folder / "sub" / "parts.dae")
    master = two('<node id="c"><translate>5 0 0</translate></node>')
    tree = master.tree
    models = tree.getroot().find(f"{{{COLLADA}}}library_physics_models")
    tree.getroot().remove(models)
    effect = next(tree.iter(f"{{{COLLADA}}}instance_physics_model"))
    effect.set("url", "sub/parts.dae#model")
    effect[0].set("target", "sub/parts.dae#a")
    effect[1].set("target", "#c")
    master.write(folder / "master.dae")
    return folder / "master.dae"


def test_other_documents_are_not_written(tmp_path: Path) -> None:
    file = parts(tmp_path)
    before = (tmp_path / "sub" / "parts.dae").read_bytes()
    document = colladaphy.read(file)
    world = document.load()
    assert len(world.bodies) == 2
    world.positions += 1.0
    world.masses[1] = 4.0
    document.update(world)
    document.write(file)
    again = colladaphy.read(file)
    assert compare(again.load(), world) == []
    assert again.related == [str(tmp_path / "sub" / "parts.dae")]
    assert (tmp_path / "sub" / "parts.dae").read_bytes() == before
    # The model is a copy now, and its materials are still those of the other document.
    assert len(find(again, "//c:physics_model")) == 1
    urls = find(again, "//c:instance_physics_material/@url")
    assert "sub/parts.dae#rubber" in urls


def test_a_scene_of_another_document_is_copied(tmp_path: Path) -> None:
    document = two('<node id="a"/><node id="b"/>')
    document.write(tmp_path / "scene.dae")
    root = document.tree.getroot()
    for name in ("library_physics_scenes", "library_physics_models"):
        root.remove(root.find(f"{{{COLLADA}}}{name}"))
    next(root.iter(f"{{{COLLADA}}}instance_physics_scene")).set("url", "scene.dae#physics")
    document.write(tmp_path / "master.dae")
    before = (tmp_path / "scene.dae").read_bytes()
    master = colladaphy.read(tmp_path / "master.dae")
    world = master.load()
    world.positions += 1.0
    world.masses[0] = 3.0
    world.time = 1.0
    master.update(world)
    master.write(tmp_path / "master.dae")
    again = colladaphy.read(tmp_path / "master.dae")
    assert compare(again.load(), world) == []
    assert (tmp_path / "scene.dae").read_bytes() == before
    assert find(again, "//c:instance_physics_scene/@url") == ["#physics"]


# --- what cannot be


def test_worlds_of_other_units_and_axes_are_refused() -> None:
    document = two('<node id="a"/><node id="b"/>')
    before = etree.tostring(document.tree)
    for world in (document.load(up_axis="Y_UP"), World(unit=("inch", 0.0254))):
        with pytest.raises(DocumentError, match="unit and up axis"):
            document.update(world)
    assert etree.tostring(document.tree) == before


def test_chosen_scenes() -> None:
    document = two('<node id="a"/><node id="b"/>')
    effect = document.tree.getroot().find(f"{{{COLLADA}}}scene")
    effect.remove(effect[0])
    world = document.scenes["physics"].load()
    world.positions += 2.0
    document.update(world, scenes=["physics"])
    again = reread(document)
    assert compare(again.scenes["physics"].load(), world) == []


# --- time


def _many(count: int) -> Document:
    world = World()
    sizes = np.zeros((count, 4))
    sizes[:, 0] = 1.0
    places = np.random.default_rng(1).normal(size=(count, 3))
    kinds = np.full(count, int(Kind.SPHERE))
    world.extend(BodyColumns(kinds=kinds, dimensions=sizes, positions=places))
    for first, second in pairwise(list(world.bodies)[: count // 4]):
        world.attach_ball_joint(first, second)
    return stored(world)


def _move(world: World) -> None:
    world.positions += 1.0
    world.linear_velocities += 1.0


def _exchange(world: World) -> None:
    """Half of the bodies go, as many come, and the others have another mass."""
    count = len(world.bodies)
    for body_ in list(world.bodies)[::2]:
        world.destroy(body_)
    world.masses *= 2.0
    sizes = np.zeros((count // 2, 4))
    sizes[:, 0] = 1.0
    world.extend(BodyColumns(kinds=np.full(count // 2, int(Kind.SPHERE)), dimensions=sizes))


@pytest.mark.parametrize("change", [_move, _exchange])
def test_time_grows_with_the_document(change: Any) -> None:
    spent = []
    for count in (1000, 8000):
        tries = []
        for _ in range(2):
            document = _many(count)
            world = document.load()
            change(world)
            began = time.process_time()
            document.update(world)
            tries.append(time.process_time() - began)
        spent.append(min(tries))
    assert spent[1] < 16 * spent[0], spent


def test_deep_nodes_are_placed_exactly() -> None:
    count = 60
    steps = "<translate>1 0 0</translate><rotate>0 1 1 3</rotate>"
    nodes = "".join(f'<node id="n{at}">{steps}' for at in range(count)) + "</node>" * count
    document = scene(nodes, "".join(body(f"b{at}") for at in range(count)),
                     "".join(instance(f"b{at}", f"n{at}") for at in range(count)))  # fmt: skip
    world = document.load()
    world.positions += np.random.default_rng(2).normal(size=(count, 3))
    document.update(world)
    reads_back(document, world)
    assert not [f for f in document.report if f.code.startswith("store-")]

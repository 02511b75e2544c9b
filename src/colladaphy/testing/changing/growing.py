"""Bodies that an editor program removes, copies and adds."""

from __future__ import annotations

import copy

from hypothesis import strategies as st
from lxml import etree

from colladaphy.testing.changing.elements import C, child, common, free_id, insert_in_order, make

__all__ = ["add_body", "copy_body", "remove_body"]

Element = etree._Element
_radii = st.integers(1, 16).map(lambda number: number / 8)


def remove_body(draw: st.DrawFn, instance: Element) -> None:
    """Removes an instance of a body; what it was an instance of stays."""
    parent = instance.getparent()
    assert parent is not None
    parent.remove(instance)


def copy_body(draw: st.DrawFn, instance: Element) -> None:
    """Instances a body once more, at a node of its own."""
    root = instance.getroottree().getroot()
    again = copy.deepcopy(instance)
    again.tail = None
    again.set("target", f"#{_new_node(draw, root)}")
    if again.get("sid") is not None:
        del again.attrib["sid"]
    for technique in again.findall(f"{C}technique"):  # what a profile knows is of the other one
        again.remove(technique)
    parent = instance.getparent()
    assert parent is not None
    # A constraint could not tell which of the two it binds.
    for constraint in parent.findall(f"{C}instance_rigid_constraint"):
        parent.remove(constraint)
    instance.addnext(again)


def add_body(draw: st.DrawFn, instance: Element) -> None:
    """A ball in a model of its own, which stands beside another one or in it."""
    root = instance.getroottree().getroot()
    model = make("physics_model", id=free_id(root, "new-model"))
    body = make("rigid_body", sid="ball")
    technique, shape, sphere = make("technique_common"), make("shape"), make("sphere")
    sphere.append(make("radius", repr(draw(_radii))))
    shape.extend([make("mass", "1.5"), sphere])
    technique.append(shape)
    body.append(technique)
    model.append(body)
    used = make("instance_rigid_body", body="ball", target=f"#{_new_node(draw, root)}")
    used.append(make("technique_common"))
    whole = make("instance_physics_model", url=f"#{model.get('id')}")
    whole.append(used)
    instance.addnext(whole)
    library = make("library_physics_models")
    library.append(model)
    insert_in_order(root, library, ("asset",))


def _new_node(draw: st.DrawFn, root: Element) -> str:
    """The id of a new node in the visual scene, which is made where there is none."""
    node = make("node", id=free_id(root, "new-node"))
    place = " ".join(map(str, draw(st.tuples(*[st.integers(-5, 5)] * 3))))
    node.append(make("translate", place))
    scenes = common(root, "visual_scene")
    scene = scenes[0] if scenes else None
    if scene is None:
        scene = make("visual_scene", id=free_id(root, "new-visual"))
        library = make("library_visual_scenes")
        library.append(scene)
        insert_in_order(root, library, ("asset",))
        _show(root, scene.get("id", ""))
    insert_in_order(scene, node, ("asset", "node"))
    return node.get("id", "")


def _show(root: Element, id: str) -> None:
    effect = child(root, "scene")
    if effect is not None and child(effect, "instance_visual_scene") is None:
        shown = make("instance_visual_scene", url=f"#{id}")
        insert_in_order(effect, shown, ("instance_physics_scene",))

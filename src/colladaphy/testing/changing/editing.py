"""What an editor program does to a document: it stays valid, and means something else."""

from __future__ import annotations

import math
from collections.abc import Callable

from hypothesis import strategies as st
from lxml import etree

from colladaphy.testing.changing.elements import NUMERIC, C, child, common, insert_in_order, make
from colladaphy.testing.changing.growing import add_body, copy_body, remove_body
from colladaphy.testing.changing.rewriting import Change, Element, of, whole
from colladaphy.testing.markup import numbers

__all__ = ["EDITS"]

_small = st.integers(-40, 40).map(lambda number: number / 8)
_positive = st.integers(1, 64).map(lambda number: number / 8)
_shares = st.integers(0, 8).map(lambda number: number / 8)
_vectors = st.tuples(_small, _small, _small)
_axes = st.sampled_from([(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.6, -0.8, 0.0)])


def _number(of_size: st.SearchStrategy[float]) -> Callable[[st.DrawFn, Element], None]:
    """Sets the one number that an element holds."""

    def change(draw: st.DrawFn, element: Element) -> None:
        _set(element, numbers([draw(of_size)]))

    return change


def _set(element: Element, text: str) -> None:
    """Another text; comments within it go."""
    for inner in list(element):
        element.remove(inner)
    element.text = text


def _text_of(element: Element) -> str:
    """The text of an element, whatever comments stand in it."""
    return (element.text or "") + "".join(inner.tail or "" for inner in element)


def _move(draw: st.DrawFn, node: Element) -> None:
    """Drags a node: to another place, where it has one, or by a new translation."""
    place = child(node, "translate")
    text = numbers(draw(_vectors))
    if place is not None:
        _set(place, text)
    else:
        _prepend(node, make("translate", text))


def _turn(draw: st.DrawFn, node: Element) -> None:
    angle = draw(st.integers(-180, 180))
    _prepend(node, make("rotate", numbers((*draw(_axes), float(angle)))))


def _prepend(node: Element, step: Element) -> None:
    node.insert(1 if len(node) and node[0].tag == f"{C}asset" else 0, step)


def _resize(draw: st.DrawFn, element: Element) -> None:
    factor = draw(st.sampled_from([2.0, 0.5, 1.5]))
    sizes = [float(word) * factor for word in _text_of(element).split()]
    if all(0 < size < math.inf for size in sizes):
        _set(element, numbers(sizes))


def _fix(draw: st.DrawFn, body: Element) -> None:
    technique = child(body, "technique_common")
    assert technique is not None
    found = child(technique, "dynamic")
    if found is None:
        after = ("angular_velocity", "velocity")
        found = insert_in_order(technique, make("dynamic"), after)
    _set(found, draw(st.sampled_from(["false", "true"])))


def _push(draw: st.DrawFn, instance: Element) -> None:
    technique = child(instance, "technique_common")
    assert technique is not None
    found = child(technique, "velocity")
    if found is None:
        found = insert_in_order(technique, make("velocity"), ("angular_velocity",))
    _set(found, numbers(draw(_vectors)))


def _weigh(draw: st.DrawFn, body: Element) -> None:
    """States the mass of the whole body."""
    technique = child(body, "technique_common")
    assert technique is not None
    found = child(technique, "mass")
    if found is None:
        after = ("angular_velocity", "velocity", "dynamic")
        found = insert_in_order(technique, make("mass"), after)
    _set(found, numbers([draw(_positive)]))


def _gravity(draw: st.DrawFn, scene: Element) -> None:
    technique = child(scene, "technique_common")
    assert technique is not None
    found = child(technique, "gravity")
    if found is None:
        found = insert_in_order(technique, make("gravity"), ())
    _set(found, numbers((0.0, 0.0, draw(_small))))


def _remove(draw: st.DrawFn, element: Element) -> None:
    parent = element.getparent()
    if parent is not None:
        parent.remove(element)


def _unit(draw: st.DrawFn, root: Element) -> None:
    asset = child(root, "asset")
    assert asset is not None
    unit = child(asset, "unit")
    if unit is None:
        before = ("contributor", "coverage", "created", "keywords", "modified", "revision",
                  "subject", "title")  # fmt: skip
        unit = insert_in_order(asset, make("unit"), before)
    name, size = draw(st.sampled_from([("centimeter", "0.01"), ("meter", "1"), ("foot", "0.3048")]))
    unit.set("name", name)
    unit.set("meter", size)


def _round(draw: st.DrawFn, root: Element) -> None:
    """Numbers of seven digits, as programs write them that calculate in single precision."""
    for element in common(root, *(set(NUMERIC) - {"inertia"})):
        words = [_rounded(word) for word in _text_of(element).split()]
        _set(element, " ".join(words))


def _rounded(word: str) -> str:
    rounded = f"{float(word):.7g}"
    usual = math.isfinite(float(word)) and math.isfinite(float(rounded))
    return rounded if usual and bool(float(word)) == bool(float(rounded)) else word


def _drop(*names: str) -> Callable[[st.DrawFn, Element], None]:
    def change(draw: st.DrawFn, root: Element) -> None:
        for element in list(root.iter(*(C + name for name in names))):
            _remove(draw, element)

    return change


def _drop_techniques(draw: st.DrawFn, root: Element) -> None:
    """Those of any profile, and the extras that had nothing else."""
    for technique in [each for each in root.iter(f"{C}technique") if "profile" in each.attrib]:
        around = technique.getparent()
        _remove(draw, technique)
        if around is not None and around.tag == f"{C}extra" and child(around, "technique") is None:
            _remove(draw, around)


def _drop_comments(draw: st.DrawFn, root: Element) -> None:
    etree.strip_tags(root, etree.Comment)
    etree.strip_tags(root, etree.ProcessingInstruction)


def _indent(draw: st.DrawFn, root: Element) -> None:
    etree.indent(root, "    ")


def _saved(draw: st.DrawFn, root: Element) -> None:
    """When it was saved."""
    for element in common(root, "modified")[:1]:
        _set(element, "2024-02-29T12:00:00Z")


def _second_instance(root: Element) -> list[Element]:
    """Instances of bodies, if there is one more in the document than may be removed."""
    found = common(root, "instance_rigid_body")
    return found if len(found) > 1 else []


def _several_scenes(root: Element) -> list[Element]:
    scenes = [each.get("id") for each in common(root, "physics_scene")]
    return common(root, "instance_physics_scene")[:1] if all(scenes) and len(scenes) > 1 else []


def _switch(draw: st.DrawFn, instance: Element) -> None:
    """Another scene is in effect."""
    root = instance.getroottree().getroot()
    used = {each.get("url") for each in common(root, "instance_physics_scene")}
    others = [each.get("id", "") for each in common(root, "physics_scene")]
    free = [id for id in others if f"#{id}" not in used]
    if free:
        instance.set("url", f"#{draw(st.sampled_from(free))}")


EDITS: dict[str, Change] = {
    "nodes-moved": (of("node"), _move),
    "nodes-turned": (of("node"), _turn),
    "masses": (of("rigid_body", "instance_rigid_body"), _weigh),
    "sizes": (of("radius", "half_extents", "height"), _resize),
    "materials": (of("dynamic_friction", "restitution", "static_friction"), _number(_shares)),
    "fixed": (of("rigid_body", "instance_rigid_body"), _fix),
    "velocities": (of("instance_rigid_body"), _push),
    "gravity": (of("physics_scene"), _gravity),
    "bodies-removed": (_second_instance, remove_body),
    "bodies-copied": (of("instance_rigid_body"), copy_body),
    "bodies-added": (of("instance_physics_model"), add_body),
    "joints-removed": (of("instance_rigid_constraint"), _remove),
    "unit": (whole, _unit),
    "numbers-rounded": (whole, _round),
    "techniques-dropped": (whole, _drop_techniques),
    "extras-dropped": (whole, _drop("extra")),
    "comments-dropped": (whole, _drop_comments),
    "indented": (whole, _indent),
    "saved": (whole, _saved),
    "scenes-switched": (_several_scenes, _switch),
}
"""Edits by name; after each a valid document is valid."""

"""Rigid bodies and their instances, with what a World says of them now."""

from __future__ import annotations

from copy import deepcopy

from lxml import etree

from colladaphy.document.placing import indent, indentation, separator
from colladaphy.document.updating.elements import (
    child,
    children,
    drop,
    profile_element,
    put,
    replace_profile,
)
from colladaphy.links.names import PE, c
from colladaphy.mapper.tokens import system_id

__all__ = ["foreign_content", "pin", "replace_body", "replace_joint", "set_motion", "set_name"]

_OVERRIDES = (
    "dynamic", "mass", "mass_frame", "inertia", "instance_physics_material", "physics_material",
    "shape",
)  # fmt: skip


def set_name(element: etree._Element, stored: etree._Element) -> None:
    """Take over the name, or that there is none."""
    name = stored.get("name")
    if name is None:
        element.attrib.pop("name", "")
    else:
        element.set("name", name)


def pin(element: etree._Element, name: str, prefix: str, sid: int) -> None:
    """Let the pe:body of a rigid_body, or the pe:joint of a rigid_constraint, say a system id."""
    kept = profile_element(element, name)
    if kept is None:
        kept = etree.Element(f"{{{PE}}}{name}", nsmap={"pe": PE})
        kept.set("sid", str(sid))
        replace_profile(element, name, kept)
        return
    said = kept.get("sid")
    stated = system_id(element.get("sid", ""), prefix) if said is None else int(said)
    if stated != sid:
        kept.set("sid", str(sid))


def set_motion(instance: etree._Element, stored: etree._Element) -> None:
    """Velocities, forces and sleep of an instance_rigid_body, and its exact pose."""
    common, made = child(instance, "technique_common"), child(stored, "technique_common")
    assert common is not None and made is not None
    for before, name in (((), "angular_velocity"), (("angular_velocity",), "velocity")):
        old, new = child(common, name), child(made, name)
        if old is not None and new is not None:
            old.text = new.text
            for inner in list(old):
                old.remove(inner)
        elif old is not None:
            drop(old)
        elif new is not None:
            put(common, new, before)
    replace_profile(instance, "motion", profile_element(stored, "motion"))


def replace_body(body: etree._Element, instance: etree._Element, stored: etree._Element) -> None:
    """What a rigid_body is; what its instance says otherwise, of all but motion, is taken out."""
    _keep_extras(body, stored)
    _replace(body, stored, "technique_common")
    replace_profile(body, "body", profile_element(stored, "body"))
    set_name(body, stored)
    if stored.get("name") is None:
        instance.attrib.pop("name", "")
    common = child(instance, "technique_common")
    assert common is not None
    for override in children(common, *_OVERRIDES):
        drop(override)


def _keep_extras(body: etree._Element, stored: etree._Element) -> None:
    """Let the shapes keep what other programs say of them, where they are as many as before."""
    shapes = [list(element.iter(c("shape"))) for element in (body, stored)]
    if len(shapes[0]) == len(shapes[1]):
        for old, made in zip(*shapes, strict=True):
            for extra in children(old, "extra"):
                made.append(deepcopy(extra))


def replace_joint(constraint: etree._Element, stored: etree._Element) -> None:
    """What a rigid_constraint is."""
    for name in ("ref_attachment", "attachment"):
        old = child(constraint, name)
        made = child(stored, name)
        assert made is not None
        for extra in [] if old is None else children(old, "extra"):
            made.append(deepcopy(extra))
        _replace(constraint, stored, name)
    _replace(constraint, stored, "technique_common")
    replace_profile(constraint, "joint", profile_element(stored, "joint"))
    set_name(constraint, stored)


def _replace(element: etree._Element, stored: etree._Element, name: str) -> None:
    old, made = child(element, name), child(stored, name)
    assert old is not None and made is not None
    line = separator(element, False)
    unit = indentation(element, line)
    made.tail = old.tail
    element.replace(old, made)
    indent(made, line, unit)


def foreign_content(body: etree._Element) -> list[etree._Element]:
    """Copies of what other programs have put into an element."""
    return [
        deepcopy(inner) for inner in body.iterchildren(c("technique"), c("extra"))
        if inner.get("profile") != "pe"
    ]  # fmt: skip

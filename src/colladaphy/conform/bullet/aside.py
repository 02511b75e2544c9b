"""What Bullet cannot have, set aside for the way back.

Bullet keeps the extras of what it loads: bodies without a shape and constraints that are not
enabled go there, and so does what a mesh stands for that took the place of a primitive.
"""

from __future__ import annotations

import math
import sys
from typing import cast

from lxml import etree

from colladaphy.conform.context import CONFORM, NS, Context, insert, local
from colladaphy.conform.downgrade.draft import KEPT_PROFILE, Draft, detach

__all__ = ["note_primitive", "restore_instances", "restore_primitives", "set_aside"]

_KEPT = ("instance_rigid_body", "instance_rigid_constraint")
_INSTEAD = f"{{{CONFORM}}}instead_of"
_PLACE = f"{{{CONFORM}}}place"
_LISTS = ("height", "radius")
_SIZES = {"cylinder": [1, 2], "capsule": [1, 3]}
"""How many numbers each of the lists has."""


def set_aside(draft: Draft, instances: list[etree._Element]) -> None:
    """Move instances into an extra of the instance of their model, with their places there."""
    for instance in instances:
        same = list(instance.itersiblings(instance.tag, preceding=True))
        instance.set(_PLACE, str(len(same)))
    for instance in instances:
        draft.keep(instance)


def note_primitive(draft: Draft, primitive: etree._Element, geometry: etree._Element) -> None:
    """Say in an extra of a geometry which primitive it stands for."""
    extra, technique = draft.make("extra"), draft.make("technique")
    technique.set("profile", "colladaphy")
    nsmap = cast("dict[str, str]", {None: CONFORM})
    note = etree.SubElement(technique, _INSTEAD, nsmap=nsmap)
    note.set("name", local(primitive))
    for child in primitive:
        if local(child) in _LISTS:
            note.set(local(child), " ".join((child.text or "").split()))
    extra.append(technique)
    geometry.append(extra)


def restore_instances(context: Context) -> None:
    """Put back the instances that were set aside."""
    for technique in list(context.root.iter(NS + "technique")):
        extra = technique.getparent()
        holder = None if extra is None else extra.getparent()
        if extra is None or holder is None or technique.get("profile") != KEPT_PROFILE:
            continue
        if local(holder) == "instance_physics_model":
            _put_back(holder, technique)
            if not len(technique):
                detach(technique if len(extra) > 1 else extra)


def restore_primitives(context: Context) -> None:
    """Put primitives in the place of the meshes that stood for them."""
    for note in list(context.root.iter(_INSTEAD)):
        geometry = next(note.iterancestors(NS + "geometry"), None)
        sizes = [len(_numbers(note.get(name, ""))) for name in _LISTS]
        if geometry is not None and _SIZES.get(note.get("name", "")) == sizes:
            _put_primitive(context, note, geometry)


def _put_back(holder: etree._Element, technique: etree._Element) -> None:
    kept = [child for child in technique if local(child) in _KEPT]
    for instance in sorted(kept, key=_place_of):
        place = _place_of(instance)
        instance.attrib.pop(_PLACE, "")
        same = [child for child in holder if local(child) == local(instance)]
        if place < len(same):
            insert(holder, holder.index(same[place]), detach(instance))
            continue
        names = ("asset", "instance_force_field", *_KEPT[: _KEPT.index(local(instance)) + 1])
        before = [at for at, child in enumerate(holder) if local(child) in names]
        insert(holder, before[-1] + 1 if before else 0, detach(instance))


def _place_of(instance: etree._Element) -> int:
    """The place among all of its kind; the end where that is not told."""
    text = instance.get(_PLACE, "")
    return int(text) if text.isascii() and text.isdigit() and len(text) < 10 else sys.maxsize


def _put_primitive(context: Context, note: etree._Element, geometry: etree._Element) -> None:
    """The primitive in every shape that has the mesh, and no mesh."""
    url = f"#{geometry.get('id')}"
    found = [instance for instance in context.all("instance_geometry")
             if (instance.get("url") or "").strip() == url]  # fmt: skip
    for instance in found:
        primitive = context.make(note.get("name", ""))
        for name in _LISTS:
            primitive.append(context.make(name, note.get(name)))
        instance.addprevious(primitive)
        primitive.tail = instance.tail
        parent = instance.getparent()
        if parent is not None:
            parent.remove(instance)
    library = geometry.getparent()
    detach(geometry)
    if library is not None and not any(local(child) == "geometry" for child in library):
        detach(library)


def _numbers(text: str) -> list[float]:
    """The numbers of a list; none where it is no list of finite ones."""
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []

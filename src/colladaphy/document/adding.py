"""A World as one more physics scene of a document (thesis 5.2, 5.4)."""

from __future__ import annotations

import re

from lxml import etree

from colladaphy.errors import DocumentError, SchemaError
from colladaphy.gate import gate
from colladaphy.links import rules
from colladaphy.links.names import c
from colladaphy.mapper import WriteOptions, store
from colladaphy.source.copying import copy_tree
from colladaphy.world import World

__all__ = ["with_scene"]

_REFERENCES = ("url", "source", "target", "first", "second", "rigid_body")
_NAME = re.compile(r"[^\W\d][\w.\-]*\Z")


def with_scene(
    tree: etree._ElementTree, world: World, id: str, options: WriteOptions | None
) -> etree._ElementTree:
    """A copy of `tree` that also holds the World, as an instantiated physics scene of that id.

    All ids of the new elements begin with the scene's. Raises DocumentError where the id cannot
    be taken.
    """
    used = set(_ids(tree.getroot()))
    if not _NAME.match(id):
        raise DocumentError(rules.SCENE_ID.at(message=f"{id!r} is not a valid id."))
    stored = etree.fromstring(store(world, options), etree.XMLParser(huge_tree=True))
    renamed = {old: f"{id}-{old}" for old in _ids(stored)}
    renamed[next(stored.iter(c("physics_scene"))).get("id", "")] = id
    if taken := sorted(used.intersection(renamed.values())):
        message = f"The document has an element of the id {taken[0]!r} already."
        raise DocumentError(rules.SCENE_ID.at(message=message))
    _rename(stored, renamed)
    result = copy_tree(tree)
    _join(result.getroot(), stored)
    faults = gate(result)
    if faults:
        raise SchemaError(faults)
    return result


def _ids(root: etree._Element) -> list[str]:
    return [element.get("id", "") for element in root.iter(etree.Element) if "id" in element.attrib]


def _rename(stored: etree._Element, renamed: dict[str, str]) -> None:
    for element in stored.iter(etree.Element):
        if "id" in element.attrib:
            element.set("id", renamed[element.get("id", "")])
        for name in _REFERENCES:
            value = element.get(name)
            if value is not None:
                mark = "#" if value.startswith("#") else ""
                head, slash, rest = value.removeprefix("#").partition("/")
                element.set(name, f"{mark}{renamed.get(head, head)}{slash}{rest}")


def _join(root: etree._Element, stored: etree._Element) -> None:
    """Put the libraries before the scene, and the instance of the scene behind the others."""
    effect = root.find(c("scene"))
    if effect is None:
        effect = etree.Element(c("scene"))
        last = [child for child in root.iterchildren("{*}*") if child.tag != c("extra")][-1]
        last.addnext(effect)
    for library in list(stored):
        if str(library.tag).startswith(c("library_")):
            effect.addprevious(library)
    instances = stored.find(c("scene"))
    assert instances is not None
    place = len(list(effect.iterchildren(c("instance_physics_scene"))))
    others = list(effect.iterchildren("{*}*"))[place:]
    for instance in list(instances):
        if instance.tag == c("instance_visual_scene") and effect.find(instance.tag) is not None:
            continue  # a document shows one visual scene
        if others:
            others[0].addprevious(instance)
        else:
            effect.append(instance)

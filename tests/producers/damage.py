"""Damage: what an editor's slip, a bug of an exporter or a bad merge makes of a file."""

from __future__ import annotations

import copy
from random import Random

from lxml import etree

__all__ = ["damaged"]

_WORDS = (
    "", " ", "NaN", "INF", "1e999", "-1", "0", "0 0", "-0", "1e-320", "1e308", "1_0", "0x10", "１",
    "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16", "abc", "true", "ä b", "2147483648",
    "99999999999999999999", "#nowhere", "#model", "#physics", "#look", "model/link0", "link0",
    "link0-node", "model",
)  # fmt: skip
_NAMES = (
    "asset", "bogus", "extra", "float_array", "instance_geometry", "instance_node",
    "instance_physics_model", "limits", "mass", "mesh", "node", "p", "physics_model", "radius",
    "rigid_body", "scene", "shape", "source", "sphere", "technique", "technique_common",
    "translate",
)  # fmt: skip
_ATTRIBUTES = ("id", "sid", "name", "url", "target", "body", "parent", "rigid_body")


def damaged(data: bytes, random: Random) -> bytes:
    """A document after one to four accidents; still well-formed."""
    root = etree.fromstring(data)
    elements = [element for element in root.iter(etree.Element) if element is not root]
    for _ in range(random.randint(1, 4)):
        _damage(random.choice(elements), elements, random)
    return etree.tostring(root)


def _damage(element: etree._Element, elements: list[etree._Element], random: Random) -> None:
    parent = element.getparent()
    if parent is None:
        return
    space = element.tag.rpartition("}")[0] + "}"
    match random.randrange(10):
        case 0:
            parent.remove(element)
        case 1:
            parent.insert(random.randrange(len(parent) + 1), copy.deepcopy(element))
        case 2:
            children = list(element)
            random.shuffle(children)
            element.extend(children)
        case 3:
            element.text = random.choice(_WORDS)
        case 4 if element.attrib:
            element.set(random.choice(sorted(element.attrib)), random.choice(_WORDS))
        case 5 if element.attrib:
            del element.attrib[random.choice(sorted(element.attrib))]
        case 6:
            element.tag = space + random.choice(_NAMES)
        case 7:
            other = random.choice(elements)
            if other is not element and element not in other.iterancestors():
                other.append(element)
        case 8:
            element.set(random.choice(_ATTRIBUTES), random.choice(_WORDS))
        case _:
            new = etree.SubElement(element, space + random.choice(_NAMES))
            new.text = random.choice(_WORDS)

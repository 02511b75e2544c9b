"""What the mending of a copy has a part in: nothing may be said about that from the copy."""

from __future__ import annotations

from collections import defaultdict
from functools import cache

from lxml import etree

from colladaphy.conform.context import local
from colladaphy.conform.grammar import all_types
from colladaphy.validation.copies import Copy

__all__ = ["touched"]

_ENDS = frozenset(
    {"COLLADA", "visual_scene", "physics_scene", "physics_model", "kinematics_model", "animation"}
)
"""Elements that do not become others by what one of their children is."""
_REFERRING = (
    "url", "source", "target", "parent", "body", "constraint", "rigid_body", "convex_hull_of",
    "joint", "link", "axis", "node", "texture", "param", "ref",
)  # fmt: skip
_NAMES = str.maketrans("#/.()", "     ")
_MOVING = frozenset(
    {"matrix", "translate", "rotate", "scale", "skew", "lookat", "unit", "up_axis", "asset"}
)
"""What places everything below it, so that nothing is sure of where things stand."""


def touched(before: Copy, after: Copy) -> tuple[frozenset[int], bool]:
    """The elements of a document, by number, whose meaning is not that of the document any more.

    They are what was changed, what it is part of, and what refers to it. The second value says
    whether things may stand elsewhere now. `before` is the document itself.
    """
    changed = _changed(before, after)
    if not changed:
        return frozenset(), False
    elements = {number: element for element, number in before.by_element.items()}
    moved = any(local(elements[number]) in _MOVING for number in changed if number in elements)
    return frozenset(_spread(changed, elements, before)), moved


def _changed(before: Copy, after: Copy) -> set[int]:
    """The elements with another text, other attributes or other children."""
    now = {number: element for element, number in after.by_element.items() if number >= 0}
    changed = set()
    for element, number in before.by_element.items():
        twin = now.get(number)
        above = element.getparent()
        if twin is None:
            if above is not None and local(element) in _known_names():
                changed |= {before.by_element[above], number}
            continue
        parent = twin.getparent()
        if (
            above is not None
            and (parent is None or after.by_element[parent] != before.by_element[above])
            and local(element) in _known_names()
        ):
            changed |= {before.by_element[above], number}
        if twin.attrib != element.attrib and _differ(element, twin):
            changed.add(number)
        if twin.text != element.text and (twin.text or "").split() != (element.text or "").split():
            changed.add(number)
    for element, number in after.by_element.items():
        parent = element.getparent()
        if number < 0 and parent is not None and local(element) != "extra":
            changed.add(after.by_element[parent])
    return changed - {-1}


def _differ(old: etree._Element, new: etree._Element) -> bool:
    """Whether attributes differ that have a meaning."""
    keys = {str(key) for attributes in (old.attrib, new.attrib) for key in attributes}
    return any(old.get(key) != new.get(key) for key in keys & _known_attributes())


@cache
def _known_attributes() -> frozenset[str]:
    return frozenset(name for kind in all_types() for name in kind.attributes)


@cache
def _known_names() -> frozenset[str]:
    return frozenset(name for kind in all_types() for name in kind.children)


def _spread(changed: set[int], elements: dict[int, etree._Element], before: Copy) -> set[int]:
    """Elements, what they are part of, and what refers to these."""
    referring: defaultdict[str, list[int]] = defaultdict(list)
    for element, number in before.by_element.items():
        for key in _REFERRING:
            if value := element.get(key):
                for name in value.translate(_NAMES).split():
                    referring[name].append(number)
    found: set[int] = set()
    waiting = list(changed)
    while waiting:
        number = waiting.pop()
        changed_one = elements.get(number)
        if number in found or changed_one is None:
            continue
        found.add(number)
        for key in ("id", "sid"):
            waiting += referring.get(changed_one.get(key) or "", ())
        above = changed_one.getparent()
        if above is not None and not _is_end(local(above)) and local(above) != local(changed_one):
            waiting.append(before.by_element[above])
    return found


def _is_end(name: str) -> bool:
    return name in _ENDS or name.startswith("library_")

"""What the mending of a copy has a part in: nothing may be said about that from the copy."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from lxml import etree

from colladaphy.conform.context import CONFORM, local
from colladaphy.conform.grammar import all_types
from colladaphy.validation.copies import Copy

__all__ = ["SEPARATORS", "Touched", "holds_others", "taken_out", "touched"]

_ENDS = frozenset(
    {"COLLADA", "visual_scene", "physics_scene", "physics_model", "kinematics_model", "animation"}
)
"""Elements that do not become others by what one of their children is."""
_REFERRING = (
    "url", "source", "target", "parent", "body", "constraint", "rigid_body", "convex_hull_of",
    "joint", "link", "axis", "node", "texture", "param", "ref",
)  # fmt: skip
SEPARATORS = str.maketrans("#/.()", "     ")
_MOVING = frozenset(
    {"matrix", "translate", "rotate", "scale", "skew", "lookat", "unit", "up_axis", "asset"}
)
"""What places everything below it, so that nothing is sure of where things stand."""


@dataclass(frozen=True, slots=True)
class Touched:
    """What a mending has changed; elements by their numbers."""

    changed: frozenset[int] = frozenset()
    """Elements with another text, other attributes or other children."""
    around: frozenset[int] = frozenset()
    """These, what they are part of, and what refers to them."""
    names: frozenset[str] = frozenset()
    """Ids and sids that are not there any more."""
    moved: bool = False
    """Whether things may stand elsewhere now, or be of another size."""
    nameless: frozenset[str] = frozenset()
    """The names of elements that had no id, or no sid, and have one now."""


def touched(before: Copy, after: Copy) -> Touched:
    """The elements whose meaning is not that of the document any more; `before` is that itself."""
    changed = _changed(before, after)
    names = frozenset(_names(before.tree) - _names(after.tree))
    if not changed:
        return Touched(names=names)
    elements = {number: element for element, number in before.by_element.items()}
    return Touched(
        frozenset(changed),
        frozenset(_spread(changed, elements, before)),
        names,
        any(local(elements[number]) in _MOVING for number in changed),
        frozenset(_nameless(changed, elements, after)),
    )


def _nameless(changed: set[int], elements: dict[int, etree._Element], after: Copy) -> Iterator[str]:
    """The names of changed elements that were not named themselves, and are now."""
    now = {number: element for element, number in after.by_element.items() if number in changed}
    for number, twin in now.items():
        if any(twin.get(key) and not elements[number].get(key) for key in ("id", "sid")):
            yield local(twin)


def taken_out(whole: Copy, tops: set[int], gone: set[int]) -> Touched:
    """What changes where some elements are taken out of a document, with all that is in them."""
    elements = {number: element for element, number in whole.by_element.items()}
    changed = gone | {whole.parents[top] for top in tops if top in whole.parents}
    left = {name for element, number in whole.by_element.items() if number not in gone
            for key in ("id", "sid") if (name := element.get(key))}  # fmt: skip
    lost = {name for number in gone for key in ("id", "sid")
            if (name := elements[number].get(key))}  # fmt: skip
    return Touched(
        frozenset(changed),
        frozenset(_spread(changed, elements, whole)),
        frozenset(lost - left),
        any(local(elements[number]) in _MOVING for number in gone),
    )


def _names(tree: etree._ElementTree) -> set[str]:
    """The ids and sids of a document, but for those of what was set aside."""
    aside = {inner for moved in tree.iter(f"{{{CONFORM}}}*") for inner in moved.iter(etree.Element)}
    found: set[str] = set()
    for element in tree.iter(etree.Element):
        if element not in aside:
            found.update(name for key in ("id", "sid") if (name := element.get(key)))
    return found


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
    names = {name for kind in all_types() for name in kind.attributes}
    return frozenset(names - {"digits", "magnitude", "name"})


@cache
def _known_names() -> frozenset[str]:
    return frozenset(name for kind in all_types() for name in kind.children)


def _spread(changed: set[int], elements: dict[int, etree._Element], before: Copy) -> set[int]:
    """Elements, what they are part of, and what refers to these."""
    referring: defaultdict[str, list[int]] = defaultdict(list)
    for element, number in before.by_element.items():
        for key in _REFERRING:
            if value := element.get(key):
                for name in value.translate(SEPARATORS).split():
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
        if (
            above is not None
            and not holds_others(local(above))
            and local(above) != local(changed_one)
        ):
            waiting.append(before.by_element[above])
    return found


def holds_others(name: str) -> bool:
    """Whether elements of a name are what they are, whatever one of their children is."""
    return name in _ENDS or name.startswith("library_")

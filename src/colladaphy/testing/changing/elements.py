"""Finding elements of the common profile in a document."""

from __future__ import annotations

from collections.abc import Iterable

from lxml import etree

from colladaphy.conform.grammar import NAMESPACE

__all__ = [
    "NUMERIC",
    "C",
    "child",
    "common",
    "free_id",
    "insert_in_order",
    "is_common",
    "local",
    "make",
]

C = f"{{{NAMESPACE}}}"
_PROFILES = (f"{C}technique", f"{C}extra")

NUMERIC = (
    "angular_velocity", "damping", "density", "dynamic_friction", "equation", "float_array",
    "gravity", "half_extents", "height", "inertia", "lookat", "mass", "matrix", "max", "min",
    "radius", "restitution", "rotate", "static_friction", "stiffness", "target_value", "time_step",
    "translate", "velocity",
)  # fmt: skip
"""Elements of physics that hold numbers."""


def is_common(element: etree._Element) -> bool:
    """Whether an element is not a profile's own affair."""
    return not any(above.tag in _PROFILES for above in element.iterancestors())


def common(root: etree._Element, *names: str) -> list[etree._Element]:
    """The elements of some names, in the order of the document, outside of profiles."""
    tags = [C + name for name in names]
    return [element for element in root.iter(*tags) if is_common(element)]


def local(element: etree._Element) -> str:
    """The name of an element without its namespace."""
    return etree.QName(element).localname


def child(element: etree._Element, name: str) -> etree._Element | None:
    """The first child of a name."""
    return element.find(C + name)


def make(name: str, text: str | None = None, **attributes: str) -> etree._Element:
    """An element of COLLADA."""
    made = etree.Element(C + name, attributes)
    made.text = text
    return made


def insert_in_order(
    parent: etree._Element, made: etree._Element, after: Iterable[str]
) -> etree._Element:
    """Inserts a child behind all children of the names that come before it."""
    place = 0
    before = {C + name for name in after}
    for position, each in enumerate(parent):
        if each.tag in before:
            place = position + 1
    parent.insert(place, made)
    return made


def free_id(root: etree._Element, wanted: str) -> str:
    """An id that no element of a document has."""
    taken = {element.get("id") for element in root.iter(etree.Element)}
    number = 0
    while f"{wanted}-{number}" in taken:
        number += 1
    return f"{wanted}-{number}"

"""Builds a document from choices: what the schema fixes is done here, once for all generators."""

from __future__ import annotations

from functools import cache
from typing import Any, Protocol

from lxml import etree

from colladaphy.conform.grammar import (
    NAMESPACE,
    Attribute,
    ComplexType,
    Declaration,
    Group,
    SimpleType,
    grammar,
    root_declaration,
)

__all__ = [
    "MATHML",
    "XSI",
    "Builder",
    "Choices",
    "Particle",
    "cost",
    "holds",
    "is_reference",
    "tag_of",
]

MATHML = "http://www.w3.org/1998/Math/MathML"
XSI = "http://www.w3.org/2001/XMLSchema-instance"
Particle = Declaration | Group


class Choices(Protocol):
    """Everything the schema leaves open."""

    def children(self, kind: ComplexType, room: int) -> list[tuple[Declaration, int]]:
        """The children of an element, in a valid order, each with the room for its content."""

    def attributes(self, kind: ComplexType) -> list[Attribute]:
        """The attributes an element has: all the required ones, and any others."""

    def kind(self, declaration: Declaration) -> ComplexType | SimpleType:
        """The type of an element: the declared one, or one derived from it (``xsi:type``)."""

    def text(self, simple: SimpleType) -> str:
        """A text of a simple type."""

    def is_defaulted(self) -> bool:
        """Whether an element that has a default is left empty."""

    def references(self, ids: list[str]) -> list[str]:
        """One or more ids of the document that a list of references names."""

    def foreign(self, parent: etree._Element, room: int) -> None:
        """Fills an element whose content is not declared."""


def is_reference(simple: SimpleType) -> bool:
    """Whether a type's values must be ids of the document."""
    return simple.item is not None and simple.item.primitive == "IDREF"


def tag_of(declaration: Declaration) -> str:
    """The expanded name of an element. The one element of another namespace is MathML's."""
    namespace = MATHML if declaration.name == "math" else NAMESPACE
    return f"{{{namespace}}}{declaration.name}"


class Builder:
    """Makes one document: keeps ids unique and references pointing at them."""

    def __init__(self, choices: Choices, prefix: str | None = None) -> None:
        self._choices = choices
        self._prefix = prefix
        self._ids: list[str] = []
        self._references: list[etree._Element] = []

    def document(self, room: int) -> bytes:
        """A valid document; `room` is about how many elements beyond the least it may hold."""
        declaration = root_declaration()
        namespaces: Any = {self._prefix: NAMESPACE, "xsi": XSI}  # None is the default namespace
        root = etree.Element(tag_of(declaration), nsmap=namespaces)
        self._fill(root, declaration, room)
        for element in self._references:
            element.text = " ".join(self._choices.references(self._ids))
        return etree.tostring(root, encoding="utf-8", xml_declaration=True)

    def _fill(self, element: etree._Element, declaration: Declaration, room: int) -> None:
        kind = self._choices.kind(declaration)
        if kind is not declaration.type:
            prefix = f"{self._prefix}:" if self._prefix else ""
            element.set(f"{{{XSI}}}type", prefix + kind.name)
        if isinstance(kind, SimpleType):
            self._text(element, kind, declaration)
            return
        for attribute in self._choices.attributes(kind):
            element.set(attribute.name, self._value(attribute.type))
        if kind.anything:
            self._choices.foreign(element, room)
        elif kind.value is not None:
            self._text(element, kind.value, declaration)
        elif kind.content is not None:
            for child, share in self._choices.children(kind, room):
                self._fill(etree.SubElement(element, tag_of(child)), child, share)

    def _text(self, element: etree._Element, simple: SimpleType, declaration: Declaration) -> None:
        if declaration.default is not None and self._choices.is_defaulted():
            return
        if is_reference(simple):
            self._references.append(element)
        else:
            element.text = self._value(simple)

    def _value(self, simple: SimpleType) -> str:
        text = self._choices.text(simple)
        if simple.primitive == "ID":
            while text in self._ids:
                text += "_"
            self._ids.append(text)
        return text


@cache
def _costs() -> dict[int, int]:
    """For every complex type, by identity, how many elements it holds at least."""
    waiting: list[ComplexType | SimpleType] = [*grammar().values(), root_declaration().type]
    types: dict[int, ComplexType] = {}
    while waiting:
        kind = waiting.pop()
        if isinstance(kind, ComplexType) and id(kind) not in types:
            types[id(kind)] = kind
            if kind.content is not None:
                waiting += [child.type for child in kind.content.declarations()]
    costs = dict.fromkeys(types, 1 << 20)
    changed = True
    while changed:
        changed = False
        for key, kind in types.items():
            now = 0 if kind.content is None else kind.content.low * _once(kind.content, costs)
            if now < costs[key]:
                costs[key], changed = now, True
    return costs


def _once(particle: Particle, costs: dict[int, int]) -> int:
    if isinstance(particle, Declaration):
        return 1 + costs.get(id(particle.type), 0)
    parts = [part.low * _once(part, costs) for part in particle.parts] or [0]
    return sum(parts) if particle.kind == "sequence" else min(parts)


def cost(particle: Particle) -> int:
    """How many elements a particle brings at least when it occurs once."""
    return _once(particle, _costs())


def holds(particle: Particle, declaration: Declaration) -> bool:
    """Whether a particle is a declaration, or has it in it."""
    if isinstance(particle, Declaration):
        return particle is declaration
    return any(holds(part, declaration) for part in particle.parts)

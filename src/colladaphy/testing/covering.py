"""A fixed series of small documents that together hold every component of the schema."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from functools import cache

from lxml import etree

from colladaphy.conform.grammar import (
    Attribute,
    ComplexType,
    Declaration,
    SimpleType,
    root_declaration,
)
from colladaphy.testing.building import Builder, Particle, cost, holds
from colladaphy.testing.coverage import components
from colladaphy.testing.values import example

__all__ = ["covering_documents", "paths"]

Path = tuple[Declaration, ...]
Children = list[Declaration]


def covering_documents() -> Iterator[bytes]:
    """Valid documents, as UTF-8 bytes, always the same; each shows something the others did not.

    Each leads to one complex type by the shortest path, holds there all attributes and as many
    children as one content model allows at once, and only what is required elsewhere.
    """
    missing = set(components())
    for path in paths():
        kind = path[-1].type
        assert isinstance(kind, ComplexType)
        for children in [[]] if kind.content is None else _coverings(kind.content):
            shown = {id(child) for child in children} | {
                id(attribute) for attribute in kind.attributes.values()
            }
            if shown & missing:
                missing -= shown
                yield Builder(_Directed(path, children)).document(room=0)


@cache
def paths() -> tuple[Path, ...]:
    """A shortest path of declarations from the root to every complex type, shortest first."""
    return tuple(_paths())


def _paths() -> Iterator[Path]:
    waiting: deque[Path] = deque([(root_declaration(),)])
    seen: set[int] = set()
    while waiting:
        path = waiting.popleft()
        kind = path[-1].type
        if isinstance(kind, ComplexType) and id(kind) not in seen:
            seen.add(id(kind))
            yield path
            if kind.content is not None:
                waiting.extend((*path, child) for child in kind.content.declarations())


def _coverings(particle: Particle) -> list[Children]:
    """Valid lists of children that together hold every declaration of a content model."""
    if isinstance(particle, Declaration):
        found: list[Children] = [[particle]]
    else:
        parts = [_coverings(part) for part in particle.parts]
        if particle.kind == "choice":
            found = [children for part in parts for children in part]
        else:
            turns = max(map(len, parts), default=0)
            found = [
                [child for part in parts for child in part[turn % len(part)]]
                for turn in range(turns)
            ]
    if particle.high > len(found) > 1:  # one after the other, where repetition allows
        return [[child for children in found for child in children]]
    return [children * max(1, particle.low) for children in found]


def _least(particle: Particle, onward: Declaration | None = None) -> Children:
    """A shortest valid list of children, among them `onward` if it is given."""
    if onward is not None and not holds(particle, onward):
        onward = None
    if isinstance(particle, Declaration):
        return [particle] * max(particle.low, onward is not None)
    found: Children = []
    for _ in range(max(particle.low, onward is not None)):
        if particle.kind == "choice":
            chosen = min(particle.parts, key=lambda part: part.low * cost(part))
            if onward is not None:
                chosen = next(part for part in particle.parts if holds(part, onward))
            found += _least(chosen, onward)
        else:
            found += [child for part in particle.parts for child in _least(part, onward)]
        onward = None
    return found


class _Directed:
    """Leads to one type and gives it certain children; everything else is as small as can be."""

    def __init__(self, path: Path, children: Children) -> None:
        self._path = path
        self._children = children
        self._depth = 0  # how much of the path has been taken

    def kind(self, declaration: Declaration) -> ComplexType | SimpleType:
        return declaration.type

    def _is_goal(self, kind: ComplexType) -> bool:
        return kind is self._path[-1].type

    def children(self, kind: ComplexType, room: int) -> list[tuple[Declaration, int]]:
        assert kind.content is not None
        if self._depth == len(self._path) - 1 and self._is_goal(kind):
            self._depth += 1
            return [(child, 0) for child in self._children]
        if self._depth < len(self._path) - 1 and kind is self._path[self._depth].type:
            self._depth += 1
            return [(child, 0) for child in _least(kind.content, self._path[self._depth])]
        return [(child, 0) for child in _least(kind.content)]

    def attributes(self, kind: ComplexType) -> list[Attribute]:
        everything = self._is_goal(kind)
        return [
            attribute for attribute in kind.attributes.values() if everything or attribute.required
        ]

    def text(self, simple: SimpleType) -> str:
        return example(simple)

    def is_defaulted(self) -> bool:
        return False

    def references(self, ids: list[str]) -> list[str]:
        return ids[:1]

    def foreign(self, parent: etree._Element, room: int) -> None:
        """Left empty."""

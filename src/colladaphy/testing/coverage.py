"""Which components of the schema documents hold: element declarations and attributes."""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass
from functools import cache

from lxml import etree

from colladaphy.conform.grammar import (
    ComplexType,
    Declaration,
    SimpleType,
    grammar,
    root_declaration,
)
from colladaphy.testing.areas import areas
from colladaphy.testing.building import XSI, Particle, tag_of

__all__ = ["Component", "Coverage", "components"]


@dataclass(frozen=True, order=True)
class Component:
    """An element declaration or an attribute, by the place in the schema where it is declared.

    `owner` is the global type and the path below it; `number` tells apart declarations of one
    name in one content model.
    """

    owner: str
    name: str
    number: int = 0

    def __str__(self) -> str:
        again = f" ({self.number + 1})" if self.number else ""
        return f"{self.owner}/{self.name}{again}"


class Coverage:
    """Counts what recorded documents hold of all that a document could hold.

    `reachable` are all components that a document can hold, `reached` those recorded so far.
    """

    def __init__(self) -> None:
        self.reachable: frozenset[Component] = frozenset(components().values())
        self.reached: set[Component] = set()

    @property
    def missed(self) -> list[Component]:
        """What no recorded document holds, sorted."""
        return sorted(self.reachable - self.reached)

    def record(self, document: bytes) -> None:
        """Takes note of a schema-valid document. Of an invalid one, some parts are not counted."""
        root = etree.fromstring(document)
        self._element(root, root_declaration().type)

    def _element(self, element: etree._Element, declared: ComplexType | SimpleType) -> None:
        derived = element.get(f"{{{XSI}}}type")
        kind = declared if derived is None else grammar().get(derived.rpartition(":")[2], declared)
        if not isinstance(kind, ComplexType):
            return
        known = components()
        for attribute in kind.attributes.values():
            if attribute.name in element.attrib and id(attribute) in known:
                self.reached.add(known[id(attribute)])
        if kind.content is None:
            return
        children = list(element.iterchildren(tag=etree.Element))
        assigned: list[Declaration] = []
        _assign(kind.content, [child.tag for child in children], 0, assigned)
        for child, declaration in zip(children, assigned, strict=False):
            if id(declaration) in known:  # not what only an xsi:type brings in
                self.reached.add(known[id(declaration)])
            self._element(child, declaration.type)


def _assign(
    particle: Particle, tags: list[str], at: int, assigned: list[Declaration]
) -> int | None:
    """Assigns children to the declarations that they stand for; None where the particle fails.

    No search is needed: a schema's content models are deterministic.
    """
    count = 0
    while count < particle.high:
        before, kept = at, len(assigned)
        after = _assign_once(particle, tags, at, assigned)
        if after is None or after == before:
            del assigned[kept:]
            count = count if after is None else particle.low
            break
        at, count = after, count + 1
    return at if count >= particle.low else None


def _assign_once(
    particle: Particle, tags: list[str], at: int, assigned: list[Declaration]
) -> int | None:
    if isinstance(particle, Declaration):
        if at < len(tags) and tags[at] == tag_of(particle):
            assigned.append(particle)
            return at + 1
        return None
    if particle.kind == "sequence":
        position: int | None = at
        for part in particle.parts:
            if position is None:
                break
            position = _assign(part, tags, position, assigned)
        return position
    empty = None
    for part in particle.parts:
        kept = len(assigned)
        after = _assign(part, tags, at, assigned)
        if after is not None and after > at:
            return after
        del assigned[kept:]
        empty = at if after is not None else empty
    return empty


@cache
def components() -> dict[int, Component]:
    """Every component that a document can hold, by the identity of its declaration."""
    found: dict[int, Component] = {}
    root = root_declaration()
    waiting = deque([(root.type, root.name)])
    seen: set[int] = set()
    while waiting:
        kind, owner = waiting.popleft()
        if not isinstance(kind, ComplexType) or id(kind) in seen:
            continue
        seen.add(id(kind))
        for attribute in kind.attributes.values():  # an inherited one counts once
            found.setdefault(id(attribute), Component(owner, f"@{attribute.name}"))
        numbers: Counter[str] = Counter()
        for child in [] if kind.content is None else kind.content.declarations():
            if id(child) not in found:  # a group's may stand in several types
                found[id(child)] = Component(owner, child.name, numbers[child.name])
                numbers[child.name] += 1
            is_global = child.type.name in areas().of_type
            waiting.append((child.type, child.type.name if is_global else f"{owner}/{child.name}"))
    return found

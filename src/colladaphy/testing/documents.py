"""Strategies for schema-valid documents."""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform.grammar import (
    Attribute,
    ComplexType,
    Declaration,
    Group,
    SimpleType,
    grammar,
)
from colladaphy.testing.areas import areas as schema_areas
from colladaphy.testing.building import Builder, Particle, cost, holds
from colladaphy.testing.covering import Path, paths
from colladaphy.testing.foreign import fill_foreign
from colladaphy.testing.values import texts

__all__ = ["AREAS", "documents"]

AREAS: tuple[str, ...] = tuple(sorted(schema_areas().includes))
"""The names of the schema's areas, each a file of ``schema/collada-1.5``."""

MORE = 2
"""How many repetitions beyond the least are tried."""


def documents(
    *, areas: Iterable[str] | None = None, size: int = 60, xsi_types: bool = False
) -> st.SearchStrategy[bytes]:
    """Schema-valid COLLADA 1.5 documents, as UTF-8 bytes.

    `areas` (of AREAS) keeps optional content to what these areas, and those that they build on,
    declare; None is the whole schema. `size` is about how many elements a document has at most.
    With `xsi_types` some elements have a type derived from the declared one. Ids are unique within
    a document, and IDREF arrays name its ids; urls and sids point anywhere.

    Raises ValueError for an unknown area.
    """
    allowed = None if areas is None else schema_areas().closure(areas)

    @st.composite
    def document(draw: st.DrawFn) -> bytes:
        prefix = draw(st.sampled_from([None, None, None, "c"]))
        path = draw(st.sampled_from(ways))
        return Builder(_Drawn(draw, allowed, xsi_types, path), prefix).document(size)

    ways = [path for path in paths() if all(_is_allowed(step, allowed) for step in path)]
    return document()


def _is_allowed(particle: Particle, allowed: frozenset[str] | None) -> bool:
    """Whether a particle's type is declared in an allowed area, or in place."""
    if allowed is None:
        return True
    if isinstance(particle, Group):
        return any(_is_allowed(part, allowed) for part in particle.parts)
    area = schema_areas().of_type.get(particle.type.name)
    return area is None or area in allowed


class _Drawn:
    """Choices made by hypothesis. The simplest choice is always the smallest content.

    The document leads to a type, drawn from all of them, and has most of its content there: a
    walk that chose freely at every step would hardly ever come far from the root.
    """

    def __init__(
        self, draw: st.DrawFn, allowed: frozenset[str] | None, xsi_types: bool, path: Path
    ) -> None:
        self._draw = draw
        self._allowed = allowed
        self._xsi_types = xsi_types
        self._path = path
        self._depth = 0  # how much of the path has been taken

    def children(self, kind: ComplexType, room: int) -> list[tuple[Declaration, int]]:
        onward = None
        if self._depth < len(self._path) - 1 and kind is self._path[self._depth].type:
            self._depth += 1
            onward = self._path[self._depth]
        found: list[Declaration] = []
        if kind.content is not None:
            room = self._expand(kind.content, onward, found, room)
        weights = [self._draw(st.integers(0, 3)) if room > 0 else 0 for _ in found]
        weights = [
            weight + (len(found) * 9 if child is onward else 0)
            for child, weight in zip(found, weights, strict=True)
        ]
        total = sum(weights) or 1
        return [
            (child, room * weight // total) for child, weight in zip(found, weights, strict=True)
        ]

    def _expand(
        self, particle: Particle, onward: Declaration | None, found: list[Declaration], room: int
    ) -> int:
        """Appends children that the particle allows; returns the room that is left."""
        if onward is not None and not holds(particle, onward):
            onward = None
        count = max(particle.low, onward is not None)
        most = min(particle.high, particle.low + MORE)
        if room > 0 and most > count and _is_allowed(particle, self._allowed):
            count = self._draw(st.integers(count, most))
        for _ in range(count):
            if isinstance(particle, Declaration):
                found.append(particle)
                room -= cost(particle)
            elif particle.kind == "sequence":
                for part in particle.parts:
                    room = self._expand(part, onward, found, room)
            else:
                room = self._expand(self._branch(particle, onward, room), onward, found, room)
            onward = None
        return room

    def _branch(self, choice: Group, onward: Declaration | None, room: int) -> Particle:
        if onward is not None:
            return next(part for part in choice.parts if holds(part, onward))
        allowed = [part for part in choice.parts if _is_allowed(part, self._allowed)]
        if room > 0 and allowed:
            branch: Particle = self._draw(st.sampled_from(allowed))
            return branch
        return min(allowed or choice.parts, key=lambda part: part.low * cost(part))

    def attributes(self, kind: ComplexType) -> list[Attribute]:
        return [
            attribute
            for attribute in kind.attributes.values()
            if attribute.required or self._draw(st.booleans())
        ]

    def kind(self, declaration: Declaration) -> ComplexType | SimpleType:
        if self._xsi_types:
            names = schema_areas().descendants(declaration.type.name)
            if names and self._draw(st.integers(0, 5)) == 5:
                return grammar()[self._draw(st.sampled_from(names))]
        return declaration.type

    def text(self, simple: SimpleType) -> str:
        return self._draw(texts(simple))

    def is_defaulted(self) -> bool:
        return self._draw(st.booleans())

    def references(self, ids: list[str]) -> list[str]:
        return self._draw(st.lists(st.sampled_from(ids), min_size=1, max_size=3))

    def foreign(self, parent: etree._Element, room: int) -> None:
        fill_foreign(self._draw, parent, room)

"""The inputs of primitives, vertices, samplers, skins and morphs: where they lead, and which.

Several rules look at the sources behind inputs, so that these are one table for all of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.columns.distinct import are_among, numbered
from colladaphy.findings import Severity
from colladaphy.links.rules import WRONG_TYPE
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.links import reference_hits
from colladaphy.meaning.source_table import sources_of
from colladaphy_schema.rows import Column, Masked, Rows

__all__ = ["CHECKS", "PRIMITIVES", "Inputs", "inputs_of", "needed_by"]

Array = NDArray[Any]


PRIMITIVES = ("lines", "linestrips", "polygons", "polylist", "triangles", "trifans", "tristrips")
_NEEDED = {
    **dict.fromkeys(PRIMITIVES, ("VERTEX",)),
    "vertices": ("POSITION",),
    "joints": ("JOINT", "INV_BIND_MATRIX"),
    "vertex_weights": ("JOINT", "WEIGHT"),
    "targets": ("MORPH_TARGET", "MORPH_WEIGHT"),
    "sampler": ("INPUT", "OUTPUT", "INTERPOLATION"),
    "control_vertices": ("POSITION",),
}
_BREP = ("curves", "surface_curves", "surfaces", "orient", "edges", "wires", "faces", "pcurves",
         "shells", "solids")  # fmt: skip


class InputRows(Rows):
    """Inputs of every kind."""

    __slots__ = ()
    offset: Column[Masked[Any]] = Column("offset", "attribute", "integer", optional=True)
    set: Column[Masked[Any]] = Column("set", "attribute", "integer", optional=True)


class Inputs:
    """All inputs of a document, one a row, in its order."""

    def __init__(self, context: Context) -> None:
        self.context = context
        rows = context.rows(InputRows, "input")
        assert rows.ordinals is not None
        self.elements: Array = rows.ordinals.astype(np.int64)
        self.owners: Array = context.parent[rows.ordinals].astype(np.int64)
        """(n,) the elements that they belong to."""
        self.kinds, semantics = context.columns.factorized(rows, "semantic")
        """(n,) the numbers of their semantics; -1 for none."""
        self.kinds_texts = [*semantics, ""]
        self.offsets: Array = counted(np.where(rows.offset.present, rows.offset.values, 0))
        self.sets: Array = np.where(rows.set.present, rows.set.values, -1)
        leads = context.leads("input", "source")
        self.targets: Array = leads.targets
        """(n,) the elements that they lead to in this document; -1 for none."""
        self.sources: Array = sources_of(context).rows_of(self.targets)
        """(n,) the rows of sources; -1 for what is not a source."""
        self.plain: Array = leads.plain
        """(n,) which say ``#id``."""

    def semantic(self, row: int) -> str:
        """The semantic of an input."""
        return self.kinds_texts[int(self.kinds[row])]

    def text(self, row: int) -> str:
        """The reference of an input."""
        return self.context.columns.attribute_of(int(self.elements[row]), "source") or ""

    def are(self, *semantics: str) -> Array:
        """Which of them (n,) have one of some semantics."""
        found: Array = np.array([text in semantics for text in self.kinds_texts], np.bool_)
        return found[self.kinds]

    @cached_property
    def _by_owner(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for row, owner in enumerate(self.owners.tolist()):
            found.setdefault(owner, []).append(row)
        return found

    def of(self, owner: int) -> list[int]:
        """The inputs of an element."""
        return self._by_owner.get(owner, [])

    def named(self, owner: int, semantic: str) -> int:
        """The first input of a semantic of an element; -1 for none."""
        return next((row for row in self.of(owner) if self.semantic(row) == semantic), -1)

    def first(self, owners: Array, semantic: str) -> Array:
        """The same for many (n,)."""
        rows = np.flatnonzero(self.are(semantic))
        at = self.context.places_in(self.owners[rows], owners)
        found: Array = np.append(rows, -1)[at]
        return found

    def source(self, owner: int, semantic: str) -> int:
        """The row of the source behind that input; -1 where there is none."""
        row = self.named(owner, semantic)
        return -1 if row < 0 else int(self.sources[row])

    @cached_property
    def behind(self) -> Array:
        """(n,) the rows of the sources behind inputs, be it through vertices; -1 for none."""
        through = self.sources < 0
        through &= self.context.is_named(self.targets, "vertices")
        rows = np.flatnonzero(through)
        found: Array = self.sources.copy()
        found[rows] = np.append(self.sources, -1)[self.first(self.targets[rows], "POSITION")]
        return found

    @cached_property
    def counts(self) -> Array:
        """(n,) how many values there are behind inputs; -1 where that cannot be told."""
        found: Array = np.append(sources_of(self.context).counts, -1)[self.behind]
        return found

    def count(self, row: int) -> int | None:
        """How many values there are behind an input; None where that cannot be told."""
        return int(self.counts[row]) if self.counts[row] >= 0 else None

    def short(self, row: int, wanted: int) -> Hit | None:
        """What to say where only the accessor behind an input lacks so many items."""
        return sources_of(self.context).short(int(self.behind[row]), wanted)


def inputs_of(context: Context) -> Inputs:
    """The inputs of a document."""
    return context.shared(Inputs)


def needed_by(name: str) -> tuple[str, ...]:
    """The semantics that an element of a name cannot do without."""
    return _NEEDED.get(name, ())


def links(context: Context) -> Iterator[Hit]:
    """Inputs that lead nowhere, or to something else than sources."""
    inputs = inputs_of(context)
    for row in np.flatnonzero(~_lead_right(context, inputs)).tolist():
        element, owner = int(inputs.elements[row]), int(inputs.owners[row])
        name, semantic, text = context.name(owner), inputs.semantic(row), inputs.text(row)
        target = int(inputs.targets[row])
        if name in PRIMITIVES and semantic == "VERTEX":
            expected: tuple[str, ...] = ("vertices",)
        elif name in PRIMITIVES and inputs.named(owner, "VERTEX") < 0:
            expected = ("source", "vertices")  # the semantic is wrong, and that is told
        elif name in _BREP:
            expected = ("source", "vertices", *_BREP)
        else:
            expected = ("source",)
        found = context.name(target) if target >= 0 else ""
        severity = Severity.WARNING
        if (semantic, found) in (("VERTEX", "source"), ("POSITION", "vertices")):
            severity = Severity.ERROR  # no reader finds the positions then
        if found == "vertices" == expected[0] and not _is_beside(context, owner, target):
            message = f"{text!r} is the <vertices> of another mesh."
            yield Hit(WRONG_TYPE, element, message, (target,), "source", Severity.WARNING)
            continue
        yield from reference_hits(context, element, "source", text, expected, severity=severity)


def _lead_right(context: Context, inputs: Inputs) -> Array:
    """Which inputs (n,) lead where most do: to sources, or to the vertices of their meshes."""
    is_vertex = inputs.are("VERTEX")
    good = inputs.plain & (inputs.sources >= 0) & ~is_vertex
    rows = np.flatnonzero(is_vertex & inputs.plain)
    owners, targets = inputs.owners[rows], inputs.targets[rows]
    good[rows] = context.is_named(targets, "vertices") & context.is_named(owners, *PRIMITIVES)
    good[rows] &= context.parent[owners] == context.parent[targets]
    return good


def _is_beside(context: Context, one: int, other: int) -> bool:
    return int(context.parent[one]) == int(context.parent[other])


def needed(context: Context) -> Iterator[Hit]:
    """Elements without an input that they need, and with two of one kind."""
    inputs = inputs_of(context)
    repeating = _repeating(inputs)
    for name, wanted in _NEEDED.items():
        owners = context.ordinals(name).astype(np.int64)
        if not len(owners):
            continue
        doubtful = are_among(owners, repeating)
        for semantic in wanted:
            doubtful |= inputs.first(owners, semantic) < 0
        for owner in owners[doubtful].tolist():
            yield from _lacking(context, owner, name, wanted)
            yield from _twice(inputs, owner, name)


def _repeating(inputs: Inputs) -> Array:
    """The elements with inputs of the same semantic and set."""
    _, sets = numbered(inputs.sets)
    keys = np.stack([inputs.owners, inputs.kinds, sets])
    order = np.lexsort(keys[::-1])
    keys = keys[:, order]
    found: Array = keys[0, 1:][(keys[:, 1:] == keys[:, :-1]).all(axis=0)]
    return found


def _lacking(context: Context, owner: int, name: str, wanted: tuple[str, ...]) -> Iterator[Hit]:
    inputs = inputs_of(context)
    rows = inputs.of(owner)
    there = {inputs.semantic(row) for row in rows}
    lacking = [semantic for semantic in wanted if semantic not in there]
    if lacking and not _is_empty(context, owner, name):
        message = f"<{name}> has no input {' and no input '.join(lacking)}."
        if not rows:
            message = f"<{name}> has no inputs at all."
        yield Hit(geometry_rules.INPUT_MISSING, owner, message)


def _twice(inputs: Inputs, owner: int, name: str) -> Iterator[Hit]:
    seen: dict[tuple[str, int], int] = {}
    for row in inputs.of(owner):
        key = (inputs.semantic(row), int(inputs.sets[row]))
        if name == "sampler" and key[0].endswith("TANGENT"):
            continue  # one a dimension
        first = seen.setdefault(key, row)
        if first != row:
            where = f" of the set {key[1]}" if key[1] >= 0 else ""
            message = f"<{name}> has two inputs {key[0]}{where}."
            yield Hit(geometry_rules.INPUT_TWICE, int(inputs.elements[row]), message,
                      (int(inputs.elements[first]),), "semantic")  # fmt: skip


def _is_empty(context: Context, owner: int, name: str) -> bool:
    """Whether a primitive says itself that there is nothing in it."""
    if name not in PRIMITIVES:
        return False
    return (context.columns.attribute_of(owner, "count") or "").strip() == "0"


CHECKS = (links, needed)

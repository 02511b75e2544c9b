"""The inputs of primitives, vertices, samplers, skins and morphs: where they lead, and which.

Several rules look at the sources behind inputs, so that these are one table for all of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Severity
from colladaphy.links.rules import WRONG_TYPE
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.arrays import sources_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.links import reference_hits
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
    semantic: Column[list[str]] = Column("semantic", "attribute", "token")
    source: Column[list[str]] = Column("source", "attribute", "token")
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
        self.semantics = list(rows.semantic)
        self.texts = list(rows.source)
        self.offsets: Array = np.where(rows.offset.present, rows.offset.values, 0)
        self.sets: Array = np.where(rows.set.present, rows.set.values, -1)
        self.targets = context.targets(self.texts)
        """(n,) the elements that they lead to in this document; -1 for none."""
        self.sources = sources_of(context).rows_of(self.targets)
        """(n,) the rows of sources; -1 for what is not a source."""
        self._by_owner: dict[int, list[int]] = {}
        for row, owner in enumerate(self.owners.tolist()):
            self._by_owner.setdefault(owner, []).append(row)

    def of(self, owner: int) -> list[int]:
        """The inputs of an element."""
        return self._by_owner.get(owner, [])

    def named(self, owner: int, semantic: str) -> int:
        """The first input of a semantic of an element; -1 for none."""
        return next((row for row in self.of(owner) if self.semantics[row] == semantic), -1)

    def source(self, owner: int, semantic: str) -> int:
        """The row of the source behind that input; -1 where there is none."""
        row = self.named(owner, semantic)
        return -1 if row < 0 else int(self.sources[row])

    def count(self, row: int) -> int | None:
        """How many values there are behind an input; None where that cannot be told."""
        source = self.behind(row)
        return None if source < 0 else sources_of(self.context).count(source)

    def behind(self, row: int) -> int:
        """The row of the source behind an input, be it through vertices; -1 for none."""
        target = int(self.targets[row])
        if target < 0 or self.sources[row] >= 0:
            return int(self.sources[row])
        return self.source(target, "POSITION") if self.context.name(target) == "vertices" else -1

    def short(self, row: int, wanted: int) -> Hit | None:
        """What to say where only the accessor behind an input lacks so many items."""
        return sources_of(self.context).short(self.behind(row), wanted)


def inputs_of(context: Context) -> Inputs:
    """The inputs of a document."""
    return context.shared(Inputs)


def needed_by(name: str) -> tuple[str, ...]:
    """The semantics that an element of a name cannot do without."""
    return _NEEDED.get(name, ())


def links(context: Context) -> Iterator[Hit]:
    """Inputs that lead nowhere, or to something else than sources."""
    inputs = inputs_of(context)
    for row, (element, owner) in enumerate(
        zip(inputs.elements.tolist(), inputs.owners.tolist(), strict=True)
    ):
        is_plain = inputs.texts[row][:1] == "#" and inputs.semantics[row] != "VERTEX"
        if is_plain and inputs.sources[row] >= 0:
            continue
        name, semantic, target = context.name(owner), inputs.semantics[row], inputs.targets[row]
        if name in PRIMITIVES and semantic == "VERTEX":
            expected: tuple[str, ...] = ("vertices",)
        elif name in PRIMITIVES and inputs.named(owner, "VERTEX") < 0:
            expected = ("source", "vertices")  # the semantic is wrong, and that is told
        elif name in _BREP:
            expected = ("source", "vertices", *_BREP)
        else:
            expected = ("source",)
        found = context.name(int(target)) if target >= 0 else ""
        severity = Severity.WARNING
        if (semantic, found) in (("VERTEX", "source"), ("POSITION", "vertices")):
            severity = Severity.ERROR  # no reader finds the positions then
        if found == "vertices" == expected[0] and not _is_beside(context, owner, int(target)):
            message = f"{inputs.texts[row]!r} is the <vertices> of another mesh."
            yield Hit(WRONG_TYPE, element, message, (int(target),), "source", Severity.WARNING)
            continue
        yield from reference_hits(
            context, element, "source", inputs.texts[row], expected, severity=severity
        )


def _is_beside(context: Context, one: int, other: int) -> bool:
    return int(context.parent[one]) == int(context.parent[other])


def needed(context: Context) -> Iterator[Hit]:
    """Elements without an input that they need, and with two of one kind."""
    inputs = inputs_of(context)
    for name, wanted in _NEEDED.items():
        for owner in context.ordinals(name).tolist():
            rows = inputs.of(owner)
            there = {inputs.semantics[row] for row in rows}
            lacking = [semantic for semantic in wanted if semantic not in there]
            if lacking and not _is_empty(context, owner, name):
                message = f"<{name}> has no input {' and no input '.join(lacking)}."
                if not rows:
                    message = f"<{name}> has no inputs at all."
                yield Hit(geometry_rules.INPUT_MISSING, owner, message)
            seen: dict[tuple[str, int, int], int] = {}
            for row in rows:
                key = (inputs.semantics[row], int(inputs.sets[row]), 0)
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

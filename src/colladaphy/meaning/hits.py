"""What a rule has found: an element, and why. Findings are made of all hits at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.columns.reading import Document
from colladaphy.findings import Finding, Rule, Severity
from colladaphy_schema.rows import Column, Rows

__all__ = ["Hit", "findings_of", "listed"]

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class Hit:
    """One element that a rule has something to say about."""

    rule: Rule
    element: int
    """The number of the element at which it stands."""
    message: str
    related: tuple[int, ...] = ()
    """Elements that have to do with it."""
    attribute: str | None = None
    severity: Severity | None = None
    hint: str | None = None
    repair: str | None = None
    """The code of the repair that mends it."""


def findings_of(
    columns: Document, file: str | None, hits: Sequence[Hit | Finding]
) -> list[Finding]:
    """Findings in the order of the document, each with line, column, path and scoped id.

    The document need not be valid. Findings about what is not in the columns are passed on.
    """
    others = [hit for hit in hits if isinstance(hit, Finding)]
    kept = list(dict.fromkeys(hit for hit in hits if isinstance(hit, Hit)))
    if not kept:
        return others
    kept.sort(key=lambda hit: (hit.element, hit.rule.code))
    elements = [hit.element for hit in kept]
    related = sorted({element for hit in kept for element in hit.related})
    wanted = distinct(np.array([*elements, *related], np.int64))
    paths = dict(zip(wanted.tolist(), _paths(columns, wanted), strict=True))
    places = dict(zip(wanted.tolist(), columns.places.places(wanted), strict=True))
    sids = dict(zip(wanted.tolist(), _attribute(columns, wanted, "sid"), strict=True))
    made = others
    for hit in kept:
        place = places[hit.element]
        made.append(
            Finding(
                code=hit.rule.code,
                severity=hit.severity or hit.rule.severity,
                stage=hit.rule.stage,
                message=hit.message,
                file=file,
                line=place.line,
                column=place.column,
                path=paths[hit.element],
                hint=hit.hint or hit.rule.hint,
                why=hit.rule.why,
                attribute=hit.attribute,
                sid=sids[hit.element],
                related=tuple((paths[other], places[other].line) for other in hit.related),
                repair=hit.repair,
            )
        )
    return made


def _attribute(columns: Document, elements: Array, name: str) -> list[str | None]:
    column: Column[Any] = Column(name, "attribute", "token", optional=True)
    column.name = name
    rows = Rows(len(elements), origin=columns, ordinals=elements.astype(np.int32))
    found: list[str | None] = columns.column(rows, column)
    return found


def _paths(columns: Document, elements: Array) -> list[str]:
    """The paths of elements, as `colladaphy.findings.element_path` has them, in linear time."""
    parent = columns.index.parent
    needed = np.zeros(len(parent), np.bool_)
    current = elements
    while len(current):
        current = current[~needed[current]]
        needed[current] = True
        current = distinct(parent[current])
        current = current[current >= 0]
    codes, inverse = np.unique(columns.index.codes, return_inverse=True)
    firsts = np.zeros(len(codes), np.int64)
    firsts[inverse[::-1]] = np.arange(len(parent))[::-1]
    names = [columns.local_name(first) for first in firsts.tolist()]
    numbers: dict[str, int] = {}
    local = np.array([numbers.setdefault(name, len(numbers)) for name in names])[inverse]
    # Siblings of those elements, by parent and name.
    around = np.zeros(len(parent), np.bool_)
    around[parent[np.flatnonzero(needed)]] = True
    some = np.flatnonzero(around[parent])
    some = some[some > 0]
    keys = parent[some].astype(np.int64) * len(numbers) + local[some]
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.append(True, keys[order][1:] != keys[order][:-1]))
    sizes = np.diff(np.append(starts, len(order)))
    rank = np.zeros(len(parent), np.int64)
    alike = np.ones(len(parent), np.int64)
    if len(some):
        rank[some[order]] = np.arange(len(order)) - np.repeat(starts, sizes)
        alike[some[order]] = np.repeat(sizes, sizes)
    texts = list(numbers)
    known: dict[int, str] = {-1: ""}
    for element in np.flatnonzero(needed).tolist():
        name = texts[local[element]]
        step = f"{name}[{rank[element] + 1}]" if alike[element] > 1 else name
        known[element] = f"{known[int(parent[element])]}/{step}"
    return [known[element] for element in elements.tolist()]


def listed(values: Sequence[Any], most: int = 3) -> str:
    """Some values for a message."""
    shown = ", ".join(str(value) for value in values[:most])
    return f"{shown}, …" if len(values) > most else shown

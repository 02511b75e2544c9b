"""Columns without rows that are like others: their document is valid if, and only if, the whole is.

The counterpart of `colladaphy.columns.thinning` for columns that are to be written. A row is left
out where other rows of its table have the same columns and children, and neighbours, and where its
texts are valid for certain by their form, as numbers that are written are.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.cells import present_in
from colladaphy.columns.sure import unsure_texts
from colladaphy.columns.tags import compressed
from colladaphy_schema.content import NOT_LOCAL
from colladaphy_schema.rows import Child, Column, Lists, Masked, Rows

__all__ = ["sampled"]

Array = NDArray[Any]

_LARGEST: Final = 999_999_999
"""Counts that every integer type without a restriction holds."""


def sampled(root: Rows) -> Rows:
    """A copy of the root of a document, made by hand, with few of the rows below it."""
    return _Sample(root, "").thinned(np.zeros(1, np.int64))


class _Sample:
    """The rows of one table, and those of the tables below it."""

    def __init__(self, rows: Rows, tag: str) -> None:
        self.rows = rows
        self.count = len(rows)
        self.wanted = np.zeros(self.count, np.bool_)
        """Rows that the sample has to have, for themselves or what is in them."""
        if tag in NOT_LOCAL:
            self.wanted[:] = True
        self.children: list[tuple[Child[Any], _Sample]] = []
        patterns = np.zeros(self.count, np.int64)
        for field in type(rows).FIELDS:
            value = rows.known.get(field.name)
            if value is None:
                continue
            if isinstance(field, Child):
                if not len(value):
                    continue
                child = _Sample(value, field.tag)
                if tag in NOT_LOCAL:
                    child.wanted[:] = True
                self.children.append((field, child))
                counts = np.bincount(value.owner, minlength=self.count)
                self.wanted[value.owner[child.wanted]] = True
                seen = np.minimum(counts, 2)
            else:
                there = present_in(value)
                self._want_values(field, value, there)
                seen = there.astype(np.int64)
            patterns = patterns * 3 + seen
            patterns = compressed(patterns, int(patterns.max(initial=0)) + 1)[0].astype(np.int64)
        if self.count:
            self.wanted[compressed(patterns, int(patterns.max()) + 1)[1]] = True
        self._want_neighbours()

    def _want_values(self, column: Column[Any], value: Any, there: Array) -> None:
        rows = np.flatnonzero(there)
        if not len(rows):
            return
        self.wanted[rows[0]] = True
        if isinstance(value, Masked):
            value = value.values
        if isinstance(value, Lists):
            unsure = np.arange(len(rows)) if column.restriction else rows[:0]
        elif isinstance(value, np.ndarray):
            unsure = _unsure_numbers(column, value[rows])
        elif column.tokens:
            unsure = unsure_texts([" ".join(value[row]) for row in rows.tolist()], column)
        else:
            texts = value if len(rows) == self.count else [value[row] for row in rows.tolist()]
            unsure = unsure_texts(texts, column)
        self.wanted[rows[unsure]] = True

    def _want_neighbours(self) -> None:
        """Children of several tables that stand between one another: one of each pair of them."""
        groups: dict[object, list[_Sample]] = {}
        for field, child in self.children:
            if field.group and field.many:
                groups.setdefault(field.group, []).append(child)
        for group in groups.values():
            if len(group) < 2:
                continue
            owner = np.concatenate([child.rows.owner for child in group])
            kind = np.repeat(np.arange(len(group)), [child.count for child in group])
            place = np.concatenate([np.arange(child.count) for child in group])
            order = np.concatenate([
                np.zeros(child.count) if child.rows.order is None else child.rows.order
                for child in group
            ])  # fmt: skip
            sorting = np.lexsort((order, owner))
            owner, kind, place = owner[sorting], kind[sorting], place[sorting]
            same = owner[1:] == owner[:-1]
            before = np.append(0, np.where(same, kind[:-1] + 1, 0))
            after = np.append(np.where(same, kind[1:] + 1, 0), 0)
            width = len(group) + 1
            keys = (kind * width + before) * width + after
            for example in compressed(keys, width**3)[1].tolist():
                for at in range(max(example - 1, 0), min(example + 2, len(owner))):
                    if owner[at] == owner[example]:
                        group[kind[at]].wanted[place[at]] = True
                        self.wanted[owner[at]] = True

    def thinned(self, kept: Array) -> Rows:
        """A copy of some of the rows, with what they have to have in them."""
        rows = self.rows
        made = type(rows)(len(kept), origin=rows.origin, empty=rows.empty_text)
        made.order = None if rows.order is None else rows.order[kept]
        for field in type(rows).FIELDS:
            value = rows.known.get(field.name)
            if value is None:
                continue
            if isinstance(field, Column):
                setattr(made, field.name, _some(value, kept))
        new = np.full(self.count, -1, np.int64)
        new[kept] = np.arange(len(kept))
        for field, child in self.children:
            owner = child.rows.owner
            mine = new[owner] >= 0
            ends = np.ones(child.count, np.bool_)
            ends[1:-1] = (owner[1:-1] != owner[:-2]) | (owner[1:-1] != owner[2:])
            below = np.flatnonzero(mine & (ends | child.wanted))
            part = child.thinned(below)
            part._owner = new[owner[below]]
            setattr(made, field.name, part)
        return made


def _unsure_numbers(column: Column[Any], values: Array) -> Array:
    if column.kind in ("boolean", "float") and not column.restriction:
        return np.zeros(0, np.int64)
    flat = values.reshape(len(values), -1)
    if column.restriction:
        odd = np.arange(len(flat))
    else:
        odd = np.flatnonzero(((flat < 0) | (flat > _LARGEST)).any(axis=1))
    _, first = np.unique(flat[odd], axis=0, return_index=True)
    return np.asarray(odd[first])


def _some(value: Any, rows: Array) -> Any:
    """A column of some rows."""
    if isinstance(value, Masked):
        return Masked(value.values[rows], value.present[rows])
    if isinstance(value, Lists):
        counts = np.diff(value.offsets)[rows]
        parts = [value[row] for row in rows.tolist()]
        values = np.concatenate(parts) if parts else value.values[:0]
        present = None if value.present is None else value.present[rows]
        return Lists(values, np.concatenate([[0], np.cumsum(counts)]), present)
    if isinstance(value, np.ndarray):
        return value[rows]
    return [value[row] for row in rows.tolist()]

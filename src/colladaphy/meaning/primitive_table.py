"""Primitives of meshes, with their lists of indices (COLLADA 1.5 §triangles … §tristrips)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.columns.spans import places_of
from colladaphy.meaning.array_table import CountRows
from colladaphy.meaning.context import Context, IntegerRows
from colladaphy.meaning.inputs import PRIMITIVES, inputs_of

__all__ = ["Group", "Primitives", "primitives_of"]

Array = NDArray[Any]


@dataclass(slots=True)
class Group:
    """One primitive."""

    element: int
    name: str
    count: int
    stride: int
    parts: list[tuple[int, Array]]
    """Elements p, or h, and their indices."""
    vcount: tuple[int, Array] | None


class Primitives:
    """All primitives of a document, one a row, and all of their lists of indices."""

    def __init__(self, context: Context) -> None:
        every = [context.rows(CountRows, name) for name in PRIMITIVES]
        sizes = [len(rows) for rows in every]
        self.elements: Array = np.concatenate([_ordinals(rows) for rows in every])
        self.kinds: Array = np.repeat(np.arange(len(PRIMITIVES)), sizes)
        """(n,) which of `PRIMITIVES` each is."""
        self.said: Array = np.concatenate([rows.count.values for rows in every])
        """(n,) their counts, as they are written."""
        self.counts: Array = counted(self.said)
        inputs = inputs_of(context)
        self.input_rows = context.places_in(self.elements, inputs.owners)
        """For each input the primitive that it belongs to; -1 for none."""
        mine = np.flatnonzero(self.input_rows >= 0)
        self.has_inputs = np.zeros(len(self.elements), np.bool_)
        self.has_inputs[self.input_rows[mine]] = True
        self.strides = np.zeros(len(self.elements), np.int64)
        """(n,) how many indices a corner has."""
        np.maximum.at(self.strides, self.input_rows[mine], inputs.offsets[mine])
        self.strides += 1
        self._read_lists(context)
        self._read_sizes(context)

    def _read_lists(self, context: Context) -> None:
        lists = [rows for tag in ("p", "h") if len(rows := context.rows(IntegerRows, tag))]
        elements = [_ordinals(rows) for rows in lists]
        lengths = [np.diff(rows.value.offsets) for rows in lists]
        values = [rows.value.values for rows in lists]
        empty = np.zeros(0, np.int64)
        self.list_elements: Array = np.concatenate([empty, *elements])
        """(m,) the elements p, then h."""
        self.list_lengths: Array = np.concatenate([empty, *lengths])
        self.list_starts: Array = np.cumsum(self.list_lengths) - self.list_lengths
        """(m,) where their indices start."""
        self._said_indices = values[0] if len(values) == 1 else np.concatenate([empty, *values])
        large = self._said_indices.dtype == object
        self.indices: Array = counted(self._said_indices) if large else self._said_indices
        """Those of all lists."""
        around = context.ancestor(self.list_elements, *PRIMITIVES)
        self.list_owners: Array = context.places_in(self.elements, around)
        """(m,) the primitives that they belong to; -1 for none."""

    def _read_sizes(self, context: Context) -> None:
        rows = context.rows(IntegerRows, "vcount")
        elements = _ordinals(rows)
        owners = context.places_in(self.elements, context.parent[elements].astype(np.int64))
        mine = np.flatnonzero(owners >= 0)
        self._sizes = rows.value if len(rows) else None
        self.vcounts = np.full(len(self.elements), -1, np.int64)
        """(n,) the elements vcount; -1 for none."""
        self._vcount_rows = self.vcounts.copy()
        self.vcounts[owners[mine]] = elements[mine]
        self._vcount_rows[owners[mine]] = mine

    def sizes_of(self, rows: Array) -> tuple[Array, Array]:
        """The corners of each polygon of some primitives with a vcount, and how many polygons."""
        if self._sizes is None or not len(rows):
            return np.zeros(0, np.int64), np.zeros(len(rows), np.int64)
        at, offsets = self._vcount_rows[rows], self._sizes.offsets
        counts = offsets[at + 1] - offsets[at]
        return counted(self._sizes.values[places_of(offsets[at], counts)]), counts

    def kind(self, *names: str) -> Array:
        """Which of them (n,) have one of some names."""
        return np.isin(self.kinds, [PRIMITIVES.index(name) for name in names])

    def summed(self, lists: Array, values: Array) -> Array:
        """Numbers of some lists, summed for each primitive (n,)."""
        owners = self.list_owners[lists]
        return np.bincount(owners, values, minlength=len(self.elements)).astype(np.int64)

    @cached_property
    def _by_owner(self) -> tuple[Array, Array]:
        """The lists by their primitives, and these."""
        order = np.argsort(self.list_owners, kind="stable")
        return order, self.list_owners[order]

    def group(self, row: int) -> Group:
        """One of them, to be looked at alone."""
        order, owners = self._by_owner
        first, last = np.searchsorted(owners, [row, row + 1]).tolist()
        parts = []
        for at in order[first:last].tolist():
            start = int(self.list_starts[at])
            indices = self._said_indices[start : start + int(self.list_lengths[at])]
            parts.append((int(self.list_elements[at]), indices))
        vcount = None
        if self._sizes is not None and self.vcounts[row] >= 0:
            vcount = int(self.vcounts[row]), self._sizes[int(self._vcount_rows[row])]
        name = PRIMITIVES[int(self.kinds[row])]
        return Group(int(self.elements[row]), name, int(self.said[row]), int(self.strides[row]),
                     parts, vcount)  # fmt: skip


def _ordinals(rows: Any) -> Array:
    return np.asarray(rows.ordinals, np.int64)


def primitives_of(context: Context) -> Primitives:
    """The primitives of a document."""
    return context.shared(Primitives)

"""Sources: what stands behind inputs, as all rules read it (COLLADA 1.5 §source)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import rows_among
from colladaphy.columns.spans import places_of
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.array_table import (
    TOKEN_ARRAYS,
    WordRows,
    accessors_of,
    arrays_of,
)
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit

__all__ = ["Sources", "sources_of"]

Array = NDArray[Any]


class Sources:
    """The sources of a document, one a row, with their arrays and accessors."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.elements: Array = context.ordinals("source").astype(np.int64)
        count = len(self.elements)
        arrays, accessors = arrays_of(context), accessors_of(context)
        around = context.ancestor(accessors.elements, "source")
        good = np.flatnonzero(around >= 0)
        self._read = np.full(count, -1, np.int64)
        """(n,) the rows of their accessors; -1 for none."""
        self._read[np.searchsorted(self.elements, around[good])] = good
        self.accessors = self._of_accessor(accessors.elements, -1)
        """(n,) the accessors; -1 for none."""
        self.arrays = self._of_accessor(accessors.targets, -1)
        """(n,) the elements of the arrays that the accessors read; -1 for none."""
        self.starts = self._of_accessor(accessors.offsets, 0)
        self.steps = self._of_accessor(accessors.strides, 1)
        self.counts = self._of_accessor(accessors.counts, -1)
        """(n,) of the accessors; -1 for sources without one."""
        self.widths = self._of_accessor(accessors.widths, 0)
        """(n,) how many values an item has."""
        rows = self._of_accessor(accessors.arrays, -1)
        # Of those that read past the end it cannot be told how many items there are.
        last = self.starts + self.steps * (self.counts - 1) + 1
        lengths = np.append(arrays.whole, -1)[rows]
        self._held = (lengths - self.starts) // np.maximum(self.steps, 1)
        self.counts[(lengths >= 0) & (last > lengths) & (self.counts > 0)] = -1
        self._faulty = self._of_accessor(accessors.wide | accessors.beyond, False)
        """(n,) whose values are others than were meant, as is told at array or accessor."""
        self._faulty |= np.append(arrays.faulty, False)[rows]
        self._words: dict[int, list[str]] = {}

    def _of_accessor(self, column: Array, default: Any) -> Array:
        return np.append(column, np.array(default, column.dtype))[self._read]

    def rows_of(self, elements: Array) -> Array:
        """The rows of elements; -1 for those that are no sources."""
        return rows_among(self.elements, elements)

    def count(self, row: int) -> int | None:
        """How many items the accessor of a source reads."""
        return int(self.counts[row]) if self.counts[row] >= 0 else None

    def short(self, row: int, wanted: int) -> Hit | None:
        """What to say where so many items are used that only the accessor lacks them.

        It is the same whoever finds it, so that it is told once.
        """
        if row < 0 or self._faulty[row]:
            return None
        count, held = int(self.counts[row]), int(self._held[row])
        if not 0 <= count < wanted <= held:
            return None
        message = f"The count is {count}, but more items are used, and the array has {held}."
        return Hit(geometry_rules.ACCESSOR_SHORT, int(self.accessors[row]), message,
                   (int(self.arrays[row]),), "count")  # fmt: skip

    def numbers(self, row: int) -> Array | None:
        """The items (n, stride) of a source of numbers; None where they cannot be read."""
        rows = np.array([row])
        if not self.is_readable(rows)[0]:
            return None
        return self.items(rows, int(self.steps[row]))

    def is_readable(self, rows: Array) -> Array:
        """Of which sources (n,) the items can be read as numbers."""
        starts, steps, counts = self.starts[rows], self.steps[rows], self.counts[rows]
        good = self.context.is_named(self.arrays[rows], "float_array") & ~self._faulty[rows]
        good &= (rows >= 0) & (steps > 0) & (counts >= 0)
        which = np.flatnonzero(good)
        if len(which):
            lists, at = self.context.numbers("float_array", self.arrays[rows[which]])
            lengths = lists.offsets[at + 1] - lists.offsets[at]
            good[which] &= (starts + steps * (counts - 1))[which] <= lengths
        return good

    def items(self, rows: Array, width: int) -> Array:
        """The first values (m, width) of all items of sources that are readable, one by one.

        What the last item of an array lacks is 0.
        """
        lists, at = self.context.numbers("float_array", self.arrays[rows])
        starts = lists.offsets[at] + self.starts[rows]
        counts = self.counts[rows]
        places = places_of(starts, counts, self.steps[rows])[:, None] + np.arange(width)
        ends = np.repeat(lists.offsets[at + 1], counts)[:, None]
        lacking = places >= ends
        if not lacking.any():
            found: Array = lists.values[places]
            return found
        there = np.append(lists.values, 0.0)
        return np.asarray(there[np.where(lacking, len(lists.values), places)])

    def words(self, row: int) -> list[str] | None:
        """The words of a source of names."""
        array = int(self.arrays[row])
        if array < 0 or self.context.name(array) not in TOKEN_ARRAYS or self._faulty[row]:
            return None
        if array not in self._words:
            self._words[array] = self.context.at(WordRows, np.array([array])).value[0]
        return self._words[array]


def sources_of(context: Context) -> Sources:
    """The sources of a document."""
    return context.shared(Sources)

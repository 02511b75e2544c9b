"""Arrays of sources, and the accessors that read them (COLLADA 1.5 §float_array, §accessor)."""

from __future__ import annotations

import re
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.columns.distinct import rows_among
from colladaphy.meaning.context import Context, FloatRows
from colladaphy_schema.rows import Column, Masked, Rows

__all__ = [
    "ARRAYS", "NUMBER_ARRAYS", "TOKEN_ARRAYS", "Accessors", "Arrays", "CountRows", "Param",
    "WordRows", "accessors_of", "arrays_of", "is_figure", "is_word",
]  # fmt: skip

Array = NDArray[Any]
Param = tuple[str, str, int]
"""The name, the type and the element of a parameter."""


TOKEN_ARRAYS = ("Name_array", "IDREF_array", "SIDREF_array", "token_array")
NUMBER_ARRAYS = ("float_array", "int_array", "bool_array")
ARRAYS = (*NUMBER_ARRAYS, *TOKEN_ARRAYS)
_WORDS = frozenset({"name", "idref", "sidref", "token", "string"})
_FIGURES = re.compile(r"(float|double|int|half|fixed)([234])?(?:x([234]))?\Z", re.IGNORECASE)


class AccessorRows(Rows):
    """Accessors; what the schema requires is there."""

    __slots__ = ()
    count: Column[Array] = Column("count", "attribute", "integer", default=0)
    offset: Column[Array] = Column("offset", "attribute", "integer", default=0)
    stride: Column[Array] = Column("stride", "attribute", "integer", default=1)


class CountRows(Rows):
    """Elements that say how much is in them."""

    __slots__ = ()
    count: Column[Masked[Any]] = Column("count", "attribute", "integer", optional=True)


class WordRows(Rows):
    """Elements of words."""

    __slots__ = ()
    value: Column[list[list[str]]] = Column("", "text", "token", tokens=True)


def is_word(type: str) -> bool:
    """Whether a type of a parameter is one of names."""
    return type.lower() in _WORDS


def is_figure(type: str) -> bool:
    """Whether it is one of numbers."""
    return _FIGURES.match(type) is not None


def _size(type: str) -> int:
    """How many values a parameter of a type takes."""
    match = _FIGURES.match(type)
    return 1 if match is None else int(match[2] or 1) * int(match[3] or 1)


class Arrays:
    """All arrays of a document, one a row, in its order."""

    def __init__(self, context: Context) -> None:
        elements, lengths, stated, present = [], [], [], []
        for name in ARRAYS:
            rows = context.rows(CountRows, name)
            if len(rows):
                assert rows.ordinals is not None
                elements.append(rows.ordinals)
                lengths.append(_lengths(context, name))
                stated.append(rows.count.values)
                present.append(rows.count.present)
        order: Any = slice(None)
        if len(elements) > 1:
            order = np.argsort(np.concatenate(elements))
        self.elements: Array = _joined(elements)[order].astype(np.int64)
        self.lengths: Array = _joined(lengths)[order]
        """(n,) how many values there are."""
        self.said: Array = _joined(stated)[order]
        """(n,) how many there are to be, as it is written; 0 where nothing is."""
        stated_counts = counted(self.said)
        self.whole: Array = np.maximum(self.lengths, stated_counts)
        """(n,) how many there are, or are to be."""
        self.faulty: Array = _joined(present)[order].astype(np.bool_)
        """(n,) which have others than they say, so that others are meant."""
        self.faulty &= stated_counts != self.lengths

    def rows_of(self, elements: Array) -> Array:
        """The rows of elements; -1 for those that are no arrays."""
        return rows_among(self.elements, elements)


def _joined(parts: list[Any]) -> Array:
    return np.concatenate(parts) if parts else np.zeros(0, np.int64)


def _lengths(context: Context, name: str) -> Array:
    if name == "float_array":
        return np.diff(context.rows(FloatRows, name).value.offsets)
    return np.array([len(words) for words in context.rows(WordRows, name).value], np.int64)


def arrays_of(context: Context) -> Arrays:
    """The arrays of a document."""
    return context.shared(Arrays)


class Accessors:
    """All accessors of a document, one a row, in its order."""

    def __init__(self, context: Context) -> None:
        rows = context.rows(AccessorRows, "accessor")
        assert rows.ordinals is not None
        arrays = arrays_of(context)
        self.rows = rows
        self.elements: Array = rows.ordinals.astype(np.int64)
        self.targets: Array = context.led("accessor", "source")
        """(n,) the elements that they read; -1 for none."""
        self.arrays: Array = arrays.rows_of(self.targets)
        """(n,) the rows of these arrays; -1 for what is none."""
        self.offsets, self.strides = counted(rows.offset), counted(rows.stride)
        self.counts = counted(rows.count)
        self._read_params(context, rows)
        self.wide: Array = self.sizes > self.strides
        """(n,) where an item of the parameters is longer than the stride."""
        ends = self.offsets + self.strides * (self.counts - 1)
        ends += np.where(self.sizes > 0, self.sizes, np.minimum(self.strides, 1))
        self.beyond: Array = ~self.wide & (self.arrays >= 0) & (self.counts > 0)
        """(n,) where values are read that the array has not."""
        if len(arrays.whole):
            self.beyond &= ends > arrays.whole[self.arrays]

    def _read_params(self, context: Context, rows: Rows) -> None:
        params = context.children(rows, "param", Rows)
        assert params.ordinals is not None
        self.owners: Array = params.owner
        """(m,) the rows of the accessors of parameters."""
        self.params: Array = params.ordinals
        numbers, texts = context.columns.factorized(params, "name")
        self.names, self.names_texts = _with_empty(numbers, texts)
        """(m,) the numbers of the names of parameters, which are 0 for none, and these."""
        numbers, texts = context.columns.factorized(params, "type")
        self.types, self.types_texts = _with_empty(numbers, texts)
        """The same for types."""
        self._taken = np.array([_size(text) for text in self.types_texts])[self.types]
        self.sizes: Array = self._summed(self._taken)
        """(n,) how many values the parameters of an item take."""

    def _summed(self, values: Array) -> Array:
        found = np.bincount(self.owners, values, minlength=len(self.elements))
        return found.astype(np.int64)

    @cached_property
    def widths(self) -> Array:
        """(n,) how many values an item has; without a name, and others with one, none count."""
        is_named = self.names > 0
        named = self._summed(np.where(is_named, self._taken, 0))
        some = np.where(self._summed(is_named) > 0, named, self.sizes)
        there = np.bincount(self.owners, minlength=len(self.elements)) > 0
        return np.where(there, some, self.strides)

    def params_of(self, row: int) -> list[Param]:
        """The parameters of an accessor."""
        first, last = np.searchsorted(self.owners, [row, row + 1]).tolist()
        return [
            (self.names_texts[self.names[at]], self.types_texts[self.types[at]],
             int(self.params[at]))
            for at in range(first, last)
        ]  # fmt: skip


def _with_empty(numbers: Array, texts: list[str]) -> tuple[Array, list[str]]:
    """Texts with an empty one first, which stands for none too."""
    if "" in texts:
        empty = texts.index("")
        numbers = np.where(numbers == empty, -1, numbers)
    return numbers + 1, ["", *texts]


def accessors_of(context: Context) -> Accessors:
    """The accessors of a document."""
    return context.shared(Accessors)

"""From the texts of a column to its values: arrays, masks, lists, strings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.texts import (
    Ranges,
    boolean_lists_of,
    booleans_of,
    floats_of,
    integers_of,
    strings_of,
    words_of,
)
from colladaphy.columns.words import Words
from colladaphy_schema.rows import Column, Lists, Masked

__all__ = ["Spelling", "column_of"]

Array = NDArray[Any]

_READERS = {"float": floats_of, "integer": integers_of, "boolean": boolean_lists_of}
_FILLERS = {"float": np.nan, "integer": 0, "boolean": False}


@dataclass(frozen=True, slots=True)
class Spelling:
    """What has to be known of a document and of a place in it."""

    empty: str = ""
    """What stands for an empty text."""
    entities: bool = False
    """Whether there may be references such as &amp; in it."""
    blanked: bool = False
    """Whether there may be comments in it that were blanked out."""


def column_of(
    ranges: Ranges, column: Column[Any], there: Array | None, count: int, spelling: Spelling
) -> Any:
    """The column of `count` rows, of which those `there` have a text (None: all of them)."""
    if column.kind not in _FILLERS:
        return _strings(ranges, column, there, count, spelling)
    if column.tokens and column.width is None:
        return _lists(ranges, column, there, count)
    values = _values(ranges, column, spelling)
    if there is None:
        return Masked(values, np.ones(count, np.bool_)) if column.optional else values
    filler = _FILLERS[column.kind] if column.default is None else column.default
    filled = np.full((count, *values.shape[1:]), filler, dtype=values.dtype)
    filled[there] = values
    if not column.optional:
        return filled
    present = np.zeros(count, np.bool_)
    present[there] = True
    return Masked(filled, present)


def _values(ranges: Ranges, column: Column[Any], spelling: Spelling) -> Array:
    blank = _empty(ranges, spelling) if spelling.empty else None
    if blank is not None and bool(blank.any()):
        word = Words(np.frombuffer(spelling.empty.encode(), np.uint8))
        one = Ranges(word, np.array([0]), np.array([len(word.data)]))
        values = np.repeat(_values(one, column, Spelling()), len(ranges), axis=0)
        full = np.flatnonzero(~blank)
        values[full] = _values(ranges.take(full), column, Spelling())
        return values
    if column.kind == "boolean" and not column.tokens:
        return booleans_of(ranges)
    width = 1 if column.width is None else column.width
    values, counts = _READERS[column.kind](ranges, width)
    if len(values) != width * len(ranges) or (counts is not None and bool(np.any(counts != width))):
        raise ValueError(f"the texts of {column.name} do not hold {width} numbers each")
    return values if column.width is None else values.reshape(len(ranges), width)


def _empty(ranges: Ranges, spelling: Spelling) -> Array:
    """Which texts have nothing in them, but for comments."""
    empty = ranges.stops <= ranges.starts
    if spelling.blanked:
        first = ranges.all_words.data[ranges.starts]
        rows = np.flatnonzero(~empty & (first == 0))
        empty[rows] = [not text.strip(b"\0") for text in ranges.take(rows).texts()]
    return np.asarray(empty)


def _lists(ranges: Ranges, column: Column[Any], there: Array | None, count: int) -> Lists:
    values, counts = _READERS[column.kind](ranges, None)
    if counts is None:
        counts = np.full(len(ranges), len(values) // max(len(ranges), 1), np.int64)
    present = None
    if there is not None:
        spread = np.zeros(count, np.int64)
        spread[there] = counts
        counts = spread
        present = np.zeros(count, np.bool_)
        present[there] = True
    return Lists(values, np.concatenate([[0], np.cumsum(counts)]), present)


def _strings(
    ranges: Ranges, column: Column[Any], there: Array | None, count: int, spelling: Spelling
) -> list[Any]:
    if not len(ranges) and there is not None:
        return [_absent(column)] * count
    attribute = column.form == "attribute"
    texts: list[Any] = strings_of(
        ranges, column.kind, attribute=attribute, entities=spelling.entities
    )
    if spelling.empty:
        texts = [text or spelling.empty for text in texts]
    if column.tokens:
        texts = [words_of(text) for text in texts]
    if there is None:
        return texts
    spread = [_absent(column)] * count
    for row, text in zip(there.tolist(), texts, strict=True):
        spread[row] = text
    return spread


def _absent(column: Column[Any]) -> Any:
    """What stands for an attribute or element that is not there."""
    return [] if column.tokens and column.default == () else column.default

"""The texts of one column: which rows have one, and how they are spelled."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.numbers import integer_texts, list_texts, texts_of
from colladaphy.columns.pieces import Part, Slot
from colladaphy.errors import SchemaError
from colladaphy_schema.rows import Column, Lists, Masked, Rows

__all__ = ["Cells", "cells", "present_in"]

Array = NDArray[Any]

_NUMBERS = ("float", "integer", "boolean")
_TRUTH = np.array(["false", "true"], dtype=object)


@dataclass(slots=True)
class Cells:
    """What stands in a column."""

    part: str | Part
    """The texts of the rows that have one; one text where they all have the same."""
    there: Array | None = None
    """The rows (n,) that have one; None for all of them."""


def cells(rows: Rows, column: Column[Any]) -> Cells | None:
    """The texts of a column of rows; None where no row has one."""
    value = getattr(rows, column.name)
    if value is None:
        if column.optional or column.default is not None or not len(rows):
            return None
        raise SchemaError(
            f"{_place(rows, column)} is missing: assign `{column.name}` for all {len(rows)} rows"
        )
    if column.kind not in _NUMBERS:
        return _words(rows, column, value)
    if column.tokens and column.width is None:
        return _lists(rows, column, value)
    return _numbers(rows, column, value)


def present_in(value: Any) -> Array:
    """Which rows (n,) have a value, be it the default, which is not written."""
    if isinstance(value, Masked):
        return np.asarray(value.present, np.bool_)
    if isinstance(value, Lists) and value.present is not None:
        return np.asarray(value.present, np.bool_)
    if isinstance(value, list) and None in value:
        return np.array([text is not None for text in value], np.bool_)
    return np.ones(len(value), np.bool_)


def _place(rows: Rows, column: Column[Any]) -> str:
    return f"{type(rows).__name__}.{column.name}"


def _wrong(rows: Rows, column: Column[Any], what: str) -> NoReturn:
    raise SchemaError(f"{_place(rows, column)} {what}")


def _complete(rows: Rows, column: Column[Any], count: int) -> None:
    if count != len(rows):
        _wrong(rows, column, f"has {count} values for {len(rows)} rows: give one for each")


def _stated(rows: Rows, column: Column[Any], there: Array | None) -> Array | bool:
    """Where an attribute stands in the document though its value may be the default."""
    if rows.origin is None or column.form != "attribute":
        return False
    stated: Array = rows.origin.stated(rows, column)
    return stated if there is None else stated[there]


def _chosen(there: Array | None, kept: Array) -> Array:
    return np.flatnonzero(kept) if there is None else there[kept]


# --- words


def _words(rows: Rows, column: Column[Any], value: Any) -> Cells | None:
    texts = value if isinstance(value, list) else list(value)
    _complete(rows, column, len(texts))
    there: Array | None = None
    missing = texts.count(None)
    if missing:
        if not column.optional and column.default is None:
            _wrong(rows, column, f"is missing in row {texts.index(None)}: every row needs one")
        if missing == len(texts):
            return None
        there = np.array([place for place, text in enumerate(texts) if text is not None], np.int64)
        texts = [texts[place] for place in there.tolist()]
    if column.default is not None:
        kept = _unlike(texts, column.default, _stated(rows, column, there))
        if not kept.all():
            there = _chosen(there, kept)
            texts = [texts[place] for place in np.flatnonzero(kept).tolist()]
    if not texts:
        return None
    if column.tokens:
        texts = [" ".join(words) for words in texts]
    if len(texts) > 1 and texts[0] == texts[-1] and texts.count(texts[0]) == len(texts):
        return Cells(_escaped(rows, column, texts[:1])[0], there)
    texts = _escaped(rows, column, texts)
    return Cells(Slot(lambda begin, end: texts[begin:end]), there)


def _unlike(texts: list[Any], default: Any, stated: Array | bool) -> Array:
    """Which texts are written: those that are not the default, and those that are stated."""
    if default == ():
        kept = np.fromiter(map(bool, texts), np.bool_, len(texts)) | stated
    elif texts.count(default) == len(texts):
        kept = np.zeros(len(texts), np.bool_) | stated
    else:
        kept = np.array([text != default for text in texts], np.bool_) | stated
    return np.asarray(kept)


_IN_TEXT = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#13;"})
_IN_ATTRIBUTE = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;",
     "\r": "&#13;"}
)  # fmt: skip
_NO_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def _escaped(rows: Rows, column: Column[Any], texts: list[str]) -> list[str]:
    """The texts as markup; what no document can hold is refused."""
    try:
        joined = "".join(texts)
    except TypeError:
        row = next(row for row, text in enumerate(texts) if not isinstance(text, str))
        _wrong(rows, column, f"holds {texts[row]!r}: its values are texts (str)")
    ascii_only = joined.isascii()
    if ascii_only:
        codes = np.frombuffer(joined.encode("ascii"), np.uint8)
        low = bool((codes < 32).any())
    else:
        low = True
    if low and (found := _NO_XML.search(joined)):
        _wrong(rows, column, f"holds {found[0]!r}, which no XML can hold: take it out")
    attribute = column.form == "attribute"
    special = any(character in joined for character in "&<>")
    if special or (low and any(blank in joined for blank in "\r\n\t")) or '"' in joined:
        table = _IN_ATTRIBUTE if attribute else _IN_TEXT
        return [text.translate(table) for text in texts]
    return texts


# --- numbers


def _numbers(rows: Rows, column: Column[Any], value: Any) -> Cells | None:
    present = None
    if isinstance(value, Masked):
        value, present = value.values, np.asarray(value.present, np.bool_)
    values = _array(rows, column, value)
    _complete(rows, column, len(values))
    there: Array | None = None
    if present is not None and not bool(present.all()):
        if not column.optional and column.default is None:
            _wrong(
                rows, column, f"is missing in row {int(np.argmin(present))}: every row needs one"
            )
        there = np.flatnonzero(present)
        values = values[there]
    if column.default is not None:
        kept = _differs(values, column.default) | _stated(rows, column, there)
        if not bool(kept.all()):
            there = _chosen(there, kept)
            values = values[kept]
    if not len(values):
        return None
    values = values.reshape(len(values), -1)
    if column.kind == "boolean" and values.shape[1] == 1:
        flags = values[:, 0].astype(np.intp)
        if bool(np.all(flags == flags[0])):
            return Cells(_TRUTH[flags[0]], there)
        return Cells(Slot(lambda begin, end: _TRUTH[flags[begin:end]].tolist()), there)
    if column.kind == "boolean":
        return Cells(Slot(lambda begin, end: _truths(values[begin:end])), there)
    make = texts_of if column.kind == "float" else integer_texts
    bits = values.view(np.int64) if values.dtype == np.float64 else values
    if bool(np.all(bits[0] == bits[-1])) and bool(np.all(bits == bits[0])):
        return Cells(make(values[:1])[0], there)
    return Cells(
        Slot(lambda begin, end: make(values[begin:end]), max(values.shape[1] // 4, 1)), there
    )


def _array(rows: Rows, column: Column[Any], value: Any) -> Array:
    """The values as an array of the right type and shape."""
    try:
        if column.kind == "float":
            values = np.ascontiguousarray(value, dtype=np.float64)
        elif column.kind == "boolean":
            values = np.asarray(value)
            if values.dtype != np.bool_:
                raise ValueError(f"has values of type {values.dtype}, where bool is asked for")
        else:
            values = np.asarray(value)
            if values.dtype.kind not in "iuO" and values.size:
                raise ValueError(f"has values of type {values.dtype}, where int is asked for")
            if values.dtype == np.uint64:
                values = values.astype(object)
            elif values.dtype != object:
                values = np.ascontiguousarray(values, dtype=np.int64)
    except (TypeError, ValueError) as error:
        _wrong(rows, column, f"cannot be written: {error}")
    shape = () if column.width is None else (column.width,)
    if values.ndim == 0 or values.shape[1:] != shape:
        wanted = "(n,)" if column.width is None else f"(n, {column.width})"
        _wrong(rows, column, f"has the shape {values.shape}: it needs {wanted}")
    return values


def _differs(values: Array, default: Any) -> Array:
    """Where values are not the default, bit by bit."""
    if values.dtype == np.float64:
        return np.asarray(values.view(np.int64) != np.float64(default).view(np.int64))
    return np.asarray(values != default, dtype=np.bool_)


def _truths(values: Array) -> list[str]:
    return [" ".join(row) for row in _TRUTH[values.astype(np.intp)].tolist()]


def _lists(rows: Rows, column: Column[Any], value: Any) -> Cells | None:
    if not isinstance(value, Lists):
        _wrong(rows, column, f"is a {type(value).__name__}: give `Lists` of values and offsets")
    _complete(rows, column, len(value))
    flat: Column[Any] = Column("", column.form, column.kind)
    flat.name = column.name
    values = _array(rows, flat, value.values)
    counts = np.diff(value.offsets)
    there: Array | None = None
    if value.present is not None and not bool(value.present.all()):
        if not column.optional and column.default is None:
            row = int(np.argmin(value.present))
            _wrong(rows, column, f"is missing in row {row}: every row needs one")
        there = np.flatnonzero(value.present)
        if int(counts.sum()) != int(counts[there].sum()):
            _wrong(rows, column, "has numbers in rows that `present` says have none")
        counts = counts[there]
    if column.default == ():
        kept = (counts > 0) | _stated(rows, column, there)
        there, counts = _chosen(there, kept), counts[kept]
        if len(there) == len(rows):
            there = None
    if not len(counts):
        return None
    offsets = np.concatenate([[0], np.cumsum(counts)]) + int(value.offsets[0])
    if offsets[-1] > len(values) or bool((counts < 0).any()):
        _wrong(rows, column, f"has offsets that do not fit its {len(values)} numbers")

    def texts(begin: int, end: int) -> list[str]:
        here = values[offsets[begin] : offsets[end]]
        if column.kind == "boolean":
            cuts = (offsets[begin + 1 : end] - offsets[begin]).tolist()
            return [" ".join(part) for part in np.split(_TRUTH[here.astype(np.intp)], cuts)]
        return list_texts(here, counts[begin:end])

    return Cells(Slot(texts, counts // 4 + 1), there)

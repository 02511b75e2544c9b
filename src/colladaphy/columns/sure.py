"""Texts that are valid for certain by their form, for types without further restrictions."""

from __future__ import annotations

import re
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.factors import factors_of
from colladaphy.columns.texts import Ranges, plain_numbers_of
from colladaphy_schema.rows import Column

__all__ = ["unsure", "unsure_texts"]

Array = NDArray[Any]

_PART: Final = 1 << 13
_FEW: Final = 200
"""Different texts of which each may be an example."""

_END: Final = 1
"""A byte behind each text that no document holds."""
_NAME: Final = rb"[A-Za-z_][A-Za-z0-9_.-]*+"
_COUNT: Final = rb"(?:0|[1-9][0-9]{0,8}+)"
_FORMS: Final = {
    form: re.compile(rb"(?:%b\x01)*+" % pattern)
    for form, pattern in {
        "name": _NAME,
        "fragment": b"#" + _NAME,
        "anyURI": rb"#?+[A-Za-z0-9_.-]++(?:/[A-Za-z0-9_.-]++)*+",
        "integer": _COUNT,
        "integers": rb"[ \t\r\n]*+(?:" + _COUNT + rb"(?:[ \t\r\n]++|(?=\x01)))*+",
    }.items()
}
_FORM_OF_RESTRICTION: Final = {"(#(.*))": "fragment", "anyURI": "anyURI"}
_NUMBERS: Final = re.compile(
    rb"[ \t\r\n]*+(?:[+-]?+[0-9]++(?:\.[0-9]++)?+(?:[eE][+-]?+[0-9]{1,2}+)?+(?:[ \t\r\n]++|\Z))*+"
)
_ANYTHING: Final = ("string", "normalized", "token")


def unsure(ranges: Ranges, column: Column[Any] | None) -> Array:
    """Which texts (their rows) have to be looked at by a validator, for all to be valid.

    `column` says what they are; None where that is not known. Of equal texts one is enough.
    """
    if not len(ranges):
        return np.zeros(0, np.int64)
    if ranges.all_equal() or (column is not None and _is_anything(column)):
        return np.zeros(1, np.int64)
    form = None if column is None else _form(column)
    if form is None or column is None:
        return factors_of(ranges)[1]
    few = factors_of(ranges.part(0, _FEW))[1]
    if len(few) < _FEW // 4:
        found = factors_of(ranges)[1]
        if len(found) < _FEW:
            return found
    if form == "floats":
        found = _floats(ranges, column)
    elif _FORMS[form].fullmatch(ranges.joined(_END)) is not None:
        found = _NONE
    else:
        found = _unlike(form, ranges.texts())
    return np.append(found, 0)


def unsure_texts(texts: list[str], column: Column[Any]) -> Array:
    """The same for texts that are to be written; of lists the items are parted by blanks."""
    if _is_anything(column):
        return _NONE
    form = _form(column)
    if form is not None and form != "floats":
        parts = [text.encode("utf-8", "replace") for text in texts]
        if _FORMS[form].fullmatch(b"".join(part + b"\1" for part in parts)) is not None:
            return _NONE
        return _unlike(form, parts)
    first: dict[str, int] = {}
    for row, text in enumerate(texts):
        first.setdefault(text, row)
    return np.array(list(first.values()), np.int64)


_NONE: Final = np.zeros(0, np.int64)


def _is_anything(column: Column[Any]) -> bool:
    return column.kind in _ANYTHING and not (column.restriction or column.tokens)


def _form(column: Column[Any]) -> str | None:
    """What texts of a column look like that are valid for certain; None if that is not known."""
    if column.tokens:
        if column.restriction or column.kind not in ("float", "integer"):
            return None
        if column.kind == "integer":
            return "integers" if column.width is None else None
        return "floats"
    if column.restriction:
        return _FORM_OF_RESTRICTION.get(column.restriction)
    return {"float": "floats", "integer": "integer", "name": "name"}.get(column.kind)


def _unlike(form: str, texts: list[bytes]) -> Array:
    """Rows of texts that are not of a form."""
    pattern = _FORMS[form]
    return np.array(
        [row for row, text in enumerate(texts) if pattern.fullmatch(text + b"\1") is None], np.int64
    )


def _floats(ranges: Ranges, column: Column[Any]) -> Array:
    width = column.width if column.tokens else 1
    values: list[Array] = []
    counts: list[Array] = []
    found: list[Array] = []
    for begin in range(0, len(ranges), _PART):
        part = ranges.part(begin, begin + _PART)
        made = plain_numbers_of(part, width)
        if made is not None:
            values.append(made[0])
            counts += [] if made[1] is None or width is not None else [made[1]]
        else:
            found.append(begin + _unusual(part, width))
    if not found:
        every = np.concatenate(counts) if counts else None
        ranges.all_words.keep(ranges.starts, np.concatenate(values), every)
    return np.concatenate([_NONE, *found])


def _unusual(ranges: Ranges, width: int | None) -> Array:
    """Rows of lists that are not of numbers as everybody spells them, or not of `width`."""
    return np.array(
        [
            row
            for row, text in enumerate(ranges.texts())
            if _NUMBERS.fullmatch(text) is None
            or (width is not None and len(text.split()) != width)
        ],
        np.int64,
    )

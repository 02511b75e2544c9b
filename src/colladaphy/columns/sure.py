"""Texts that are valid for certain by their form, for types without further restrictions."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.texts import Ranges, factors_of, plain_numbers_of
from colladaphy_schema.rows import Column

__all__ = ["unsure"]

Array = NDArray[Any]

_PART: Final = 1 << 13
_FEW: Final = 200
"""Different texts of which each may be an example."""

_NAME: Final = rb"[A-Za-z_][A-Za-z0-9_.-]*+"
_FORMS: Final = {
    "name": re.compile(rb"(?:" + _NAME + rb"\n)*+"),
    "address": re.compile(rb"(?:#?+[A-Za-z0-9_.-]++(?:/[A-Za-z0-9_.-]++)*+\n)*+"),
    "fragment": re.compile(rb"(?:#" + _NAME + rb"\n)*+"),
    "integer": re.compile(rb"(?:[1-9][0-9]{0,8}+\n|0\n)*+"),
    "integers": re.compile(rb"(?:(?:0|[1-9][0-9]{0,8}+)[ \n])*+"),
}
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
    if ranges.all_equal():
        return np.zeros(1, np.int64)
    find = None
    if column is not None:
        restriction = column.restriction
        if not restriction and not column.tokens and column.kind in _ANYTHING:
            return np.zeros(1, np.int64)
        find = _PATTERNS.get(restriction) if restriction else _FINDERS.get(column.kind)
    if find is None or column is None:
        return factors_of(ranges)[1]
    few = factors_of(ranges.part(0, _FEW))[1]
    if len(few) < _FEW // 4:
        found = factors_of(ranges)[1]
        if len(found) < _FEW:
            return found
    return np.concatenate([np.zeros(1, np.int64), find(ranges, column)])


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


_NONE: Final = np.zeros(0, np.int64)


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


def _matching(form: str) -> Callable[[Ranges, Column[Any]], Array]:
    pattern = _FORMS[form]

    def find(ranges: Ranges, column: Column[Any]) -> Array:
        if column.tokens and form != "integers":
            return np.arange(len(ranges))
        if pattern.fullmatch(ranges.joined(10)) is not None:
            return np.zeros(0, np.int64)
        return np.array([row for row, text in enumerate(ranges.texts())
                         if pattern.fullmatch(text + b"\n") is None], np.int64)  # fmt: skip

    return find


def _integers(ranges: Ranges, column: Column[Any]) -> Array:
    if column.tokens and column.width is not None:
        return np.arange(len(ranges))
    return _INTEGERS[column.tokens](ranges, column)


_INTEGERS: Final = {False: _matching("integer"), True: _matching("integers")}
_FINDERS: Final = {
    "float": _floats,
    "integer": _integers,
    "name": _matching("name"),
}
_PATTERNS: Final = {"(#(.*))": _matching("fragment"), "anyURI": _matching("address")}
"""By the restrictions of the schema's types."""

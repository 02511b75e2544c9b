"""Arrays, and the accessors that read them (COLLADA 1.5 §source, §accessor)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import geometry_rules
from colladaphy.meaning.array_table import (
    NUMBER_ARRAYS,
    TOKEN_ARRAYS,
    Accessors,
    Param,
    accessors_of,
    arrays_of,
    is_figure,
    is_word,
)
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Column, Lists, Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


class BoundRows(Rows):
    """Arrays of whole numbers, with their bounds."""

    __slots__ = ()
    least: Column[Array] = Column("minInclusive", "attribute", "integer", default=-(2**31))
    most: Column[Array] = Column("maxInclusive", "attribute", "integer", default=2**31 - 1)
    value: Column[Lists] = Column("", "text", "integer", tokens=True)


def counts(context: Context) -> Iterator[Hit]:
    """Arrays with more or fewer values than they say."""
    arrays = arrays_of(context)
    for row in np.flatnonzero(arrays.faulty).tolist():
        message = f"The count is {arrays.said[row]}, but there are {arrays.lengths[row]} values."
        element = int(arrays.elements[row])
        yield Hit(geometry_rules.ARRAY_COUNT, element, message, attribute="count")


def bounds(context: Context) -> Iterator[Hit]:
    """Arrays of whole numbers with some that are out of the bounds that they state."""
    rows = context.rows(BoundRows, "int_array")
    if not len(rows):
        return
    assert rows.ordinals is not None
    for row, element in enumerate(rows.ordinals.tolist()):
        values = rows.value[row]
        least, most = int(rows.least[row]), int(rows.most[row])
        outside = values[(values < least) | (values > most)]
        if len(outside):
            message = f"{int(outside[0])} is not between {least} and {most}."
            yield Hit(geometry_rules.ARRAY_BOUNDS, element, message)


def accessors(context: Context) -> Iterator[Hit]:
    """Accessors whose parameters do not fit their strides, or that read past their arrays."""
    table, arrays = accessors_of(context), arrays_of(context)
    unlike = _unlike(context, table)
    for row in np.flatnonzero(table.wide | table.beyond | unlike).tolist():
        element, size = int(table.elements[row]), int(table.sizes[row])
        offset, stride, count = (int(column[row]) for column in (
            table.rows.offset, table.rows.stride, table.rows.count))  # fmt: skip
        if table.wide[row]:
            message = f"The stride is {stride}, but there are {size} values in an item."
            yield Hit(geometry_rules.ACCESSOR_STRIDE, element, message, attribute="stride")
        elif table.beyond[row]:
            array = int(table.arrays[row])
            # Where the array itself is wrong, that is said there.
            whole = max(int(arrays.lengths[array]), int(arrays.said[array]))
            end = offset + stride * (count - 1) + (size or min(stride, 1))
            message = (
                f"{count} items of {stride} from {offset} on reach to value {end}, but the "
                f"array has {whole}."
            )
            key = "offset" if offset >= whole else "count"
            related = (int(table.targets[row]),)
            yield Hit(geometry_rules.ACCESSOR_RANGE, element, message, related, key)
        if unlike[row]:
            yield from _types(context, int(table.targets[row]), table.params_of(row))


def _unlike(context: Context, table: Accessors) -> Array:
    """Which accessors (n,) have a parameter of numbers for names, or the other way round."""
    found = np.zeros(len(table.elements), np.bool_)
    for names, is_wrong in ((NUMBER_ARRAYS, is_word), (TOKEN_ARRAYS, is_figure)):
        wrong = np.array([is_wrong(type) for type in table.types_texts], np.bool_)
        if wrong.any():
            owners = table.owners[wrong[table.types]]
            found[owners[context.is_named(table.targets[owners], *names)]] = True
    return found


def _types(context: Context, array: int, params: list[Param]) -> Iterator[Hit]:
    name = context.name(array)
    for _, type, element in params:
        if is_word(type) if name in NUMBER_ARRAYS else is_figure(type):
            message = f"The parameter is of type {type!r}, but its values are in a <{name}>."
            yield Hit(geometry_rules.PARAM_TYPE, element, message, (array,), "type")
            return


CHECKS = (counts, bounds, accessors)

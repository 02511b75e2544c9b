"""Sources: arrays, and the accessors that read them (COLLADA 1.5 §source, §accessor)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.context import Context, FloatRows
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Column, Lists, Masked, Rows

__all__ = ["CHECKS", "NUMBER_ARRAYS", "TOKEN_ARRAYS", "Sources", "params_of", "sources_of"]

Array = NDArray[Any]


TOKEN_ARRAYS = ("Name_array", "IDREF_array", "SIDREF_array", "token_array")
NUMBER_ARRAYS = ("float_array", "int_array", "bool_array")
_ARRAYS = (*NUMBER_ARRAYS, *TOKEN_ARRAYS)
_WORDS = frozenset({"name", "idref", "sidref", "token", "string"})
_FIGURES = re.compile(r"(float|double|int|half|fixed)([234])?(?:x([234]))?\Z", re.IGNORECASE)


class AccessorRows(Rows):
    """Accessors; what the schema requires is there."""

    __slots__ = ()
    source: Column[list[str]] = Column("source", "attribute", "token")
    count: Column[Array] = Column("count", "attribute", "integer", default=0)
    offset: Column[Array] = Column("offset", "attribute", "integer", default=0)
    stride: Column[Array] = Column("stride", "attribute", "integer", default=1)


class CountRows(Rows):
    """Elements that say how much is in them."""

    __slots__ = ()
    count: Column[Masked[Any]] = Column("count", "attribute", "integer", optional=True)


class BoundRows(Rows):
    """Arrays of whole numbers, with their bounds."""

    __slots__ = ()
    least: Column[Array] = Column("minInclusive", "attribute", "integer", default=-(2**31))
    most: Column[Array] = Column("maxInclusive", "attribute", "integer", default=2**31 - 1)
    value: Column[Lists] = Column("", "text", "integer", tokens=True)


class WordRows(Rows):
    """Elements of words."""

    __slots__ = ()
    value: Column[list[list[str]]] = Column("", "text", "token", tokens=True)


class ParamRows(Rows):
    """Parameters of accessors."""

    __slots__ = ()
    name: Column[list[str]] = Column("name", "attribute", "token", default="")
    type: Column[list[str]] = Column("type", "attribute", "token", default="")


class Params:
    """The parameters of accessors: name, type and element of each."""

    def __init__(self, context: Context) -> None:
        rows = context.rows(AccessorRows, "accessor")
        params = context.children(rows, "param", ParamRows)
        assert rows.ordinals is not None and params.ordinals is not None
        self._by_accessor: dict[int, list[tuple[str, str, int]]] = {
            element: [] for element in rows.ordinals.tolist()
        }
        for owner, name, type, element in zip(
            rows.ordinals[params.owner].tolist(), params.name, params.type,
            params.ordinals.tolist(), strict=True,
        ):  # fmt: skip
            self._by_accessor[owner].append((name, type, element))

    def of(self, accessor: int) -> list[tuple[str, str, int]]:
        """The parameters of an accessor."""
        return self._by_accessor[accessor]

    def each(self) -> Iterable[tuple[int, list[tuple[str, str, int]]]]:
        """All accessors with their parameters, one after the other."""
        return self._by_accessor.items()

    def width(self, accessor: int, stride: int) -> int:
        """How many values an item has; those without a name are passed over, if others have one."""
        mine = self._by_accessor[accessor]
        named = [type for name, type, _ in mine if name] or [type for _, type, _ in mine]
        return sum(map(_size, named)) if named else stride


def params_of(context: Context) -> Params:
    """The parameters of the accessors of a document."""
    return context.shared(Params)


class Sources:
    """The sources of a document, one a row, with their arrays and accessors."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.elements: Array = context.ordinals("source").astype(np.int64)
        count = len(self.elements)
        self.arrays = np.full(count, -1, np.int64)
        """(n,) the elements of the arrays that the accessors read; -1 for none."""
        self.accessors = np.full(count, -1, np.int64)
        self.starts, self.steps = np.zeros(count, np.int64), np.ones(count, np.int64)
        self.counts = np.full(count, -1, np.int64)
        """(n,) of the accessors; -1 for sources without one."""
        self._lengths = array_lengths(context)
        self._numbers: dict[int, Array] = {}
        rows = context.rows(AccessorRows, "accessor")
        assert rows.ordinals is not None
        around = context.ancestor(rows.ordinals, "source")
        mine = np.searchsorted(self.elements, around) if count else around
        good = np.flatnonzero(around >= 0)
        at = mine[good]
        self.accessors[at] = rows.ordinals[good]
        self.arrays[at] = context.targets(rows.source)[good]
        self.starts[at] = counted(rows.offset[good])
        self.steps[at], self.counts[at] = counted(rows.stride[good]), counted(rows.count[good])
        # Of those that read past the end it cannot be told how many items there are.
        last = self.starts + self.steps * (self.counts - 1) + 1
        whole = [self._whole(array) for array in self.arrays.tolist()]
        lengths = counted(np.array(whole, dtype=object))
        self._held = (lengths - self.starts) // np.maximum(self.steps, 1)
        self.counts[(lengths >= 0) & (last > lengths) & (self.counts > 0)] = -1
        self._faulty = context.shared(_faulty_arrays) | context.shared(_faulty_accessors)

    def _whole(self, array: int) -> int:
        """How many values an array has, or says that it has."""
        if array not in self._lengths:
            return -1
        return max(self._lengths[array], self.context.shared(_stated).get(array, 0))

    def rows_of(self, elements: Array) -> Array:
        """The rows of elements; -1 for those that are no sources."""
        if not len(self.elements):
            return np.full(len(elements), -1, np.int64)
        at = np.minimum(np.searchsorted(self.elements, elements), len(self.elements) - 1)
        return np.where(self.elements[at] == elements, at, -1)

    def count(self, row: int) -> int | None:
        """How many items the accessor of a source reads."""
        return int(self.counts[row]) if self.counts[row] >= 0 else None

    def short(self, row: int, wanted: int) -> Hit | None:
        """What to say where so many items are used that only the accessor lacks them.

        It is the same whoever finds it, so that it is told once.
        """
        count, held = int(self.counts[row]), int(self._held[row])
        if row < 0 or not 0 <= count < wanted <= held or self._is_faulty(row):
            return None
        message = f"The count is {count}, but more items are used, and the array has {held}."
        return Hit(geometry_rules.ACCESSOR_SHORT, int(self.accessors[row]), message,
                   (int(self.arrays[row]),), "count")  # fmt: skip

    def numbers(self, row: int) -> Array | None:
        """The items (n, stride) of a source of numbers; None where they cannot be read."""
        array = int(self.arrays[row])
        if array < 0 or self.context.name(array) != "float_array" or self._is_faulty(row):
            return None
        values = self.values(array)
        start, step, count = int(self.starts[row]), int(self.steps[row]), int(self.counts[row])
        if step <= 0 or count < 0 or start + step * count > len(values) + step:
            return None
        part = values[start : start + step * count]
        if len(part) < step * count:  # the last item may be shorter
            part = np.append(part, np.zeros(step * count - len(part)))
        return part.reshape(count, step)

    def _is_faulty(self, row: int) -> bool:
        """Whether its values are others than were meant, as is told at array or accessor."""
        return bool(self._faulty & {int(self.arrays[row]), int(self.accessors[row])})

    def words(self, row: int) -> list[str] | None:
        """The words of a source of names."""
        array = int(self.arrays[row])
        if array < 0 or self.context.name(array) not in TOKEN_ARRAYS or self._is_faulty(row):
            return None
        return words_of(self.context, array)

    def values(self, array: int) -> Array:
        """The numbers of a float_array."""
        if array not in self._numbers:
            rows = self.context.rows(FloatRows, "float_array")
            assert rows.ordinals is not None
            place = int(np.searchsorted(rows.ordinals, array))
            self._numbers[array] = rows.value[place]
        return self._numbers[array]


def sources_of(context: Context) -> Sources:
    """The sources of a document."""
    return context.shared(Sources)


def array_lengths(context: Context) -> dict[int, int]:
    """How many values there are in each array, by its element."""
    return context.shared(_lengths)


def words_of(context: Context, array: int) -> list[str]:
    """The words of an array."""
    rows = context.at(WordRows, np.array([array]))
    return rows.value[0]


def _lengths(context: Context) -> dict[int, int]:
    found: dict[int, int] = {}
    rows: Any = context.rows(FloatRows, "float_array")
    if len(rows):
        found.update(zip(rows.ordinals.tolist(), np.diff(rows.value.offsets).tolist(), strict=True))
    for name in _ARRAYS[1:]:
        words: Any = context.rows(WordRows, name)
        if len(words):
            found.update(zip(words.ordinals.tolist(), map(len, words.value), strict=True))
    return found


def _faulty_arrays(context: Context) -> set[int]:
    return {hit.element for hit in counts(context)}


def _faulty_accessors(context: Context) -> set[int]:
    rules = (geometry_rules.ACCESSOR_STRIDE, geometry_rules.ACCESSOR_RANGE)
    return {hit.element for hit in accessors(context) if hit.rule in rules}


def counts(context: Context) -> Iterator[Hit]:
    """Arrays with more or fewer values than they say."""
    lengths = array_lengths(context)
    for name in _ARRAYS:
        rows = context.rows(CountRows, name)
        assert rows.ordinals is not None
        for element, stated, there in zip(
            rows.ordinals.tolist(), rows.count.values.tolist(), rows.count.present.tolist(),
            strict=True,
        ):  # fmt: skip
            if there and stated != lengths[element]:
                message = f"The count is {stated}, but there are {lengths[element]} values."
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
    rows = context.rows(AccessorRows, "accessor")
    if not len(rows):
        return
    assert rows.ordinals is not None
    lengths = array_lengths(context)
    params = params_of(context)
    targets = context.targets(rows.source).tolist()
    stated = context.shared(_stated)
    columns = (rows.ordinals, rows.offset, rows.stride, rows.count)
    for row, (element, offset, stride, count) in enumerate(
        zip(*(column.tolist() for column in columns), strict=True)
    ):
        array = targets[row]
        length = lengths.get(array)
        mine = params.of(element)
        sizes = [_size(type) for _, type, _ in mine]
        if sum(sizes) > stride:
            message = f"The stride is {stride}, but there are {sum(sizes)} values in an item."
            yield Hit(geometry_rules.ACCESSOR_STRIDE, element, message, attribute="stride")
        elif length is not None and count > 0:
            # Where the array itself is wrong, that is said there.
            end = offset + stride * (count - 1) + (sum(sizes) or min(stride, 1))
            whole = max(length, stated.get(array, 0))
            if end > whole:
                message = (
                    f"{count} items of {stride} from {offset} on reach to value {end}, but the "
                    f"array has {whole}."
                )
                key = "offset" if offset >= whole else "count"
                yield Hit(geometry_rules.ACCESSOR_RANGE, element, message, (array,), key)
        if array >= 0:
            yield from _types(context, array, mine)


def _stated(context: Context) -> dict[int, int]:
    found: dict[int, int] = {}
    for name in _ARRAYS:
        rows = context.rows(CountRows, name)
        assert rows.ordinals is not None
        found.update(zip(rows.ordinals.tolist(), rows.count.values.tolist(), strict=True))
    return found


def _size(type: str) -> int:
    match = _FIGURES.match(type)
    if match is None:
        return 1
    return int(match[2] or 1) * int(match[3] or 1)


def _types(context: Context, array: int, params: list[tuple[str, str, int]]) -> Iterator[Hit]:
    name = context.name(array)
    for _, type, element in params:
        wrong = type.lower() in _WORDS if name in NUMBER_ARRAYS else bool(_FIGURES.match(type))
        if wrong and (name in NUMBER_ARRAYS or name in TOKEN_ARRAYS):
            message = f"The parameter is of type {type!r}, but its values are in a <{name}>."
            yield Hit(geometry_rules.PARAM_TYPE, element, message, (array,), "type")
            return


CHECKS = (counts, bounds, accessors)

"""The documents that are read together, and tables of their elements.

A table holds all elements of one kind in all documents of a pool, numbered through; documents that
references lead to join the pool when they are first needed, and their rows come after all others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from functools import cached_property
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import ColladaError, DocumentError
from colladaphy.links.poses import Poses
from colladaphy.links.resource import Resource
from colladaphy.source.rules import UNREACHABLE
from colladaphy_schema.rows import Rows

__all__ = ["Pool", "Table", "concatenated", "expanded", "is_unreachable", "taken"]

Array = NDArray[Any]
R = TypeVar("R", bound=Rows)
T = TypeVar("T")

_HOME = np.int64(1) << 40
"""Above all numbers of elements of one document."""


def is_unreachable(error: ColladaError) -> bool:
    """Whether a reference cannot be followed only because its file cannot be reached."""
    return all(finding.code in UNREACHABLE for finding in error.findings)


class Pool:
    """Documents by number, the first one first."""

    def __init__(self, first: Resource) -> None:
        first.lead()
        self.resources = [first]
        self._numbers = {id(first): 0}
        self._tables: dict[tuple[type[Rows], tuple[str, ...]], Table[Any]] = {}

    def number(self, resource: Resource) -> int:
        """The number of a document, which joins the pool if it is new."""
        known = self._numbers.get(id(resource))
        if known is None:
            known = self._numbers[id(resource)] = len(self.resources)
            self.resources.append(resource)
        return known

    def table(self, kind: type[R], *tags: str) -> Table[R]:
        """The elements of some names."""
        key = (kind, tags)
        if key not in self._tables:
            self._tables[key] = Table(self, kind, tags)
        return self._tables[key]

    def follow(
        self,
        table: Table[Any],
        references: Sequence[str],
        homes: Array,
        origins: Array,
        expected: str | tuple[str, ...],
        *,
        needed: bool = True,
    ) -> tuple[Array, dict[int, DocumentError]]:
        """The rows of a table that references lead to (-1 for those that fail, with their errors).

        `homes` are the numbers of the documents that the references stand in, `origins` the
        numbers of their elements there. Where the scene cannot do without what is `needed`, a
        document that is there but cannot be read raises, unless the first one is tolerant.
        """
        count = len(references)
        rows = np.full(count, -1, np.int64)
        if len(self.resources) == 1:
            get = table.ids(0).get
            rows[...] = [get(reference, -1) for reference in references]
        else:
            known = [table.ids(home) for home in range(len(self.resources))]
            rows[...] = [
                known[home].get(reference, -1)
                for home, reference in zip(homes.tolist(), references, strict=True)
            ]
        errors: dict[int, DocumentError] = {}
        seen: dict[tuple[int, str], int | DocumentError] = {}
        for place in np.flatnonzero(rows < 0).tolist():
            home, reference = int(homes[place]), references[place]
            key = (home, reference)
            # Only what names its document or an id means the same wherever it stands.
            found = seen.get(key) if reference.startswith("#") else None
            if found is None:
                resource = self.resources[home]
                try:
                    target, element = resource.follow(reference, int(origins[place]), expected)
                    found = table.row_of(self.number(target), element)
                except DocumentError as error:
                    found = error
                except ColladaError as error:
                    if needed and not self.resources[0].tolerant:
                        raise
                    found = DocumentError(error.findings)
                seen[key] = found
            if isinstance(found, DocumentError):
                errors[place] = found
            else:
                rows[place] = found
        return rows, errors


class Table(Generic[R]):
    """All elements of one kind, numbered through the documents of a pool."""

    def __init__(self, pool: Pool, kind: type[R], tags: tuple[str, ...]) -> None:
        self._pool = pool
        self._kind = kind
        self._tags = tags
        self._parts: list[R] = []
        self._starts = [0]
        self._ids: list[dict[str, int]] = []
        self._gathered: dict[Callable[..., Any], tuple[list[Any], Any]] = {}
        self._keys: tuple[int, Array, Array] | None = None

    @property
    def parts(self) -> list[R]:
        """The rows of each document."""
        for resource in self._pool.resources[len(self._parts) :]:
            part = resource.columns.rows(self._kind, *self._tags)
            self._parts.append(part)
            self._starts.append(self._starts[-1] + len(part))
        return self._parts

    def start(self, home: int) -> int:
        """The number of the first row of a document."""
        assert len(self.parts) > home
        return self._starts[home]

    def __len__(self) -> int:
        assert self.parts is not None
        return self._starts[-1]

    def ids(self, home: int) -> dict[str, int]:
        """Rows of one document by `#` and the id."""
        parts = self.parts
        while len(self._ids) <= home:
            number = len(self._ids)
            texts = getattr(parts[number], "id", None) or []
            start = self._starts[number]
            known: dict[str, int] = {}
            if texts:
                rows = range(start + len(texts) - 1, start - 1, -1)
                known = {f"#{text}": row for text, row in zip(reversed(texts), rows, strict=True)}
                known.pop("#None", None) if None in texts else None
            self._ids.append(known)
        return self._ids[home]

    def row_of(self, home: int, element: int) -> int:
        """The row of an element; -1 for one of another kind."""
        return int(self.rows_of(home, np.array([element]))[0])

    def rows_of(self, home: int, elements: Array) -> Array:
        """The rows of elements (n,) of one document; -1 for those of another kind."""
        mine = self.parts[home].ordinals
        assert mine is not None
        rows = np.minimum(np.searchsorted(mine, elements), max(len(mine) - 1, 0))
        there = mine[rows] == elements if len(mine) else np.zeros(len(elements), np.bool_)
        return np.where(there, rows + self._starts[home], -1)

    def homes(self, rows: Array) -> Array:
        """The numbers of the documents that rows are of."""
        if len(self.parts) == 1:
            return np.zeros(len(rows), np.int64)
        return np.searchsorted(np.array(self._starts[1:]), rows, side="right")

    @property
    def ordinals(self) -> Array:
        """The numbers of the elements in their documents (n,)."""
        return self._known_keys()[1]

    @property
    def parent_keys(self) -> Array:
        """What tells the parents of the elements (n,), ascending."""
        return self._known_keys()[0]

    def keys(self, rows: Array) -> Array:
        """What tells elements as parents of others (n,)."""
        ordinals = self.ordinals[rows].astype(np.int64)
        if len(self.parts) == 1:
            return ordinals
        return ordinals + self.homes(rows) * _HOME

    def _known_keys(self) -> tuple[Array, Array]:
        parts = self.parts
        if self._keys is None or self._keys[0] != len(parts):
            keys, ordinals = [], []
            for home, part in enumerate(parts):
                assert part.ordinals is not None
                parent = self._pool.resources[home].columns.index.parent[part.ordinals]
                keys.append(parent.astype(np.int64) + home * _HOME)
                ordinals.append(part.ordinals)
            self._keys = (len(parts), _joined(keys), _joined(ordinals))
        return self._keys[1], self._keys[2]

    def below(self, keys: Array) -> tuple[Array, Array]:
        """The rows whose parents have the given keys, and the number of the key of each."""
        mine = self.parent_keys
        begin = np.searchsorted(mine, keys, side="left")
        end = np.searchsorted(mine, keys, side="right")
        return expanded(begin, end)

    def gather(self, read: Callable[[R, int, int], T]) -> T:
        """What a function reads of the rows of each document, joined.

        It is called with the rows, the number of the document and that of the first row.
        """
        parts = self.parts
        gathered: tuple[list[T], T] | None = self._gathered.get(read)
        if gathered is None or len(gathered[0]) < len(parts):
            known = gathered[0] if gathered is not None else []
            for home in range(len(known), len(parts)):
                known.append(read(parts[home], home, self._starts[home]))
                # What was made of the columns stays, not the columns: a document has many.
                parts[home].forget()
            gathered = (known, concatenated(known))
            self._gathered[read] = gathered
        return gathered[1]

    def texts(self, name: str, *, once: bool = False) -> list[Any]:
        """A column of texts of all rows; one that is asked for `once` is not kept in memory."""
        found: list[Any] = []
        for part in self.parts:
            column = getattr(part, name)
            if once and part.origin is not None:
                part.known.pop(name, None)
            if len(self._parts) == 1:
                return list(column) if not isinstance(column, list) else column
            found += column
        return found

    @cached_property
    def nothing(self) -> Array:
        """No rows."""
        return np.zeros(0, np.int64)


def expanded(begin: Array, end: Array) -> tuple[Array, Array]:
    """All numbers of ranges, one range after the other, and the range of each."""
    counts = end - begin
    total = int(counts.sum())
    if total == len(counts) and bool(np.all(counts == 1)):
        return begin.astype(np.int64), np.arange(total)
    owner = np.repeat(np.arange(len(counts)), counts)
    before = np.cumsum(counts) - counts
    return np.arange(total) - before[owner] + begin[owner], owner


def _joined(parts: list[Array]) -> Array:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def concatenated(parts: Sequence[T]) -> T:
    """Several records of arrays, lists and poses as one, field by field."""
    if len(parts) == 1:
        return parts[0]
    first = parts[0]
    values: dict[str, Any] = {}
    for field in fields(first):  # type: ignore[arg-type]
        mine = [getattr(part, field.name) for part in parts]
        if isinstance(mine[0], np.ndarray):
            values[field.name] = np.concatenate(mine)
        elif isinstance(mine[0], list):
            values[field.name] = [value for part in mine for value in part]
        elif isinstance(mine[0], Poses):
            values[field.name] = Poses.joined(mine)
        else:
            values[field.name] = concatenated(mine)
    return type(first)(**values)


def taken(record: T, rows: Array) -> T:
    """Some rows of a record of arrays, lists and poses, in that order, field by field."""
    values: dict[str, Any] = {}
    for field in fields(record):  # type: ignore[arg-type]
        column = getattr(record, field.name)
        if isinstance(column, list):
            values[field.name] = [column[row] for row in rows.tolist()]
        elif isinstance(column, np.ndarray):
            values[field.name] = column.take(rows, axis=0)
        else:
            values[field.name] = column.take(rows)
    return type(record)(**values)

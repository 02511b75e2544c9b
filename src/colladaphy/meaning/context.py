"""What rules look at: the columns of a document, tables that several rules need, and its links."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.reading import Document
from colladaphy.errors import ColladaError
from colladaphy.findings import Rule, Severity
from colladaphy.links.names import c
from colladaphy.links.nodes import Placement
from colladaphy.links.pool import Pool
from colladaphy.links.resource import Resource
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Child, Column, Lists, Rows

__all__ = ["Context", "FloatRows", "IntegerRows", "NamedRows", "TextRows", "texts_of"]

Array = NDArray[Any]
R = TypeVar("R", bound=Rows)
T = TypeVar("T")


class FloatRows(Rows):
    """Elements of numbers."""

    __slots__ = ()
    value: Column[Lists] = Column("", "text", "float", tokens=True)


class IntegerRows(Rows):
    """Elements of whole numbers."""

    __slots__ = ()
    value: Column[Lists] = Column("", "text", "integer", tokens=True)


class TextRows(Rows):
    """Elements of text."""

    __slots__ = ()
    value: Column[list[str]] = Column("", "text", "token")


class NamedRows(Rows):
    """Elements with ids, sids and names."""

    __slots__ = ()
    id: Column[list[str | None]] = Column("id", "attribute", "token", optional=True)
    sid: Column[list[str | None]] = Column("sid", "attribute", "token", optional=True)
    name: Column[list[str | None]] = Column("name", "attribute", "token", optional=True)


class _Quiet(Resource):
    """Takes what is noticed on the way, as rules of their own tell it."""

    def note(
        self,
        rule: Rule,
        number: int | None = None,
        message: str | None = None,
        *,
        home: Resource | None = None,
        severity: Severity | None = None,
    ) -> None:
        """Nothing."""

    def note_broken(self, error: ColladaError, severity: Severity | None = None) -> None:
        """Nothing."""


@dataclass(frozen=True, slots=True)
class Reference:
    """A text that refers to something, at an element."""

    element: int
    text: str


@dataclass(frozen=True, slots=True)
class Leads:
    """Where a reference of elements (n,) leads."""

    targets: Array
    """(n,) the elements of the document; -1 for nothing."""
    plain: Array
    """(n,) which are written as ``#id``."""
    present: Array
    """(n,) which have the attribute."""


class Context:
    """One document, for all rules."""

    def __init__(self, resource: Resource, exists: Callable[[str], str | None] | None = None):
        self.resource = resource
        self.exists = exists
        """Why a file that a reference names cannot be had (None: it can); None if not known."""
        self._rows: dict[tuple[type[Rows], tuple[str, ...]], Rows] = {}
        self._firsts: dict[tuple[str, ...], dict[int, int]] = {}
        self._shared: dict[Callable[[Context], Any], Any] = {}
        self._leads: dict[tuple[str, str], Leads] = {}

    @cached_property
    def columns(self) -> Document:
        """The document as columns."""
        return self.resource.columns

    @property
    def parent(self) -> Array:
        """The parent of each element, -1 for the root."""
        return self.columns.index.parent

    @cached_property
    def pool(self) -> Pool:
        """The documents that the document refers to."""
        return Pool(self.resource)

    @cached_property
    def placement(self) -> Placement:
        """Where nodes stand."""
        made = Placement(self.pool, _Quiet(None))
        self.fill(made.nodes.parts[0])
        return made

    def shared(self, make: Callable[[Context], T]) -> T:
        """What a function makes of the document, made once."""
        if make not in self._shared:
            self._shared[make] = make(self)
        found: T = self._shared[make]
        return found

    # --- elements

    def rows(self, kind: type[R], *names: str) -> R:
        """All elements of some names, but for those in techniques."""
        key = (kind, names)
        if key not in self._rows:
            self._rows[key] = self.columns.rows(kind, *map(c, names))
        found: Any = self._rows[key]
        return found  # type: ignore[no-any-return]

    def ordinals(self, *names: str) -> Array:
        """The numbers of all elements of some names."""
        found = self.rows(Rows, *names).ordinals
        assert found is not None
        return found

    def every(self, *names: str) -> Array:
        """The numbers of all elements of some names, in techniques too."""
        columns = self.columns
        parts = [columns.index.rows(code) for name in names for code in columns.codes_of(c(name))]
        return np.sort(np.concatenate(parts)) if parts else np.zeros(0, np.int32)

    def children(self, rows: Rows, name: str, kind: type[R]) -> R:
        """The children of a name of some rows."""
        child: Child[Any] = Child(c(name), "rows:Rows")
        child._type = kind
        found: R = self.columns.children(rows, child)
        return found

    def first_children(self, *names: str) -> dict[int, int]:
        """The first child of some names of each element that has one."""
        if names not in self._firsts:
            found = self.ordinals(*names)
            above = self.parent[found]
            self._firsts[names] = dict(
                zip(reversed(above.tolist()), reversed(found.tolist()), strict=True)
            )
        return self._firsts[names]

    def scalars(
        self, rows: Rows, name: str, default: float = np.nan
    ) -> tuple[Array, Array]:  # fmt: skip
        """The number (n,) in a child of each row, NaN for none, and the child (n,), -1 for none.

        A child without text has the schema's `default`, as far as there is one.
        """
        values, elements = self.vectors(rows, name, 1, default)
        return values[:, 0], elements

    def vectors(
        self, rows: Rows, name: str, width: int, default: float = np.nan
    ) -> tuple[Array, Array]:
        """The same for children of several numbers (n, width)."""
        values = np.full((len(rows), width), np.nan)
        elements = np.full(len(rows), -1, np.int64)
        found = self.children(rows, name, FloatRows)
        if len(found):
            assert found.ordinals is not None
            lists, at = self.numbers(name, found.ordinals)
            first = lists.offsets[at]
            full = lists.offsets[at + 1] - first == width
            values[found.owner[lists.offsets[at + 1] == first]] = default
            values[found.owner[full]] = lists.values[first[full][:, None] + np.arange(width)]
            elements[found.owner] = found.ordinals
        return values, elements

    def numbers(self, name: str, ordinals: Array) -> tuple[Lists, Array]:
        """Lists of numbers, and which of them (n,) are those in some elements of a name.

        As several rules ask for the same, all that is not in techniques is read once.
        """
        every = self.rows(FloatRows, name)
        assert every.ordinals is not None
        return every.value, np.searchsorted(every.ordinals, ordinals)

    def fill(self, placed: Any) -> None:
        """Give rows with translate and rotate the numbers of these, where they were read."""
        for name, width in (("translate", 3), ("rotate", 4)):
            steps = getattr(placed, name)
            steps.value = self.table(name, steps.ordinals, width)

    def table(self, name: str, ordinals: Array, width: int) -> Array:
        """The same as a table (n, width), where the schema wants as many."""
        lists, at = self.numbers(name, ordinals)
        found: Array = lists.values[lists.offsets[at][:, None] + np.arange(width)]
        return found

    def flags(self, rows: Rows, name: str, default: bool) -> tuple[Array, Array]:
        """The truth value (n,) in a child of each row, and the child (n,), -1 for none.

        Without a child, and where it is empty, it is the schema's `default`.
        """
        values = np.full(len(rows), default)
        elements = np.full(len(rows), -1, np.int64)
        found = self.children(rows, name, TextRows)
        if len(found):
            assert found.ordinals is not None
            words = [text.strip() for text in found.value]
            values[found.owner] = [word in ("true", "1") if word else default for word in words]
            elements[found.owner] = found.ordinals
        return values, elements

    def at(self, kind: type[R], ordinals: Array) -> R:
        """Elements of some numbers, ascending."""
        return kind(len(ordinals), owners=len(ordinals), origin=self.columns,
                    ordinals=np.asarray(ordinals, np.int32))  # fmt: skip

    def places_in(self, elements: Array, wanted: Array) -> Array:
        """Where each wanted one (n,) stands first among elements in any order; -1 for nowhere."""
        scratch = self.columns.index.scratch
        scratch[elements[::-1]] = np.arange(len(elements) - 1, -1, -1)
        found = np.where(wanted >= 0, scratch[wanted], -1)
        scratch[elements] = -1
        return found

    def is_within(self, ordinals: Array, *names: str) -> Array:
        """Which elements (n,) are children of elements of some names."""
        codes = [code for name in names for code in self.columns.codes_of(c(name))]
        return self.columns.have_code(self.parent[ordinals], codes)

    def ancestor(self, ordinals: Array, *names: str) -> Array:
        """The nearest elements (n,) of some names around elements; -1 for none."""
        codes = [code for name in names for code in self.columns.codes_of(c(name))]
        parent, current = self.parent, self.parent[ordinals].astype(np.int64)
        while True:
            left = np.flatnonzero((current >= 0) & ~self.columns.have_code(current, codes))
            if not len(left):
                return current
            current[left] = parent[current[left]]

    def name(self, element: int) -> str:
        """The local name of an element."""
        return self.columns.local_name(element)

    def is_named(self, elements: Array, *names: str) -> Array:
        """Which elements (n,) have one of some names; none where there is no element (-1)."""
        codes = [code for name in names for code in self.columns.codes_of(c(name))]
        return self.columns.have_code(elements, codes)

    def label(self, element: int) -> str:
        """What an element is called in a message."""
        text = self._labels.get(element)
        return f"<{self.name(element)}> {text!r}" if text else f"<{self.name(element)}>"

    @cached_property
    def _labels(self) -> dict[int, str]:
        """Ids, or else sids, or else names, by element."""
        found: dict[int, str] = {}
        for key in ("name", "sid", "id"):
            elements, texts = self.columns.with_attribute(key)
            found.update(zip(elements.tolist(), texts, strict=True))
        return found

    # --- references

    def texts(self, rows: Rows, attribute: str) -> list[str | None]:
        """An attribute of some rows."""
        return texts_of(self.columns, rows, attribute)

    def references(self, attribute: str, *names: str) -> list[Reference]:
        """All references of an attribute of elements of some names."""
        rows = self.rows(Rows, *names)
        assert rows.ordinals is not None
        return [
            Reference(element, text)
            for element, text in zip(
                rows.ordinals.tolist(), self.texts(rows, attribute), strict=True
            )
            if text is not None
        ]

    def target(self, text: str | None) -> int:
        """The element of this document that a URI such as ``#id``, or an id, means; -1 for none.

        The URI may name the file of the document, too.
        """
        if not text:
            return -1
        file, sign, id = text.partition("#")
        if file and sign and self.resource.is_own(file):
            return self.named(id)
        return self.named(text.removeprefix("#"))

    def named(self, id: str) -> int:
        """The element of an id as a reference spells it, which may escape signs; -1 for none."""
        found = self.resource.ids.get(id, -1)
        return self.resource.ids.get(unquote(id), -1) if found < 0 and "%" in id else found

    def targets(self, texts: Iterable[str | None]) -> Array:
        """The same for many."""
        listed, get = list(texts), self.resource.ids.get
        found = [get(text[1:] if text[:1] == "#" else text, -1) if text else -1 for text in listed]
        if -1 in found:  # few are escaped, and nearly all are found
            found = [
                self.target(text) if at < 0 else at for at, text in zip(found, listed, strict=True)
            ]
        return np.array(found, np.int64)

    def leads(self, name: str, attribute: str) -> Leads:
        """Where a reference of all elements of a name leads."""
        key = (name, attribute)
        if key not in self._leads:
            rows, columns = self.rows(Rows, name), self.columns
            there, ranges = columns.ranges(rows, attribute)
            targets = columns.identifiers.referred(ranges)
            plain = targets >= 0
            left = np.flatnonzero(~plain)
            if len(left):
                texts = columns.strings(ranges.take(left))
                targets[left] = self.targets(texts)
                plain[left] = [text[:1] == "#" for text in texts]
            if there is not None:
                present = np.zeros(len(rows), np.bool_)
                present[there] = True
                every = np.full(len(rows), -1, np.int64), np.zeros(len(rows), np.bool_)
                every[0][there], every[1][there] = targets, plain
                self._leads[key] = Leads(*every, present)
            else:
                self._leads[key] = Leads(targets, plain, np.ones(len(rows), np.bool_))
        return self._leads[key]

    def led(self, name: str, attribute: str, ordinals: Array | None = None) -> Array:
        """The elements (n,) that it leads to, for all of the name or for some; -1 for nothing."""
        found = self.leads(name, attribute).targets
        if ordinals is None:
            return found
        every = self.rows(Rows, name).ordinals
        assert every is not None
        return found[np.searchsorted(every, ordinals)]

    def doubtful(self, name: str, attribute: str, expected: tuple[str, ...]) -> list[Reference]:
        """The references that are there, but do not lead to an expected element by ``#id``."""
        rows = self.rows(Rows, name)
        if not len(rows):
            return []
        leads = self.leads(name, attribute)
        good = leads.plain & self.is_named(leads.targets, *expected)
        doubtful = leads.present & ~good
        if not doubtful.any():
            return []
        bad = rows.select(doubtful)
        assert bad.ordinals is not None
        texts = self.texts(bad, attribute)
        return [
            Reference(element, text or "")
            for element, text in zip(bad.ordinals.tolist(), texts, strict=True)
        ]


def texts_of(columns: Document, rows: Rows, attribute: str) -> list[str | None]:
    """An attribute of some rows of a document."""
    column: Column[Any] = Column(attribute, "attribute", "token", optional=True)
    column.name = attribute
    found: list[str | None] = columns.column(rows, column)
    return found


Check = Callable[[Context], Iterable[Hit]]
"""A rule as a function."""

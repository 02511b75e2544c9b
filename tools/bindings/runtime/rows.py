"""Columns: all elements of a kind at once, their values as arrays.

A class of rows has the names of the schema. A value is an array of one entry a row, with a mask
where it is optional (`Masked`), texts are lists; a child element is a table of rows of its own,
each with the row of the parent that it belongs to (`owner`). Children of one kind stand in the
order of the document; where several kinds alternate, `ordinals` or `order` tells theirs.

Rows that come from a document read a column when it is first asked for (`Source`). Rows made by
hand take columns by assignment, and are written by `colladaphy.columns.writing`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any, ClassVar, Generic, Protocol, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Bools", "Child", "Column", "Floats", "Integers", "Lists", "Masked", "Rows", "Source",
]  # fmt: skip

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Bools = NDArray[np.bool_]

A = TypeVar("A")
R = TypeVar("R", bound="Rows")
Self = TypeVar("Self", bound="Rows")


@dataclass(slots=True)
class Masked(Generic[A]):
    """Values of which some are not there."""

    values: A
    """(n, ...); NaN or zero where there is none."""
    present: Bools
    """(n,) where there is one."""


@dataclass(slots=True)
class Lists:
    """A list of numbers a row: that of row i is values[offsets[i]:offsets[i + 1]]."""

    values: NDArray[Any]
    offsets: Integers
    """(n + 1,)."""
    present: Bools | None = None
    """(n,) where there is a list; None where there always is."""

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, row: int) -> NDArray[Any]:
        return self.values[self.offsets[row] : self.offsets[row + 1]]


class Source(Protocol):
    """Where rows come from."""

    def column(self, rows: Rows, column: Column[Any]) -> Any:
        """Read a column."""

    def children(self, rows: Rows, child: Child[Any]) -> Any:
        """Find the rows of a child element."""

    def stated(self, rows: Rows, column: Column[Any]) -> Bools:
        """Where the attribute of a column is there (n,), be it the default."""


class Column(Generic[A]):
    """The values of an attribute, of a child element of simple content, or of the text."""

    __slots__ = (
        "default", "empty", "form", "group", "kind", "name", "optional", "restriction", "tag",
        "tokens", "width",
    )  # fmt: skip

    def __init__(
        self,
        tag: str,
        form: str,
        kind: str,
        *,
        optional: bool = False,
        tokens: bool = False,
        width: int | None = None,
        default: Any = None,
        empty: str = "",
        group: int = 0,
        restriction: str = "",
    ) -> None:
        self.tag = tag
        """The qualified name; of an attribute as it is written; empty for the text."""
        self.form = form
        """attribute, element or text."""
        self.kind = kind
        """float, integer, boolean, or what white space means in a text."""
        self.optional = optional
        self.tokens = tokens
        """Whether it is a list."""
        self.width = width
        """The length of lists that all have the same."""
        self.default = default
        """What an attribute is that is not there; None where that is said by a mask."""
        self.empty = empty
        """What stands for an empty text."""
        self.group = group
        """The number of the choice that the element is an alternative of; 0 for none."""
        self.restriction = restriction
        """Empty where any text of the kind is valid; the schema's pattern, anyURI or "other"."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, rows: None, owner: type) -> Column[A]: ...
    @overload
    def __get__(self, rows: Rows, owner: type) -> A: ...
    def __get__(self, rows: Rows | None, owner: type) -> Any:
        if rows is None:
            return self
        known = rows.known
        if self.name not in known:
            if rows.origin is None:
                return None
            known[self.name] = rows.origin.column(rows, self)
        return known[self.name]

    def __set__(self, rows: Rows, value: Any) -> None:
        rows.known[self.name] = value


class Child(Generic[R]):
    """The rows of a child element."""

    __slots__ = ("_type", "empty", "group", "home", "many", "name", "optional", "tag")

    def __init__(
        self, tag: str, home: str, *, many: bool = False, optional: bool = False,
        empty: str = "", group: int = 0,
    ) -> None:  # fmt: skip
        self.tag = tag
        """The qualified name."""
        self.home = home
        """Module and class of the rows."""
        self.many = many
        self.optional = optional
        self.empty = empty
        self.group = group
        self._type: type[R] | None = None

    @property
    def type(self) -> type[R]:
        """The class of the rows, imported when it is first needed."""
        if self._type is None:
            module, _, name = self.home.partition(":")
            self._type = getattr(import_module(f"colladaphy_schema.{module}"), name)
        assert self._type is not None
        return self._type

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, rows: None, owner: type) -> Child[R]: ...
    @overload
    def __get__(self, rows: Rows, owner: type) -> R: ...
    def __get__(self, rows: Rows | None, owner: type) -> Any:
        if rows is None:
            return self
        known = rows.known
        if self.name not in known:
            if rows.origin is None:
                known[self.name] = self.type(0, owners=len(rows))
            else:
                known[self.name] = rows.origin.children(rows, self)
        return known[self.name]

    def __set__(self, rows: Rows, value: R) -> None:
        value.owners = len(rows)
        rows.known[self.name] = value


class Rows:
    """Elements of one kind, in the order of the document."""

    __slots__ = ("_owner", "_size", "empty_text", "known", "order", "ordinals", "origin", "owners")

    FIELDS: ClassVar[tuple[Column[Any] | Child[Any], ...]] = ()
    """Everything that such an element has, in the schema's order: attributes, then content."""

    def __init__(
        self,
        size: int,
        owner: NDArray[Any] | None = None,
        *,
        owners: int | None = None,
        origin: Source | None = None,
        ordinals: NDArray[Any] | None = None,
        order: NDArray[Any] | None = None,
        empty: str = "",
    ) -> None:
        self._size = size
        self._owner = owner
        self.owners = size if owners is None else owners
        """The number of rows of the parent."""
        self.origin = origin
        self.ordinals = ordinals
        """(n,) numbers of the elements in the document; None for rows made by hand."""
        self.order = ordinals if order is None else order
        """(n,) numbers by which rows of several kinds are sorted within their parent."""
        self.empty_text = empty
        """The schema's default for elements of this place without text."""
        self.known: dict[str, Any] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        fields = [field for base in reversed(cls.__mro__) for field in vars(base).values()
                  if isinstance(field, Column | Child)]  # fmt: skip
        if "FIELDS" not in vars(cls):
            cls.FIELDS = tuple(fields)

    def __len__(self) -> int:
        return self._size

    def __repr__(self) -> str:
        return f"<{self._size} {type(self).__name__}>"

    @property
    def owner(self) -> NDArray[np.int64]:
        """(n,) the row of the parent of each row, never descending."""
        if self._owner is None:
            self._owner = np.arange(self._size)
        return self._owner

    @property
    def is_whole(self) -> bool:
        """Whether each row of the parent has exactly one row here."""
        return self._size == self.owners and (
            self._owner is None or bool(np.array_equal(self._owner, np.arange(self._size)))
        )

    @property
    def present(self) -> Bools:
        """(m,) which rows of the parent have a row here."""
        if self.is_whole:
            return np.ones(self.owners, np.bool_)
        there = np.zeros(self.owners, np.bool_)
        there[self.owner] = True
        return there

    def per_owner(self, values: NDArray[Any], default: Any = 0) -> NDArray[Any]:
        """A column of an element that stands once at most, for every row of the parent (m, ...)."""
        if self.is_whole:
            return values
        spread = np.full((self.owners, *values.shape[1:]), default, dtype=values.dtype)
        spread[self.owner] = values
        return spread

    def texts_per_owner(self, texts: list[Any], default: Any = None) -> list[Any]:
        """The same for a column of texts."""
        if self.is_whole:
            return texts
        spread = [default] * self.owners
        for row, text in zip(self.owner.tolist(), texts, strict=True):
            spread[row] = text
        return spread

    def counts(self) -> NDArray[np.int64]:
        """(m,) how many rows there are of each row of the parent."""
        return np.bincount(self.owner, minlength=self.owners)

    def select(self: Self, rows: NDArray[Any]) -> Self:
        """Some of the rows (a mask, or ascending numbers), of the same parents."""
        if rows.dtype == np.bool_:
            if bool(rows.all()):
                return self
            rows = np.flatnonzero(rows)
        assert self.origin is not None and self.ordinals is not None
        return type(self)(
            len(rows), self.owner[rows], owners=self.owners, origin=self.origin,
            ordinals=self.ordinals[rows], empty=self.empty_text,
        )  # fmt: skip

    def forget(self) -> None:
        """Let go of what was read of a document, but for texts; it is read again when asked for."""
        if self.origin is not None:
            self.known = {name: known for name, known in self.known.items()
                          if isinstance(known, list)}  # fmt: skip

    def __iter__(self) -> Iterator[int]:
        return iter(range(self._size))

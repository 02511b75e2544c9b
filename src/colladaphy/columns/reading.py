"""Reading columns: the rows of a document, by the classes that are generated from the schema."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.columns.factors import factors_of
from colladaphy.columns.identifiers import Identifiers
from colladaphy.columns.index import BLOCK, Index, NotPlain
from colladaphy.columns.namespaces import codes_by_name
from colladaphy.columns.places import Place, Places
from colladaphy.columns.plain import Tree, plain, serialised
from colladaphy.columns.tags import Tags
from colladaphy.columns.texts import Ranges, strings_of
from colladaphy.columns.values import Spelling, column_of
from colladaphy_schema.rows import Child, Column, Rows

__all__ = ["Document"]

Array = NDArray[Any]
R = TypeVar("R", bound=Rows)

_COLLADA = "{http://www.collada.org/2008/03/COLLADASchema}"
_TECHNIQUE, _EXTRA = f"{_COLLADA}technique", f"{_COLLADA}extra"
_FEW = 24
"""Attributes of an element that are looked at one after the other."""


class Document:
    """A document as columns: `rows` gives all elements of a kind.

    `Document.of` takes any valid document; the bytes given to the class itself have to be plain
    (see `colladaphy.columns.plain`).
    """

    def __init__(self, data: bytes | bytearray, start: int = 0, *, block: int = BLOCK) -> None:
        self._take(Index(data, start, block), None)

    def _take(self, index: Index, tags: Tags | None) -> None:
        self.index = index
        self.places = Places(index, index.data)
        """Where its elements stand in the source as it came."""
        self._entities = b"&" in index.data
        self._blanked = b"\0" in index.data
        self._codes = codes_by_name(index, tags)
        self._tags = tags
        self._attribute_rows: Array | None = None
        self._looked_at = 0
        self._names: dict[int, str] | None = None

    @classmethod
    def of_index(cls, index: Index, tags: Tags, data: bytes) -> Document:
        """A valid document that is indexed as it is, but for comments that were blanked."""
        made = cls.__new__(cls)
        made._take(index, tags)
        made.places = Places(index, data)
        return made

    @classmethod
    def of(cls, data: bytes, tree: Tree = None, *, block: int = BLOCK) -> Document:
        """A valid document in any spelling.

        `tree` is the parsed tree of it, or what parses it if that is needed.
        """
        text, start = plain(data, tree)
        direct = len(text) == len(data) and (text is data or isinstance(text, bytearray))
        try:
            made = cls(text, start, block=block)
        except NotPlain:
            text, start = serialised(data, tree)
            direct = False
            made = cls(text, start, block=block)
        made.places = Places(made.index, data if direct else None, tree)
        return made

    def place(self, ordinal: int) -> Place:
        """Line and column of an element in the source."""
        return self.places.place(ordinal)

    def element(self, ordinal: int) -> etree._Element:
        """The element of the tree that the document was made with."""
        return self.places.element(ordinal)

    def texts_within(self, ordinals: Iterable[int]) -> list[bytes]:
        """The bytes of whole elements, from the start tag to the end tag."""
        return self.places.texts_within(ordinals)

    # --- rows

    def rows(self, kind: type[R], *tags: str) -> R:
        """All elements of some names as rows of a class, but for those in foreign techniques."""
        found = self._elements(tags)
        found = found[~self._is_foreign(found)]
        return kind(len(found), owners=len(found), origin=self, ordinals=found)

    def _elements(self, tags: tuple[str, ...]) -> Array:
        parts = [self.index.rows(code) for tag in tags for code in self._codes.get(tag, ())]
        if len(parts) == 1:
            return parts[0]
        return np.sort(np.concatenate(parts)) if parts else np.zeros(0, np.int32)

    def _is_foreign(self, rows: Array) -> Array:
        """Which elements stand in a technique of a profile."""
        foreign = np.zeros(len(rows), np.bool_)
        codes = self._codes.get(_TECHNIQUE)
        if codes is None:
            return foreign
        index = self.index
        self._looked_at += len(rows)
        if self._looked_at > len(index):  # so many that to know it of all costs less
            return self._foreign[rows]
        above = index.parent[rows]
        while len(above) and bool(np.any(above > 0)):
            foreign |= self.have_code(above, codes)
            above = np.maximum(index.parent[above], 0)
        return foreign

    @cached_property
    def _foreign(self) -> Array:
        """The same of all elements."""
        parent = self.index.parent
        found = self.have_code(parent, self._codes[_TECHNIQUE])
        while True:
            further = found | found[parent]
            further[0] = False
            if np.array_equal(further, found):
                return found
            found = further

    def names(self) -> dict[str, int]:
        """How many elements there are of each qualified name, those in techniques included."""
        counts = np.bincount(self.index.codes, minlength=1).tolist()
        found = {
            name: sum(counts[code] for code in codes if code < len(counts))
            for name, codes in self._codes.items()
        }
        return {name: count for name, count in found.items() if count}

    # --- texts that are compared only

    def factorized(self, rows: Rows, name: str) -> tuple[Array, list[str]]:
        """The values of an attribute as numbers (n,) into the different ones; -1 where none is.

        For references: there are few different ones, mostly, and no string is made for a row.
        """
        there, ranges = self._attribute(rows, name)
        numbers, first = factors_of(ranges)
        texts = strings_of(ranges.take(first), "token", attribute=True, entities=self._entities)
        if len(set(texts)) < len(texts):  # spelled differently
            known: dict[str, int] = {}
            again = np.array([known.setdefault(text, len(known)) for text in texts], np.int64)
            numbers, texts = again[numbers], list(known)
        if there is None:
            return numbers, texts
        codes = np.full(len(rows), -1, np.int64)
        codes[there] = numbers
        return codes, texts

    @cached_property
    def identifiers(self) -> Identifiers:
        """The ids, to be matched with references."""
        elements, ranges = self._holders("id")
        return Identifiers(elements, ranges.part(0, 0) if self._entities else ranges)

    @cached_property
    def scoped_identifiers(self) -> Identifiers:
        """The sids, those of one element being a scope."""
        elements, ranges = self._holders("sid")
        scopes = self.index.parent[elements]
        return Identifiers(elements, ranges.part(0, 0) if self._entities else ranges, scopes)

    def _holders(self, name: str) -> tuple[Array, Ranges]:
        """The elements that have an attribute, and its values; not those in foreign techniques."""
        every = self.index.attributed
        rows = Rows(len(every), owners=len(every), origin=self, ordinals=every)
        there, ranges = self._attribute(rows, name)
        found = every if there is None else every[there]
        mine = np.flatnonzero(~self._is_foreign(found))
        return found[mine], ranges.take(mine)

    def strings(self, ranges: Ranges) -> list[str]:
        """The values of attributes that are tokens."""
        return strings_of(ranges, "token", attribute=True, entities=self._entities)

    # --- single elements, by their numbers in the document

    def with_attribute(self, name: str) -> tuple[Array, list[str]]:
        """The elements that have an attribute, and its values; not those in foreign techniques."""
        elements, ranges = self._holders(name)
        return elements, self.strings(ranges)

    def parent_of(self, element: int) -> int:
        """The element around one; -1 for the root."""
        return int(self.index.parent[element])

    def end_of(self, element: int) -> int:
        """The number behind that of the last descendant."""
        parent, start, step = self.index.parent, element + 1, 64
        while start < len(parent):
            outside = np.flatnonzero(parent[start : start + step] < element)
            if len(outside):
                return start + int(outside[0])
            start, step = start + step, 2 * step
        return len(parent)

    def local_name(self, element: int) -> str:
        """The name without a namespace."""
        return self._name_of(element).rpartition("}")[2]

    def record_texts(self, element: int) -> list[bytes]:
        """The texts of an element and those in it, without what stands in profiles and extras."""
        index = self.index
        left_out = {*self.codes_of(_TECHNIQUE), *self.codes_of(_EXTRA)}
        kept = []
        row, end = element, self.end_of(element)
        while row < end:
            if int(index.codes[row]) in left_out:
                row = self.end_of(row)
                continue
            kept.append(row)
            row += 1
        return self._texts(np.array(kept, np.int32)).texts()

    def has_foreign_content(self, rows: Rows, namespace: str) -> bool:
        """Whether the first child of an element is not of a namespace (given in braces)."""
        assert rows.ordinals is not None
        index = self.index
        below = rows.ordinals[rows.ordinals + 1 < len(index)]
        first = below[index.parent[below + 1] == below] + 1
        foreign = np.ones(len(index.names.texts), np.bool_)
        foreign[[code for name, codes in self._codes.items() if name.startswith(namespace)
                 for code in codes]] = False  # fmt: skip
        return bool(np.any(foreign[index.codes[first]]))

    def chosen(self, rows: Rows, name: str, value: str) -> Array:
        """Which rows have a value of an attribute (n,)."""
        numbers, texts = self.factorized(rows, name)
        ours = np.array([*(text == value for text in texts), False], np.bool_)
        return ours[numbers]

    def codes_of(self, tag: str) -> tuple[int, ...]:
        """The codes of a qualified name in the index."""
        return self._codes.get(tag, ())

    def have_code(self, elements: Array, codes: Collection[int]) -> Array:
        """Which elements (n,) have one of some codes; none where there is no element (-1)."""
        ours = np.zeros(len(self.index.names.texts), np.bool_)
        ours[list(codes)] = True
        found: Array = ours[self.index.codes[elements]] & (elements >= 0)
        return found

    def is_profile(self, element: int) -> bool:
        """Whether an element is a technique of some profile."""
        return self._name_of(element) == _TECHNIQUE

    def attribute_of(self, element: int, name: str) -> str | None:
        """An attribute of one element, by its name as it is written."""
        one = np.array([element], np.int32)
        rows = Rows(1, owners=1, origin=self, ordinals=one)
        there, ranges = self._attribute(rows, name)
        if there is not None:
            return None
        return strings_of(ranges, "token", attribute=True, entities=self._entities)[0]

    def _name_of(self, element: int) -> str:
        if self._names is None:
            self._names = {code: name for name, codes in self._codes.items() for code in codes}
        return self._names[int(self.index.codes[element])]

    def children(self, rows: Rows, child: Child[Any]) -> Any:
        """The rows of a child element (see `colladaphy_schema.rows.Source`)."""
        found, owner = self._below(rows, child.tag)
        return child.type(
            len(found), owner, owners=len(rows), origin=self, ordinals=found, empty=child.empty
        )

    def _below(self, rows: Rows, tag: str) -> tuple[Array, Array | None]:
        """The children of a name of all rows, and the row of each; None where all have one."""
        found = self._elements((tag,))
        mine = rows.ordinals
        assert mine is not None
        if not len(mine) or not len(found):
            return found[:0], np.zeros(0, np.int64)
        parents = self.index.parent[found]
        if len(found) == len(mine) and np.array_equal(parents, mine):
            return found, None
        scratch = self.index.scratch
        scratch[mine] = np.arange(len(mine), dtype=np.int32)
        owner = scratch[parents]
        scratch[mine] = -1
        here = np.flatnonzero(owner >= 0)
        owner = owner[here]
        if len(here) != len(found):
            found = found[here]
        if len(owner) == len(mine) and np.array_equal(owner, np.arange(len(mine))):
            return found, None
        return found, owner.astype(np.int64)

    # --- columns

    def column(self, rows: Rows, column: Column[Any]) -> Any:
        """The values of a column (see `colladaphy_schema.rows.Source`)."""
        empty = column.empty
        there: Array | None = None
        if column.form == "attribute":
            there, ranges = self._attribute(rows, column.tag)
        elif column.form == "element":
            found, there = self._below(rows, column.tag)
            ranges = self._texts(found)
        else:
            assert rows.ordinals is not None
            ranges = self._texts(rows.ordinals)
            empty = rows.empty_text
        if there is not None and len(there) == len(rows):
            there = None
        spelling = Spelling(empty, entities=self._entities, blanked=self._blanked)
        return column_of(ranges, column, there, len(rows), spelling)

    def stated(self, rows: Rows, column: Column[Any]) -> Array:
        """Where the attribute of a column is there (n,)."""
        there, _ = self._attribute(rows, column.tag)
        found = np.zeros(len(rows), np.bool_)
        found[slice(None) if there is None else there] = True
        return found

    def _texts(self, elements: Array) -> Ranges:
        """What stands in elements of simple content."""
        index = self.index
        return Ranges(index.words, index.stop[elements] + 1, index.text_end[elements])

    def ranges(self, rows: Rows, name: str) -> tuple[Array | None, Ranges]:
        """Where the values of an attribute stand: the rows that have one (None: all), the bytes."""
        return self._attribute(rows, name)

    def _attribute(self, rows: Rows, name: str) -> tuple[Array | None, Ranges]:
        """The rows that have an attribute (None: all), and where their values stand."""
        index = self.index
        mine = rows.ordinals
        assert mine is not None
        if self._attribute_rows is None:
            self._attribute_rows = np.full(len(index), -1, np.int32)
            self._attribute_rows[index.attributed] = np.arange(
                len(index.attributed), dtype=np.int32
            )
        at = self._attribute_rows[mine]
        if self._tags is not None:
            return self._numbered(self._tags, mine, at, name)
        count = np.where(at >= 0, index.quotes[at] if len(index.quotes) else 0, 0)
        first = index.first_quote[at] if len(index.quotes) else at
        start = np.full(len(mine), -1, index.stop.dtype)
        stop = start.copy()
        key = name.encode()
        places = index.quote_places
        todo = np.arange(len(mine))
        for pair in range(0, min(int(count.max(initial=0)), 2 * _FEW), 2):
            todo = todo[count[todo] > pair]
            opens = places[first[todo] + pair].astype(np.int64)
            same = self.index.words.end_with(opens - 1, key)
            here = todo[same]
            start[here] = opens[same] + 1
            stop[here] = places[first[here] + pair + 1]
            todo = todo[~same]
        todo = todo[count[todo] > 2 * _FEW]
        if len(todo):  # all others of the few elements that have very many
            more = (count[todo] - 2 * _FEW) // 2
            number = np.arange(int(more.sum())) - np.repeat(np.cumsum(more) - more, more)
            at = np.repeat(first[todo], more) + 2 * (number + _FEW)
            same = self.index.words.end_with(places[at].astype(np.int64) - 1, key)
            here = np.repeat(todo, more)[same]
            start[here] = places[at[same]] + 1
            stop[here] = places[at[same] + 1]
        found = start >= 0
        if bool(found.all()):
            return None, Ranges(index.words, start, stop)
        there = np.flatnonzero(found)
        return there, Ranges(index.words, start[there], stop[there])

    def _numbered(
        self, tags: Tags, mine: Array, at: Array, name: str
    ) -> tuple[Array | None, Ranges]:
        """The same for elements whose kind of start tag says which attribute it is."""
        index = self.index
        number = tags.numbers(name)[tags.kinds[mine]]
        there = None
        if int(number.min(initial=0)) < 0:
            there = np.flatnonzero(number >= 0)
            number, at = number[there], at[there]
            if len(there) == 0:
                return there, Ranges(index.words, there, there)
        quote: Array = index.first_quote[at]
        quote += 2 * number.astype(quote.dtype)
        places = index.quote_places
        return there, Ranges(index.words, places[quote] + 1, places[quote + 1])

"""Start tags that are the same but for the values of their attributes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.index import Index
from colladaphy.columns.names import Names, NotPlain
from colladaphy.columns.words import LOW

__all__ = ["Tags", "compressed", "examples", "tags_of"]

Array = NDArray[Any]
U = np.uint64

_BLANKS: Final = (9, 10, 13, 32)
_XMLNS: Final = int.from_bytes(b"xmlns", "little")
_INSTANCE: Final = b"XMLSchema-instance"
_MOST_ATTRIBUTES: Final = 64
"""Of an element; each takes a round."""
_MOST_KINDS: Final = 30_000
"""Of names and start tags: two such numbers are one of 32 bits."""
_MOST: Final = 1 << 22
"""Combinations up to which a table of all is quicker than sorting."""


@dataclass(frozen=True, slots=True)
class Tags:
    """Which start tag each element has."""

    kinds: Array
    """(n,) the kind of each element: tags of a kind differ in values of attributes only."""
    first: Array
    """(k,) an element of each kind."""
    attributes: list[tuple[bytes, ...]]
    """(k,) the names of attributes, as they are written with what is before and behind them; of
    declarations of namespaces the values too."""
    ids: Array
    """(m,) places of the quotes that open values of `id`."""
    declaring: Array
    """Elements that declare namespaces, one for each declaration, in the order of the document."""
    declared: Array
    """Which of `declarations` it is."""
    declarations: list[bytes]
    """The different ones, as they are written."""

    def numbers(self, name: str) -> Array:
        """Which of the attributes has a name, for each kind (k,); -1 where none has."""
        key = name.encode() + b"="
        return np.array(
            [next((n for n, text in enumerate(texts) if text.strip() == key), -1)
             for texts in self.attributes], np.int8
        )  # fmt: skip


def compressed(keys: Array, size: int) -> tuple[Array, Array]:
    """Numbers without gaps for keys (n,) below `size`, and a place (k,) where each is."""
    if size > _MOST:
        _, places, numbers = np.unique(keys, return_index=True, return_inverse=True)
        return numbers.astype(np.int32), places
    places, there = _places(keys, size)
    table = np.empty(size, np.int32)
    table[there] = np.arange(len(there), dtype=np.int32)
    return table.take(keys), places


def examples(keys: Array, size: int) -> Array:
    """A place of every different key (n,) below `size`."""
    return _places(keys, size)[0] if size <= _MOST else np.unique(keys, return_index=True)[1]


def _places(keys: Array, size: int) -> tuple[Array, Array]:
    places = np.full(size, -1, np.int32)
    places[keys] = np.arange(len(keys), dtype=np.int32)
    there = np.flatnonzero(places >= 0)
    return places[there], there


def tags_of(index: Index) -> Tags:
    """The start tags of a document. Raises NotPlain where there is anything unusual in one."""
    kinds = index.codes.astype(np.int32) * 2
    kinds += index.bytes[index.stop - 1] == ord("/")
    every, first = compressed(kinds, 2 * len(index.names.texts))
    if not len(index.attributed):
        none = first[:0]
        return Tags(every, first, [()] * len(first), none, none, none, [])
    count = index.quotes // 2
    if int(count.max()) > _MOST_ATTRIBUTES:
        raise NotPlain("very many attributes")
    names, codes = _attributes(index)
    if max(len(names.texts), len(first)) > _MOST_KINDS:
        raise NotPlain("very many different names")
    begin = np.cumsum(count) - count
    mine = every[index.attributed]
    todo = np.arange(len(count))
    width = len(names.texts) + 1
    spellings = [(int(kind),) for kind in range(len(first))]
    for place in range(int(count.max())):
        todo = todo[count[todo] > place]
        # A kind and one more attribute; those that have no more stay as they are.
        keys = mine[todo] * width + codes[begin[todo] + place]
        numbers, where = compressed(keys, len(spellings) * width)
        base = len(spellings)
        old, added = keys[where] // width, keys[where] % width
        spellings += [(*spellings[o], int(a)) for o, a in zip(old, added, strict=True)]
        if len(spellings) > _MOST_KINDS:
            raise NotPlain("very many different start tags")
        mine[todo] = numbers + base
    every[index.attributed] = mine
    every, first = compressed(every, len(spellings))
    if len(first) <= np.iinfo(np.int16).max:
        every = every.astype(np.int16)
    ids = _are(names, lambda text: text.strip() == b"id=")
    declare = _are(names, lambda text: text.lstrip().startswith(b"xmlns"))
    places = np.flatnonzero(declare[codes])
    return Tags(
        every,
        first,
        _texts(index, first, names, codes, begin),
        index.quote_places[::2][ids[codes]],
        index.attributed[np.searchsorted(begin, places, side="right") - 1],
        codes[places],
        names.texts,
    )


def _are(names: Names, test: Callable[[bytes], bool]) -> Array:
    return np.array([test(text) for text in names.texts], np.bool_)


def _texts(
    index: Index, first: Array, names: Names, codes: Array, begin: Array
) -> list[tuple[bytes, ...]]:
    """The attributes of one element of each kind."""
    rows = np.searchsorted(index.attributed, first)
    found: list[tuple[bytes, ...]] = []
    for element, row in zip(first.tolist(), rows.tolist(), strict=True):
        if row == len(index.attributed) or index.attributed[row] != element:
            found.append(())
            continue
        mine = codes[begin[row] : begin[row] + index.quotes[row] // 2]
        found.append(tuple(names.texts[code] for code in mine.tolist()))
    return found


def _attributes(index: Index) -> tuple[Names, Array]:
    """Codes of the spellings of all attributes, in the order of the document."""
    opens, closes = index.quote_places[::2], index.quote_places[1::2]
    start = np.empty(len(opens), np.int64)
    start[1:] = closes[:-1]
    start[1:] += 1
    start[index.first_quote // 2] = index.name_end
    length = opens - start
    if not np.isin(index.bytes[start], _BLANKS).all():
        raise NotPlain("attributes without a blank between them")
    last = closes[(index.first_quote + index.quotes) // 2 - 1] + 1
    stop = index.stop[index.attributed]
    rest = stop - last
    rest -= index.bytes[stop - 1] == ord("/")
    if bool(rest.any()):
        raise NotPlain("blanks behind the attributes of a tag")
    words = index.words.at(start)
    declares = (words >> U(8)) & LOW[5] == U(_XMLNS)
    length = length.astype(np.int64)
    declaring = np.flatnonzero(declares)
    length[declaring] = closes[declaring] + 1 - start[declaring]
    names = Names()
    codes = names.codes(index.words, start, length, words)
    for text in names.texts:
        if text.lstrip().startswith(b"xmlns") and (b"&" in text or _INSTANCE in text):
            raise NotPlain("a namespace that is not spelled out, or types in the document")
    return names, codes

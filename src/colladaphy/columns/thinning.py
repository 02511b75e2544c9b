"""Documents without what repeats: valid if, and only if, the whole is.

What is left out has the same place in the schema, neighbours and attributes as something that is
left, and texts that are valid by their form (see `colladaphy.columns.paths` and `sure`). Where
what may follow an element is known from the element alone, an automaton that takes the rest takes
the whole. The few content models that are otherwise keep all their elements.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.closings import Closings
from colladaphy.columns.declarations import Declarations
from colladaphy.columns.index import Index
from colladaphy.columns.names import NotPlain
from colladaphy.columns.paths import Paths, paths_of
from colladaphy.columns.plain import direct
from colladaphy.columns.sure import unsure
from colladaphy.columns.tags import Tags, tags_of
from colladaphy.columns.texts import Ranges

__all__ = ["Thinned", "thinned"]

Array = NDArray[Any]

_FEW: Final = 16
"""Elements of a path that are all kept."""
_ODD: Final = 1000
"""References and comments beyond which a document is not regular."""


@dataclass(frozen=True, slots=True)
class Thinned:
    """A document without what repeats."""

    rest: bytes
    index: Index
    """That of the whole document."""
    tags: Tags
    paths: Array
    """(n,) numbers of the paths of all elements."""
    begins: Array
    """(k,) where what is left out begins."""
    stops: Array

    def rows(self) -> Array:
        """(n,) the numbers, in the whole document, of the elements that are left."""
        opens = self.index.start - 1
        gap = np.searchsorted(self.begins, opens, side="right") - 1
        return np.flatnonzero((gap < 0) | (opens >= np.append(self.stops, 0)[gap]))

    def are_alone(self, rows: Array) -> Array:
        """Whether no element of the paths of some is left out (n,)."""
        left = np.bincount(self.paths[self.rows()], minlength=int(self.paths.max()) + 1)
        every = np.bincount(self.paths, minlength=len(left))
        return np.asarray((left == every)[self.paths[rows]])


def thinned(data: bytes) -> Thinned | None:
    """A document without what repeats; None where nothing is known of it."""
    if not _characters_are_legal(data):
        return None
    taken = direct(data)
    if taken is None:
        return None
    text, start = taken
    odd = np.flatnonzero(np.frombuffer(data, np.uint8) == ord("&")) if b"&" in data else _NONE
    if text is not data:
        blanked = np.frombuffer(text, np.uint8) == 0
        odd = np.concatenate([odd, np.flatnonzero(blanked[1:] & ~blanked[:-1]) + 1])
    if len(odd) > _ODD:
        return None
    try:
        index = Index(text, start, closings=Closings())
        tags = tags_of(index)
        paths = paths_of(index, tags)
    except NotPlain:
        return None
    if not _ids_are_unique(index, tags):
        return None
    kept = _kept(index, tags, paths)
    kept[np.maximum(np.searchsorted(index.start, odd) - 1, 0)] = True
    begins, stops = _gaps(index, kept)
    return Thinned(_cut(data, begins, stops), index, tags, paths.numbers, begins, stops)


_NONE: Final = np.zeros(0, np.int64)


def _characters_are_legal(data: bytes) -> bool:
    if not data.isascii():
        try:
            data.decode()
        except UnicodeDecodeError:
            return False
        if b"\xef\xbf\xbe" in data or b"\xef\xbf\xbf" in data:
            return False
    codes = np.frombuffer(data, np.uint8)
    for begin in range(0, len(codes), _BLOCK):
        block = codes[begin : begin + _BLOCK]
        low = block[np.flatnonzero(block < ord(" "))]
        if not bool(np.all((low == 10) | (low == 13) | (low == 9))):
            return False
    return True


_BLOCK: Final = 1 << 17


def _ids_are_unique(index: Index, tags: Tags) -> bool:
    stops = index.quote_places[np.searchsorted(index.quote_places, tags.ids) + 1]
    ids = Ranges(index.words, tags.ids + 1, stops).joined(10)
    if b"&" in ids or b"\t" in ids or b"\r" in ids or b" " in ids:
        return False
    return len(set(ids.split(b"\n"))) == len(tags.ids) + 1


def _kept(index: Index, tags: Tags, paths: Paths) -> Array:
    """(n,) which elements have to be judged."""
    kept = np.zeros(len(index), np.bool_)
    kept[paths.examples] = True
    numbers = paths.numbers.astype(np.int16)  # numpy sorts these by radix
    order = np.argsort(numbers, kind="stable").astype(np.int32)
    cuts = np.searchsorted(numbers[order], np.arange(len(paths.first) + 1)).tolist()
    schema = Declarations(index, tags, paths)
    rows_of = np.full(len(index), -1, np.int32)
    rows_of[index.attributed] = np.arange(len(index.attributed), dtype=np.int32)
    for path in range(len(paths.first)):
        rows = order[cuts[path] : cuts[path + 1]]
        if len(rows) <= _FEW or not schema.is_local(path):
            kept[rows] = True
            continue
        if not schema.is_local(int(paths.parents[path])):
            kept[rows] = True
            continue
        for number, column in enumerate(schema.attributes(path)):
            quote = index.first_quote[rows_of[rows]] + 2 * number
            places = index.quote_places
            ranges = Ranges(index.words, places[quote] + 1, places[quote + 1])
            kept[rows[unsure(ranges, column)]] = True
        leaves = rows[paths.leaves[rows]]
        if len(leaves) and not schema.is_closed(path):
            ranges = Ranges(index.words, index.stop[leaves] + 1, index.text_end[leaves])
            kept[leaves[unsure(ranges, schema.text(path))]] = True
    return kept


def _gaps(index: Index, kept: Array) -> tuple[Array, Array]:
    """Where elements that nothing kept is in, between two others of their name, begin and stop."""
    parent = index.parent
    order = np.argsort(index.level, kind="stable")
    cuts = np.searchsorted(index.level[order], np.arange(1, int(index.level.max()) + 2)).tolist()
    whole = kept.copy()
    for depth in range(len(cuts) - 2, 0, -1):
        rows = order[cuts[depth] : cuts[depth + 1]]
        whole[parent[rows[whole[rows]]]] = True
    # Those that may go, of each depth; of those within them nothing is asked.
    gone: list[tuple[Array, Array]] = []
    for depth in range(1, len(cuts) - 1):
        rows = order[cuts[depth] : cuts[depth + 1]]
        if len(rows) < 3:
            continue
        middle = rows[1:-1]
        around = parent[rows]
        may = ~whole[middle]
        may &= (around[1:-1] == around[:-2]) & (around[1:-1] == around[2:])
        codes = index.codes[rows]
        may &= (codes[1:-1] == codes[:-2]) & (codes[1:-1] == codes[2:])
        may &= whole[around[1:-1]]
        gone.append((index.start[middle[may]] - 1, index.start[rows[2:][may]] - 1))
    if not gone:
        return _NONE, _NONE
    begins = np.concatenate([begin for begin, _ in gone])
    stops = np.concatenate([stop for _, stop in gone])
    sorting = np.argsort(begins)
    begins, stops = begins[sorting], stops[sorting]
    # Neighbours that go make one gap.
    joined = np.flatnonzero(begins[1:] != stops[:-1])
    begins = np.concatenate([begins[:1], begins[joined + 1]])
    return begins, np.concatenate([stops[joined], stops[-1:]])


def _cut(data: bytes, begins: Array, stops: Array) -> bytes:
    """The document without what is in the gaps."""
    if not len(begins):
        return data
    pieces, place = [], 0
    for begin, stop in zip(begins.tolist(), stops.tolist(), strict=True):
        pieces.append(data[place:begin])
        place = stop
    return b"".join([*pieces, data[place:]])

"""What a text of many records is put together from: literals, columns of texts, other records.

A template is what all records of a kind have in common. Its parts that are not the same in all
records give one text for each of a range of them, so that a block of records is one flat list of
strings, joined at once; nothing is done for a record alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Kind", "Part", "Repeated", "Slot", "Spread", "Template", "in_turn"]

Array = NDArray[Any]

_HEAVY = 1 << 15
"""Pieces of text that are joined together; what they take stays in the processor's cache."""
_RECORD = "\x01"
"""No document can hold it."""


class Part:
    """What differs from record to record."""

    def texts(self, begin: int, end: int) -> list[str]:
        """One text for each of a range of records."""
        raise NotImplementedError

    def weights(self) -> Array | int:
        """About how many pieces of text each record (n,) takes; a number where that is the same."""
        return 1

    def stream(self, row: int) -> Iterator[str]:
        """The text of one record that is too heavy for one block."""
        yield from self.texts(row, row + 1)


class Slot(Part):
    """The texts of a column."""

    def __init__(self, texts: Callable[[int, int], list[str]], weights: Array | int = 1) -> None:
        self._texts = texts
        self._weights = weights

    def texts(self, begin: int, end: int) -> list[str]:
        """One text for each of a range of records."""
        return self._texts(begin, end)

    def weights(self) -> Array | int:
        """Numbers count like pieces."""
        return self._weights


class Template:
    """Records of one kind: literals, and parts that give a text for each."""

    def __init__(self, parts: list[str | Part], count: int) -> None:
        self.count = count
        self.parts: list[str | Part] = []
        for part in parts:
            if isinstance(part, str) and self.parts and isinstance(self.parts[-1], str):
                self.parts[-1] += part
            elif part != "":
                self.parts.append(part)
        self._pattern = [part if isinstance(part, str) else "" for part in self.parts]
        self._slots = [(place, part) for place, part in enumerate(self.parts)
                       if isinstance(part, Part)]  # fmt: skip
        self._weights: Array | int | None = None

    def _flat(self, begin: int, end: int, pattern: list[str]) -> list[str]:
        flat = pattern * (end - begin)
        width = len(pattern)
        for place, part in self._slots:
            flat[place::width] = part.texts(begin, end)
        return flat

    def pieces(self, begin: int, end: int) -> list[str]:
        """The pieces of text of a range of records, as many for each as there are parts."""
        return self._flat(begin, end, self._pattern)

    def joined(self, begin: int, end: int) -> str:
        """The text of a range of records, one after the other."""
        return "".join(self.pieces(begin, end))

    def texts(self, begin: int, end: int) -> list[str]:
        """One text for each of a range of records."""
        if not self._slots or end == begin:
            return ["".join(self._pattern)] * (end - begin)
        if len(self._pattern) == 1:
            return self._slots[0][1].texts(begin, end)
        flat = self._flat(begin, end, [*self._pattern, _RECORD])
        flat.pop()
        return "".join(flat).split(_RECORD)

    def weights(self) -> Array | int:
        """About how many pieces of text each record (n,) takes; a number where that is the same."""
        if self._weights is None:
            self._weights = len(self.parts)
            for _, part in self._slots:
                self._weights = self._weights + part.weights()
        return self._weights

    def stream(self, begin: int, end: int) -> Iterator[str]:
        """The text of a range of records, in blocks."""
        weights = self.weights()
        for first, last in pairwise(_blocks(weights, begin, end)):
            if last - first != 1 or _heaviest(weights, first) <= _HEAVY:
                yield self.joined(first, last)
                continue
            for part in self.parts:
                if isinstance(part, str):
                    yield part
                else:
                    yield from part.stream(first)


def _heaviest(weights: Array | int, row: int) -> int:
    return weights if isinstance(weights, int) else int(weights[row])


def _blocks(weights: Array | int, begin: int, end: int) -> list[int]:
    """Where blocks of not much more than _HEAVY begin and end."""
    if isinstance(weights, int):
        return [*range(begin, end, max(_HEAVY // weights, 1)), end]
    here = weights[begin:end]
    block = np.cumsum(here) // _HEAVY
    alone = here > _HEAVY
    starts = np.flatnonzero((block[1:] != block[:-1]) | alone[1:] | alone[:-1]) + 1 + begin
    return [begin, *starts.tolist(), end]


class Spread(Part):
    """Records that not every record around them has, one at most: of these kinds, one of them."""

    def __init__(self, count: int, kinds: list[tuple[Template, Array]]) -> None:
        self.count = count
        self.kinds = kinds

    def texts(self, begin: int, end: int) -> list[str]:
        """Nothing where there is none."""
        spread = np.full(end - begin, "", dtype=object)
        for template, owner in self.kinds:
            first, last = np.searchsorted(owner, (begin, end)).tolist()
            if last > first:
                spread[owner[first:last] - begin] = template.texts(first, last)
        texts: list[str] = spread.tolist()
        return texts

    def weights(self) -> Array | int:
        """Those of the record that is there."""
        total = np.ones(self.count, np.int64)
        for template, owner in self.kinds:
            total[owner] += template.weights()
        return total

    def stream(self, row: int) -> Iterator[str]:
        """The text of the record within one record."""
        for template, owner in self.kinds:
            first, last = np.searchsorted(owner, (row, row + 1)).tolist()
            yield from template.stream(first, last)


class Repeated(Part):
    """Any number of records in each record around them.

    Those of one kind stand one after the other; those of several are sorted by their numbers.
    """

    def __init__(self, count: int, kinds: list[Kind]) -> None:
        self.count = count
        self.kinds = [(template, owner) for template, owner, _ in kinds]
        self._kind: Array | None = None
        if len(kinds) == 1:
            self._owner = kinds[0][1]
            return
        owner = np.concatenate([owner for _, owner in self.kinds])
        kind = np.repeat(np.arange(len(kinds)), [len(owner) for _, owner in self.kinds])
        order = [np.zeros(len(o), np.int64) if numbers is None else numbers
                 for _, o, numbers in kinds]  # fmt: skip
        sorting = np.lexsort((np.concatenate(order), owner))
        self._owner, self._kind = owner[sorting], kind[sorting]
        self._place = np.concatenate([np.arange(len(o)) for _, o in self.kinds])[sorting]

    def texts(self, begin: int, end: int) -> list[str]:
        """Nothing where there are none."""
        first, last = np.searchsorted(self._owner, (begin, end)).tolist()
        if first == last:
            return [""] * (end - begin)
        owner = self._owner[first:last] - begin
        starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
        if len(starts) == len(owner):
            texts = self._sorted(first, last)
        else:
            # Cut out of one list: to split a long text looks at every letter of it.
            if self._kind is None:
                template = self.kinds[0][0]
                width, flat = len(template.parts), template.pieces(first, last)
            else:
                width, flat = 1, self._sorted(first, last)
            cuts = [*(starts * width).tolist(), len(flat)]
            texts = ["".join(flat[start:stop]) for start, stop in pairwise(cuts)]
        if len(starts) == end - begin:
            return texts
        spread = np.full(end - begin, "", dtype=object)
        spread[owner[starts]] = texts
        made: list[str] = spread.tolist()
        return made

    def _sorted(self, first: int, last: int) -> list[str]:
        """The texts of records, in their order."""
        if self._kind is None:
            return self.kinds[0][0].texts(first, last)
        kind, place = self._kind[first:last], self._place[first:last]
        mixed = np.empty(last - first, dtype=object)
        for number, (template, _) in enumerate(self.kinds):
            here = np.flatnonzero(kind == number)
            if not len(here):
                continue
            places = place[here]
            begin, end = int(places.min()), int(places.max()) + 1
            made = np.empty(end - begin, dtype=object)
            made[:] = template.texts(begin, end)
            mixed[here] = made[places - begin]
        texts: list[str] = mixed.tolist()
        return texts

    def weights(self) -> Array | int:
        """Those of all that are in it."""
        total = np.ones(self.count, np.int64)
        for template, owner in self.kinds:
            weights = template.weights()
            counts = np.bincount(
                owner, None if isinstance(weights, int) else weights, minlength=self.count
            )
            total += counts.astype(np.int64) * (weights if isinstance(weights, int) else 1)
        return total

    def stream(self, row: int) -> Iterator[str]:
        """The records of one record: runs of one kind in blocks, short ones together."""
        first, last = np.searchsorted(self._owner, (row, row + 1)).tolist()
        if first == last:
            return
        if self._kind is None:
            yield from self.kinds[0][0].stream(first, last)
            return
        kind, place = self._kind[first:last], self._place[first:last]
        breaks = np.flatnonzero((kind[1:] != kind[:-1]) | (place[1:] != place[:-1] + 1)) + 1
        if len(breaks) > 1000:
            for begin in range(first, last, 4096):
                yield from self._sorted(begin, min(begin + 4096, last))
            return
        for begin, end in pairwise([0, *breaks.tolist(), last - first]):
            run = int(place[begin])
            yield from self.kinds[int(kind[begin])][0].stream(run, run + end - begin)


Kind = tuple[Template, Array, "Array | None"]
"""Records of a kind, the row around each (never descending), and the numbers they are sorted by."""


def in_turn(kinds: list[Kind], count: int) -> list[Kind] | None:
    """The kinds in the order that they have in every record around them; None if it varies."""
    if all(order is None for _, _, order in kinds):
        return kinds
    ranges = [_extent(kind, count) for kind in kinds]
    sizes = np.arange(len(kinds))
    behind = np.zeros(len(kinds), np.int64)
    for i in sizes.tolist():
        for j in range(i):
            before = bool(np.all(ranges[j][1] <= ranges[i][0]))
            if not before and not bool(np.all(ranges[i][1] < ranges[j][0])):
                return None
            behind[i if before else j] += 1
    if len(set(behind.tolist())) < len(kinds):
        return None
    return [kinds[place] for place in np.argsort(behind).tolist()]


def _extent(kind: Kind, count: int) -> tuple[Array, Array]:
    """The first and the last number in each row around; rows without are before and behind all."""
    _, owner, order = kind
    numbers = np.zeros(len(owner)) if order is None else np.asarray(order, np.float64)
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    first, last = np.full(count, np.inf), np.full(count, -np.inf)
    first[owner[starts]] = np.minimum.reduceat(numbers, starts)
    last[owner[starts]] = np.maximum.reduceat(numbers, starts)
    return first, last

"""Bodies or joints in a row."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar, overload

from colladaphy.world import values
from colladaphy.world.storage import Storage
from colladaphy.world.table import Table

__all__ = ["Handles"]

Handle = TypeVar("Handle")

SHOWN = 5
"""How many the text of all of them names."""


class Handles(Sequence[Handle]):
    """The rows of a table, by their place in the order of system ids."""

    __slots__ = ("_make", "_noun", "_storage", "_table")

    def __init__(
        self, storage: Storage, table: Table, make: Callable[[Storage, int], Handle], noun: str
    ) -> None:
        self._storage = storage
        self._table = table
        self._make = make
        self._noun = noun

    def __len__(self) -> int:
        return len(self._table)

    @overload
    def __getitem__(self, index: int) -> Handle: ...
    @overload
    def __getitem__(self, index: slice) -> list[Handle]: ...
    def __getitem__(self, index: int | slice) -> Handle | list[Handle]:
        sids = self._table.column("sids")
        if isinstance(index, slice):
            return [self._make(self._storage, sid) for sid in sids[index].tolist()]
        place = values.integer("place", index)
        if not -len(sids) <= place < len(sids):
            raise IndexError(f"There are {len(sids)} {self._noun}.")
        return self._make(self._storage, int(sids[place]))

    def __iter__(self) -> Iterator[Handle]:
        for sid in self._table.column("sids").tolist():
            yield self._make(self._storage, sid)

    def __repr__(self) -> str:
        first = [repr(handle) for handle in self[:SHOWN]]
        more = ["…"] if len(self) > SHOWN else []
        return f"<{len(self)} {self._noun}: {', '.join(first + more) or 'none'}>"

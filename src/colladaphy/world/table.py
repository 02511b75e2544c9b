"""Columns of equal length that grow in place: the storage under bodies and joints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Field", "Table"]

Field = tuple[Any, tuple[int, ...]]
"""The dtype of a column and the shape of one row of it."""

_START = 8


class Table:
    """Rows of numbers by column, each row under a unique system id.

    Rows are appended at the end and removed by a mark; `settle` closes the gaps and sorts the
    rows by system id. Single rows cost amortised constant time, columns of a settled table cost
    nothing but a view. The column ``sids`` is always there.
    """

    __slots__ = ("_alive", "_arrays", "_dead", "_late", "_size", "_sorted")

    def __init__(self, fields: Mapping[str, Field]) -> None:
        self._arrays: dict[str, NDArray[Any]] = {
            name: np.zeros((_START, *shape), dtype=dtype) for name, (dtype, shape) in fields.items()
        }
        self._arrays["sids"] = np.zeros(_START, dtype=np.int64)
        self._alive = np.zeros(_START, dtype=np.bool_)
        self._size = 0
        self._dead = 0
        self._sorted = 0  # rows that are in ascending order of sid, from the start
        self._late: dict[int, int] = {}  # rows behind those, by sid

    def __len__(self) -> int:
        return self._size - self._dead

    @property
    def last_sid(self) -> int:
        """The largest system id of the rows in order, -1 for none."""
        return int(self._arrays["sids"][self._sorted - 1]) if self._sorted else -1

    def find(self, sid: int) -> int:
        """The row of a system id, -1 if there is none."""
        sids, count = self._arrays["sids"], self._sorted
        if count:
            row = sid - int(sids[0])  # where system ids run without gaps
            if not (0 <= row < count and sids[row] == sid):
                row = int(np.searchsorted(sids[:count], sid))
            if row < count and sids[row] == sid and self._alive[row]:
                return row
        return self._late.get(sid, -1)

    def find_all(self, sids: NDArray[np.int64]) -> NDArray[np.int64]:
        """The rows of many system ids, -1 where there is none; settles."""
        own = self.column("sids")
        if not len(own):
            return np.full(sids.shape, -1, dtype=np.int64)
        rows = np.minimum(np.searchsorted(own, sids), len(own) - 1)
        rows[own[rows] != sids] = -1
        return rows

    def append(self, sid: int, values: Mapping[str, Any]) -> int:
        """Add a row; columns that `values` leaves out are zero. Returns its place."""
        row = self._size
        self._reserve(row + 1)
        self._arrays["sids"][row] = sid
        for name, value in values.items():
            self._arrays[name][row] = value
        self._alive[row] = True
        self._size = row + 1
        if self._sorted == row and sid > self.last_sid:
            self._sorted = row + 1
        else:
            self._late[sid] = row
        return row

    def extend(self, sids: NDArray[np.int64], values: Mapping[str, Any]) -> None:
        """Add many rows at once; `sids` must be new to the table."""
        start, stop = self._size, self._size + len(sids)
        if start == stop:
            return
        self._reserve(stop)
        self._arrays["sids"][start:stop] = sids
        for name, value in values.items():
            self._arrays[name][start:stop] = value
        self._alive[start:stop] = True
        ascending = bool(np.all(sids[1:] > sids[:-1]))
        if ascending and self._sorted == start and sids[0] > self.last_sid:
            self._sorted = stop
        else:
            self._late.update(zip(sids.tolist(), range(start, stop), strict=True))
        self._size = stop

    def remove(self, row: int) -> None:
        """Take a row out; its place is given up when the table is next settled."""
        self._late.pop(int(self._arrays["sids"][row]), None)
        self._alive[row] = False
        self._dead += 1

    def settle(self) -> None:
        """Close gaps and sort by system id. Views taken before are no longer aligned."""
        if self._sorted == self._size and not self._dead:
            return
        rows = np.flatnonzero(self._alive[: self._size])
        if self._late:
            rows = rows[np.argsort(self._arrays["sids"][rows], kind="stable")]
        count = len(rows)
        for name, array in self._arrays.items():
            # A new array: views that were handed out keep what they show.
            fresh = np.zeros((max(count, _START), *array.shape[1:]), dtype=array.dtype)
            fresh[:count] = array[rows]
            self._arrays[name] = fresh
        self._alive = np.zeros(max(count, _START), dtype=np.bool_)
        self._alive[:count] = True
        self._size = self._sorted = count
        self._dead = 0
        self._late = {}

    def column(self, name: str) -> NDArray[Any]:
        """A writable view of a column, one row a system id in ascending order."""
        self.settle()
        return self._arrays[name][: self._size]

    def frozen(self, name: str) -> NDArray[Any]:
        """The same, read-only."""
        view = self.column(name)
        view.flags.writeable = False
        return view

    def views(self, names: Mapping[int, str]) -> dict[str, Any]:
        """All columns, the system ids read-only, and beside them names by system id."""
        columns = {name: self.column(name) for name in self._arrays}
        sids = columns["sids"] = self.frozen("sids")
        listed = [names.get(sid) for sid in sids.tolist()] if names else None
        return {**columns, "names": listed}

    def raw(self, name: str) -> NDArray[Any]:
        """The array under a column, addressed by the rows that `find` returns."""
        return self._arrays[name]

    def values(self, row: int) -> dict[str, Any]:
        """All of a row, by column, copied."""
        return {name: array[row].copy() for name, array in self._arrays.items() if name != "sids"}

    def copy(self) -> Table:
        """The same rows, which change independently from now on."""
        twin = Table.__new__(Table)
        twin._arrays = {name: array.copy() for name, array in self._arrays.items()}
        twin._alive, twin._late = self._alive.copy(), dict(self._late)
        twin._size, twin._dead, twin._sorted = self._size, self._dead, self._sorted
        return twin

    def _reserve(self, size: int) -> None:
        if size <= len(self._alive):
            return
        capacity = max(size, len(self._alive) * 3 // 2 + _START)
        for name, array in self._arrays.items():
            fresh = np.zeros((capacity, *array.shape[1:]), dtype=array.dtype)
            fresh[: self._size] = array[: self._size]
            self._arrays[name] = fresh
        alive = np.zeros(capacity, dtype=np.bool_)
        alive[: self._size] = self._alive[: self._size]
        self._alive = alive

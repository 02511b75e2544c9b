"""Progress of what takes longer than a second, through rich, while a person looks on.

It stands on standard error, if that is a terminal, and leaves no trace there.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from rich.progress import Progress

__all__ = ["Bar", "aside", "counting", "waiting"]

_Item = TypeVar("_Item")

_PATIENCE = 1.0
"""Seconds after which something is long."""
_PAUSE = 0.1
"""Seconds between two looks at a bar."""


_live: list[Progress] = []
"""What is on the terminal now: at most one."""


@contextmanager
def aside() -> Iterator[None]:
    """Take progress off the terminal while something is written to it."""
    live = list(_live)
    for progress in live:
        progress.stop()
    try:
        yield
    finally:
        for progress in live:
            progress.start()


def _is_watched() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _columns(total: int | None) -> Progress:
    # Most runs are short: rich is not even imported then.
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        SpinnerColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    # A name may hold brackets, which are no markup.
    label = TextColumn("{task.description}", markup=False)
    columns = (
        [SpinnerColumn(), label, TimeElapsedColumn()]
        if total is None
        else [label, BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"),
              TimeRemainingColumn()]
    )  # fmt: skip
    return Progress(*columns, console=Console(stderr=True), transient=True)


@contextmanager
def waiting(label: str, began: float | None = None) -> Iterator[None]:
    """Say what is done, and for how long already, once it takes longer than a second.

    It may have begun before, at a time of the monotonic clock.
    """
    if not _is_watched():
        yield
        return

    def show() -> None:
        progress = _columns(None)
        progress.add_task(label, total=None)
        progress.start()
        _live.append(progress)

    passed = 0.0 if began is None else time.monotonic() - began
    timer = threading.Timer(max(_PATIENCE - passed, 0.0), show)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        while _live:
            _live.pop().stop()


def counting(items: Iterable[_Item], total: int, label: str) -> Iterator[_Item]:
    """The items, with ``label 3/21`` while the next one is awaited."""
    began = time.monotonic()
    walk = iter(items)
    for number in count(1):
        with waiting(f"{label} {min(number, total)}/{total}", began):
            try:
                item = next(walk)
            except StopIteration:
                return
        yield item


class Bar:
    """How much is done of something that tells so itself: call it with the number."""

    def __init__(self, label: str, total: int, *, unit: str = "") -> None:
        self._label = label
        self._total = total
        self._unit = unit
        self._began = self._seen = time.monotonic()
        self._progress: Progress | None = None
        self._watched = _is_watched()

    def __call__(self, done: int) -> None:
        """So many are done."""
        now = time.monotonic()
        if not self._watched or now - self._seen < _PAUSE or now - self._began < _PATIENCE:
            return
        self._seen = now
        if self._progress is None:
            self._progress = _columns(self._total)
            self._progress.add_task(self._label, total=self._total, rate="")
            self._progress.start()
            _live.append(self._progress)
        rate = f"{done / (now - self._began):.0f} {self._unit} a second" if self._unit else ""
        task = self._progress.task_ids[0]
        self._progress.update(task, completed=done, rate=rate)

    def clear(self) -> None:
        """Leave no trace."""
        if self._progress is not None:
            self._progress.stop()
            _live.remove(self._progress)
            self._progress = None

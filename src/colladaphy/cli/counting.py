"""Progress of runs over many files, on standard error while a person looks on.

A plain line: it comes and goes with each file, between the lines of the report.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

__all__ = ["counting"]

_Item = TypeVar("_Item")
_PATIENCE = 1.0
"""Seconds after which a run is long."""


def counting(items: Iterable[_Item], total: int, label: str) -> Iterator[_Item]:
    """The items, with ``label 3/21`` on standard error while the next one is awaited.

    Nothing is written to what is not a terminal, nor in the first second.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield from items
        return
    began = time.monotonic()
    walk = iter(items)
    number = 0
    while True:
        number += 1
        with _line(f"{label} {min(number, total)}/{total}", began + _PATIENCE - time.monotonic()):
            try:
                item = next(walk)
            except StopIteration:
                return
        yield item


@contextmanager
def _line(text: str, delay: float) -> Iterator[None]:
    """A line that is there from `delay` seconds on, and gone afterwards."""
    shown = threading.Event()

    def show() -> None:
        shown.set()
        sys.stderr.write(f"\r{text}")
        sys.stderr.flush()

    timer = threading.Timer(max(delay, 0.0), show)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        if shown.is_set():
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()

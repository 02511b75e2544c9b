"""Properties with faults, for the fuzzer to find."""

from __future__ import annotations

import os
import time

from hypothesis import strategies as st
from tools.fuzz.registry import of


def numbers() -> st.SearchStrategy[int]:
    return st.integers(0, 1000)


@of(numbers)
def holds(value: int) -> None:
    """Nothing is asked."""


@of(numbers)
def holds_too(value: int) -> None:
    """Nothing is asked."""


@of(numbers)
def fails(value: int) -> None:
    """Numbers are below three."""
    assert value < 3


@of(numbers)
def ends(value: int) -> None:
    """The process goes on."""
    if value >= 3:
        os._exit(3)


@of(numbers)
def fills_memory(value: int) -> None:
    """Memory is enough."""
    if value >= 3:
        bytearray(2**31)


@of(numbers)
def hangs(value: int) -> None:
    """It ends."""
    time.sleep(600)

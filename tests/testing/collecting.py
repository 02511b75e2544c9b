"""What a strategy draws, and the smallest of it."""

from __future__ import annotations

from typing import TypeVar

from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st

T = TypeVar("T")

USUAL = settings(
    settings.get_profile("default"),
    derandomize=True,
    database=None,
    deadline=None,
    phases=[Phase.generate, Phase.shrink],
    # Measured in seconds of a machine that may be busy; test_strategies_are_fast counts its own.
    suppress_health_check=[HealthCheck.too_slow],
)
"""What hypothesis does by itself, with all other health checks, but always the same."""


def drawn(strategy: st.SearchStrategy[T], count: int) -> list[T]:
    """So many examples, always the same."""
    found: list[T] = []

    @settings(USUAL, max_examples=count)
    @given(strategy)
    def collect(example: T) -> None:
        found.append(example)

    collect()
    return found


def any_one(strategy: st.SearchStrategy[T], condition: object) -> T:
    """Some example that fulfils a condition, always the same."""
    options = settings(USUAL, max_examples=2000, phases=[Phase.generate])
    return find(strategy, condition, settings=options)  # type: ignore[arg-type]


def smallest(strategy: st.SearchStrategy[T], condition: object) -> T:
    """The simplest example that fulfils a condition."""
    options = settings(USUAL, max_examples=2000)
    return find(strategy, condition, settings=options)  # type: ignore[arg-type]

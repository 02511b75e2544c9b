"""Numbers, names, directions and turns, of everyday size or as far as they go."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from hypothesis import strategies as st

from colladaphy.world import rotations

__all__ = [
    "Scale",
    "directions",
    "identifiers",
    "maybe",
    "names",
    "numbers",
    "positives",
    "quaternions",
    "ranges",
    "several",
    "triples",
]

T = TypeVar("T")


class Scale(NamedTuple):
    """Of which size numbers are."""

    extreme: bool
    """Any finite floats, rather than those of everyday size."""
    physical: bool
    """Only inertias that bodies can have."""


# What XML 1.0 can hold: most of Unicode, but few control characters and no halves of pairs.
_characters = st.characters(
    exclude_categories=["Cs", "Cc"], exclude_characters="\ufffe\uffff"
) | st.sampled_from("\t\n\r &<>\"'")
names = st.text(_characters, max_size=8)
"""Any text that XML can hold, the empty one among them."""

identifiers = st.integers(-(2**63), 2**63 - 1)
"""User ids."""

_LARGEST = 1.7976931348623157e308
_everyday = st.floats(-1e3, 1e3)
_any = st.floats(allow_nan=False, allow_infinity=False) | st.sampled_from(
    [-0.0, 5e-324, -5e-324, 2.2250738585072014e-308, _LARGEST, 0.1, 1 / 3]
)
_everyday_positive = st.floats(1e-2, 1e2)
_any_positive = st.floats(5e-324, _LARGEST)


def numbers(extreme: bool) -> st.SearchStrategy[float]:
    """Finite floats: all of them, denormal and largest ones too, or those of everyday size."""
    return _any if extreme else _everyday


def positives(extreme: bool) -> st.SearchStrategy[float]:
    """Positive, finite floats."""
    return _any_positive if extreme else _everyday_positive


def triples(of: st.SearchStrategy[T]) -> st.SearchStrategy[tuple[T, T, T]]:
    """Three of something."""
    return st.tuples(of, of, of)


def _has_length(values: tuple[float, ...]) -> bool:
    return max(map(abs, values)) > 1e-3


_unit = st.floats(-1, 1)
directions = st.sampled_from([(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)]) | triples(
    _unit
).filter(_has_length)
"""Three numbers that are not (nearly) all zero; of any length up to that of a cube's diagonal."""

quaternions: st.SearchStrategy[tuple[float, ...]] = st.just(rotations.IDENTITY) | st.tuples(
    _unit, _unit, _unit, _unit
).filter(_has_length).map(lambda q: tuple(rotations.normalize(q).tolist()))
"""Orientations (w, x, y, z), normalized."""

ranges: st.SearchStrategy[tuple[float, float]] = (
    st.just((0.0, 0.0))
    | st.just((-math.inf, math.inf))
    | st.tuples(st.floats(allow_nan=False), st.floats(allow_nan=False)).map(
        lambda pair: (min(pair), max(pair))
    )
)
"""Limits of an axis: locked, free, or any two numbers, the lower one first."""


def maybe(draw: st.DrawFn, options: dict[str, Any], key: str, of: st.SearchStrategy[Any]) -> None:
    """Draws an option now and then; left out, it makes an example shorter."""
    if draw(st.integers(0, 2)) == 2:
        options[key] = draw(of)


@st.composite
def _part(draw: st.DrawFn, function: Callable[[st.DrawFn], T]) -> T:
    return function(draw)


def several(draw: st.DrawFn, fewest: int, most: int, function: Callable[[st.DrawFn], T]) -> list[T]:
    """What a function draws, at least `fewest` and at most `most` times.

    The count comes first and each part is a draw of its own: so hypothesis knows how to leave out
    any part when it makes an example smaller.
    """
    count = fewest if most <= fewest else draw(st.integers(fewest, most))
    return [draw(_part(function)) for _ in range(count)]

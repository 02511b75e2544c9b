"""Comparing what the pe profile keeps with what the common profile says (thesis 6.2.1).

Values that agree to six digits are the same, as other programs write no more of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import reach
from colladaphy.meaning import profile_rules
from colladaphy.meaning.hits import Hit

__all__ = ["DIGITS", "TURN", "are_numbers", "differing", "matched", "old", "same"]

Array = NDArray[Any]

DIGITS: Final = 6e-6
TURN: Final = 1e-4
_LARGE = 1e300
"""Of larger numbers the common profile says only that they are large."""
_TINY = 1e-300
"""Smaller ones have few bits."""


def same(one: Array, other: Array) -> Array:
    """Which values (n, m) agree to six digits (n,); what is no number is told elsewhere."""
    sizes = np.abs(one), np.abs(other)
    large = (np.minimum(*sizes) > _LARGE) & (np.sign(one) == np.sign(other))
    scale = reach(np.where(large, 0.0, np.maximum(*sizes)))
    close = (np.abs(one - other) <= DIGITS * scale[:, None]) & np.isfinite(one) & np.isfinite(other)
    close |= large | (one == other)
    told = np.isnan(one) | np.isnan(other)
    return np.asarray(close.all(axis=1) | told.any(axis=1) | (scale < _TINY))


def are_numbers(*values: Array) -> Array:
    """Which rows (n,) of values (n, m) are numbers; what is none is told elsewhere."""
    return np.asarray(np.logical_and.reduce([np.isfinite(each).all(axis=1) for each in values]))


def matched(keys: Array, wanted: Array) -> tuple[Array, Array]:
    """The places in `wanted` of what is among `keys`, which ascend, and its places there."""
    if not len(keys):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    mine = np.flatnonzero(keys[at] == wanted)
    return mine, at[mine]


def old(what: str, element: int, stated: Array, kept: Array, other: int) -> Hit:
    """What to say of a value that was left behind."""
    one, two = (" ".join(f"{value:g}" for value in values.tolist()) for values in (stated, kept))
    message = f"The {what} is {one} in the common profile, {two} in the pe profile."
    return Hit(profile_rules.OLD_VALUE, element, message, (other,))


def differing(
    what: str,
    elements: Array,
    stated: Array,
    kept: Array,
    others: Array,
    among: Array | None = None,
) -> Iterator[Hit]:
    """The rows whose values (n, m) were left behind: `elements` keep them, `others` state them."""
    wrong = are_numbers(stated, kept) & ~same(stated, kept)
    if among is not None:
        wrong &= among
    for row in np.flatnonzero(wrong).tolist():
        yield old(what, int(elements[row]), stated[row], kept[row], int(others[row]))

"""The different numbers of an array, and where numbers are among others."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["are_among", "distinct", "numbered", "rows_among"]


def distinct(values: NDArray[Any]) -> NDArray[Any]:
    """The different numbers in an array, ascending.

    `numpy.unique` imports what knows masked arrays first, which takes longer than a small document;
    that is why there is what is below, too.
    """
    made = np.sort(values, axis=None)
    first = np.ones(len(made), np.bool_)
    first[1:] = made[1:] != made[:-1]
    return made[first]


def numbered(values: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The first places (m,) of different numbers that ascend, and which of them each (n,) is."""
    order = np.argsort(values, kind="stable")
    made = values[order]
    new = np.ones(len(made), np.bool_)
    new[1:] = made[1:] != made[:-1]
    which = np.empty(len(made), np.int64)
    which[order] = np.cumsum(new) - 1
    return order[new], which


def are_among(elements: NDArray[Any], others: NDArray[Any] | Collection[int]) -> NDArray[np.bool_]:
    """Which elements (of any shape) are among others; for what is as close together as these are.

    Among many, `numpy.isin` would sort them by `numpy.unique` where a document is small.
    """
    wanted = others if isinstance(others, np.ndarray) else np.array(list(others), np.int64)
    return np.isin(elements, wanted, kind="table")


def rows_among(known: NDArray[Any], elements: NDArray[Any]) -> NDArray[np.int64]:
    """Where elements (n,) are among some that ascend; -1 for those that are not there."""
    if not len(known):
        return np.full(len(elements), -1, np.int64)
    at = np.minimum(np.searchsorted(known, elements), len(known) - 1)
    found: NDArray[np.int64] = np.where(known[at] == elements, at, -1)
    return found

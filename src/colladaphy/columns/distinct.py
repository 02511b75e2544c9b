"""The different numbers of an array."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["distinct"]


def distinct(values: NDArray[Any]) -> NDArray[Any]:
    """The different numbers in an array, ascending.

    `numpy.unique` imports what knows masked arrays first, which takes longer than a small document.
    """
    made = np.sort(values, axis=None)
    first = np.ones(len(made), np.bool_)
    first[1:] = made[1:] != made[:-1]
    return made[first]

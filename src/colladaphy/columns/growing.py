"""Arrays that are filled part by part, without a copy of what is there already."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

__all__ = ["Growing"]

Array = NDArray[Any]


class Growing:
    """An array of one dimension that grows at its end.

    Room is made for what the share of the work that is done lets expect, so that it grows once or
    twice; memory that is never written to is never taken.
    """

    def __init__(self, dtype: DTypeLike) -> None:
        self._array: Array = np.empty(0, dtype)
        self._size = 0

    def add(self, part: Array, done: float) -> None:
        """Add numbers; `done` is the share of all that there is with them (0, 1]."""
        size = self._size + len(part)
        # Codes of names outgrow 16 bits where there are very many names.
        kept = max(self._array.dtype, part.dtype) if part.dtype == np.int32 else self._array.dtype
        if size > len(self._array) or kept != self._array.dtype:
            grown = np.empty(max(int(size / done * 1.05) + 64, size), kept)
            grown[: self._size] = self._array[: self._size]
            self._array = grown
        self._array[self._size : size] = part
        self._size = size

    def array(self) -> Array:
        """All that was added."""
        return self._array[: self._size]

"""Sums that are rounded once, of any numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

__all__ = ["exact_sum"]


def exact_sum(numbers: Iterable[float]) -> float:
    """The sum, rounded once; infinite or NaN where a sum on the way is."""
    parts = list(numbers)
    try:
        return math.fsum(parts)
    except (OverflowError, ValueError):
        with np.errstate(all="ignore"):
            return float(np.sum(parts))

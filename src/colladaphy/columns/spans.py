"""Many stretches of one array at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["places_of"]


def places_of(
    starts: NDArray[Any], counts: NDArray[Any], steps: NDArray[Any] | int = 1
) -> NDArray[np.int64]:
    """The places of stretches, one behind the other: `counts` (n,) each, every `steps`-th one."""
    ends = np.cumsum(counts)
    places = np.arange(int(ends[-1]) if len(ends) else 0)
    places -= np.repeat(ends - counts, counts)
    if isinstance(steps, np.ndarray):
        places *= np.repeat(steps, counts)
    elif steps != 1:
        places *= steps
    places += np.repeat(starts, counts)
    return places

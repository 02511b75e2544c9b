"""What bodies are made of, between the documents and the World (thesis 5.3: ColladaBody).

A part is a primitive, a mesh or a union. The parts of a body stand together, members before the
union that holds them, so that the last one is the body itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.pool import taken
from colladaphy.links.poses import Poses

__all__ = ["Parts", "new_parts"]

Array = NDArray[Any]


@dataclass(slots=True)
class Parts:
    """Parts of bodies, one a row; NaN, -1 or None for what the World works out by itself."""

    body: Array
    """(n,) the body of each."""
    parents: Array
    """(n,) the part that holds it; -1 for the body itself."""
    kinds: Array
    dimensions: Array
    poses: Poses
    """In the enclosing union; of the body itself in the rigid_body, later in the world."""
    mesh_ids: Array
    material_ids: Array
    hollow: Array
    masses: Array
    inertias: Array
    """(n, 9) row by row, about the centre of mass in the part's frame."""
    uids: Array
    sids: Array
    """(n,) system ids that are wanted, later those that they get; -1 for any."""
    names: list[str | None]

    def __len__(self) -> int:
        return len(self.body)

    def take(self, rows: Array) -> Parts:
        """Some of them, in that order; parents are numbered anew."""
        some = taken(self, rows)
        places = np.full(len(self) + 1, -1, np.int64)
        places[rows] = np.arange(len(rows))
        some.parents = places[some.parents]
        return some


def new_parts(count: int) -> Parts:
    """Parts of which nothing is known yet."""
    return Parts(
        np.zeros(count, np.int64), np.full(count, -1, np.int64), np.zeros(count, np.int8),
        np.zeros((count, 4)), Poses.none(count), np.full(count, -1, np.int64),
        np.full(count, -1, np.int64), np.zeros(count, np.bool_), np.full(count, np.nan),
        np.full((count, 9), np.nan), np.zeros(count, np.int64), np.full(count, -1, np.int64),
        [None] * count,
    )  # fmt: skip

"""Elements that stand in the same place of the schema, and which neighbours they have there.

A path is the kinds of start tags from the root to an element. It says what the schema declares
the element as, and which namespaces it sees.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.index import Index
from colladaphy.columns.names import NotPlain
from colladaphy.columns.tags import Tags, compressed, examples

__all__ = ["Paths", "paths_of"]

Array = NDArray[Any]

_MOST: Final = 4000
"""Paths beyond which documents are not as regular as this is worth its while for."""


@dataclass(frozen=True, slots=True)
class Paths:
    """Which path leads to each element."""

    numbers: Array
    """(n,) of each element's."""
    first: Array
    """(k,) an element of each path."""
    parents: Array
    """(k,) the path of the parents; -1 for the root."""
    leaves: Array
    """(n,) which elements have no children."""
    examples: Array
    """Elements that have, together, every path, every pair of neighbours of each path, and its
    first and last place among its siblings, with and without children."""


def paths_of(index: Index, tags: Tags) -> Paths:
    """The paths of a document."""
    count = len(index)
    leaves = np.ones(count, np.bool_)
    leaves[index.parent[1:]] = False
    numbers = np.zeros(count, np.int32)
    order = np.argsort(index.level, kind="stable").astype(np.int32)
    depths = int(index.level.max())
    cuts = np.searchsorted(index.level[order], np.arange(1, depths + 2)).tolist()
    if cuts[1] != 1:
        raise NotPlain("more than one root")
    width = len(tags.first)
    first: list[Array] = [order[:1]]
    parents = [np.array([-1], np.int32)]
    found = []
    base, above = 1, 0
    for depth in range(1, depths):
        rows = order[cuts[depth] : cuts[depth + 1]]
        around = index.parent[rows]
        keys = (numbers[around] - above) * width + tags.kinds[rows]
        mine, where = compressed(keys, (base - above) * width)
        parents.append((keys[where] // width + above).astype(np.int32))
        first.append(rows[where])
        kinds = len(where)
        if base + kinds > _MOST:
            raise NotPlain("too many different elements")
        numbers[rows] = mine + base
        found.append(_examples(rows, around, mine, kinds, leaves))
        above, base = base, base + kinds
    return Paths(
        numbers,
        np.concatenate(first),
        np.concatenate(parents),
        leaves,
        np.concatenate([order[:1], *found]),
    )


def _examples(rows: Array, around: Array, mine: Array, kinds: int, leaves: Array) -> Array:
    """Elements of one depth that have all neighbours and places that there are."""
    same = around[1:] == around[:-1]
    pairs = mine * np.int32(kinds + 1)
    pairs[1:] += (mine[:-1] + 1) * same
    found = examples(pairs, kinds * (kinds + 1))
    place = mine * 4
    place[:-1] += ~same
    place[-1] += 1
    place += leaves[rows] * np.int32(2)
    return np.concatenate([rows[found], rows[np.maximum(found - 1, 0)],
                           rows[examples(place, kinds * 4)]])  # fmt: skip

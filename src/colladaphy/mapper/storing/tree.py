"""The members of unions: where they stand in the tree, and in their outermost union."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses
from colladaphy.mapper.numbers import differs
from colladaphy.world import rotations
from colladaphy.world.columns import MEMBER_FIELDS
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Tree"]

Array = NDArray[Any]


class Tree:
    """The members of the unions of a World, m rows in the order of system ids.

    Levels are counted from 0, the members of unions that are no members themselves.
    """

    def __init__(self, world: World, top_sids: Array) -> None:
        """`top_sids` (n,) are those of the bodies that are no members, in any order."""
        members = world.member_columns
        self.values: dict[str, Array] = {
            name: getattr(members, name) for name in ("sids", *MEMBER_FIELDS)
        }
        self.names: list[str | None] | None = None
        if members.names is not None:
            self.names = list(members.names)
        self.sids: Array = self.values["sids"]
        self.is_union: Array = self.values["kinds"] == int(Kind.UNION)
        parents = self.values["parents"]
        sorting = np.argsort(top_sids, kind="stable")
        self.parent = _found(self.sids, parents)
        """(m,) the row of the union that each is a member of, -1 for one that is no member."""
        self.top = _found(top_sids, parents, sorting)
        """(m,) the row of the outermost union among the bodies."""
        self.levels = self._levels()
        """The rows of each level, in the order in which a reader meets them."""
        for rows in self.levels[1:]:
            self.top[rows] = self.top[self.parent[rows]]
        self.place, rank = self._places(world.children)
        """(m,) places among siblings."""
        self.order = np.lexsort((rank, self.top))
        """The rows (m,) in the order in which a reader meets them."""
        ranked = np.empty(len(self), np.int64)
        ranked[self.order] = np.arange(len(self))
        self.levels = [rows[np.argsort(ranked[rows])] for rows in self.levels]
        self.poses = self._poses()
        """Where the members stand in their outermost unions."""

    def __len__(self) -> int:
        return len(self.sids)

    def _levels(self) -> list[Array]:
        depth = np.zeros(len(self), np.int64)
        above = self.parent
        while (inner := above >= 0).any():
            depth += inner
            above = np.where(inner, self.parent[above], -1)
        sorting = np.argsort(depth, kind="stable")
        return np.split(sorting, np.cumsum(np.bincount(depth))[:-1]) if len(self) else []

    def _places(self, children: dict[int, tuple[int, ...]]) -> tuple[Array, Array]:
        """Places among siblings (m,), and in the outermost union, as a reader meets the members."""
        listed = np.fromiter(chain.from_iterable(children.values()), np.int64, len(self))
        counts = np.fromiter(map(len, children.values()), np.int64, len(children))
        starts = np.repeat(np.cumsum(counts) - counts, counts)
        rows = np.searchsorted(self.sids, listed)
        place = np.empty(len(self), np.int64)
        place[rows] = np.arange(len(self)) - starts
        sizes = np.ones(len(self), np.int64)
        for level in self.levels[:0:-1]:
            np.add.at(sizes, self.parent[level], sizes[level])
        before = np.cumsum(sizes[rows]) - sizes[rows]
        rank = np.empty(len(self), np.int64)
        rank[rows] = before - before[starts] if len(self) else before
        for level in self.levels[1:]:
            rank[level] += rank[self.parent[level]] + 1
        return place, rank

    def _poses(self) -> Poses:
        positions, turns = self.values["positions"], self.values["orientations"]
        poses = Poses.of(
            len(self), positions, rotations.normalize(turns),
            moved=differs(positions, np.zeros(3)), turned=differs(turns, rotations.IDENTITY),
        )  # fmt: skip
        with np.errstate(all="ignore"):
            for rows in self.levels[1:]:
                poses.put(rows, poses.take(self.parent[rows]).then(poses.take(rows)))
        return poses


def _found(sids: Array, wanted: Array, sorting: Array | None = None) -> Array:
    """The rows of system ids, -1 where there is none."""
    if not len(sids):
        return np.full(len(wanted), -1)
    rows = np.minimum(np.searchsorted(sids, wanted, sorter=sorting), len(sids) - 1)
    if sorting is not None:
        rows = sorting[rows]
    return np.where(sids[rows] == wanted, rows, -1)

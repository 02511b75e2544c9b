"""Holes of polygons that become part of the outline, by bridges there and back.

A bridge goes from a hole to the nearest corner that is seen from it: between them is no edge, no
other corner, and nothing of any other hole. The rightmost hole comes first, from its rightmost
corner: what is to the right of that can only be hidden by what is joined already, so that there is
always a corner to be seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Point", "turn_of", "with_bridges"]

Array = NDArray[Any]
Point = tuple[float, float]

_FIRST = 8
"""How many corners are looked at before all are sorted by their distance."""


def turn_of(one: Point, two: Point, three: Point) -> float:
    """Positive for a turn to the left."""
    return (two[0] - one[0]) * (three[1] - two[1]) - (two[1] - one[1]) * (three[0] - two[0])


def with_bridges(ring: list[int], holes: list[list[int]], points: Sequence[Point]) -> list[int]:
    """A counter-clockwise ring with clockwise holes in it, as one ring of numbers of points."""
    starts = [max(range(len(hole)), key=lambda at: points[hole[at]]) for hole in holes]
    order = sorted(range(len(holes)), key=lambda at: points[holes[at][starts[at]]], reverse=True)
    places = np.array(points, np.float64)
    # Edges of all that is there, from each corner of a hole or of the ring to the next one.
    begin = np.concatenate([np.array(part, np.int64) for part in (ring, *holes)])
    end = np.concatenate([np.roll(np.array(part, np.int64), -1) for part in (ring, *holes)])
    edges = _Edges(places[begin], places[end], len(holes))
    joined = np.array(ring, np.int64)
    for number in order:
        hole, first = holes[number], starts[number]
        turned = hole[first:] + hole[:first]
        source = points[turned[0]]
        corners = places[joined]
        if not _is_inside([points[corner] for corner in turned], corners):
            continue  # a hole outside of the outline takes nothing away
        at = _seen(places[turned], joined, corners, edges)
        if at >= 0:
            bridge = np.array([*turned, turned[0], joined[at]], np.int64)
            edges.add(source, points[int(joined[at])])
            joined = np.concatenate([joined[: at + 1], bridge, joined[at + 1 :]])
    return [int(at) for at in joined]


class _Edges:
    """Edges that a bridge must not meet, those of other bridges too."""

    def __init__(self, begin: Array, end: Array, more: int) -> None:
        self._count = len(begin)
        self._all = np.zeros((4, self._count + more))
        self._all[:2, : self._count], self._all[2:, : self._count] = begin.T, end.T

    def add(self, one: Point, two: Point) -> None:
        """One more edge: a bridge."""
        self._all[:, self._count] = *one, *two
        self._count += 1

    def are_free(self, one: Point, two: Point) -> bool:
        """Whether nothing is between two corners: no edge, and no third corner."""
        (ax, ay), (bx, by) = one, two
        x, y, end_x, end_y = self._all[:, : self._count]
        reach = (
            (np.minimum(x, end_x) <= max(ax, bx))
            & (np.maximum(x, end_x) >= min(ax, bx))
            & (np.minimum(y, end_y) <= max(ay, by))
            & (np.maximum(y, end_y) >= min(ay, by))
        )
        x, y, end_x, end_y = self._all[:, : self._count][:, reach]
        across, along = bx - ax, by - ay
        begins = across * (y - ay) - along * (x - ax)
        ends = across * (end_y - ay) - along * (end_x - ax)
        ways, rises = end_x - x, end_y - y
        first = ways * (ay - y) - rises * (ax - x)
        second = ways * (by - y) - rises * (bx - x)
        crossed = (np.sign(begins) * np.sign(ends) < 0) & (np.sign(first) * np.sign(second) < 0)
        if bool(crossed.any()):
            return False
        share = (x - ax) * across + (y - ay) * along
        whole = across * across + along * along
        return not bool(np.any((begins == 0) & (share > 0) & (share < whole)))


def _is_inside(hole: Sequence[Point], ring: Array) -> bool:
    """Whether a hole is in a ring, told by a corner or a middle of an edge that is not on it."""
    after = np.roll(ring, -1, axis=0)
    (x1, y1), (x2, y2) = ring.T, after.T
    middles = [(0.5 * one[0] + 0.5 * two[0], 0.5 * one[1] + 0.5 * two[1])
               for one, two in zip(hole, [*hole[1:], hole[0]], strict=True)]  # fmt: skip
    for x, y in (*hole, *middles):
        turns = (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
        spans = (np.minimum(x1, x2) <= x) & (x <= np.maximum(x1, x2))
        spans &= (np.minimum(y1, y2) <= y) & (y <= np.maximum(y1, y2))
        if bool(np.any((turns == 0) & spans)):
            continue
        # Of what goes up, the point is on the left where the turn to it is one to the left.
        crossing = (y1 <= y) != (y2 <= y)
        right = crossing & ((turns > 0) == (y2 > y1))
        return bool(np.count_nonzero(right) % 2)
    return True


def _seen(hole: Array, ring: Array, corners: Array, edges: _Edges) -> int:
    """The place in a ring of the nearest corner that a hole's first one sees; -1 for none."""
    (x, y), following = hole[0].tolist(), (float(hole[1, 0]), float(hole[1, 1]))
    source = x, y
    far = np.hypot(corners[:, 0] - x, corners[:, 1] - y)
    free: dict[int, bool] = {}
    for at in _nearest(far):
        tip = (float(corners[at, 0]), float(corners[at, 1]))
        target = following if tip == source else source
        if not _faces(corners, at, target) or not (tip == source or _faces(hole, 0, tip)):
            continue
        number = int(ring[at])
        if number not in free:
            free[number] = tip == source or edges.are_free(source, tip)
        if free[number]:
            return at
    return -1


def _nearest(far: Array) -> Iterator[int]:
    """Rows by their distance, of equal ones the first; only the first few are sorted at once."""
    few = np.argpartition(far, _FIRST)[:_FIRST] if len(far) > 4 * _FIRST else np.arange(0)
    if len(few):
        near = np.flatnonzero(far <= far[few].max())
        yield from near[np.argsort(far[near], kind="stable")].tolist()
        rest = np.flatnonzero(far > far[few].max())
    else:
        rest = np.arange(len(far))
    yield from rest[np.argsort(far[rest], kind="stable")].tolist()


def _faces(corners: Array, at: int, target: Point) -> bool:
    """Whether a point lies inside of the corner of a ring, as it leaves the corner."""
    count = len(corners)
    before, here, after = (
        (float(corners[place % count, 0]), float(corners[place % count, 1]))
        for place in (at - 1, at, at + 1)
    )
    one, two = turn_of(before, here, target), turn_of(here, after, target)
    if turn_of(before, here, after) > 0.0:
        return one > 0.0 and two > 0.0
    return one > 0.0 or two > 0.0

"""Polygons with holes as triangles, by cutting off ears.

A corner is an ear where the polygon turns left and no other corner lies in its triangle; only
corners that turn right can. They stand in a grid, so that few of them are looked at for each ear.
Holes are joined to the outline first, by a bridge there and back.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from colladaphy.links.sums import exact_sum

__all__ = ["triangles_of"]

Point = tuple[float, float]


def triangles_of(outline: Sequence[Point], holes: Sequence[Sequence[Point]]) -> list[list[int]]:
    """Triangles as numbers of points: those of the outline, then those of each hole.

    They are counter-clockwise where the outline is, and clockwise where it is not.
    """
    points = [*outline, *(point for hole in holes for point in hole)]
    ring = list(range(len(outline)))
    flipped = _area([points[at] for at in ring]) < 0.0
    if flipped:
        ring.reverse()
    start = len(outline)
    inner = []
    for hole in holes:
        corners = list(range(start, start + len(hole)))
        start += len(hole)
        if _area(hole) > 0.0:
            corners.reverse()
        if len(corners) > 2:
            inner.append(corners)
    # The rightmost hole first, so that its bridge cannot cross another one.
    inner.sort(key=lambda corners: -max(points[at][0] for at in corners))
    for corners in inner:
        ring = _joined(ring, corners, points)
    triangles = _Cutting(ring, points).triangles()
    return [triangle[::-1] for triangle in triangles] if flipped else triangles


def _area(ring: Sequence[Point]) -> float:
    """Twice the signed area."""
    return exact_sum(
        one[0] * two[1] - one[1] * two[0]
        for one, two in zip(ring, [*ring[1:], *ring[:1]], strict=True)
    )


def _turn(one: Point, two: Point, three: Point) -> float:
    """Positive for a turn to the left."""
    return (two[0] - one[0]) * (three[1] - two[1]) - (two[1] - one[1]) * (three[0] - two[0])


def _joined(ring: list[int], hole: list[int], points: list[Point]) -> list[int]:
    """The ring with a hole that is reached by a bridge from the nearest corner that sees it.

    To the right of the hole's rightmost corner, the first edge is met; its farther end is seen,
    unless a corner that turns right stands in between: then the one in the flattest direction.
    """
    first = max(range(len(hole)), key=lambda at: points[hole[at]])
    x, y = points[hole[first]]
    best, best_x = -1, math.inf
    for at, corner in enumerate(ring):
        one, two = points[corner], points[ring[(at + 1) % len(ring)]]
        if not (one[1] <= y <= two[1] and one[1] < two[1]):
            continue  # what bounds the inside on its right goes upward
        meets = one[0] + (y - one[1]) * (two[0] - one[0]) / (two[1] - one[1])
        if x <= meets < best_x:
            best_x = meets
            best = at if one[0] > two[0] else (at + 1) % len(ring)
    if best < 0:
        return ring  # a hole outside of the outline takes nothing away
    tip = points[ring[best]]
    flattest = abs(tip[1] - y) / max(tip[0] - x, 1e-300)
    for at, corner in enumerate(ring):
        px, py = points[corner]
        if px <= x or (px, py) == tip or not _is_within((px, py), (x, y), (best_x, y), tip):
            continue
        slope = abs(py - y) / (px - x)
        if slope < flattest and _sees(ring, at, points, (x, y)):
            best, flattest = at, slope
    turned = hole[first:] + hole[:first]
    return [*ring[: best + 1], *turned, turned[0], *ring[best:]]


def _sees(ring: list[int], at: int, points: list[Point], target: Point) -> bool:
    """Whether a point lies inside of the corner of a ring, as it leaves the corner."""
    before, here, after = (points[ring[(at + step) % len(ring)]] for step in (-1, 0, 1))
    if _turn(before, here, after) > 0.0:
        return _turn(before, here, target) > 0.0 and _turn(here, after, target) > 0.0
    return _turn(before, here, target) > 0.0 or _turn(here, after, target) > 0.0


def _is_within(point: Point, one: Point, two: Point, three: Point) -> bool:
    """Whether a point is in a triangle of either winding, its edges included."""
    sides = (_turn(one, two, point), _turn(two, three, point), _turn(three, one, point))
    return min(sides) >= 0.0 or max(sides) <= 0.0


class _Cutting:
    """Cuts the ears off a counter-clockwise ring, which may pass a point twice."""

    def __init__(self, ring: list[int], points: list[Point]) -> None:
        self._points = [points[at] for at in ring]
        self._ring = ring
        count = len(ring)
        self._before = [(at - 1) % count for at in range(count)]
        self._after = [(at + 1) % count for at in range(count)]
        self._blocking: dict[int, tuple[int, int]] = {}
        """The corners that do not turn left, and where they are in the grid."""
        self._cells: dict[tuple[int, int], set[int]] = {}
        xs, ys = [point[0] for point in self._points], [point[1] for point in self._points]
        self._low = min(xs), min(ys)
        lines = max(1, math.isqrt(count))
        size = max(max(xs) - self._low[0], max(ys) - self._low[1]) / lines
        self._size = size if size > 0.0 and math.isfinite(size) else 1.0
        for at in range(count):
            self._note(at)

    def _cell(self, point: Point) -> tuple[int, int]:
        return (int((point[0] - self._low[0]) / self._size),
                int((point[1] - self._low[1]) / self._size))  # fmt: skip

    def _corner(self, at: int) -> tuple[Point, Point, Point]:
        points = self._points
        return points[self._before[at]], points[at], points[self._after[at]]

    def _note(self, at: int) -> None:
        """Put a corner into the grid, or take it out once it turns left."""
        turns_left = _turn(*self._corner(at)) > 0.0
        if turns_left:
            self._forget(at)
        elif at not in self._blocking:
            cell = self._blocking[at] = self._cell(self._points[at])
            self._cells.setdefault(cell, set()).add(at)

    def _forget(self, at: int) -> None:
        cell = self._blocking.pop(at, None)
        if cell is not None:
            self._cells[cell].discard(at)

    def triangles(self) -> list[list[int]]:
        """All of them, in the order in which they are cut off."""
        made: list[list[int]] = []
        left = len(self._ring)
        at, tried = 0, 0
        while left > 3:
            if self._is_ear(at) or tried > left:
                # A ring that crosses itself may have no ear: then any corner has to do.
                before, after = self._before[at], self._after[at]
                made.append([self._ring[before], self._ring[at], self._ring[after]])
                self._after[before], self._before[after] = after, before
                self._forget(at)
                self._note(before)
                self._note(after)
                left -= 1
                tried = 0
                # Not at its neighbour again, so that no long, thin fan comes about.
                at = self._after[after]
            else:
                at = self._after[at]
                tried += 1
        if left == 3:
            made.append([self._ring[self._before[at]], self._ring[at], self._ring[self._after[at]]])
        return made

    def _is_ear(self, at: int) -> bool:
        if at in self._blocking:
            return False
        one, two, three = self._corner(at)
        low = self._cell((min(one[0], two[0], three[0]), min(one[1], two[1], three[1])))
        high = self._cell((max(one[0], two[0], three[0]), max(one[1], two[1], three[1])))
        if (high[0] - low[0] + 1) * (high[1] - low[1] + 1) >= len(self._blocking):
            return not any(self._blocks(other, one, two, three) for other in self._blocking)
        return not any(
            self._blocks(other, one, two, three)
            for x in range(low[0], high[0] + 1)
            for y in range(low[1], high[1] + 1)
            for other in self._cells.get((x, y), ())
        )

    def _blocks(self, other: int, one: Point, two: Point, three: Point) -> bool:
        point = self._points[other]
        if point in (one, two, three):
            return False
        return (
            _turn(one, two, point) >= 0.0
            and _turn(two, three, point) >= 0.0
            and _turn(three, one, point) >= 0.0
        )

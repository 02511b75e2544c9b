"""Polygons with holes as triangles, by cutting off ears.

A corner is an ear where the polygon turns left and no other corner lies in its triangle; only
corners that turn right can. They are sorted by both axes, so that few of them are looked at for
each ear. Holes are joined to the outline first, by a bridge there and back.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from colladaphy.links.sums import exact_sum

__all__ = ["triangles_of"]

Point = tuple[float, float]

_FEW = 24
"""Corners that are looked at one by one in less time than it takes to sort them."""


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
    if not _sees(ring, best, points, (x, y)):
        # Bridges pass their ends several times; only between two of them the hole is seen.
        seeing = (at for at, corner in enumerate(ring)
                  if points[corner] == tip and _sees(ring, at, points, (x, y)))  # fmt: skip
        best = next(seeing, best)
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
        self._blocking = {at for at in range(count) if not self._turns_left(at)}
        """The corners that do not turn left: no others can lie in the triangle of an ear."""
        self._hopeful = bytearray(at not in self._blocking for at in range(count))
        """Corners that may be ears; of the others it is known what keeps them from being one."""
        self._waiting: dict[int, list[int]] = {}
        """The corners that each keeps from being ears."""
        self._sorted: _Blocking | None = None
        self._unsorted: set[int] = set()
        self._sort()

    def _sort(self) -> None:
        """Sort what blocks, once there is more of it than is quickly looked through."""
        many = len(self._blocking) > _FEW
        self._sorted = _Blocking(sorted(self._blocking), self._points) if many else None
        self._unsorted = set() if many else self._blocking.copy()

    def _corner(self, at: int) -> tuple[Point, Point, Point]:
        points = self._points
        return points[self._before[at]], points[at], points[self._after[at]]

    def _turns_left(self, at: int) -> bool:
        return _turn(*self._corner(at)) > 0.0

    def _forget(self, at: int) -> None:
        """A corner blocks no more: those that it kept from being ears may be some now."""
        if at not in self._blocking:
            return
        self._blocking.discard(at)
        for other in self._waiting.pop(at, ()):
            self._hopeful[other] = self._after[other] >= 0 and other not in self._blocking
        if at in self._unsorted:
            self._unsorted.discard(at)
        elif self._sorted is not None:
            self._sorted.drop(at)
            if 2 * len(self._blocking) < self._sorted.count:
                self._sort()

    def _note(self, at: int) -> None:
        """Look at a corner anew after one beside it was cut off."""
        turns_left = self._turns_left(at)
        self._hopeful[at] = turns_left
        if turns_left:
            self._forget(at)
        elif at not in self._blocking:
            # Straight on, or a turn by rounding, or the ring crosses itself.
            self._blocking.add(at)
            self._unsorted.add(at)
            if len(self._unsorted) > _FEW:
                self._sort()

    def triangles(self) -> list[list[int]]:
        """All of them, in the order in which they are cut off."""
        made: list[list[int]] = []
        at = 0
        for _ in range(len(self._ring) - 3):
            at = self._next_ear(at)
            before, after = self._before[at], self._after[at]
            made.append([self._ring[before], self._ring[at], self._ring[after]])
            self._after[before], self._before[after] = after, before
            self._hopeful[at], self._after[at] = False, -1
            self._forget(at)
            self._note(before)
            self._note(after)
            # Not at its neighbour again, so that no long, thin fan comes about.
            at = self._after[after]
        if len(self._ring) >= 3:
            made.append([self._ring[self._before[at]], self._ring[at], self._ring[self._after[at]]])
        return made

    def _next_ear(self, start: int) -> int:
        """The first ear from a corner on; that corner itself where there is none.

        A ring that crosses itself may have no ear: then any corner has to do.
        """
        at = start
        while (at := self._hopeful.find(1, at)) >= 0 or (at := self._hopeful.find(1)) >= 0:
            blocker = self._blocker(at)
            if blocker < 0:
                return at
            self._hopeful[at] = False
            self._waiting.setdefault(blocker, []).append(at)
        return start

    def _blocker(self, at: int) -> int:
        """A corner that lies in the triangle of another one; -1 for none."""
        corner = self._corner(at)
        for other in self._unsorted:
            if self._blocks(other, *corner):
                return other
        return -1 if self._sorted is None else self._sorted.blocker(corner)

    def _blocks(self, other: int, one: Point, two: Point, three: Point) -> bool:
        point = self._points[other]
        if point in (one, two, three):
            return False
        return (
            _turn(one, two, point) >= 0.0
            and _turn(two, three, point) >= 0.0
            and _turn(three, one, point) >= 0.0
        )


class _Blocking:
    """Many corners that may block ears, by x and by y: of a triangle, few are looked at."""

    def __init__(self, corners: list[int], points: list[Point]) -> None:
        self.count = len(corners)
        """How many there were when they were sorted."""
        places = np.array([points[at] for at in corners])
        orders = [np.argsort(places[:, axis], kind="stable") for axis in (0, 1)]
        self._corners = [np.array(corners)[order] for order in orders]
        self._xs, self._ys = ([places[order, axis] for order in orders] for axis in (0, 1))
        self._keys = (self._xs[0], self._ys[1])
        self._there = [np.ones(self.count, np.bool_) for _ in (0, 1)]
        self._at = [
            dict(zip(known.tolist(), range(self.count), strict=True)) for known in self._corners
        ]

    def drop(self, corner: int) -> None:
        """A corner that blocks no more."""
        for there, at in zip(self._there, self._at, strict=True):
            there[at[corner]] = False

    def blocker(self, corner: tuple[Point, Point, Point]) -> int:
        """One that lies in a triangle, its edges included, but not at a corner; -1 for none."""
        spans = []
        for axis in (0, 1):
            ends = corner[0][axis], corner[1][axis], corner[2][axis]
            begin = int(self._keys[axis].searchsorted(min(ends), "left"))
            end = int(self._keys[axis].searchsorted(max(ends), "right"))
            spans.append((end - begin, axis, begin, end))
        size, axis, begin, end = min(spans)
        if size <= 0:
            return -1
        x, y = self._xs[axis][begin:end], self._ys[axis][begin:end]
        inside = self._there[axis][begin:end].copy()
        (ax, ay), (bx, by), (cx, cy) = corner
        inside &= (bx - ax) * (y - by) - (by - ay) * (x - bx) >= 0.0
        inside &= (cx - bx) * (y - cy) - (cy - by) * (x - cx) >= 0.0
        inside &= (ax - cx) * (y - ay) - (ay - cy) * (x - ax) >= 0.0
        for at in np.flatnonzero(inside).tolist():
            if (float(x[at]), float(y[at])) not in corner:
                return int(self._corners[axis][begin + at])
        return -1

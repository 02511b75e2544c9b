"""Polygons with holes as triangles, by cutting off ears.

A corner is an ear where the polygon turns left and no other corner lies in its triangle; only
corners that turn right can. They are sorted by both axes, so that few of them are looked at for
each ear. Holes are joined to the outline first, by a bridge there and back (`bridges`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from colladaphy.links.sums import exact_sum
from colladaphy.mapper.loading.bridges import Point, turn_of, with_bridges

__all__ = ["triangles_of"]

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
    if inner:
        ring = with_bridges(ring, inner, points)
    triangles = _Cutting(ring, points).triangles()
    return [triangle[::-1] for triangle in triangles] if flipped else triangles


def _area(ring: Sequence[Point]) -> float:
    """Twice the signed area."""
    return exact_sum(
        one[0] * two[1] - one[1] * two[0]
        for one, two in zip(ring, [*ring[1:], *ring[:1]], strict=True)
    )


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
        self._hopeful = bytearray(map(self._may_be_ear, range(count)))
        """Corners that may be ears; of the others it is known what keeps them from being one."""
        self._spikes = [at for at in sorted(self._blocking) if self._is_spike(at)]
        """Corners that go before any ear, so that none is cut across them."""
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
        return turn_of(*self._corner(at)) > 0.0

    def _is_spike(self, at: int) -> bool:
        """Whether the ring turns back at a corner, or stays where it is: that can go at once."""
        one, two, three = self._corner(at)
        if turn_of(one, two, three) != 0.0:
            return False
        there, back = (two[0] - one[0], two[1] - one[1]), (three[0] - two[0], three[1] - two[1])
        return there[0] * back[0] + there[1] * back[1] <= 0.0

    def _may_be_ear(self, at: int) -> bool:
        return self._after[at] >= 0 and at not in self._blocking

    def _forget(self, at: int) -> None:
        """A corner blocks no more: those that it kept from being ears may be some now."""
        if at not in self._blocking:
            return
        self._blocking.discard(at)
        for other in self._waiting.pop(at, ()):
            self._hopeful[other] = self._may_be_ear(other)
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
            return
        if self._is_spike(at):
            self._spikes.append(at)
        if at in self._blocking:
            # It may leave ears whose tip it comes by in another direction now.
            for other in self._waiting.get(at, ()):
                if self._points[other] == self._points[at]:
                    self._hopeful[other] = self._may_be_ear(other)
        else:
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
        """A spike, or the first ear from a corner on; that corner itself where there is none.

        A ring that crosses itself may have no ear: then any corner has to do.
        """
        while self._spikes:
            at = self._spikes.pop()
            if self._after[at] >= 0 and self._is_spike(at):
                return at
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
        return -1 if self._sorted is None else self._sorted.blocker(corner, self._passes)

    def _blocks(self, other: int, one: Point, two: Point, three: Point) -> bool:
        point = self._points[other]
        if point in (one, two, three):
            return point == two and self._passes(other, one, two, three)
        return (
            turn_of(one, two, point) >= 0.0
            and turn_of(two, three, point) >= 0.0
            and turn_of(three, one, point) >= 0.0
        )

    def _passes(self, other: int, one: Point, two: Point, three: Point) -> bool:
        """Whether the ring comes by the tip of an ear once more, and leaves it into the ear."""
        return any(
            turn_of(one, two, self._points[at]) > 0.0
            and turn_of(two, three, self._points[at]) > 0.0
            for at in (self._before[other], self._after[other])
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

    def blocker(
        self,
        corner: tuple[Point, Point, Point],
        passes: Callable[[int, Point, Point, Point], bool],
    ) -> int:
        """One that lies in a triangle, its edges included, or `passes` its tip; -1 for none."""
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
            point, number = (float(x[at]), float(y[at])), int(self._corners[axis][begin + at])
            if point not in corner or (point == corner[1] and passes(number, *corner)):
                return number
        return -1

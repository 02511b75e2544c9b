"""Polygons and their holes as triangles."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from colladaphy.mapper.loading.closedness import are_closed
from colladaphy.mapper.loading.ears import triangles_of
from colladaphy.mapper.loading.polygons import _polylist, _with_holed

Point = tuple[float, float]


def area(ring: list[Point]) -> float:
    """By the shoelace formula."""
    x, y = np.array(ring).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2)


def star(
    count: int, middle: Point = (0.0, 0.0), radii: tuple[float, ...] = (1.0, 0.4)
) -> list[Point]:
    """A polygon around a point, its corners at these distances in turn."""
    x, y = middle
    return [
        (x + radii[at % len(radii)] * math.cos(math.tau * at / count),
         y + radii[at % len(radii)] * math.sin(math.tau * at / count))
        for at in range(count)
    ]  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(
    st.integers(3, 60),
    st.lists(st.floats(0.2, 3.0), min_size=1, max_size=9).map(tuple),
    st.booleans(),
)
def test_a_polygon_is_covered_once(count: int, radii: tuple[float, ...], clockwise: bool) -> None:
    ring = star(count, radii=radii)
    if clockwise:
        ring.reverse()
    triangles = triangles_of(ring, [])
    assert len(triangles) == count - 2
    parts = [area([ring[at] for at in triangle]) for triangle in triangles]
    assert math.isclose(sum(parts), area(ring), rel_tol=1e-9, abs_tol=1e-12)
    assert all(part * math.copysign(1, area(ring)) >= -1e-12 for part in parts)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(0, 15), min_size=1, max_size=8, unique=True),
    st.lists(st.floats(0.2, 1.1), min_size=3, max_size=9).map(tuple),
    st.booleans(),
    st.booleans(),
)
@example(
    [0, 8, 2, 4, 12, 15],
    (0.2, 0.3060726681896659, 0.35, 1.055459987154324, 1.055459987154324),
    False,
    False,
)  # three bridges to one corner, one of them level with it
def test_holes_are_left_out(
    cells: list[int], radii: tuple[float, ...], clockwise: bool, hole_clockwise: bool
) -> None:
    outline = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]
    holes = [
        star(len(radii), (cell % 4 * 2.5 + 1.25, cell // 4 * 2.5 + 1.25), radii) for cell in cells
    ]
    want = 100.0 - sum(area(hole) for hole in holes)
    if clockwise:
        outline.reverse()
    if hole_clockwise:
        holes = [hole[::-1] for hole in holes]
    points = [*outline, *(point for hole in holes for point in hole)]
    sign = -1 if clockwise else 1
    parts = [
        sign * area([points[at] for at in triangle]) for triangle in triangles_of(outline, holes)
    ]
    assert math.isclose(sum(parts), want, rel_tol=1e-9)
    assert min(parts) >= -1e-12


@pytest.mark.parametrize("count", [400, 800])
def test_many_corners_take_little_time(count: int) -> None:
    ring = star(count)
    start = time.process_time()
    assert len(triangles_of(ring, [])) == count - 2
    assert time.process_time() - start < 0.5  # half a minute, once


def comb(teeth: int, tall: float, *, square: bool) -> list[Point]:
    """Teeth on a bar, counter-clockwise."""
    up: list[Point] = []
    for at in range(teeth):
        tip = [(at + 0.5, 1.0 + tall)]
        wide = [(float(at), 1.0 + tall), (at + 0.5, 1.0 + tall), (at + 0.5, 1.0)]
        up += [(float(at), 1.0), *(wide if square else tip)]
    return [(-1.0, 0.0), (float(teeth), 0.0), *up[::-1]]


def spiral(count: int) -> list[Point]:
    """A band wound twenty times: all but a few of its corners are no ears for long."""
    turns = [40 * math.pi * at / count for at in range(count)]
    outer = [((1 + t) * math.cos(t), (1 + t) * math.sin(t)) for t in turns]
    inner = [((t + 0.5) * math.cos(t), (t + 0.5) * math.sin(t)) for t in turns]
    return outer + inner[::-1]


LONG = {
    "comb": comb(10_000, 1.0, square=False),
    "tall comb": comb(10_000, 10_000.0, square=False),
    "square comb": comb(5_000, 1.0, square=True),
    "spiral": spiral(10_000),
    "star": star(20_000),
    "line": [(float(at), 0.0) for at in range(20_000)],
    "point": [(1.0, 2.0)] * 20_000,
}


@pytest.mark.parametrize("name", list(LONG))
@pytest.mark.parametrize("clockwise", [False, True])
def test_twenty_thousand_corners_are_cut_in_seconds(name: str, clockwise: bool) -> None:
    ring = LONG[name][::-1] if clockwise else LONG[name]
    start = time.process_time()
    triangles = triangles_of(ring, [])
    assert time.process_time() - start < 6.0  # 21 s for a comb, and for ever for a spiral, once
    assert len(triangles) == len(ring) - 2
    corners = np.array(ring)[np.array(triangles)]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]) / 2
    whole = area(ring)
    assert math.isclose(areas.sum(), whole, rel_tol=1e-9, abs_tol=1e-6)
    assert np.all(areas * math.copysign(1.0, whole) >= -1e-9 * abs(whole))


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=3, max_size=60))
def test_rings_that_cross_themselves_end(ring: list[Point]) -> None:
    assert len(triangles_of(ring, [])) == len(ring) - 2


_CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
_FACES = np.array([
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6),
    (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
])  # fmt: skip


def test_surfaces_are_closed_where_every_edge_is_passed_both_ways() -> None:
    apart = _CUBE[_FACES].reshape(-1, 3)  # each face with vertices of its own
    turned = _FACES.copy()
    turned[3] = turned[3, ::-1]
    found = are_closed([
        (_CUBE, _FACES), (_CUBE, _FACES[1:]), (apart, np.arange(36).reshape(-1, 3)),
        (_CUBE, turned), (_CUBE, np.concatenate([_FACES[:8]])),
    ])  # fmt: skip
    assert found.tolist() == [True, False, True, False, False]


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=1, max_size=12),
    st.lists(st.lists(st.integers(0, 12), max_size=7), max_size=8),
    st.integers(0, 3),
)
def test_polygons_together_are_what_they_are_alone(
    points: list[tuple[int, int, int]], rings: list[list[int]], cut: int
) -> None:
    """Of any size, turned any way, with corners that are not there, and with a list too short."""
    places = np.array(points, np.float64)
    lists = [np.array(ring, np.int64) for ring in rings]
    alone = [_with_holed([ring], places) for ring in lists]
    together = _with_holed(lists, places)
    assert np.array_equal(together, np.concatenate([np.zeros((0, 3), np.int64), *alone]))
    sizes = np.array([len(ring) for ring in lists], np.int64)
    corners = np.concatenate([np.zeros(0, np.int64), *lists])
    assert np.array_equal(_polylist([corners], sizes, places), together)
    short = corners[: len(corners) - cut]
    whole = int(np.searchsorted(np.cumsum(sizes), len(short), "right"))
    kept = sum(len(part) for part in alone[:whole])
    assert np.array_equal(_polylist([short], sizes, places)[:kept], together[:kept])
    holed = np.array([(7, 8, 9)])
    mixed = [part for ring in lists for part in (holed, ring)]
    expected = [part for ring in alone for part in (holed, ring)]
    assert np.array_equal(
        _with_holed(mixed, places), np.concatenate([np.zeros((0, 3), np.int64), *expected])
    )


def test_many_quads_take_little_time() -> None:
    count = 200_000
    corners = np.arange(4 * count)
    points = np.tile([(0.0, 0.0, 0.0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], (count, 1))
    begin = time.perf_counter()
    made = _polylist([corners], np.full(count, 4), points)
    assert time.perf_counter() - begin < 5.0
    assert made.shape == (2 * count, 3)
    assert made[:2].tolist() == [[0, 1, 2], [0, 2, 3]]


_HOLES: dict[str, list[Point]] = {
    "square": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
    "diamond": [(-1, 0), (0, -1), (1, 0), (0, 1)],
    "left": [(-1, -1), (1, 0), (-1, 1)],
    "right": [(1, -1), (-1, 0), (1, 1)],
    "straight": [(-1, -1), (0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (0, 0), (-1, 0)],
}
_cells = st.tuples(st.sampled_from(sorted(_HOLES)), st.booleans(), st.booleans())


def aligned(size: int, cells: dict[tuple[int, int], tuple[str, bool, bool]], notched: bool) -> Any:
    """A square with holes whose corners are in line with each other, and touch its notches."""
    far, half = 4 * size, 2 * size
    outline: list[Point] = [(0, 0), (far, 0), (far, far), (0, far)]
    if notched:
        outline = [(0, 0), (half, 0), (half, 1), (half + 1, 1), (half + 1, 0), (far, 0), (far, far),
                   (half, far), (half, far - 1), (half - 1, far - 1), (half - 1, far),
                   (0, far)]  # fmt: skip
    holes = []
    for (x, y), (name, wide, turned) in cells.items():
        wider = 1 if wide and x < size - 1 else 0
        hole = [(4 * x + 2 + dx + wider * (dx > 0), 4 * y + 2 + dy) for dx, dy in _HOLES[name]]
        holes.append(hole[::-1] if turned else hole)
    return outline, holes


@settings(max_examples=150, deadline=None)
@given(
    st.integers(2, 6).map(lambda half: 2 * half),
    st.dictionaries(st.tuples(st.integers(0, 3), st.integers(0, 3)), _cells, max_size=14),
    st.booleans(),
)
@example(4, {(2, 0): ("square", False, False)}, True)
@example(4, {(1, 3): ("left", True, False)}, True)
@example(6, {(0, 2): ("diamond", True, False), (0, 0): ("right", True, False)}, False)
def test_holes_in_line_leave_nothing_covered_twice(
    size: int, cells: dict[tuple[int, int], tuple[str, bool, bool]], notched: bool
) -> None:
    outline, holes = aligned(size, cells, notched)
    points = [*outline, *(point for hole in holes for point in hole)]
    parts = [area([points[at] for at in triangle]) for triangle in triangles_of(outline, holes)]
    assert min(parts) >= 0.0  # these are whole numbers and halves: without any rounding
    assert sum(parts) == area(outline) - sum(abs(area(hole)) for hole in holes)
    assert len(parts) == len(points) - 2 + 2 * len(holes)


def test_many_holes_take_little_time() -> None:
    count = 40
    outline, holes = aligned(
        count, {(x, y): ("square", False, False) for x in range(count) for y in range(count)}, False
    )
    begin = time.perf_counter()
    made = triangles_of(outline, holes)
    assert time.perf_counter() - begin < 5.0
    assert len(made) == 4 + 4 * count**2 - 2 + 2 * count**2


def test_a_hole_outside_takes_nothing_away() -> None:
    outline: list[Point] = [(0, 0), (4, 0), (4, 4), (0, 4)]
    outside: list[Point] = [(5, 1), (6, 1), (6, 2)]
    parts = triangles_of(outline, [outside])
    assert len(parts) == 2

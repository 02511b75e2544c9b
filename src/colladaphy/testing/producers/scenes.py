"""Scenes that authors of files may have meant, drawn."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from colladaphy.testing.producers.truth import Joint, Link, Scene, Solid, Steps

__all__ = ["KINDS", "scenes"]


def _tame(low: int, high: int) -> st.SearchStrategy[float]:
    return st.integers(low, high).map(lambda number: number / 1000)


LENGTHS = _tame(50, 2000)
COORDINATES = _tame(-5000, 5000)
VECTORS = st.tuples(COORDINATES, COORDINATES, COORDINATES)
AXES = st.sampled_from([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.6, 0.0, 0.8)])
TRANSLATES = VECTORS.map(lambda vector: ("translate", vector))
ROTATES = st.tuples(AXES, st.integers(-180, 180)).map(
    lambda pair: ("rotate", (*pair[0], float(pair[1])))
)


def steps(least: int = 0, most: int = 3) -> st.SearchStrategy[Steps]:
    """Translations and rotations in any order, repeated too."""
    return st.lists(st.one_of(TRANSLATES, ROTATES), min_size=least, max_size=most).map(tuple)


PLACES = st.tuples(TRANSLATES, ROTATES)


@st.composite
def solids(draw: st.DrawFn, kinds: tuple[str, ...], places: bool) -> Solid:
    kind = draw(st.sampled_from(kinds))
    count = {"box": 3, "mesh": 3, "sphere": 1, "cylinder": 2, "capsule": 2}[kind]
    size = tuple(draw(LENGTHS) for _ in range(count))
    return Solid(kind, size, draw(PLACES) if places else ())


@st.composite
def principal(draw: st.DrawFn) -> tuple[float, float, float]:
    """Moments of inertia that a body can have: none exceeds the sum of the others."""
    x, y, z = (draw(_tame(10, 1000)) for _ in range(3))
    return round(y + z, 6), round(x + z, 6), round(x + y, 6)


KINDS = ("box", "sphere", "cylinder", "capsule", "mesh")


@st.composite
def scenes(
    draw: st.DrawFn,
    *,
    kinds: tuple[str, ...] = KINDS,
    placed: bool = True,
    compounds: bool = True,
    centred: bool = False,
    nested: bool = False,
    rooted: bool = False,
    moving: bool = True,
    joints: bool = False,
    most: int = 4,
) -> Scene:
    """A scene of one to `most` links; with `centred` all state a mass frame and an inertia."""
    links = []
    for number in range(draw(st.integers(1, most))):
        several = compounds and draw(st.booleans())
        count = draw(st.integers(2, 3)) if several else 1
        made = tuple(draw(solids(kinds, placed or several)) for _ in range(count))
        stated = centred or draw(st.booleans())
        links.append(
            Link(
                name=f"link{number}",
                steps=draw(PLACES),
                solids=made,
                mass=draw(_tame(100, 20000)),
                centre=draw(PLACES) if stated and centred else None,
                inertia=draw(principal()) if stated and centred else None,
                fixed=draw(st.booleans()) if not centred else False,
                velocity=draw(VECTORS) if moving else (0.0, 0.0, 0.0),
                spin=draw(VECTORS) if moving else (0.0, 0.0, 0.0),
                parent=number - 1 if nested and number and draw(st.booleans()) else None,
            )
        )
    found: list[Joint] = []
    if joints and len(links) > 1:
        found = [draw(_joints(number)) for number in range(1, len(links))]
    return Scene(
        tuple(links),
        tuple(found),
        gravity=draw(st.sampled_from([(0.0, 0.0, -9.81), (0.0, -9.81, 0.0), (0.0, 0.0, 0.0)])),
        root=draw(PLACES) if rooted else (),
    )


@st.composite
def _joints(draw: st.DrawFn, number: int) -> Joint:
    linear = [draw(_ranges()) for _ in range(3)]
    angular = [draw(_ranges()) for _ in range(3)]
    return Joint(
        name=f"joint{number}",
        first=draw(st.sampled_from([None, number - 1])),
        second=number,
        frames=(draw(PLACES), draw(PLACES)),
        linear=(tuple(low for low, _ in linear), tuple(high for _, high in linear)),
        angular=(tuple(low for low, _ in angular), tuple(high for _, high in angular)),
    )


@st.composite
def _ranges(draw: st.DrawFn) -> tuple[float, float]:
    """Locked, limited or free."""
    return draw(
        st.one_of(
            st.just((0.0, 0.0)),
            st.tuples(_tame(-90000, -1), _tame(1, 90000)),
            st.just((-math.inf, math.inf)),
        )
    )

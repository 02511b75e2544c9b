"""Which reading of frames fits: what the shown geometry says of each frame, and the votes of all.

A mesh that its link shows must stand there; a centre of mass and any other shape must be about
where the link shows something. Each holds to a tolerance that goes with the sizes. What is shown
at the very same place says most, and so the votes are counted in three ranks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from lxml import etree

from colladaphy.conform.context import NS, Context
from colladaphy.conform.conventions.clues import extents, place_of
from colladaphy.conform.conventions.links import READINGS, Link
from colladaphy.conform.frames import Matrix, inverse
from colladaphy.conform.solids import are_usable, numbers_of

__all__ = ["Evidence", "Votes", "mass_evidence", "shape_evidence"]

_EXACT = 2e-3
"""Of the size: places are written with six digits or fewer, and turned several times."""
_ABOUT = 0.1
_SAME, _INSIDE, _NEAR = range(3)
_WHY = (
    "shapes where the same geometry is shown",
    "inside the shown geometry",
    "near their body",
)


@dataclass(frozen=True, slots=True)
class Evidence:
    """What speaks for each reading of one frame: rank, fits, distances, and the places found."""

    rank: int
    fits: tuple[bool, ...]
    distances: tuple[float, ...]
    places: tuple[Matrix | None, ...] = (None,) * len(READINGS)
    """Where the link shows the geometry, where only its vertices are in the frame of a reading."""


@dataclass(slots=True)
class Votes:
    """How many frames fit under each reading."""

    posed: bool = False
    """Whether any joint is not at zero."""
    seen: list[Evidence] = field(default_factory=list)

    def add(self, evidence: Evidence | None) -> None:
        """Count what speaks for readings, where anything does."""
        if evidence is not None:
            self.seen.append(evidence)

    def _best(self) -> list[Evidence]:
        """What counts: all of the best rank that there is."""
        rank = min((evidence.rank for evidence in self.seen), default=_NEAR)
        return [evidence for evidence in self.seen if evidence.rank == rank]

    def counts(self) -> list[int]:
        """The number of frames that fit, by reading."""
        return [sum(evidence.fits[i] for evidence in self._best()) for i in range(len(READINGS))]

    def decide(self, like: int | None = None) -> int:
        """The reading that fits most; then the one like `like`; then the producers' habit."""
        counts = self.counts()
        telling = [e for e in self._best() if e.rank == _NEAR]
        far = [sum(e.distances[i] for e in telling) for i in range(len(READINGS))]

        def key(reading: int) -> tuple[float, ...]:
            return counts[reading], -round(far[reading], 6), reading == like, -reading

        return max(range(len(READINGS)), key=key)

    def doubtful(self, reading: int) -> bool:
        """Whether a reading fits no more than half of the frames that can be told."""
        return 2 * self.counts()[reading] <= len(self._best()) and bool(self.seen)

    def __bool__(self) -> bool:
        return bool(self.seen)

    def __str__(self) -> str:
        if not self.seen:
            return "nothing to compare with, so the producer's habit decides"
        counts, best = self.counts(), self._best()
        readings = [i for i in range(len(READINGS)) if self.posed or i not in (2, 3)]
        parts = [f"{counts[i]} {'fit ' * (not n)}{READINGS[i]}" for n, i in enumerate(readings)]
        if none := sum(not any(evidence.fits) for evidence in best):
            parts.append(f"{none} none")
        return f"of {len(best)}, {', '.join(parts)} ({_WHY[best[0].rank]})"


def _differ(readings: Sequence[Matrix], size: float) -> bool:
    return bool(np.ptp(readings, axis=0).max() > 1e-6 * max(size, 1e-3))


def mass_evidence(link: Link, frame: etree._Element) -> Evidence | None:
    """Whether the centre of mass is in what the link shows, under each reading."""
    place = place_of(frame)
    if place is None:
        return None
    readings = link.readings(place)
    if not _differ(readings, link.reach):
        return None
    centres = [reading[:3, 3] for reading in readings]
    return _about(link, centres, 0.0)


def _about(link: Link, points: Sequence[Matrix], size: float) -> Evidence:
    """Whether points are about what the link shows, or about the link where it shows nothing."""
    if link.shown:
        boxes = [moved_box(shown.place, shown.box) for shown in link.shown]
        low = np.min([box[0] for box in boxes], axis=0)
        high = np.max([box[1] for box in boxes], axis=0)
        slack = _ABOUT * float(np.linalg.norm(high - low)) + size
        outside = [
            float(np.linalg.norm(np.maximum(np.maximum(low - p, p - high), 0.0))) for p in points
        ]
        return Evidence(_INSIDE, tuple(d <= slack for d in outside), tuple(outside))
    far = [float(np.linalg.norm(point)) for point in points]
    reach = max(link.reach, size) * (1 + _ABOUT)
    fits = tuple(d <= reach for d in far) if reach else tuple(d <= min(far) for d in far)
    return Evidence(_NEAR, fits, tuple(far))


def moved_box(place: Matrix, box: Matrix) -> Matrix:
    """Least and greatest coordinates of a box that was moved."""
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])
    points = corners @ place[:3, :3].T + place[:3, 3]
    return np.stack([points.min(axis=0), points.max(axis=0)])


def shape_evidence(context: Context, link: Link, shape: etree._Element) -> Evidence | None:
    """Whether a shape is where the link shows its geometry, or about what it shows."""
    place = place_of(shape)
    if place is None:
        return None
    readings = link.readings(place)
    instance = shape.find(NS + "instance_geometry")
    geometry = None if instance is None else context.by_url(instance.get("url"))
    box = extents(context, geometry)
    size = 0.0 if box is None else float(np.linalg.norm(np.abs(box).max(axis=0)))
    own = None if geometry is None else _stated_transform(geometry)
    doubled = None if own is None else [reading @ inverse(own) for reading in readings]
    shown = [s.place for s in link.shown if instance is not None and s.url == instance.get("url")]
    if shown:
        tolerance = _EXACT * max(size, 1e-9)
        plain = [_nearest(reading, shown, size) for reading in readings]
        again = plain if doubled is None else [_nearest(d, shown, size) for d in doubled]
        places = [
            there[1] if there[0] <= tolerance < here[0] else None
            for here, there in zip(plain, again, strict=True)
        ]
        distances = tuple(min(h[0], t[0]) for h, t in zip(plain, again, strict=True))
        fits = tuple(distance <= tolerance for distance in distances)
        if not any(fits):  # nothing fits: the mesh is where the link shows it
            places = [near[1] for near in plain]
        if not _differ(readings, link.reach) and all(place is None for place in places):
            return None
        return Evidence(_SAME, fits, distances, tuple(places))
    if (
        own is not None
        and doubled is not None
        and box is not None
        and _is_moved(geometry, own, box)
    ):
        middles = [d @ [*box.mean(axis=0), 1.0] for d in doubled]
        told = _about(link, [middle[:3] for middle in middles], size)
        return Evidence(told.rank, told.fits, told.distances, tuple(doubled))
    if not _differ(readings, link.reach):
        return None
    middle = [0.0, 0.0, 0.0, 1.0] if box is None else [*box.mean(axis=0), 1.0]
    return _about(link, [(reading @ middle)[:3] for reading in readings], 0.0)


def _nearest(reading: Matrix, shown: Sequence[Matrix], size: float) -> tuple[float, Matrix]:
    """The nearest of the places that are shown, and how far a point of the geometry is off."""
    weights = np.array([size, size, size, 1.0])
    found = [float(np.abs((reading - where)[:3] * weights).max()) for where in shown]
    best = int(np.argmin(found))
    return found[best], shown[best]


def _info(geometry: etree._Element) -> etree._Element | None:
    """What OpenRAVE says of a geometry in an extra: its transform, and the solid that it was."""
    for extra in geometry.iterchildren(NS + "extra"):
        if extra.get("type") == "geometry_info":
            return extra.find(NS + "technique")
    return None


def _stated_transform(geometry: etree._Element) -> Matrix | None:
    """The transform of a geometry that its extra states; None where there is none but identity."""
    info = _info(geometry)
    if info is None:
        return None
    place = place_of(info)
    return None if place is None or np.allclose(place, np.eye(4), rtol=0, atol=1e-9) else place


def _is_moved(geometry: etree._Element | None, own: Matrix, box: Matrix | None) -> bool:
    """Whether the vertices are where the stated transform puts the stated solid."""
    info = None if geometry is None else _info(geometry)
    halves = None if info is None else info.find(f"{NS}box/{NS}half_extents")
    values = numbers_of(halves)
    if box is None or len(values) != 3 or not are_usable(values):
        return False
    stated = np.stack([-np.asarray(values), np.asarray(values)])
    size = float(np.linalg.norm(values))
    return bool(np.abs(moved_box(own, stated) - box).max() <= 10 * _EXACT * size)

"""Frames in the model's space: OpenRAVE, ROS urdf_to_collada, OpenHRP3 and their relatives.

The standard has mass frames and shapes relative to the body's node. These producers write them
relative to the node that the model is instanced under, with all joints at zero. Not all of their
versions do, so both readings are compared with the geometry that the bodies show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from lxml import etree

from colladaphy.conform import rules
from colladaphy.conform.bodies import body_targets
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.conventions.clues import Clues, extents, is_assumed, place_of
from colladaphy.conform.conventions.places import Places
from colladaphy.conform.frames import Matrix, inverse
from colladaphy.conform.placing import put_place

__all__ = ["apply", "recognise_openhrp3", "recognise_openrave", "recognise_ros"]

_NEAR = 1e-4
_ROUNDING = 1e-9


def recognise_openrave(clues: Clues) -> str | None:
    """OpenRAVE and its relatives name themselves, or leave their profile."""
    found = clues.tool("openrave", "mujin")
    profiles = clues.profiles & {"OpenRAVE", "MUJIN"}
    return found or (f"it has the profile {min(profiles)}" if profiles else None)


def recognise_ros(clues: Clues) -> str | None:
    """ROS's urdf_to_collada names itself."""
    return clues.tool("urdf collada writer", "urdf_to_collada", "collada_urdf")


def recognise_openhrp3(clues: Clues) -> str | None:
    """OpenHRP3 names itself."""
    return clues.tool("openhrp", "export_collada")


@dataclass(slots=True)
class _Link:
    """A body, its node, and where the node is in the model's space: at rest, and as shown."""

    body: etree._Element
    node: etree._Element
    rest: Matrix
    shown: Matrix

    def readings(self, place: Matrix) -> tuple[Matrix, Matrix, Matrix]:
        """A frame at `place` in the body's space, under each of `_READINGS`."""
        return inverse(self.rest) @ place, inverse(self.shown) @ place, place


_READINGS = ("the model's space", "the model's space as it is shown", "the body's")
_LOCAL = 2


@dataclass(slots=True)
class _Votes:
    """How many frames fit the geometry under each reading."""

    counts: list[int] = field(default_factory=lambda: [0] * len(_READINGS))
    posed: bool = False
    """Whether any joint is not at zero."""
    why: set[str] = field(default_factory=set)

    def add(self, why: str, distances: Sequence[float]) -> None:
        """Count the readings that fit best."""
        self.why.add(why)
        near = min(distances) + _ROUNDING
        for reading, distance in enumerate(distances):
            self.counts[reading] += distance <= near < max(distances)

    def decide(self) -> int:
        """The reading that fits most frames; the producer's habit breaks a tie."""
        return max(range(len(_READINGS)), key=lambda reading: (self.counts[reading], -reading))

    def __str__(self) -> str:
        if not self.why:
            return "nothing to compare with, so the producer's habit decides"
        shown = (0, 1, 2) if self.posed else (0, 2)
        counts = ", ".join(f"{self.counts[i]} {'fit ' * (not i)}{_READINGS[i]}" for i in shown)
        return f"{counts} ({', '.join(sorted(self.why))})"


def apply(context: Context, *, forced: bool) -> None:
    """Bring mass frames and shapes into their body's space, where they were in the model's.

    With `forced` the model's space is taken whatever the numbers say, with a warning.
    """
    links = _links(context)
    moved = [link for link in links if not _is_identity(link.rest) or not _is_identity(link.shown)]
    for what, holders, vote in (
        ("mass frames", _mass_frames, _vote_on_mass),
        ("shapes", _shapes, _vote_on_shape),
    ):
        votes = _Votes(posed=any(not np.allclose(link.rest, link.shown) for link in moved))
        found = [(link, holder) for link in moved for holder in holders(link)]
        for link, holder in found:
            vote(context, link, holder, votes)
        if not found:
            continue
        reading = votes.decide()
        if reading == _LOCAL and not forced:
            message = f"{what} are in the bodies' own space: {votes}"
            context.note(rules.FRAMES_LOCAL, context.root, message)
            continue
        if reading == _LOCAL:
            message = f"{what} were taken from the model's space as asked, but {votes}"
            context.note(rules.FRAMES_DOUBTFUL, context.root, message)
            reading = 0
        if context.wants(rules.FRAMES):
            message = f"{len(found)} {what} moved from {_READINGS[reading]} to the bodies': {votes}"
            context.note(rules.FRAMES, context.root, message)
            for link, holder in found:
                _move(context, link, holder, reading)


def _is_identity(matrix: Matrix) -> bool:
    return np.allclose(matrix, np.eye(4), atol=1e-9)


def _links(context: Context) -> list[_Link]:
    parents: dict[etree._Element, etree._Element | None] = {}
    for instance in context.all("instance_physics_model"):
        model = context.by_url(instance.get("url"))
        if model is not None:
            parents.setdefault(model, context.by_url(instance.get("parent")))
    places = Places(context)
    links = []
    for body, node in body_targets(context).items():
        model = body.getparent()
        top = None if model is None else parents.get(model)
        place = places.of(node)
        if place is None:
            continue
        rest, shown = place.rest, place.shown
        if top is not None and local(top) == "node":
            above = places.of(top)
            if above is None:
                continue
            if above.scene is place.scene:
                rest, shown = inverse(above.rest) @ rest, inverse(above.shown) @ shown
        links.append(_Link(body, node, rest, shown))
    return links


def _commons(link: _Link) -> list[etree._Element]:
    return list(link.body.iterchildren(NS + "technique_common"))


def _mass_frames(link: _Link) -> list[etree._Element]:
    return [frame for common in _commons(link) for frame in common.iterchildren(NS + "mass_frame")]


def _shapes(link: _Link) -> list[etree._Element]:
    return [
        shape
        for common in _commons(link)
        for shape in common.iterchildren(NS + "shape")
        if not is_assumed(shape)
    ]


def _own_geometries(context: Context, link: _Link) -> list[tuple[str, Matrix, Matrix]]:
    """Url, place and extents of what the node itself and plain nodes below it show."""
    found = []
    holders = [(link.node, np.eye(4))]
    for child in link.node.iterchildren(NS + "node"):
        own = place_of(child)
        if own is not None and child.find(NS + "node") is None:
            holders.append((child, own))
    for holder, place in holders:
        for instance in holder.iterchildren(NS + "instance_geometry"):
            box = extents(context, context.by_url(instance.get("url")))
            if box is not None:
                found.append((instance.get("url", ""), place, box))
    return found


def _vote_on_mass(context: Context, link: _Link, frame: etree._Element, votes: _Votes) -> None:
    place = place_of(frame)
    if place is None:
        return
    centres = [reading[:3, 3] for reading in link.readings(place)]
    if np.ptp(centres, axis=0).max() < _NEAR:
        return
    boxes = [_moved_box(own, box) for _, own, box in _own_geometries(context, link)]
    if boxes:
        low = np.min([box[0] for box in boxes], axis=0)
        high = np.max([box[1] for box in boxes], axis=0)

        def outside(point: Matrix) -> float:
            return float(np.linalg.norm(np.maximum(np.maximum(low - point, point - high), 0.0)))

        votes.add("centres of mass inside the shown geometry", [outside(c) for c in centres])
    else:
        distances = [float(np.linalg.norm(centre)) for centre in centres]
        votes.add("centres of mass near their body", distances)


def _moved_box(place: Matrix, box: Matrix) -> Matrix:
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])
    points = corners @ place[:3, :3].T + place[:3, 3]
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _vote_on_shape(context: Context, link: _Link, shape: etree._Element, votes: _Votes) -> None:
    place = place_of(shape)
    if place is None:
        return
    readings = link.readings(place)
    if np.ptp(readings, axis=0).max() < _NEAR:
        return
    own = _own_geometries(context, link)
    instance = shape.find(NS + "instance_geometry")
    same = [where for url, where, _ in own if instance is not None and url == instance.get("url")]
    if same:
        why = "shapes where the same geometry is shown"
        distances = [min(float(np.abs(r - where).max()) for where in same) for r in readings]
    elif own:
        why = "shapes near the shown geometry"
        centre = np.mean([_moved_box(where, box).mean(axis=0) for _, where, box in own], axis=0)
        distances = [float(np.linalg.norm(r[:3, 3] - centre)) for r in readings]
    else:
        why = "shapes near their body"
        distances = [float(np.linalg.norm(r[:3, 3])) for r in readings]
    votes.add(why, distances)


def _move(context: Context, link: _Link, holder: etree._Element, reading: int) -> None:
    place = place_of(holder)
    if place is not None:
        put_place(context, holder, link.readings(place)[reading])

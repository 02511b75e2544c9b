"""Frames in the model's space: OpenRAVE, ROS urdf_to_collada, OpenHRP3 and their relatives.

The standard has mass frames and shapes relative to the body's node. These producers write them
relative to the node that the model is instanced under, with all joints at zero. Not all of their
versions do, so both readings are compared with the geometry that the bodies show.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from lxml import etree

from colladaphy.conform import rules
from colladaphy.conform.bodies import body_targets, place_elements
from colladaphy.conform.context import NS, Context, insert, local
from colladaphy.conform.conventions.clues import Clues, extents, is_assumed, place_of
from colladaphy.conform.frames import TRANSFORMS, Matrix, inverse
from colladaphy.conform.solids import are_usable

__all__ = ["apply", "recognise_openhrp3", "recognise_openrave", "recognise_ros"]

_NEAR = 1e-4


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
    """A body, its node, and where the node is in the model's space."""

    body: etree._Element
    node: etree._Element
    place: Matrix


@dataclass(slots=True)
class _Votes:
    """How many frames fit the geometry under each reading."""

    model: int = 0
    local: int = 0
    why: set[str] = field(default_factory=set)

    def decide(self) -> bool:
        """Whether the frames are in the model's space; the producer's habit breaks a tie."""
        return self.model >= self.local

    def __str__(self) -> str:
        if not self.why:
            return "nothing to compare with, so the producer's habit decides"
        reasons = ", ".join(sorted(self.why))
        return f"{self.model} fit the model's space, {self.local} the body's ({reasons})"


def apply(context: Context, *, forced: bool) -> None:
    """Bring mass frames and shapes into their body's space, where they were in the model's.

    With `forced` the model's space is taken whatever the numbers say, with a warning.
    """
    links = _links(context)
    moved = [link for link in links if not np.allclose(link.place, np.eye(4), atol=1e-9)]
    for what, holders, vote in (
        ("mass frames", _mass_frames, _vote_on_mass),
        ("shapes", _shapes, _vote_on_shape),
    ):
        votes = _Votes()
        found = [(link, holder) for link in moved for holder in holders(link)]
        for link, holder in found:
            vote(context, link, holder, votes)
        if not found:
            continue
        if not votes.decide() and not forced:
            message = f"{what} are in the bodies' own space: {votes}"
            context.note(rules.FRAMES_LOCAL, context.root, message)
            continue
        if not votes.decide():
            message = f"{what} were taken from the model's space as asked, but {votes}"
            context.note(rules.FRAMES_DOUBTFUL, context.root, message)
        if context.wants(rules.FRAMES):
            message = f"{len(found)} {what} moved from the model's space to the bodies': {votes}"
            context.note(rules.FRAMES, context.root, message)
            for link, holder in found:
                _move(context, link, holder)


def _links(context: Context) -> list[_Link]:
    parents: dict[etree._Element, etree._Element | None] = {}
    for instance in context.all("instance_physics_model"):
        model = context.by_url(instance.get("url"))
        if model is not None:
            parents.setdefault(model, context.by_url(instance.get("parent")))
    places: dict[etree._Element, Matrix | None] = {}
    links = []
    for body, node in body_targets(context).items():
        model = body.getparent()
        top = None if model is None else parents.get(model)
        place = _place_in(node, places)
        if top is not None and local(top) == "node" and _scene_of(top) is _scene_of(node):
            above = _place_in(top, places)
            place = None if above is None or place is None else inverse(above) @ place
        if place is not None:
            links.append(_Link(body, node, place))
    return links


def _scene_of(node: etree._Element) -> etree._Element | None:
    """What a node hangs in: a visual scene, or the library of nodes."""
    return next((above for above in node.iterancestors() if local(above) != "node"), None)


def _place_in(node: etree._Element, known: dict[etree._Element, Matrix | None]) -> Matrix | None:
    """Where a node is in its scene; None where a transform above it cannot be read."""
    chain = []
    current: etree._Element | None = node
    while current is not None and local(current) == "node" and current not in known:
        chain.append(current)
        current = current.getparent()
    place = known.get(current, np.eye(4)) if current is not None else np.eye(4)
    for step in reversed(chain):
        own = place_of(step)
        place = known[step] = None if own is None or place is None else place @ own
        if place is not None and not are_usable(place.ravel().tolist()):
            place = known[step] = None
    return place


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
    as_local, as_model = place[:3, 3], (inverse(link.place) @ place)[:3, 3]
    if np.linalg.norm(as_local - as_model) < _NEAR:
        return
    boxes = [_moved_box(own, box) for _, own, box in _own_geometries(context, link)]
    if boxes:
        low = np.min([box[0] for box in boxes], axis=0)
        high = np.max([box[1] for box in boxes], axis=0)

        def outside(point: Matrix) -> float:
            return float(np.linalg.norm(np.maximum(np.maximum(low - point, point - high), 0.0)))

        votes.why.add("centres of mass inside the shown geometry")
        distances = outside(as_local), outside(as_model)
    else:
        votes.why.add("centres of mass near their body")
        distances = float(np.linalg.norm(as_local)), float(np.linalg.norm(as_model))
    votes.model += distances[1] < distances[0]
    votes.local += distances[0] < distances[1]


def _moved_box(place: Matrix, box: Matrix) -> Matrix:
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])
    points = corners @ place[:3, :3].T + place[:3, 3]
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _vote_on_shape(context: Context, link: _Link, shape: etree._Element, votes: _Votes) -> None:
    place = place_of(shape)
    if place is None:
        return
    as_model = inverse(link.place) @ place
    if np.allclose(place, as_model, atol=_NEAR):
        return
    own = _own_geometries(context, link)
    instance = shape.find(NS + "instance_geometry")
    same = [where for url, where, _ in own if instance is not None and url == instance.get("url")]
    if same:
        votes.why.add("shapes where the same geometry is shown")
        distances = [
            min(float(np.abs(r - where).max()) for where in same) for r in (place, as_model)
        ]
    elif own:
        votes.why.add("shapes near the shown geometry")
        centre = np.mean([_moved_box(where, box).mean(axis=0) for _, where, box in own], axis=0)
        distances = [float(np.linalg.norm(r[:3, 3] - centre)) for r in (place, as_model)]
    else:
        votes.why.add("shapes near their body")
        distances = [float(np.linalg.norm(r[:3, 3])) for r in (place, as_model)]
    votes.model += distances[1] < distances[0]
    votes.local += distances[0] < distances[1]


def _move(context: Context, link: _Link, holder: etree._Element) -> None:
    place = place_of(holder)
    if place is None:
        return
    old = [child for child in holder if local(child) in TRANSFORMS]
    index = holder.index(old[0]) if old else len(holder)
    if not old:
        index = next((i for i, c in enumerate(holder) if local(c) == "extra"), len(holder))
    made = place_elements(context, inverse(link.place) @ place)
    if not made and local(holder) == "mass_frame":
        made = [context.make("translate", "0 0 0")]
    tail = old[-1].tail if old else None
    for child in old:
        holder.remove(child)
    for offset, new in enumerate(made):
        insert(holder, index + offset, new)
    if made and old and index + len(made) == len(holder):
        made[-1].tail = tail

"""The links of robots: bodies, the nodes that show them, and where both are in their model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from lxml import etree

from colladaphy.conform.bodies import body_targets
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.conventions.clues import extents, place_of
from colladaphy.conform.conventions.places import Place, Places
from colladaphy.conform.frames import Matrix, inverse

__all__ = ["LOCAL", "READINGS", "Link", "Shown", "links_of"]

READINGS = (
    "the model's space",
    "the base link's",
    "the model's space as it is shown",
    "the base link's as it is shown",
    "the body's",
)
LOCAL = len(READINGS) - 1


@dataclass(frozen=True, slots=True)
class Shown:
    """A geometry that a link shows: its url, its place in the link, and its extents (2, 3)."""

    url: str
    place: Matrix
    box: Matrix


@dataclass(slots=True)
class Link:
    """A body, its node, and where the node is in the space of each reading but the body's own."""

    body: etree._Element
    node: etree._Element
    spaces: tuple[Matrix, Matrix, Matrix, Matrix]
    shown: list[Shown]
    reach: float
    """How far the nodes of its neighbours are."""

    def readings(self, place: Matrix) -> list[Matrix]:
        """A frame at `place`, in the body's space, under each of `READINGS`."""
        return [*(inverse(space) @ place for space in self.spaces), place]

    @property
    def posed(self) -> bool:
        """Whether it is shown elsewhere than with all joints at zero."""
        return not all(
            np.allclose(self.spaces[i], self.spaces[i + 2], rtol=0.0, atol=1e-9) for i in (0, 1)
        )

    def mass_frames(self) -> Iterator[etree._Element]:
        """The mass frames of the body."""
        for common in self.body.iterchildren(NS + "technique_common"):
            yield from common.iterchildren(NS + "mass_frame")

    def shapes(self) -> Iterator[etree._Element]:
        """The shapes of the body."""
        for common in self.body.iterchildren(NS + "technique_common"):
            yield from common.iterchildren(NS + "shape")


def links_of(context: Context) -> list[Link]:
    """Every body that moves a node, by models; the first of a model is its base link."""
    parents: dict[etree._Element, etree._Element | None] = {}
    for instance in context.all("instance_physics_model"):
        model = context.by_url(instance.get("url"))
        if model is not None:
            parents.setdefault(model, context.by_url(instance.get("parent")))
    places = Places(context)
    bases: dict[etree._Element | None, Place] = {}
    links = []
    found = body_targets(context)
    order = {body: i for i, body in enumerate(context.all("rigid_body"))}
    nodes = set(found.values())
    for body in sorted(found, key=lambda body: order.get(body, 0)):
        place = places.of(found[body])
        if place is None:
            continue
        model = body.getparent()
        base = bases.setdefault(model, place)
        top = None if model is None else parents.get(model)
        above = places.of(top) if top is not None and local(top) == "node" else None
        if top is not None and local(top) == "node" and above is None:
            continue
        spaces = (*_within(above, place), *_within(base, place))
        links.append(
            Link(
                body,
                found[body],
                (spaces[0], spaces[2], spaces[1], spaces[3]),
                _shown(context, found[body]),
                _reach(found[body], nodes, places),
            )
        )
    return links


def _within(outer: Place | None, inner: Place) -> tuple[Matrix, Matrix]:
    """A place at rest and as shown, relative to another of the same scene."""
    if outer is None or outer.scene is not inner.scene:
        return inner.rest, inner.shown
    return inverse(outer.rest) @ inner.rest, inverse(outer.shown) @ inner.shown


def _shown(context: Context, node: etree._Element) -> list[Shown]:
    """What the node itself and plain nodes below it show."""
    found = []
    holders = [(node, np.eye(4))]
    for child in node.iterchildren(NS + "node"):
        own = place_of(child)
        if own is not None and child.find(NS + "node") is None:
            holders.append((child, own))
    for holder, place in holders:
        for instance in holder.iterchildren(NS + "instance_geometry"):
            box = extents(context, context.by_url(instance.get("url")))
            if box is not None:
                found.append(Shown(instance.get("url", ""), place, box))
    return found


def _reach(node: etree._Element, nodes: set[etree._Element], places: Places) -> float:
    """How far from a link's node the nearest links above and below it are."""
    own = places.of(node)
    above = next((a for a in node.iterancestors(NS + "node") if a in nodes), None)
    near = [] if above is None else [above]
    near += [below for below in node.iterchildren(NS + "node") if below in nodes]
    found = [place.rest[:3, 3] for other in near if (place := places.of(other)) is not None]
    if own is None or not found:
        return 0.0
    return max(float(np.linalg.norm(point - own.rest[:3, 3])) for point in found)

"""Scales and mirrors of the nodes that bodies move: out of the node, into shapes and geometry.

A body is rigid, and the standard says nothing of a scale above it (COLLADA 1.5
§instance_rigid_body). Modellers scale nodes all the same, and mean what is then seen. The scale
is pushed along the nodes, through translations and what else commutes with it, until it stands in
a node of its own around what is shown, which looks as before; the body's node is rigid then. What
cannot be written so stays as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from lxml import etree

from colladaphy.conform import body_rules
from colladaphy.conform.context import NS, Context, append, insert, local, remove
from colladaphy.conform.conventions.places import Places
from colladaphy.conform.frames import TRANSFORMS, Matrix, floats_of
from colladaphy.conform.scaled_bodies import Scaling, can_scale, scale_body
from colladaphy.conform.solids import are_usable

__all__ = ["apply_scales"]

_NOISE = 1e-6
_INSTANCES = ("instance_camera", "instance_controller", "instance_geometry", "instance_light",
              "instance_node", "node")  # fmt: skip


@dataclass(slots=True)
class _Tree:
    """A top node with the bodies' nodes below it, and the factors at the end of each node."""

    top: etree._Element
    factors: dict[etree._Element, Matrix] = field(default_factory=dict)
    fault: str | None = None


class _Chains:
    """The nodes above the nodes of bodies, these included; a node instanced once hangs there."""

    def __init__(self, context: Context, nodes: list[etree._Element]) -> None:
        uses: dict[etree._Element, list[etree._Element]] = {}
        for instance in context.all("instance_node"):
            node, holder = context.by_url(instance.get("url")), instance.getparent()
            if node is not None and holder is not None and local(holder) == "node":
                uses.setdefault(node, []).append(instance)
        self._use = {}
        for node, found in uses.items():
            library = node.getparent()
            if len(found) == 1 and library is not None and local(library) == "library_nodes":
                self._use[node] = found[0]
        self._linked = {use: node for node, use in self._use.items()}
        self.tops: dict[etree._Element, etree._Element] = {}
        """The top node above every node of the chains."""
        for node in nodes:
            self._climb(node)

    def _climb(self, node: etree._Element) -> None:
        path = {node: None}
        top = node
        while top not in self.tops and (above := self._above(top)) is not None:
            if above in path:
                break
            path[above] = None
            top = above
        self.tops.update(dict.fromkeys(path, self.tops.get(top, top)))

    def _above(self, node: etree._Element) -> etree._Element | None:
        use = self._use.get(node)
        parent = node.getparent() if use is None else use.getparent()
        return parent if parent is not None and local(parent) == "node" else None

    def below(self, node: etree._Element) -> dict[etree._Element, etree._Element]:
        """The next nodes of the chains, by the child that holds each: a node or its instance."""
        found = {}
        for child in node.iterchildren(NS + "node", NS + "instance_node"):
            inner = self._linked.get(child, child)
            if inner in self.tops:
                found[child] = inner
        return found


def apply_scales(context: Context) -> None:
    """Take the scales of bodies' nodes into their shapes, mass frames and attachments."""
    users = _users(context)
    chains = _Chains(context, [node for _, _, node in users])
    if not any(child.tag in _SCALING for node in chains.tops for child in node):
        return
    trees = {}
    for top in dict.fromkeys(chains.tops.values()):
        tree = trees[top] = _Tree(top)
        try:
            _factors(tree, chains)
        except ValueError as error:
            tree.fault = str(error)
    places = Places(context)
    bodies: dict[etree._Element, list[tuple[_Tree, etree._Element, etree._Element]]] = {}
    for user, body, node in users:
        bodies.setdefault(body, []).append((trees[chains.tops[node]], user, node))
    # What cannot be scaled keeps the others of its tree from it, too.
    while sum(_judge(context, body, found, places) for body, found in bodies.items()):
        pass
    _rewrite(context, list(trees.values()), bodies, chains)


_SCALING = {NS + "scale", NS + "matrix"}


def _users(context: Context) -> list[tuple[etree._Element, etree._Element, etree._Element]]:
    """Instances of bodies, their bodies and nodes, where all are in this document."""
    found = []
    for instance in context.all("instance_physics_model"):
        model = context.by_url(instance.get("url"))
        if model is None or local(model) != "physics_model":
            continue
        bodies = {body.get("sid"): body for body in model.iterchildren(NS + "rigid_body")}
        for user in instance.iterchildren(NS + "instance_rigid_body"):
            body, node = bodies.get(user.get("body")), context.by_url(user.get("target"))
            if body is not None and node is not None and local(node) == "node":
                found.append((user, body, node))
    return found


def _is_one(factor: Matrix) -> bool:
    return bool(np.all(np.abs(factor - 1.0) < _NOISE))


def _is_uniform(factor: Matrix) -> bool:
    return bool(np.ptp(factor) < _NOISE * np.abs(factor).max())


def _factors(tree: _Tree, chains: _Chains) -> None:
    """The scale at the end of each node; ValueError where it does not go through a transform."""
    waiting = [(tree.top, np.ones(3))]
    while waiting:
        node, factor = waiting.pop()
        for step in node:
            if local(step) in TRANSFORMS:
                factor = _through(step, factor)[0]
        tree.factors[node] = factor
        waiting.extend((inner, factor) for inner in chains.below(node).values())


def _through(step: etree._Element, factor: Matrix) -> tuple[Matrix, list[float] | None]:
    """The scale after a transform when it was `factor` before, and the transform without it.

    None stands for a scale, which goes altogether.
    """
    name, values = local(step), np.asarray(floats_of(step))
    if not are_usable(values.tolist()):
        raise ValueError(f"<{name}> holds numbers that cannot be computed with")
    if name == "scale" and len(values) == 3:
        if np.any(values == 0.0):
            raise ValueError("a scale is zero")
        return factor * values, None
    if name == "translate":
        return factor, list(factor * values)
    if name == "matrix" and len(values) == 16:
        return _through_matrix(values.reshape(4, 4), factor)
    if name == "skew":
        raise ValueError("a <skew> is no scale")
    if not _is_uniform(factor):
        raise ValueError(f"the scale {_words(factor)} is not the same in all directions of a turn")
    if name == "lookat" and not _is_one(factor):
        return factor, [*(factor[0] * values[:6]), *values[6:]]
    return factor, list(values)


def _through_matrix(matrix: Matrix, factor: Matrix) -> tuple[Matrix, list[float]]:
    linear = matrix[:3, :3]
    sizes = np.sqrt(np.einsum("ij,ij->j", linear, linear))
    gram = linear.T @ linear
    if np.any(sizes == 0.0) or np.abs(gram - np.diag(np.diag(gram))).max() > 1e-5 * gram.max():
        raise ValueError("a <matrix> skews, or has no volume")
    if np.linalg.det(linear) < 0.0:  # a mirror in all directions goes through any turn
        sizes = -sizes if np.ptp(sizes) < _NOISE * sizes.max() else sizes * (-1.0, 1.0, 1.0)
    sizes = np.where(np.abs(sizes - 1.0) < _NOISE, 1.0, sizes)
    if not _is_uniform(factor):
        raise ValueError(f"the scale {_words(factor)} is not the same in all directions of a turn")
    rigid = matrix.copy()
    rigid[:3, :3] = linear / sizes
    rigid[:3, 3] = factor * matrix[:3, 3]
    return factor * sizes, rigid.ravel().tolist()


def _judge(
    context: Context,
    body: etree._Element,
    found: list[tuple[_Tree, etree._Element, etree._Element]],
    places: Places,
) -> bool:
    """Mark the trees of a body that cannot be scaled; whether one was marked."""
    if all(tree.fault is not None for tree, _, _ in found):
        return False
    fault = next((tree.fault for tree, _, _ in found if tree.fault is not None), None)
    if fault is None:
        factors = [tree.factors[node] for tree, _, node in found]
        holders = [body, *(user for _, user, _ in found)]
        if not all(np.allclose(factor, factors[0], rtol=1e-6, atol=0) for factor in factors):
            fault = "its instances have different scales"
        elif any(
            not _is_seen(places, node, f) for (_, _, node), f in zip(found, factors, strict=True)
        ):
            fault = "an instance of its node is scaled"
        elif not _is_one(factors[0]):
            fault = can_scale(context, holders, factors[0])
    if fault is None:
        return False
    for tree, _, _ in found:
        tree.fault = tree.fault or fault
    return True


def _is_seen(places: Places, node: etree._Element, factor: Matrix) -> bool:
    """Whether nothing scales the node but what stands above it in its own tree."""
    place = places.of(node)
    if place is None:
        return False
    volume = abs(float(np.linalg.det(place.shown[:3, :3])))
    return bool(np.isclose(volume, abs(float(np.prod(factor))), rtol=1e-4, atol=0.0))


def _rewrite(
    context: Context,
    trees: list[_Tree],
    bodies: dict[etree._Element, list[tuple[_Tree, etree._Element, etree._Element]]],
    chains: _Chains,
) -> None:
    scaling = Scaling(context)
    factors: dict[etree._Element, Matrix] = {}
    for body, found in bodies.items():
        tree, _, node = found[0]
        factor = tree.factors.get(node)
        if tree.fault is not None or factor is None or _is_one(factor):
            continue  # who loads the document says what it does with a scale
        if context.wants(body_rules.SCALED):
            factors[node] = factor
            scale_body(scaling, body, [user for _, user, _ in found], factor)
            message = (
                f"the node of rigid_body {body.get('sid')!r} was scaled by {_words(factor)}; its "
                "shapes, mass frame and attachments are now, and the node is rigid"
            )
            context.note(body_rules.SCALED, body, message)
    scaling.scale_attachments({body: found[0][2] for body, found in bodies.items()}, factors)
    for tree in trees:
        if tree.fault is None and any(node in factors for node in tree.factors):
            _push(context, tree.top, chains)


def _push(context: Context, top: etree._Element, chains: _Chains) -> None:
    """Move the scales of a tree behind the transforms of each node, and into what it shows."""
    waiting = [(top, np.ones(3))]
    while waiting:
        node, factor = waiting.pop()
        factor, scales = _through_node(context, node, factor)
        chain = chains.below(node)
        below = [child for child in node if local(child) in _INSTANCES and child not in chain]
        if below and not _is_one(factor):
            if len(scales) == 1 and np.array_equal(factor, floats_of(scales[0])):
                scale = scales[0]
            else:
                scale = context.make("scale")
                context.write(scale, factor.tolist())
            inner = context.make("node")
            inner.append(scale)
            at = next((i for i, c in enumerate(node) if local(c) in ("node", "extra")), len(node))
            insert(node, at, inner)
            for child in below:
                remove(child)
                append(inner, child)
        waiting.extend((inner, factor) for inner in chain.values())


def _through_node(
    context: Context, node: etree._Element, factor: Matrix
) -> tuple[Matrix, list[etree._Element]]:
    """Take the scales out of the transforms of a node; what is behind them, and the scales."""
    scales = []
    for step in [child for child in node if local(child) in TRANSFORMS]:
        before = factor
        factor, values = _through(step, factor)
        if values is None:
            scales.append(step)
        elif not (_is_one(before) and _is_one(factor / before)):
            context.write(step, values)
    for step in scales:
        remove(step)
    return factor, scales


def _words(factor: Matrix) -> str:
    parts = [f"{value:.6g}" for value in factor.tolist()]
    return parts[0] if len(set(parts)) == 1 else " ".join(parts)

"""Nodes that bodies move: alone, in one place, and rigid (COLLADA 1.5 §instance_rigid_body)."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among, distinct, numbered
from colladaphy.links.affine import skew_matrix, stretch_of
from colladaphy.links.rules import NOT_RIGID, SEVERAL_PLACES
from colladaphy.links.steps import matrix_of, own_transforms
from colladaphy.meaning import link_rules, physics_rules
from colladaphy.meaning.attachments import ends
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.context import Context, FloatRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import Nodes, nodes_of, odd_transforms
from colladaphy_schema.scene_columns import NodeTypeRows

__all__ = ["CHECKS", "doubtful"]

Array = NDArray[Any]


def rigid(context: Context) -> Iterator[Hit]:
    """Transforms above bodies that scale, skew or mirror."""
    odd = odd_transforms(context)
    if not odd:
        return
    nodes = nodes_of(context)
    users: defaultdict[int, list[int]] = defaultdict(list)
    parents = {
        reference.element: context.target(reference.text)
        for reference in context.references("parent", "instance_physics_model")
    }
    for instance, target in [*nodes.targets.items(), *parents.items()]:
        if target not in nodes.parents:
            continue
        mine = [element for node in nodes.chain(target) for element in odd.get(node, ())]
        if len(mine) > 1 and _cancels(context, nodes, target):
            continue
        for element in mine:
            users[element].append(instance)
    several = Counter(int(context.parent[element]) for element in users)
    told: set[int] = set()
    for element, instances in users.items():
        place = int(context.parent[element])
        if place in told:  # all transforms of a node are one
            continue
        told.add(place)
        done = stretch_of(_matrix(context, element))
        message = f"The {context.name(element)} of {context.label(place)} {done}, and a body "
        message += "stands in it."
        if several[place] > 1:
            message += f" {several[place] - 1} more transforms of the node are not rigid."
        yield Hit(NOT_RIGID, element, message, (*instances[:3], *_bodies(context, instances[:3])))


def _bodies(context: Context, instances: list[int]) -> list[int]:
    """The rigid bodies that elements are instances of."""
    bodies = bodies_of(context)
    rows = [bodies.body[row] for row in map(bodies.row, instances) if row >= 0]
    return [int(bodies.elements[row]) for row in rows if row >= 0]


def _matrix(context: Context, element: int) -> Array:
    """The transform (4, 4) that a <matrix>, <scale> or <skew> is."""
    name = context.name(element)
    values = context.at(FloatRows, np.array([element])).value.values.reshape(-1)
    if name == "matrix":
        return np.asarray(values.reshape(4, 4))
    if name == "skew":
        return np.array(skew_matrix(values.tolist()))
    return np.diag([*values.tolist(), 1.0])


def _cancels(context: Context, nodes: Nodes, target: int) -> bool:
    """Whether several transforms make a rigid one together."""
    made = np.eye(4)
    for node in reversed(nodes.chain(target)):
        own = own_transforms(context.at(NodeTypeRows, np.array([node])))
        made = made @ (own.matrices[0] if own.matrices else matrix_of(own.poses)[0])
    inner = made[:3, :3]
    same = np.abs(inner.T @ inner - np.eye(3)).max() <= 1e-4
    return bool(same and np.linalg.det(inner) > 0.0)


def placed(context: Context) -> Iterator[Hit]:
    """Bodies whose nodes stand in several places, within each other, or are not theirs alone."""
    shared: dict[tuple[int, int], list[Hit]] = {}
    for hit in context.shared(_placed):
        if hit.rule is not physics_rules.NODE_SHARED:
            yield hit
            continue
        first, own = (int(context.parent[each]) for each in (hit.related[0], hit.element))
        # Within one instance of a model, each body is a fault of its own.
        shared.setdefault((first, own if own != first else -hit.element), []).append(hit)
    for hits in shared.values():
        more = f" {len(hits) - 1} more bodies of this model's instance are so."
        yield replace(hits[0], message=hits[0].message + (more if len(hits) > 1 else ""))


def doubtful(context: Context) -> set[int]:
    """Instances of bodies of which it cannot be told where they stand, as is told already."""
    found = {hit.element for hit in context.shared(_placed)}
    # Which of two bodies a node is the other's is not known.
    return found | {hit.related[0] for hit in context.shared(_placed)
                    if hit.rule is physics_rules.NODE_SHARED}  # fmt: skip


def _placed(context: Context) -> list[Hit]:
    return [*_several(context), *_apart(context)]


def _several(context: Context) -> Iterator[Hit]:
    """Bodies whose nodes stand in several places."""
    nodes = nodes_of(context)
    if not nodes.holders:
        return
    for instance, target in nodes.targets.items():
        if target >= 0 and (count := nodes.places(target)) > 1:
            message = f"{context.label(target)} stands in {count} places; the first one is taken."
            yield Hit(SEVERAL_PLACES, instance, message, (target,), "target")


def _apart(context: Context) -> Iterator[Hit]:
    """Bodies that move the same node, or nodes within each other."""
    nodes, bodies = nodes_of(context), bodies_of(context)
    instances = nodes.instances
    if not len(instances):
        return
    above = _scenes_of(context, instances)
    alone = not nodes.holders and not nodes.are_nested
    if alone:
        # Nearly always every body has a node of its own.
        keys = (above * len(context.parent) + nodes.moved)[nodes.moved >= 0]
        if len(distinct(keys)) == len(keys):
            return
    scenes = above.tolist()
    twice = {hit.element for hit in ends(context)}
    movers: dict[tuple[int, int], int] = {}
    for instance, scene in zip(instances.tolist(), scenes, strict=True):
        target = nodes.targets[instance]
        if target < 0:
            continue
        first = movers.setdefault((scene, target), instance)
        if first != instance and instance not in twice:
            message = f"{context.label(target)} is moved by another body, too."
            yield Hit(physics_rules.NODE_SHARED, instance, message, (first, target), "target")
    if alone:
        return
    for instance, scene in zip(instances.tolist(), scenes, strict=True):
        target = nodes.targets[instance]
        if target < 0:
            continue
        for node in nodes.chain(target)[1:]:
            outer = movers.get((scene, node))
            row = -1 if outer is None else bodies.row(outer)
            if outer is not None and bodies.moves[row] and bodies.body[row] >= 0:
                message = (
                    f"{context.label(target)} stands in {context.label(node)}, which another "
                    "body moves."
                )
                yield Hit(physics_rules.BODIES_NESTED, instance, message, (outer, target), "target")
                break


def _scenes_of(context: Context, instances: Array) -> Array:
    """The scene or model (n,) that instances of bodies stand in.

    What stands in a model that is instanced once, and that in a scene, stands in that scene.
    """
    above = context.ancestor(instances, "physics_scene", "physics_model")
    inner = context.led("instance_physics_model", "url")
    holders = context.ordinals("instance_physics_model")[inner >= 0]
    inner = inner[inner >= 0]
    first, which = numbered(inner)
    once = first[np.bincount(which) == 1]
    if not are_among(above, inner[once]).any():
        return above
    outer = context.ancestor(holders[once], "physics_scene", "physics_model")
    around = dict(zip(inner[once].tolist(), outer.tolist(), strict=True))
    found = []
    for model in above.tolist():
        known: set[int] = set()
        while model in around and model not in known:
            known.add(model)
            model = around[model]
        found.append(model)
    return np.array(found, np.int64)


def nowhere(context: Context) -> Iterator[Hit]:
    """Bodies of scenes in effect whose nodes are in no visual scene that is seen.

    A document without any visual scene is for physics alone.
    """
    nodes = nodes_of(context)
    if not nodes.shown:
        return
    doubtful = (nodes.moved >= 0) & ~are_among(context.parent[nodes.moved], nodes.shown)
    lost = [
        (instance, target)
        for instance, target in zip(
            nodes.instances[doubtful].tolist(), nodes.moved[doubtful].tolist(), strict=True
        )
        if not nodes.places(target)
    ]
    if not lost:
        return
    active = set(context.led("instance_physics_scene", "url").tolist())
    scenes = context.ancestor(np.array([instance for instance, _ in lost]), "physics_scene")
    lent = context.ancestor(np.array([target for _, target in lost]), "library_nodes") >= 0
    # An instance that leads nowhere, which is told, may be that of any node in a library.
    lent &= any(
        reference.text.strip().find("#") <= 0
        for reference in context.doubtful("instance_node", "url", ("node",))
    )
    for (instance, target), scene, doubt in zip(lost, scenes.tolist(), lent.tolist(), strict=True):
        if scene in active and not doubt:
            message = f"{context.label(target)} stands in no visual scene that is instanced."
            yield Hit(link_rules.NODE_NOWHERE, instance, message, (target,), "target")


CHECKS = (rigid, placed, nowhere)

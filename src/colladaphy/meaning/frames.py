"""Attachment frames at time 0: within the limits of their constraint (COLLADA 1.5 §attachment)."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses, rotate_vectors
from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.constraint_table import Constraints, constraints_of, limits_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.models import parts_of
from colladaphy.meaning.node_table import nodes_of, unclear_nodes
from colladaphy.meaning.nodes import doubtful
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


_GAP = 5e-3
"""How far frames may be apart, by the distances that are involved."""
_ANGLE = 2.0
"""Degrees that they may be turned too far."""


class _Placed:
    """Where the instances of those bodies stand that constraints hold."""

    def __init__(self, context: Context) -> None:
        nodes, bodies = nodes_of(context), bodies_of(context)
        instances = context.ordinals("instance_rigid_body").astype(np.int64)
        mine = bodies.body[np.searchsorted(bodies.elements, instances)]
        held = np.isin(mine, constraints_of(context).bodies) & (mine >= 0)
        instances, mine = instances[held], mine[held]
        odd = unclear_nodes(context)
        targets = [nodes.targets.get(element, -1) for element in instances.tolist()]
        unknown = doubtful(context)
        self.known = np.array(
            [
                target >= 0
                and element not in unknown
                and not (odd and odd & set(nodes.chain(target)))
                for element, target in zip(instances.tolist(), targets, strict=True)
            ],
            np.bool_,
        )
        """Of which instances it can be told where they stand."""
        models = context.parent[instances].tolist()
        parents = {r.element: context.target(r.text) if r.text.strip() else -2
                   for r in context.references("parent", "instance_physics_model")}  # fmt: skip
        around = [parents.get(model, -2) for model in models]
        self.parents = parents
        self.context = context
        poses = self.of_nodes(np.array(targets, np.int64))
        outer = self.of_nodes(np.array(around, np.int64))
        free = [
            parent >= 0 and (target < 0 or parent not in nodes.chain(target))
            for parent, target in zip(around, targets, strict=True)
        ]
        rows = np.flatnonzero(free)
        poses.put(rows, outer.take(rows).then(poses.take(rows)))
        self.poses = poses
        self.by_model: defaultdict[tuple[int, int], list[int]] = defaultdict(list)
        """Instances by the instance of the model, and the row of the body."""
        for row, key in enumerate(zip(models, mine.tolist(), strict=True)):
            self.by_model[key].append(row)

    def of_nodes(self, elements: Array) -> Poses:
        """World poses of nodes; those that are not there, or in a circle, are not moved."""
        poses = Poses.none(len(elements))
        placement = self.context.placement
        there = np.flatnonzero(elements >= 0)
        rows = placement.nodes.rows_of(0, elements[there])
        good = rows >= 0
        there, rows = there[good], rows[good]
        if len(rows):
            found, _ = placement.poses(rows)
            poses.put(there, found)
        return poses


def _freed(low: Array, high: Array) -> tuple[Array, Array]:
    """The same limits, infinite where they are the idiom of a free axis, or faulty."""
    free = ~(low <= high)
    return np.where(free, -np.inf, low), np.where(free, np.inf, high)


def frames(context: Context) -> Iterator[Hit]:
    """Joints whose frames are apart, or turned too far."""
    references = context.references("constraint", "instance_rigid_constraint")
    if not references:
        return
    table = constraints_of(context)
    pairs = list(_pairs(context, table, [(r.element, r.text) for r in references]))
    if not pairs:
        return
    placed = context.shared(_Placed)
    rows = np.array([row for row, _, _ in pairs])
    sides = []
    for side in (0, 1):
        mine = np.array([pair[1 + side] for pair in pairs])
        outer = Poses.none(len(pairs))
        there = np.flatnonzero(mine >= 0)
        outer.put(there, placed.poses.take(mine[there]))
        sides.append((outer, outer.then(table.frames[side].take(rows))))
    (one, first), (two, second) = sides
    between = first.inverse().then(second)
    low, high = (column[rows] for column in _freed(*limits_of(context, "linear")))
    gap = np.linalg.norm(
        np.maximum(np.maximum(low - between.positions, between.positions - high), 0.0), axis=1
    )
    size = np.max([
        np.linalg.norm(one.positions - two.positions, axis=1),
        *(np.linalg.norm(table.frames[side].positions[rows], axis=1) for side in (0, 1)),
    ], axis=0)  # fmt: skip
    told: set[int] = set()
    for place in np.flatnonzero(gap > _GAP * size).tolist():
        row = int(rows[place])
        if row in told:
            continue
        told.add(row)
        message = (
            f"The frames of {context.label(int(table.elements[row]))} are {gap[place]:.3g} further "
            "apart at time 0 than its limits allow."
        )
        yield Hit(physics_rules.FRAMES_APART, int(table.attachments[row, 1]), message,
                  (int(table.attachments[row, 0]),))  # fmt: skip
    low, high = (column[rows] for column in _freed(*limits_of(context, "swing_cone_and_twist")))
    for place, excess in _turned(between.orientations, low, high):
        row = int(rows[place])
        if row in told:
            continue
        told.add(row)
        message = (
            f"The frames of {context.label(int(table.elements[row]))} are turned {excess:.3g} "
            "degrees further at time 0 than its limits allow."
        )
        yield Hit(physics_rules.FRAMES_TURNED, int(table.attachments[row, 1]), message,
                  (int(table.attachments[row, 0]),))  # fmt: skip


def _turned(orientations: Array, low: Array, high: Array) -> Iterator[tuple[int, float]]:
    """Rows that are turned further than their limits allow in any order of angles, and how far."""
    bound = np.maximum(np.abs(low), np.abs(high))
    free = ~(bound < 180.0)
    count = free.sum(axis=1)
    opened = (bound > 0.0).sum(axis=1)
    whole = np.degrees(2.0 * np.arccos(np.minimum(np.abs(orientations[:, 0]), 1.0)))
    for place in np.flatnonzero(count <= 1).tolist():
        if count[place] == 0 and opened[place] != 1:
            excess = whole[place] - float(bound[place].sum())
        else:
            # How far the only axis that turns, or that is free, swings away from itself.
            axis = int(np.argmax(bound[place]))
            unit = np.eye(3)[axis][None]
            turned = rotate_vectors(orientations[place : place + 1], unit)[0]
            swing = math.degrees(math.acos(min(max(float(turned[axis]), -1.0), 1.0)))
            excess = swing - float(np.delete(bound[place], axis).sum())
            if not free[place, axis]:
                excess = max(excess, whole[place] - swing - float(bound[place, axis]))
        if excess > _ANGLE:
            yield place, excess


def _pairs(
    context: Context, table: Constraints, instances: list[tuple[int, str]]
) -> Iterator[tuple[int, int, int]]:
    """Constraints in effect with the instances of bodies at their ends, -1 for the world."""
    parts, home = context.shared(parts_of), context.resource
    placed = context.shared(_Placed)
    at = {element: row for row, element in enumerate(table.elements.tolist())}
    disabled, faulty = _disabled(context), unclear_nodes(context)
    for element, name in instances:
        instance = int(context.parent[element])
        model = parts.model(home, instance)
        if model is None or model[0] is not home:
            continue
        constraint = parts.named(*model, "rigid_constraint", name.rpartition("/")[2])
        row = -1 if constraint is None else at.get(constraint, -1)
        if row < 0 or row in disabled:
            continue
        ends = []
        nested = context.name(int(context.parent[instance])) == "physics_model"
        for side in (0, 1):
            body = int(table.bodies[row, side])
            if body < 0:
                # The world is at rest, but a model in a model may stand anywhere.
                ends.append(-1 if not table.references[row][side] and not nested else -2)
                continue
            found = placed.by_model.get((instance, body), [])
            ends.append(found[0] if len(found) == 1 and placed.known[found[0]] else -2)
        if table.attachments[row, 0] in faulty or table.attachments[row, 1] in faulty:
            continue  # where its frames are cannot be told
        if -2 not in ends and ends != [-1, -1] and ends[0] != ends[1]:
            yield row, ends[0], ends[1]


def _disabled(context: Context) -> set[int]:
    rows = context.rows(Rows, "rigid_constraint")
    common = context.children(rows, "technique_common", Rows)
    enabled, _ = context.flags(common, "enabled", True)
    return set(common.owner[~enabled].tolist())


CHECKS = (frames,)

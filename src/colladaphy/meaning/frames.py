"""Attachment frames at time 0: within the limits of their constraint (COLLADA 1.5 §attachment)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among
from colladaphy.links.poses import Poses, rotate_vectors
from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.comparing import matched
from colladaphy.meaning.constraint_table import Constraints, constraints_of, limits_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.models import instanced_constraints
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
        held = are_among(mine, constraints_of(context).bodies) & (mine >= 0)
        instances, mine = instances[held], mine[held]
        odd = unclear_nodes(context)
        targets = nodes.moved_by(instances)
        self.known: Array = (targets >= 0) & ~are_among(instances, doubtful(context))
        """Of which instances it can be told where they stand."""
        if odd:
            self.known[self.known] = [not odd & set(nodes.chain(target))
                                      for target in targets[self.known].tolist()]  # fmt: skip
        models = context.parent[instances].astype(np.int64)
        parents = {r.element: context.target(r.text) if r.text.strip() else -2
                   for r in context.references("parent", "instance_physics_model")}  # fmt: skip
        self.context = context
        poses = self.of_nodes(targets)
        if parents:
            around = np.array([parents.get(model, -2) for model in models.tolist()], np.int64)
            rows = np.array([
                row for row in np.flatnonzero(around >= 0).tolist()
                if targets[row] < 0 or around[row] not in nodes.chain(int(targets[row]))
            ], np.int64)  # fmt: skip
            poses.put(rows, self.of_nodes(around[rows]).then(poses.take(rows)))
        self.poses, self.elements = poses, instances
        keys = models * len(bodies.elements) + mine
        self._order = np.argsort(keys, kind="stable")
        self._keys = keys[self._order]

    def of_bodies(self, models: Array, bodies: Array) -> Array:
        """The instances (n,) of bodies in instances of models; -1 where not exactly one is known.

        Bodies are those of the table.
        """
        wanted = models * len(bodies_of(self.context).elements) + bodies
        first, last = (np.searchsorted(self._keys, wanted, side=side) for side in ("left", "right"))
        made = np.full(len(wanted), -1, np.int64)
        one = np.flatnonzero((last - first == 1) & (bodies >= 0))
        found = self._order[first[one]]
        made[one] = np.where(self.known[found], found, -1)
        return made

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
    if not len(context.ordinals("instance_rigid_constraint")):
        return
    table = constraints_of(context)
    rows, instances = _pairs(context, table)
    if not len(rows):
        return
    placed = context.shared(_Placed)
    sides = []
    for side in (0, 1):
        mine = instances[:, side]
        outer = Poses.none(len(rows))
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
    told: dict[int, tuple[int, Hit]] = {}
    for place in np.flatnonzero(gap > _GAP * size).tolist():
        row = int(rows[place])
        if row in told:
            continue
        message = (
            f"The frames of {context.label(int(table.elements[row]))} are {gap[place]:.3g} further "
            "apart at time 0 than its limits allow."
        )
        beside = _beside(table, placed, row, instances[place])
        told[row] = place, Hit(physics_rules.FRAMES_APART, int(table.attachments[row, 1]),
                               message, beside)  # fmt: skip
    low, high = (column[rows] for column in _freed(*limits_of(context, "swing_cone_and_twist")))
    for place, excess in _turned(between.orientations, low, high):
        row = int(rows[place])
        if row in told:
            continue
        message = (
            f"The frames of {context.label(int(table.elements[row]))} are turned {excess:.3g} "
            "degrees further at time 0 than its limits allow."
        )
        beside = _beside(table, placed, row, instances[place])
        told[row] = place, Hit(physics_rules.FRAMES_TURNED, int(table.attachments[row, 1]),
                               message, beside)  # fmt: skip
    if told:
        yield from _by_bodies(instances, dict(told.values()))


def _beside(table: Constraints, placed: _Placed, row: int, ends: Array) -> tuple[int, ...]:
    """The other attachment of a joint, the instances of the bodies that it holds, their nodes."""
    instances = placed.elements[ends[ends >= 0]].tolist()
    nodes = [nodes_of(placed.context).targets[instance] for instance in instances]
    return (int(table.attachments[row, 0]), *instances, *(node for node in nodes if node >= 0))


def _by_bodies(instances: Array, told: dict[int, Hit]) -> Iterator[Hit]:
    """What is told of joints between instances (n, 2), by their places in these.

    Where all joints of a body, which are several, are so, it is the body that stands elsewhere,
    and it is told once.
    """
    everywhere = np.bincount(instances[instances >= 0])
    mine = instances[list(told)]
    here = np.bincount(mine[mine >= 0], minlength=len(everywhere))
    joints = np.append(np.where((here == everywhere) & (here > 1), here, 0), 0)
    groups: dict[tuple[bool, int], list[Hit]] = {}
    for place, hit in told.items():
        ends = instances[place]
        end = int(ends[joints[ends].argmax()])
        key = (True, end) if joints[end] else (False, place)
        groups.setdefault(key, []).append(hit)
    for hits in groups.values():
        more = f" So are those of {len(hits) - 1} more joints of its bodies."
        yield replace(hits[0], message=hits[0].message + (more if len(hits) > 1 else ""))


def _turned(orientations: Array, low: Array, high: Array) -> Iterator[tuple[int, float]]:
    """Rows that are turned further than their limits allow in any order of angles, and how far."""
    bound = np.maximum(np.abs(low), np.abs(high))
    free = ~(bound < 180.0)
    whole = np.degrees(2.0 * np.arccos(np.minimum(np.abs(orientations[:, 0]), 1.0)))
    # How far the only axis that turns, or that is free, swings away from itself.
    axis = bound.argmax(axis=1)
    there = np.arange(len(axis))
    own, others = bound[there, axis], bound.copy()
    others[there, axis] = 0.0
    turned = rotate_vectors(orientations, np.eye(3)[axis])[there, axis]
    swing = np.degrees(np.arccos(np.clip(turned, -1.0, 1.0)))
    excess = swing - others.sum(axis=1)
    bounded = ~free[there, axis]
    excess[bounded] = np.maximum(excess, whole - swing - own)[bounded]
    several = ~free.any(axis=1) & ((bound > 0.0).sum(axis=1) != 1)
    excess[several] = (whole - bound.sum(axis=1))[several]
    for place in np.flatnonzero((free.sum(axis=1) <= 1) & (excess > _ANGLE)).tolist():
        yield place, float(excess[place])


def _pairs(context: Context, table: Constraints) -> tuple[Array, Array]:
    """Constraints in effect (n,), and the instances of bodies (n, 2) at their ends.

    -1 is the world; those with ends of which nothing is known are left out.
    """
    placed, used = context.shared(_Placed), instanced_constraints(context)
    mine, rows = matched(table.elements, used.parts)
    faulty = are_among(table.attachments[rows], unclear_nodes(context)).any(axis=1)
    good = ~(faulty | _disabled(context)[rows])
    mine, rows = mine[good], rows[good]
    # The world is at rest, but a model in a model may stand anywhere.
    nested = context.is_within(used.around[mine], "physics_model")
    good = np.ones(len(rows), np.bool_)
    ends = np.full((len(rows), 2), -1, np.int64)
    for side in (0, 1):
        bodies = table.bodies[rows, side]
        ends[:, side] = placed.of_bodies(used.around[mine], bodies)
        good &= (ends[:, side] >= 0) | ((bodies < 0) & table.are_world[rows, side] & ~nested)
    good &= ends[:, 0] != ends[:, 1]
    return rows[good], ends[good]


def _disabled(context: Context) -> Array:
    """Which constraints (n,) are out of effect."""
    rows = context.rows(Rows, "rigid_constraint")
    common = context.children(rows, "technique_common", Rows)
    enabled, _ = context.flags(common, "enabled", True)
    made = np.zeros(len(rows), np.bool_)
    made[common.owner] = ~enabled
    return made


CHECKS = (frames,)

"""Where the nodes of bodies have to stand, so that the bodies stand where a World has them.

A node is moved by its own transforms; all that is in it, visuals and nodes, moves with it. So the
nodes of other bodies within it are placed anew too, each in the frame of what is above it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses, unit_quaternions
from colladaphy.links.steps import matrix_of, product, rigid_parts
from colladaphy.mapper import Loaded

__all__ = ["Places", "Wishes", "places_of"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Rows = NDArray[np.int64]

_PASSES = 8


@dataclass(slots=True)
class Places:
    """What to do with the nodes of bodies, n rows as the bodies are."""

    moved: Bools
    """Whose node gets other transforms: steps before its own, if these are kept."""
    own: Bools
    """Who get a node of their own, as theirs is not to be moved for them."""
    poses: Poses
    """The transforms of these nodes, for those that are poses."""
    matrices: dict[int, Floats]
    """4x4 by body, for those that are not."""
    plain: Bools
    """Whose node stands by itself and in no other frame, so that its position is the body's."""
    inner: dict[int, Floats]
    """Where what is in a node goes, 4x4 by body, where the node gets the frame of the body."""


@dataclass(slots=True)
class Wishes:
    """Where bodies shall be, and what their nodes are, n rows."""

    frames: Poses
    """Of the rigid_bodies in the world."""
    moved: Bools
    apart: Bools
    """Who get nodes of their own."""
    still: Bools
    """Who are there at all."""
    origins: Poses
    """The frames that the nodes get, in those of the rigid_bodies: the bodies', or the same."""
    kept: dict[int, Floats]
    """The bodies whose nodes keep their steps, and what stands before these already, 4x4."""


def places_of(loaded: Loaded, wishes: Wishes) -> Places:
    """Place the nodes of bodies that moved, and of those within their nodes."""
    return _Placing(loaded, wishes).places()


class _Placing:
    def __init__(self, loaded: Loaded, wishes: Wishes) -> None:
        found = loaded.bodies.found
        self._loaded, self._wanted, self._wishes = loaded, wishes.frames, wishes
        self._placement = loaded.tables.placement
        self._nodes: Rows = np.where(wishes.still, found.nodes, -1)
        self._chains: Rows = loaded.expansion.chains[found.models]
        self._above: Rows = self._placement.above()
        self._own = self._placement.own()
        there = self._nodes >= 0
        uses = np.bincount(self._nodes[there], minlength=len(self._above))
        others = _other_targets(loaded)
        uses += np.bincount(others, minlength=len(uses))[: len(uses)]
        shared = self._placement.shared()
        homes = self._placement.nodes.homes(np.maximum(self._nodes, 0))
        self._movable = there & ~wishes.apart & (homes == 0)
        self._movable[there] &= (uses[self._nodes[there]] == 1) & ~shared[self._nodes[there]]
        self._dirty = self._with_inner(wishes.moved)

    def _with_inner(self, moved: Bools) -> Bools:
        """Those that moved, and those whose nodes would be taken along."""
        above, chains = self._above, self._chains
        parents, outer = self._loaded.expansion.parent_nodes, self._loaded.expansion.parent_chains
        dirty = moved.copy()
        if not (np.any(above >= 0) or np.any(chains >= 0)):
            return dirty
        there = self._nodes >= 0
        while True:
            taken = np.zeros(len(above) + 1, np.bool_)
            taken[self._nodes[dirty & self._movable]] = True
            inner = np.zeros(len(above) + 1, np.bool_)
            for rows in self._placement.levels():
                inner[rows] = inner[above[rows]] | taken[above[rows]]
            along = np.zeros(len(dirty), np.bool_)
            along[there] = inner[self._nodes[there]]
            if len(parents):
                moving = np.append(taken[parents] | inner[parents], False)
                current = chains.copy()
                while np.any(current >= 0):
                    along |= moving[current]
                    current = np.where(current >= 0, outer[current], -1)
            along &= self._wishes.still
            if not np.any(along & ~dirty):
                return dirty
            dirty |= along

    def places(self) -> Places:
        dirty = np.flatnonzero(self._dirty)
        movable = dirty[self._movable[dirty]]
        count = len(self._dirty)
        self._poses = Poses.none(count)
        self._matrices: dict[int, Floats] = {}
        self._inner: dict[int, Floats] = {}
        world = before = _Frames(*self._placement.frames())
        for _ in range(_PASSES):
            local = self._outer(world).inverse().then(self._wanted)
            again = self._pass(movable, local, before)
            settled = again.same_as(world)
            world = again
            if settled or not len(self._loaded.expansion.parent_nodes):
                break
        own = np.zeros(count, np.bool_)
        own[dirty] = ~self._movable[dirty]
        rows = np.flatnonzero(own)
        local = self._outer(world).inverse().then(self._wanted)
        self._poses.put(rows, local.then(self._wishes.origins).take(rows))
        plain = (self._chains < 0) & (self._alone() | own)
        return Places(self._dirty & self._movable, own, self._poses, self._matrices, plain,
                      self._inner)  # fmt: skip

    def _alone(self) -> Bools:
        """Whose nodes stand in no other node, and are no matrices."""
        alone = np.zeros(len(self._nodes), np.bool_)
        there = np.flatnonzero(self._movable)
        rows = self._nodes[there]
        alone[there] = (self._above[rows] < 0) & ~self._own.affine[rows]
        alone[list(self._wishes.kept)] = False
        return alone

    def _outer(self, world: _Frames) -> Poses:
        """What the parents of instances of models do to each body."""
        count = len(self._nodes)
        expansion = self._loaded.expansion
        if not len(expansion.parent_nodes):
            return Poses.none(count)
        return expansion.node_poses(
            self._loaded.tables, self._chains, self._nodes, Poses.none(count),
            world.rigid(expansion.parent_nodes),
        )  # fmt: skip

    def _pass(self, movable: Rows, local: Poses, before: _Frames) -> _Frames:
        """Place the nodes level by level; gives the frames of all nodes after it."""
        above, own = self._above, self._own
        body_of = np.full(len(above) + 1, -1, np.int64)
        body_of[self._nodes[movable]] = movable
        world = _Frames(Poses.none(len(above)), np.zeros(len(above), np.bool_), {})
        places = np.cumsum(own.affine) - 1
        for rows in self._placement.levels():
            bodies = body_of[rows]
            set_here = bodies >= 0
            up = above[rows]
            mixed = own.affine[rows] | np.where(up >= 0, world.affine[up], False)
            rest = np.flatnonzero(~mixed)
            inner = own.poses.take(rows[rest])
            mine = np.flatnonzero(set_here[rest])
            inside = up[rest] >= 0
            outer = Poses.none(len(rest))
            outer.put(inside, world.poses.take(up[rest][inside]))
            if len(mine):
                who = bodies[rest[mine]]
                made = outer.take(mine).inverse().then(local.take(who))
                # As a reader has it, and so that lengths do not grow with the depth.
                made.orientations = unit_quaternions(made.orientations)
                self._set(who, made, inner.take(mine))
                inner.put(mine, made)
            world.poses.put(rows[rest], outer.then(inner))
            for at in np.flatnonzero(mixed).tolist():
                row, around = int(rows[at]), int(up[at])
                outside = None if around < 0 else world.matrix(around)
                if set_here[at]:
                    body = int(bodies[at])
                    total = self._total(row, body, local, before)
                    made_matrix = total if outside is None else _quotient(outside, total)
                    self._set_matrix(row, body, made_matrix, local, outside)
                elif own.affine[row]:
                    made_matrix = own.matrices[places[row]]
                else:
                    made_matrix = _matrix(own.poses, row)
                world.affine[row] = True
                world.matrices[row] = (
                    made_matrix if outside is None else product(outside, made_matrix)
                )
        return world

    def _set(self, bodies: Rows, made: Poses, before: Poses) -> None:
        """Remember the transforms of nodes, that were others `before`."""
        wishes = self._wishes
        written = made.take(np.arange(len(made))).then(wishes.origins.take(bodies))
        kept = np.array([body in wishes.kept for body in bodies.tolist()], np.bool_)
        if kept.any():
            rows = np.flatnonzero(kept)
            already, _ = rigid_parts(
                np.array([wishes.kept[body] for body in bodies[rows].tolist()])
            )
            written.put(rows, written.take(rows).then(before.take(rows).inverse()).then(already))
        self._poses.put(bodies, written)
        for place in np.flatnonzero(~wishes.origins.is_identity()[bodies]).tolist():
            body = int(bodies[place])
            self._inner[body] = _matrix(wishes.origins.inverse(), body)

    def _set_matrix(
        self, row: int, body: int, made: Floats, local: Poses, outside: Floats | None
    ) -> None:
        """The same of a node that scales, or stands in one that does."""
        wishes, own = self._wishes, self._own
        old = _matrix(own.poses, row)
        if own.affine[row]:
            old = own.matrices[int(np.cumsum(own.affine)[row]) - 1]
        framed = made
        if not wishes.origins.is_identity()[body]:
            framed = product(_matrix(local, body), _matrix(wishes.origins, body))
            framed = framed if outside is None else _quotient(outside, framed)
        already = wishes.kept.get(body)
        if already is None:
            self._matrices[body] = framed
        else:
            rigid = _matrix(rigid_parts(old[None])[0], 0)
            # With nothing around it that scales, what stands before the steps is rigid.
            way = framed if outside is not None else _matrix(rigid_parts(framed[None])[0], 0)
            before = old if outside is not None else rigid
            self._matrices[body] = product(_after(way, before), already)
            framed = product(_after(way, before), old)
        if not wishes.origins.is_identity()[body]:
            self._inner[body] = _quotient(framed, made)

    def _total(self, row: int, body: int, local: Poses, before: _Frames) -> Floats:
        """The frame that a node shall have: where it shall be, scaled as it was."""
        at = _matrix(local, body)
        old = before.matrix(row)
        rigid, exact = rigid_parts(old[None])
        if exact[0]:
            return at
        rest = _quotient(_matrix(rigid, 0), old)
        rest[:3, 3] = 0.0
        return product(at, rest)


def _other_targets(loaded: Loaded) -> Rows:
    """The nodes of bodies that are not loaded, such as those of other scenes."""
    tables, found = loaded.tables, loaded.bodies.found
    table = tables.body_instances
    left = np.setdiff1d(np.flatnonzero(table.homes(np.arange(len(table))) == 0), found.rows)
    if not len(left):
        return left
    texts = table.texts("target")
    nodes, _ = tables.pool.follow(
        tables.placement.nodes, [texts[row] for row in left.tolist()],
        np.zeros(len(left), np.int64), table.ordinals[left], "node",
    )  # fmt: skip
    return np.asarray(nodes[nodes >= 0])


class _Frames:
    """The frames of nodes in the world: poses, but for some that are matrices."""

    def __init__(self, poses: Poses, affine: Bools, matrices: dict[int, Floats]) -> None:
        self.poses, self.affine, self.matrices = poses, affine, matrices

    def matrix(self, row: int) -> Floats:
        """4x4."""
        if self.affine[row]:
            return self.matrices[row]
        return _matrix(self.poses, row)

    def rigid(self, rows: Rows) -> Poses:
        """The poses (n,) of some of them."""
        found = self.poses.take(rows)
        mixed = np.flatnonzero(self.affine[rows])
        if len(mixed):
            made, _ = rigid_parts(np.array([self.matrices[row] for row in rows[mixed].tolist()]))
            found.put(mixed, made)
        return found

    def same_as(self, other: _Frames) -> bool:
        """Whether nothing stands elsewhere."""
        return (
            np.array_equal(self.poses.positions, other.poses.positions)
            and np.array_equal(self.poses.orientations, other.poses.orientations)
            and self.matrices.keys() == other.matrices.keys()
            and all(np.array_equal(self.matrices[row], other.matrices[row])
                    for row in self.matrices)
        )  # fmt: skip


def _matrix(poses: Poses, row: int) -> Floats:
    """4x4."""
    made: Floats = matrix_of(poses.take(np.array([row])))[0]
    return made


def _after(whole: Floats, inner: Floats) -> Floats:
    """What stands before `inner` where both together are `whole`."""
    try:
        made = np.asarray(np.linalg.solve(inner.T, whole.T)).T
    except np.linalg.LinAlgError:
        made = np.asarray(np.linalg.lstsq(inner.T, whole.T)[0]).T
    made = np.ascontiguousarray(made)
    made[3] = (0.0, 0.0, 0.0, 1.0)
    return made


def _quotient(outer: Floats, whole: Floats) -> Floats:
    """What stands in a frame at `outer` and is at `whole` in the world."""
    try:
        made = np.asarray(np.linalg.solve(outer, whole))
    except np.linalg.LinAlgError:  # a frame without extent has no inverse
        made = np.asarray(np.linalg.lstsq(outer, whole)[0])
    made[3] = (0.0, 0.0, 0.0, 1.0)
    return made

"""The instances of rigid_bodies that are loaded, and what they refer to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import DocumentError
from colladaphy.links import rules as link_rules
from colladaphy.links.nodes import Sums
from colladaphy.links.pool import Table, is_unreachable
from colladaphy.links.poses import Poses, reach
from colladaphy.mapper.loading.instances import Expansion
from colladaphy.mapper.loading.tables import Tables

__all__ = ["FoundBodies", "find_bodies", "named_below"]

Array = NDArray[Any]


class FoundBodies:
    """Instances of rigid_bodies, one a row, in the order in which they are loaded."""

    def __init__(
        self, tables: Tables, expansion: Expansion, models: Array, rows: Array, bodies: Array,
        nodes: Array, poses: Poses,
    ) -> None:  # fmt: skip
        self._expansion = expansion
        self.models = models
        """(n,) the instance of the model that each belongs to."""
        self.rows = rows
        """(n,) rows of the instance_rigid_body elements."""
        self.bodies = bodies
        """(n,) rows of the rigid_body elements."""
        self.nodes = nodes
        """(n,) rows of the nodes that are their targets; -1 for none."""
        self.poses = poses
        """World poses of their nodes: of the frames of the rigid_bodies."""
        self.homes = tables.body_instances.homes(rows)
        self.body_homes = tables.bodies.homes(bodies)

    def __len__(self) -> int:
        return len(self.rows)

    def take(self, tables: Tables, rows: Array) -> FoundBodies:
        """Some of them, in that order."""
        return FoundBodies(tables, self._expansion, self.models[rows], self.rows[rows],
                           self.bodies[rows], self.nodes[rows], self.poses.take(rows))  # fmt: skip

    def reach(self, tables: Tables) -> Sums:
        """What their poses are made of: nodes, and the parents of instances of models."""
        expansion = self._expansion
        nodes = tables.placement.reach()
        sums = nodes.take(self.nodes)
        chains, parents = expansion.chains[self.models], expansion.parent_nodes
        if len(parents):
            outer, _ = tables.placement.poses(parents)
            around = nodes.take(parents)
            around.sizes += reach(outer.positions)
            around.steps += 1
            while np.any(chains >= 0):
                here = around.take(chains)
                sums.sizes += here.sizes
                sums.steps += here.steps
                chains = np.where(chains >= 0, expansion.parent_chains[chains], -1)
        return sums


def find_bodies(tables: Tables, expansion: Expansion) -> FoundBodies:
    """All instances of rigid_bodies; those with broken references are reported and left out."""
    instances, bodies = tables.body_instances, tables.bodies
    rows, models = instances.below(tables.model_instances.keys(expansion.rows))
    keys = tables.models.keys(expansion.models)
    names = _chosen(instances.texts("body", once=True), rows)
    found = named_below(bodies, keys[models], names)
    homes, origins = instances.homes(rows), instances.ordinals[rows]
    errors: dict[int, DocumentError] = {}
    for place in np.flatnonzero(found < 0).tolist():
        model = tables.models.texts("id")[int(expansion.models[models[place]])]
        home = tables.pool.resources[int(homes[place])]
        message = f"The model {model!r} has no rigid body {names[place]!r}."
        element = home.element(int(origins[place]))
        errors[place] = DocumentError(link_rules.MISSING.at(element, message, file=home.file))
    good = np.flatnonzero(found >= 0)
    wanted = instances.texts("target", once=True)
    targets = [target.strip() for target in _chosen(wanted, rows[good])]
    given = np.array([bool(target) for target in targets], np.bool_)
    nodes = np.full(len(good), -1, np.int64)
    mine = np.flatnonzero(given)
    nodes[mine], broken = tables.pool.follow(
        tables.placement.nodes, targets if given.all() else [targets[at] for at in mine.tolist()],
        homes[good[mine]], origins[good[mine]], "node",
    )  # fmt: skip
    for at, error in broken.items():
        if is_unreachable(error):  # it stands at its model's place, as without a target
            tables.resource.note_broken(error)
        else:
            errors[int(good[mine[at]])] = error
    poses = Poses.none(len(good))
    there = np.flatnonzero(nodes >= 0)
    if len(there):
        placed, circles = tables.placement.poses(nodes[there])
        poses.put(there, placed)
        for at in there.tolist() if circles else ():
            if int(nodes[at]) in circles:
                errors[int(good[at])] = circles[int(nodes[at])]
    for place in sorted(errors):
        tables.resource.note_broken(errors[place])
    poses = expansion.node_poses(tables, expansion.chains[models[good]], nodes, poses)
    keep = np.ones(len(rows), np.bool_)
    keep[list(errors)] = False
    inner = keep[good]
    if not inner.all():
        poses = poses.take(inner)
    return FoundBodies(
        tables, expansion, models[keep], rows[keep], found[keep], nodes[inner], poses
    )


def _chosen(texts: list[Any], rows: Array) -> list[Any]:
    if len(rows) == len(texts) and bool(np.all(rows == np.arange(len(rows)))):
        return texts
    return [texts[row] for row in rows.tolist()]


def named_below(table: Table[Any], keys: Array, names: Sequence[str]) -> Array:
    """The first rows of a sid below parents of the given keys (n,); -1 for none."""
    found = _named(table, keys, list(names))
    paths = np.flatnonzero(found < 0)
    paths = paths[[("/" in names[place]) for place in paths.tolist()]] if len(paths) else paths
    if len(paths):
        # A path such as Model01/Body01 is not valid here, but the thesis writes it (listing 2).
        last = [names[place].rpartition("/")[2] for place in paths.tolist()]
        found[paths] = _named(table, keys[paths], last)
    return found


def _named(table: Table[Any], keys: Array, names: list[str]) -> Array:
    sids = table.texts("sid")
    count = len(sids)
    if not count or not len(names):
        return np.full(len(names), -1, np.int64)
    if names == sids and len(names) == count and len(set(sids)) == count:
        rows = np.arange(count)
        return np.where(table.parent_keys == keys, rows, -1)
    first = dict(zip(reversed(sids), range(count - 1, -1, -1), strict=True))
    codes = np.arange(count) if len(first) == count else np.array([first[sid] for sid in sids])
    get = first.get
    wanted = np.array([get(name, -1) for name in names], np.int64)
    parents, inverse = np.unique(table.parent_keys, return_inverse=True)
    place = np.searchsorted(parents, keys)
    place = np.minimum(place, len(parents) - 1)
    good = (parents[place] == keys) & (wanted >= 0)
    mine = inverse.reshape(-1).astype(np.int64) * count + codes
    query = place * count + wanted
    if bool(np.all(mine[1:] > mine[:-1])):
        known, rows = mine, np.arange(count)
    else:
        known, rows = np.unique(mine, return_index=True)
    at = np.minimum(np.searchsorted(known, query), len(known) - 1)
    return np.where(good & (known[at] == query), rows[at], -1).astype(np.int64)

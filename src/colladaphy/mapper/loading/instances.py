"""The instances of physics models that scenes expand to (thesis 3.3, 5.3).

Models stand in models; a model that is instanced twice is two sets of bodies. An instance can have
a parent node, whose transform all of its bodies share. All instances of one depth are found at
once; the order is that of walking through them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import DocumentError
from colladaphy.links import rules
from colladaphy.links.names import MOST_INSTANCES
from colladaphy.links.pool import is_unreachable
from colladaphy.links.poses import Poses
from colladaphy.mapper.loading.tables import Tables

__all__ = ["Expansion", "expand"]

Array = NDArray[Any]


@dataclass(slots=True)
class Expansion:
    """Instances of models, each before those within it."""

    rows: Array
    """(n,) rows of the instance_physics_model elements."""
    models: Array
    """(n,) rows of the models."""
    around: Array
    """(n,) the instance that each stands in; -1 for none."""
    chains: Array
    """(n,) the innermost parent node that counts for it, by its place below; -1 for none."""
    parent_nodes: Array
    """(m,) rows of parent nodes."""
    parent_chains: Array
    """(m,) the next parent node outside of each; -1 for none."""

    def __len__(self) -> int:
        return len(self.rows)

    def node_poses(
        self, tables: Tables, chains: Array, nodes: Array, poses: Poses, outer: Poses | None = None
    ) -> Poses:
        """Poses of nodes (-1: none) with those of the parents around them.

        `outer` are the poses of the parent nodes, where they are not those of the documents.

        A parent is not applied where the node is below it in the scene, so that its own transform
        has the parent's already.
        """
        if not len(self.parent_nodes) or not np.any(chains >= 0):
            return poses
        if outer is None:
            outer, _ = tables.placement.poses(self.parent_nodes)
        done = np.zeros(len(chains), np.bool_)
        while True:
            live = np.flatnonzero((chains >= 0) & ~done)
            if not len(live):
                return poses
            parents = self.parent_nodes[chains[live]]
            within = np.zeros(len(live), np.bool_)
            known = nodes[live] >= 0
            within[known] = tables.placement.is_within(nodes[live][known], parents[known])
            done[live[within]] = True
            live, within = live[~within], within
            poses.put(live, outer.take(chains[live]).then(poses.take(live)))
            chains = chains.copy()
            chains[live] = self.parent_chains[chains[live]]


def expand(tables: Tables, roots: Array) -> Expansion:
    """Expand instance_physics_model elements (rows), and what the models hold."""
    levels: list[tuple[Array, Array, Array, Array]] = []
    parent_nodes: list[Array] = []
    parent_chains: list[Array] = []
    count = chain_count = 0
    rows, around = roots, np.full(len(roots), -1)
    chains = np.full(len(roots), -1)
    while len(rows):
        models, rows, around, chains, fresh = _followed(tables, rows, around, chains, chain_count)
        if fresh is not None:
            parent_nodes.append(fresh[0])
            parent_chains.append(fresh[1])
            chain_count += len(fresh[0])
        keep = _outside_circles(tables, levels, rows, models, around)
        rows, models, around, chains = (column[keep] for column in (rows, models, around, chains))
        if count + len(rows) > MOST_INSTANCES:
            home = tables.pool.resources[int(tables.model_instances.homes(rows[:1])[0])]
            element = home.element(int(tables.model_instances.ordinals[rows[0]]))
            raise DocumentError(rules.BUDGET.at(element, file=home.file))
        levels.append((rows, models, around, chains))
        inner, owner = tables.model_instances.below(tables.models.keys(models))
        around, chains = owner + count, chains[owner]
        count += len(rows)
        rows = inner
    if not levels:
        nothing = np.zeros(0, np.int64)
        return Expansion(nothing, nothing, nothing, nothing, nothing, nothing)
    order = _walk([level[2] for level in levels])
    back = np.empty(count + 1, np.int64)
    back[order] = np.arange(count)
    back[-1] = -1
    columns = [np.concatenate(column)[order] for column in zip(*levels, strict=True)]
    nodes = np.concatenate(parent_nodes) if parent_nodes else np.zeros(0, np.int64)
    up = np.concatenate(parent_chains) if parent_chains else np.zeros(0, np.int64)
    return Expansion(columns[0], columns[1], back[columns[2]], columns[3], nodes, up)


def _followed(
    tables: Tables, rows: Array, around: Array, chains: Array, chain_count: int
) -> tuple[Array, Array, Array, Array, tuple[Array, Array] | None]:
    """The models that instances refer to, without those instances whose references fail."""
    table, pool = tables.model_instances, tables.pool
    homes, origins = table.homes(rows), table.ordinals[rows]
    urls, parents = table.texts("url"), table.texts("parent")
    listed = rows.tolist()
    models, errors = pool.follow(
        tables.models, [urls[row] for row in listed], homes, origins, "physics_model"
    )
    given = np.array([bool((parents[row] or "").strip()) for row in listed], np.bool_)
    given &= models >= 0
    fresh = None
    if given.any():
        places = np.flatnonzero(given)
        nodes, more = pool.follow(
            tables.placement.nodes,
            [parents[listed[place]].strip() for place in places.tolist()],
            homes[places], origins[places], "node",
        )  # fmt: skip
        found = np.flatnonzero(nodes >= 0)
        _, circles = tables.placement.poses(nodes[found])
        for place in found.tolist():
            if int(nodes[place]) in circles:
                more[place] = circles[int(nodes[place])]
                nodes[place] = -1
        for place, error in more.items():
            if is_unreachable(error):  # its bodies stand as without a parent
                tables.resource.note_broken(error)
                continue
            errors[int(places[place])] = error
            models[places[place]] = -1
        good = nodes >= 0
        fresh = nodes[good], chains[places[good]]
        chains = chains.copy()
        chains[places[good]] = chain_count + np.arange(int(good.sum()))
    for place in sorted(errors):
        tables.resource.note_broken(errors[place])
    keep = models >= 0
    return models[keep], rows[keep], around[keep], chains[keep], fresh


def _outside_circles(
    tables: Tables,
    levels: list[tuple[Array, Array, Array, Array]],
    rows: Array,
    models: Array,
    around: Array,
) -> Array:
    """Which instances are not of a model that they stand in themselves."""
    keep = np.ones(len(rows), np.bool_)
    if not levels:
        return keep
    every = np.concatenate([level[1] for level in levels])
    up = np.concatenate([level[2] for level in levels])
    current = around.copy()
    while np.any(current >= 0):
        keep &= ~((current >= 0) & (every[current] == models))
        current = np.where(current >= 0, up[current], -1)
    table = tables.model_instances
    for place in np.flatnonzero(~keep).tolist():
        home = tables.pool.resources[int(table.homes(rows[place : place + 1])[0])]
        name = tables.models.texts("id")[int(models[place])]
        message = f"The physics model {name!r} is instanced within itself."
        tables.resource.note(rules.CYCLE, int(table.ordinals[rows[place]]), message, home=home)
    return keep


def _walk(around: list[Array]) -> Array:
    """The order in which each instance comes before those in it, and these before its next one."""
    sizes = [np.ones(len(level), np.int64) for level in around]
    starts = np.cumsum([0, *(len(level) for level in around)])
    for depth in range(len(around) - 1, 0, -1):
        np.add.at(sizes[depth - 1], around[depth] - starts[depth - 1], sizes[depth])
    places: list[Array] = []
    for depth, level in enumerate(around):
        before = np.cumsum(sizes[depth]) - sizes[depth]
        if depth == 0:
            places.append(before)
            continue
        owner = level - starts[depth - 1]
        first = np.searchsorted(owner, owner, side="left")
        places.append(places[depth - 1][owner] + 1 + before - before[first])
    return np.argsort(np.concatenate(places), kind="stable")

"""Where nodes stand in the world: through parents and instance_node.

COLLADA 1.5 §node, §instance_node: an instance_node puts a node of a library below the node that
holds the instance; a node that stands nowhere else is taken to stand at the origin.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.errors import ColladaError, DocumentError
from colladaphy.findings import Severity
from colladaphy.links import rules
from colladaphy.links.affine import stretch_of
from colladaphy.links.names import c
from colladaphy.links.pool import Pool, Table
from colladaphy.links.poses import Poses, reach
from colladaphy.links.resource import Resource
from colladaphy.links.steps import Transforms, matrix_of, own_transforms, product, rigid_parts
from colladaphy_schema.document_columns import ColladaSceneRows
from colladaphy_schema.scene_columns import InstanceNodeTypeRows, NodeTypeRows

__all__ = ["OwnTransforms", "Placement", "Sums"]

Array = NDArray[Any]


@dataclass(slots=True)
class OwnTransforms:
    """The nodes of the documents, by themselves."""

    poses: Poses
    affine: Array
    """(n,) whether the transform is a matrix."""
    matrices: Array
    """(n, 4, 4) where it is one, in the order of the rows."""
    steps: Array
    """(n,) of how many steps it is; a translation and then a rotation are one."""
    sizes: Array
    """(n,) how large its translations are together."""


@dataclass(slots=True)
class Sums:
    """How positions and orientations were added up, n rows."""

    sizes: Array
    """(n,) how large the positions are that others were added to."""
    steps: Array
    """(n,) how many transforms were composed; 0 for what is stated directly."""

    def take(self, rows: Array) -> Sums:
        """Some of the rows, in that order; nothing for -1."""
        sizes, steps = np.append(self.sizes, 0.0), np.append(self.steps, 0)
        return Sums(sizes[rows], steps[rows])


class Placement:
    """World poses of the nodes of a pool."""

    def __init__(self, pool: Pool, resource: Resource) -> None:
        self._pool = pool
        self._resource = resource
        self.nodes: Table[NodeTypeRows] = pool.table(NodeTypeRows, c("node"))
        self._noted: set[int] = set()
        self._above: tuple[int, Array] | None = None

    def poses(self, rows: Array) -> tuple[Poses, dict[int, DocumentError]]:
        """The world poses of some nodes, and errors by row for those that stand in a circle.

        What is not rigid in a transform is left out and reported.
        """
        above = self.above()
        needed, errors = self._closure(rows, above)
        own = self.nodes.gather(_own)
        count = len(self.nodes)
        world = own.poses if not errors and not np.any(above[needed] >= 0) else None
        if world is None:
            world, affine, matrices = self._composed(needed, above, own, count)
        else:
            affine = own.affine
            places = np.cumsum(affine) - 1
            matrices = {row: own.matrices[places[row]] for row in np.flatnonzero(affine).tolist()}
        found = world.take(rows)
        mixed = np.flatnonzero(affine[rows])
        if len(mixed):
            rigid, exact = rigid_parts(np.array([matrices[row] for row in rows[mixed].tolist()]))
            found.put(mixed, rigid)
            for row in rows[mixed[~exact]].tolist():
                self._note_not_rigid(row, matrices[row])
        return found, errors

    def above(self) -> Array:
        """The node around each node, or that which instances it; -1 for none."""
        known = len(self.nodes.parts)
        if self._above is None or self._above[0] != known:
            self._above = known, self._find_above()
        return self._above[1]

    def is_within(self, nodes: Array, ancestors: Array) -> Array:
        """Whether ancestors are above nodes, or are them (n,)."""
        above = self.above()
        found = nodes == ancestors
        current = nodes.copy()
        for _ in range(len(above) + 1):
            current = np.where(current >= 0, above[current], -1)
            live = (current >= 0) & ~found
            if not live.any():
                break
            found |= live & (current == ancestors)
            # A circle leads back to where it began.
            current[current == nodes] = -1
        return np.asarray(found)

    def own(self) -> OwnTransforms:
        """The transforms of the nodes by themselves."""
        return self.nodes.gather(_own)

    def frames(self) -> tuple[Poses, Array, dict[int, Array]]:
        """The frames of all nodes in the world: poses (n,), where they are matrices, and these.

        Of nodes that stand in a circle nothing is said.
        """
        rows = np.arange(len(self.above()))
        return self._composed(rows, self.above(), self.own(), len(rows))

    def levels(self) -> list[Array]:
        """The nodes that stand in none, those in them, and so on."""
        above = self.above()
        depth = self._depths(np.arange(len(above)), above)
        order = np.argsort(depth, kind="stable")
        order = order[depth[order] >= 0]
        sizes = np.bincount(depth[order])
        return np.split(order, np.cumsum(sizes)[:-1]) if len(order) else []

    def shared(self) -> Array:
        """Which nodes (n,) are instanced several times, or stand in one that is."""
        above = self.above()
        shared = np.zeros(len(above) + 1, np.bool_)
        shared[[row for row in self._several if row < len(above)]] = True
        for rows in self.levels():
            shared[rows] |= shared[above[rows]]
        return shared[:-1]

    def reach(self) -> Sums:
        """What the world poses of the nodes are made of."""
        own, above = self.own(), self.above()
        mixed = own.steps > 1
        sums = Sums(np.where(mixed, own.sizes, 0.0), np.where(mixed, own.steps, 0))
        if not np.any(above >= 0):
            return sums
        poses, affine, matrices = self.frames()
        places = reach(poses.positions)
        for row in np.flatnonzero(affine).tolist():
            places[row] = np.abs(matrices[row][:3, 3]).max()
        for rows in self.levels()[1:]:
            outer = above[rows]
            sums.sizes[rows] += sums.sizes[outer] + places[outer]
            sums.steps[rows] += sums.steps[outer] + own.steps[outer] + 1
        return sums

    # --- the nodes above

    def _find_above(self) -> Array:
        nodes = self.nodes
        above = np.full(len(nodes), -1, np.int64)
        roots = np.zeros(len(nodes), np.bool_)
        for home, part in enumerate(nodes.parts):
            start = nodes.start(home)
            columns = self._pool.resources[home].columns
            assert part.ordinals is not None
            parents = columns.index.parent[part.ordinals]
            place = np.searchsorted(part.ordinals, parents)
            inside = part.ordinals[np.minimum(place, max(len(part) - 1, 0))] == parents
            above[start : start + len(part)] = np.where(inside, place + start, -1)
            names = columns.index.codes[np.maximum(parents, 0)]
            scenes = columns.codes_of(c("visual_scene"))
            roots[start : start + len(part)] = inside | np.isin(names, scenes)
        self._several: dict[int, int] = {}
        if not roots.all():
            self._instanced(above, roots)
        return above

    def _instanced(self, above: Array, roots: Array) -> None:
        """Put nodes of libraries below the first node that instances them."""
        pool = self._pool
        instances = pool.table(InstanceNodeTypeRows, c("instance_node"))
        done = 0
        counts: dict[int, int] = {}
        before = len(pool.resources)
        self._join_shown()
        while done < len(instances.parts):
            for home in range(done, len(instances.parts)):
                part = instances.parts[home]
                assert part.ordinals is not None
                homes = np.full(len(part), home)
                targets, errors = pool.follow(
                    self.nodes, list(part.url), homes, part.ordinals, "node", needed=False
                )
                # What is not there is not seen, but moves nothing.
                for error in errors.values():
                    self._resource.note_broken(error, Severity.WARNING)
                holders = pool.resources[home].columns.index.parent[part.ordinals]
                for target, holder in zip(targets.tolist(), holders.tolist(), strict=True):
                    if target < 0 or (target < len(roots) and roots[target]):
                        continue
                    counts[target] = counts.get(target, 0) + 1
                    if counts[target] == 1 and target < len(above):
                        above[target] = self.nodes.row_of(home, holder)
                done = home + 1
        self._several = {row: count for row, count in counts.items() if count > 1}
        if len(pool.resources) > before:
            # Others joined; with their nodes everything is found anew.
            fresh = self._find_above()
            above.resize(len(fresh), refcheck=False)
            above[...] = fresh

    def _join_shown(self) -> None:
        """Let the files join whose visual scenes are shown: they may instance nodes of others."""
        first = self._pool.resources[0]
        shown = first.columns.rows(ColladaSceneRows, c("scene")).instance_visual_scene
        assert shown.ordinals is not None
        for url, origin in zip(shown.url, shown.ordinals.tolist(), strict=True):
            if not url.startswith("#"):
                try:
                    self._pool.number(first.follow(url, origin, "visual_scene")[0])
                except ColladaError as error:
                    self._resource.note_broken(error, Severity.WARNING)

    def _closure(self, rows: Array, above: Array) -> tuple[Array, dict[int, DocumentError]]:
        """The nodes and all those above them, and errors for those in a circle."""
        needed = np.zeros(len(above), np.bool_)
        current = distinct(rows)
        while len(current):
            current = current[~needed[current]]
            needed[current] = True
            current = distinct(above[current])
            current = current[current >= 0]
        for row in self._several:
            if row < len(needed) and needed[row]:
                self._note_several(row)
        errors: dict[int, DocumentError] = {}
        found = np.flatnonzero(needed)
        depth = self._depths(found, above)
        for row in found[depth < 0].tolist():
            home, element = self._place(row)
            name = self.nodes.texts("id")[row]
            message = f"The node {name!r} is instanced within itself."
            errors[row] = DocumentError(
                rules.CYCLE.at(home.element(element), message, file=home.file)
            )
        return found, errors

    @staticmethod
    def _depths(found: Array, above: Array) -> Array:
        """How many nodes are above each (n,); -1 for those in, or below, a circle."""
        depth = np.full(len(above) + 1, -1, np.int64)
        depth[found[above[found] < 0]] = 0
        left = found[above[found] >= 0]
        while len(left):
            known = depth[above[left]]
            ready = known >= 0
            if not ready.any():
                break
            depth[left[ready]] = known[ready] + 1
            left = left[~ready]
        return depth[found]

    def _composed(
        self, needed: Array, above: Array, own: OwnTransforms, count: int
    ) -> tuple[Poses, Array, dict[int, Array]]:
        """World transforms of the needed nodes, level by level."""
        world = Poses.none(count)
        affine = np.zeros(count, np.bool_)
        matrices: dict[int, Array] = {}
        places = np.cumsum(own.affine) - 1
        depth = self._depths(needed, above)
        for level in range(int(depth.max(initial=-1)) + 1):
            rows = needed[depth == level]
            outer = above[rows]
            mine = own.affine[rows]
            if level:
                mine = mine | affine[outer]
            plain = rows[~mine]
            inner = own.poses.take(plain)
            world.put(plain, world.take(outer[~mine]).then(inner) if level else inner)
            for row, up in zip(rows[mine].tolist(), outer[mine].tolist(), strict=True):
                if own.affine[row]:
                    made = own.matrices[places[row]]
                else:
                    made = matrix_of(own.poses.take(np.array([row])))[0]
                if up >= 0 and not (own.poses.is_identity()[row] and not own.affine[row]):
                    one = np.array([up])
                    around = matrices[up] if affine[up] else matrix_of(world.take(one))[0]
                    made = product(around, made)
                elif up >= 0:
                    made = matrices[up]
                affine[row] = True
                matrices[row] = made
        return world, affine, matrices

    # --- what is noticed

    def _place(self, row: int) -> tuple[Resource, int]:
        home = int(self.nodes.homes(np.array([row]))[0])
        return self._pool.resources[home], int(self.nodes.ordinals[row])

    def _note_not_rigid(self, row: int, matrix: Array) -> None:
        if row in self._noted:
            return
        self._noted.add(row)
        home, element = self._place(row)
        name = self.nodes.texts("id")[row] or self.nodes.texts("name")[row] or "?"
        message = (
            f"The transform of node {name!r} {stretch_of(matrix)}; "
            "its rotation and translation are taken."
        )
        self._resource.note(rules.NOT_RIGID, element, message, home=home)

    def _note_several(self, row: int) -> None:
        count = self._several[row]
        if -row - 1 in self._noted:
            return
        self._noted.add(-row - 1)
        home, element = self._place(row)
        message = (
            f"The node {self.nodes.texts('id')[row]!r} is instanced {count} times; "
            "the first instance places it."
        )
        self._resource.note(rules.SEVERAL_PLACES, element, message, home=home)


def _own(nodes: NodeTypeRows, home: int, start: int) -> OwnTransforms:
    transforms: Transforms = own_transforms(nodes)
    affine = np.zeros(len(nodes), np.bool_)
    rows = sorted(transforms.matrices)
    affine[rows] = True
    matrices = np.array([transforms.matrices[row] for row in rows]).reshape(-1, 4, 4)
    steps, sizes = np.zeros(len(nodes), np.int64), np.zeros(len(nodes))
    for name in ("translate", "rotate", "matrix", "scale", "skew", "lookat"):
        steps += np.bincount(getattr(nodes, name).owner, minlength=len(nodes))
    translate, rotate = nodes.translate, nodes.rotate
    if len(rows):
        sizes[rows] = reach(matrices[:, :3, 3])
        steps[rows] += 1
    if len(translate):
        np.add.at(sizes, translate.owner, reach(translate.value))
        first, second = (np.full(len(nodes), -1, np.int64) for _ in range(2))
        assert translate.ordinals is not None and rotate.ordinals is not None
        first[translate.owner], second[rotate.owner] = translate.ordinals, rotate.ordinals
        steps[(steps == 2) & (first >= 0) & (first < second)] = 1
    return OwnTransforms(transforms.poses, affine, matrices, steps, sizes)

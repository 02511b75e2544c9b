"""Which nodes bodies move, and what is above those (COLLADA 1.5 §node, §instance_rigid_body)."""

from __future__ import annotations

from collections import defaultdict
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import rows_among
from colladaphy.meaning.context import Context, FloatRows
from colladaphy.meaning.radians import written_as_radians
from colladaphy.meaning.scene import degenerate_matrices

__all__ = ["Nodes", "nodes_of", "odd_transforms", "unclear_nodes"]

Array = NDArray[Any]


class Nodes:
    """The nodes of a document as a tree, with the instances of bodies that move them."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.elements = context.ordinals("node")
        self.instances: Array = context.ordinals("instance_rigid_body").astype(np.int64)
        """(n,) the instances of bodies."""
        targets = context.led("instance_rigid_body", "target")
        self.moved: Array = np.where(context.is_named(targets, "node"), targets, -1)
        """(n,) the nodes that these move; -1 for none."""
        self.are_nested = bool(np.any(context.is_within(self.elements, "node")))
        """Whether any node stands in a node."""
        self.holders: defaultdict[int, list[int]] = defaultdict(list)
        """The nodes that instance each node."""
        inner = context.led("instance_node", "url")
        outer = context.parent[context.ordinals("instance_node")]
        good = context.is_named(inner, "node")
        for target, holder in zip(inner[good].tolist(), outer[good].tolist(), strict=True):
            self.holders[target].append(holder)
        self._places: dict[int, int] = {}
        self.shown = self._scenes()
        """The visual scenes that are seen."""

    @cached_property
    def targets(self) -> dict[int, int]:
        """The nodes that instances of bodies move, by the instance; -1 for none."""
        return dict(zip(self.instances.tolist(), self.moved.tolist(), strict=True))

    @cached_property
    def parents(self) -> dict[int, int]:
        """What is around each node."""
        parents: list[int] = self.context.parent[self.elements].tolist()
        return dict(zip(self.elements.tolist(), parents, strict=True))

    def moved_by(self, instances: Array) -> Array:
        """The nodes (n,) that instances of bodies move; -1 for none, and of what is none."""
        found: Array = np.append(self.moved, -1)[rows_among(self.instances, instances)]
        return found

    def _scenes(self) -> set[int]:
        """The visual scenes that are seen; all where none is instanced."""
        shown = set(self.context.led("instance_visual_scene", "url").tolist())
        every = set(self.context.ordinals("visual_scene").tolist())
        return shown & every or every

    def above(self, node: int) -> int:
        """The node around a node, or the first that instances it; -1 for none."""
        parent = int(self.parents[node])
        if parent in self.parents:
            return parent
        return next(iter(self.holders.get(node, ())), -1)

    def chain(self, node: int) -> list[int]:
        """A node and those above it."""
        found = [node]
        known = {node}
        while (node := self.above(node)) >= 0 and node not in known:
            found.append(node)
            known.add(node)
        return found

    def places(self, node: int) -> int:
        """In how many places a node stands, in the scenes that are seen."""
        if node not in self._places:
            self._places[node] = 0  # for circles
            parent = self.parents[node]
            here: int = int(parent in self.shown)
            if parent in self.parents:
                here = self.places(parent)
            here += sum(map(self.places, self.holders.get(node, ())))
            self._places[node] = here
        return self._places[node]


def nodes_of(context: Context) -> Nodes:
    """The nodes of a document."""
    return context.shared(Nodes)


def odd_transforms(context: Context) -> dict[int, list[int]]:
    """The transforms of each node that scale, skew or mirror, but for those that are faulty."""
    return context.shared(_odd_transforms)


def unclear_nodes(context: Context) -> set[int]:
    """What has transforms that scale, skew or mirror, or that are faulty: nodes and others."""
    return context.shared(_transforms)[1]


def _odd_transforms(context: Context) -> dict[int, list[int]]:
    return context.shared(_transforms)[0]


def _transforms(context: Context) -> tuple[dict[int, list[int]], set[int]]:
    found: defaultdict[int, list[int]] = defaultdict(list)
    unclear: set[int] = set()
    widths = {"matrix": 16, "scale": 3, "skew": 7, "translate": 3, "rotate": 4, "lookat": 9}
    for name, width in widths.items():
        rows = context.rows(FloatRows, name)
        if not len(rows):
            continue
        assert rows.ordinals is not None
        values = rows.value.values.reshape(-1, width)
        faulty: Array = ~np.isfinite(values).all(axis=1)
        odd: Array = np.zeros(len(rows), np.bool_)
        if name == "matrix":
            matrices = values.reshape(-1, 4, 4)
            inner = matrices[:, :3, :3]
            product = np.einsum("nij,nik->njk", inner, inner)
            skewed = np.abs(product - np.eye(3)).max(axis=(1, 2)) > 1e-4
            odd = np.logical_or(skewed, np.linalg.det(inner) < 0.0)
            wrong, flat = degenerate_matrices(matrices)
            faulty = faulty | wrong | flat
        elif name == "scale":
            odd = np.asarray((np.abs(values - 1.0) > 2e-6).any(axis=1))
            faulty = faulty | ~values.all(axis=1)
        elif name == "rotate":
            faulty = faulty | (~values[:, :3].any(axis=1) & (values[:, 3] != 0.0))
            faulty = faulty | written_as_radians(values[:, 3])
        elif name == "skew":
            odd = values[:, 0] != 0.0
        odd &= ~faulty
        for element in rows.ordinals[odd].tolist():
            found[int(context.parent[element])].append(element)
        unclear.update(context.parent[rows.ordinals[odd | faulty]].tolist())
    return dict(found), unclear

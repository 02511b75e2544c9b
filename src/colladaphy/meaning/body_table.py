"""Rigid bodies and their instances, with what they state of the whole body (thesis 3.3).

Instance data beats rigid_body data beats shape data. A body moves where it, or an instance of it,
is dynamic.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among
from colladaphy.meaning.context import Context
from colladaphy.meaning.models import instanced_bodies
from colladaphy_schema.rows import Rows

__all__ = ["Bodies", "bodies_of"]

Array = NDArray[Any]


class Bodies:
    """Rigid bodies and instances of them; of both the values that they state themselves."""

    def __init__(self, context: Context) -> None:
        self.context = context
        rows = context.rows(Rows, "rigid_body", "instance_rigid_body")
        assert rows.ordinals is not None
        self.elements: Array = rows.ordinals.astype(np.int64)
        count = len(rows)
        is_body = are_among(self.elements, context.ordinals("rigid_body"))
        self.is_instance: Array = ~is_body
        common = context.children(rows, "technique_common", Rows)
        at = common.owner
        self._common, self._at = common, at
        flags, elements = context.flags(common, "dynamic", True)
        self.dynamic, self.dynamic_elements = self._spread(flags, True), self._spread(elements, -1)
        mass, elements = context.scalars(common, "mass")
        self.masses, self.mass_elements = self._spread(mass, np.nan), self._spread(elements, -1)
        inertia, elements = context.vectors(common, "inertia", 3)
        self.inertias = self._spread(inertia, np.nan)
        self.inertia_elements = self._spread(elements, -1)
        self.body: Array = np.full(count, -1, np.int64)
        """(n,) the row of the rigid_body that each instance is of, and of a body itself."""
        self.body[is_body] = np.flatnonzero(is_body)
        self._find()
        self.moves: Array = self._moving()
        """(n,) whether a body, or an instance, moves."""

    def _spread(self, values: Array, default: Any) -> Array:
        made = np.full((len(self.elements), *values.shape[1:]), default, dtype=values.dtype)
        made[self._at] = values
        return made

    def _find(self) -> None:
        found = instanced_bodies(self.context)
        good = np.flatnonzero(found.parts >= 0)
        rows = np.searchsorted(self.elements, found.elements[good])
        self.body[rows] = np.searchsorted(self.elements, found.parts[good])
        instances = np.flatnonzero(self.is_instance & (self.body >= 0))
        self.instanced: Array = np.zeros(len(self.elements), np.bool_)
        """(n,) which bodies have instances."""
        self.instanced[self.body[instances]] = True

    def _moving(self) -> Array:
        moves = self.dynamic.copy()
        silent = self.is_instance & (self.dynamic_elements < 0) & (self.body >= 0)
        moves[silent] = self.dynamic[self.body[silent]]
        instances = np.flatnonzero(self.is_instance & (self.body >= 0))
        of_body = np.zeros(len(moves), np.bool_)
        np.logical_or.at(of_body, self.body[instances], moves[instances])
        moves[self.instanced] = of_body[self.instanced]
        return np.asarray(moves)

    @cached_property
    def _by_body(self) -> tuple[Array, Array]:
        rows = np.flatnonzero(self.is_instance & (self.body >= 0))
        order = np.argsort(self.body[rows], kind="stable")
        return self.body[rows][order], rows[order]

    def instances(self, body: int) -> Array:
        """The rows of the instances of a body."""
        bodies, rows = self._by_body
        begin, end = np.searchsorted(bodies, (body, body + 1))
        return np.asarray(rows[begin:end])

    def row(self, element: int) -> int:
        """The row of an element; -1 for none."""
        at = int(np.searchsorted(self.elements, element))
        return at if at < len(self.elements) and self.elements[at] == element else -1

    def effective_masses(self) -> Array:
        """(n,) masses, those of the body where an instance states none; NaN for none."""
        masses = self.masses.copy()
        silent = self.is_instance & (self.mass_elements < 0) & (self.body >= 0)
        masses[silent] = self.masses[self.body[silent]]
        return np.asarray(masses)


def bodies_of(context: Context) -> Bodies:
    """The bodies of a document."""
    return context.shared(Bodies)

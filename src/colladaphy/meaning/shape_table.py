"""Shapes of bodies: sizes, volumes, masses (COLLADA 1.5 §shape, §box … §sphere)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.surface_table import surfaces_of
from colladaphy_schema.rows import Rows

__all__ = ["Shapes", "shapes_of"]

Array = NDArray[Any]


class Shapes:
    """All shapes of rigid bodies and of their instances, one a row."""

    def __init__(self, context: Context) -> None:
        self.context = context
        rows = context.rows(Rows, "shape")
        assert rows.ordinals is not None
        self.rows = rows
        self.elements: Array = rows.ordinals.astype(np.int64)
        holders = context.ancestor(rows.ordinals, "rigid_body", "instance_rigid_body")
        bodies = bodies_of(context)
        self.holders: Array = np.searchsorted(bodies.elements, holders)
        """(n,) rows of the bodies or instances that they belong to."""
        self.masses, self.mass_elements = context.scalars(rows, "mass")
        self.densities, self.density_elements = context.scalars(rows, "density")
        self.hollow, self.hollow_elements = context.flags(rows, "hollow", False)
        count = len(rows)
        self.volumes = np.full(count, np.nan)
        self.reach = np.full(count, np.nan)
        """(n,) how far it is from its own origin to its farthest point."""
        self.faults: list[tuple[int, str, bool]] = []
        """Elements and messages of sizes that are none, and whether the shape is only flat."""
        self._spheres()
        self._boxes()
        self._rods()
        self._geometries()
        self.shift = np.zeros(count)
        moved = context.children(rows, "translate", Rows)
        assert moved.ordinals is not None
        np.add.at(self.shift, moved.owner, _lengths(context, moved.ordinals))

    def _sized(self, name: str) -> Rows:
        return self.context.children(self.rows, name, Rows)

    def _size(self, rows: Rows, name: str, width: int, what: str, *, zero: bool = False) -> Array:
        """The sizes (n, width) of primitives; NaN where they are none."""
        values, elements = self.context.vectors(rows, name, width)
        good = (values > 0.0) & (values < np.inf)
        if zero:
            good |= values == 0.0
        for place in np.flatnonzero(~good.all(axis=1)).tolist():
            shown = " ".join(f"{value:g}" for value in values[place].tolist())
            element = int(elements[place])
            assert rows.ordinals is not None
            if element < 0:
                element = int(rows.ordinals[place])
            message = f"The {name.replace('_', ' ')} of the {what} is {shown}."
            # What is flat has no volume, but a negative size has no meaning.
            flat = bool(np.all((values[place] >= 0.0) & (values[place] < np.inf)))
            flat &= bool(values[place].any())
            self.faults.append((element, message, flat))
        return np.where(good, values, np.nan)

    def _spheres(self) -> None:
        spheres = self._sized("sphere")
        radius = self._size(spheres, "radius", 1, "sphere")[:, 0]
        self.volumes[spheres.owner] = 4.0 / 3.0 * np.pi * radius**3
        self.reach[spheres.owner] = radius

    def _boxes(self) -> None:
        boxes = self._sized("box")
        half = self._size(boxes, "half_extents", 3, "box")
        self.volumes[boxes.owner] = 8.0 * np.prod(half, axis=1)
        self.reach[boxes.owner] = np.linalg.norm(half, axis=1)

    def _rods(self) -> None:
        capsules, cylinders = self._sized("capsule"), self._sized("cylinder")
        radii = self._size(capsules, "radius", 3, "capsule")
        # Without height a capsule is an ellipsoid.
        height = self._size(capsules, "height", 1, "capsule", zero=True)[:, 0]
        caps = 4.0 / 3.0 * np.pi * np.prod(radii, axis=1)
        self.volumes[capsules.owner] = caps + np.pi * radii[:, 0] * radii[:, 2] * height
        self.reach[capsules.owner] = height / 2.0 + radii.max(axis=1, initial=0.0)
        radii = self._size(cylinders, "radius", 2, "cylinder")
        height = self._size(cylinders, "height", 1, "cylinder")[:, 0]
        self.volumes[cylinders.owner] = np.pi * np.prod(radii, axis=1) * height
        self.reach[cylinders.owner] = np.hypot(height / 2.0, radii.max(axis=1, initial=0.0))

    def _geometries(self) -> None:
        context = self.context
        rows = context.children(self.rows, "instance_geometry", Rows)
        targets = context.led("instance_geometry", "url", _ordinals(rows))
        there = np.flatnonzero(targets >= 0)
        self.mesh_rows: Array = rows.owner[there]
        """(m,) the rows of shapes that are geometries of this document."""
        self.geometries: Array = targets[there]
        """(m,) these geometries."""
        surfaces = surfaces_of(context)
        at = surfaces.rows_of(self.geometries)
        found = np.flatnonzero(at >= 0)
        at, mine = at[found], self.mesh_rows[found]
        whole = surfaces.closed[at] & surfaces.consistent[at]
        self.volumes[mine] = np.where(whole, np.abs(surfaces.volumes[at]), np.nan)
        self.reach[mine] = surfaces.reaches[at]

    def computed(self, rows: Array) -> Array:
        """Which shapes (n,) move, while their bodies do not state both mass and inertia."""
        bodies, holders = bodies_of(self.context), self.holders[rows]
        lacking = (bodies.mass_elements[holders] < 0) | (bodies.inertia_elements[holders] < 0)
        return np.asarray(bodies.moves[holders] & lacking)

    def stated_masses(self) -> Array:
        """(n,) the mass of each shape: stated, or density times volume; NaN where unknown."""
        return np.where(self.mass_elements >= 0, self.masses, self.densities * self.volumes)

    def inertia_bounds(self, rows: Array) -> tuple[Array, Array]:
        """What inertias of some bodies can be at most, and what they are about; NaN if unknown."""
        bodies = bodies_of(self.context)
        of_body = self.holders
        masses = bodies.effective_masses()[rows]
        sums = np.zeros(len(bodies.elements))
        np.add.at(sums, of_body, self.stated_masses())
        reach = np.zeros(len(bodies.elements))
        np.maximum.at(reach, of_body, self.reach + self.shift)
        inner = np.zeros(len(bodies.elements))
        np.maximum.at(inner, of_body, self.reach)
        own = np.bincount(of_body, minlength=len(bodies.elements)) > 0
        # Instances without shapes of their own have those of the body.
        source = np.where(own[rows], rows, bodies.body[rows])
        known = source >= 0
        masses = np.where(np.isnan(masses), np.where(known, sums[source], np.nan), masses)
        frames = self.frames()
        far = reach[source] + np.maximum(frames[rows], frames[source])
        most = np.where(known, masses * far**2, np.nan)
        least = np.where(known, 0.2 * masses * inner[source] ** 2, np.nan)
        return most, least

    def reaches(self) -> Array:
        """(n,) how far the shapes of bodies, or instances, reach at most; NaN where unknown."""
        reach = np.zeros(len(bodies_of(self.context).elements))
        np.maximum.at(reach, self.holders, self.reach + self.shift)
        return reach

    def frames(self) -> Array:
        """(n,) how far the mass frames of bodies are moved."""
        context, bodies = self.context, bodies_of(self.context)
        made = np.zeros(len(bodies.elements))
        elements = context.ordinals("translate")
        inside = elements[context.is_within(elements, "mass_frame")]
        if len(inside):
            around = context.ancestor(inside, "rigid_body", "instance_rigid_body")
            rows = np.searchsorted(bodies.elements, around)
            np.add.at(made, rows, _lengths(context, inside))
        return made


def _lengths(context: Context, translates: Array) -> Array:
    """How far some translates move (n,)."""
    return np.asarray(np.linalg.norm(context.table("translate", translates, 3), axis=1))


def _ordinals(rows: Rows) -> Array:
    assert rows.ordinals is not None
    return rows.ordinals


def shapes_of(context: Context) -> Shapes:
    """The shapes of a document."""
    return context.shared(Shapes)

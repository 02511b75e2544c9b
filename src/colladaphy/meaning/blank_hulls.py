"""Shapes whose hulls are of nothing that has corners (COLLADA 1.5 §convex_mesh, §shape)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.body_table import Bodies, bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.shape_table import shapes_of

__all__ = ["CHECKS"]

Array = NDArray[Any]


def hulls(context: Context) -> Iterator[Hit]:
    """Hulls of curves and of other surfaces, which are no meshes."""
    elements = context.ordinals("convex_mesh")
    targets = context.led("convex_mesh", "convex_hull_of")
    strange = context.ordinals("spline", "brep")
    if not len(elements) or not len(strange):
        return
    contents = dict(zip(context.parent[strange].tolist(), strange.tolist(), strict=True))
    used = are_among(context.parent[elements], shapes_of(context).geometries)
    for element, target in zip(elements[used].tolist(), targets[used].tolist(), strict=True):
        content = contents.get(target)
        if content is not None:
            message = f"{context.label(target)} is a <{context.name(content)}>, not a mesh."
            yield Hit(geometry_rules.NO_FACES, element, message, (content,), "convex_hull_of")


def nothings(context: Context) -> Iterator[Hit]:
    """Shapes without an extent that have a density, of bodies that state no mass.

    With a mass, a body without an extent is one as good as any; that nobody says a mass or a
    density is told elsewhere.
    """
    shapes, bodies = shapes_of(context), bodies_of(context)
    if not len(shapes.mesh_rows):
        return
    elements = context.ordinals("convex_mesh")
    full = context.parent[context.ordinals("source")]
    empty = elements[~are_among(elements, full)]
    # A reference that leads nowhere is told there.
    present = context.leads("convex_mesh", "convex_hull_of").present
    empty = empty[~present[np.searchsorted(elements, empty)]]
    rows = shapes.mesh_rows[are_among(shapes.geometries, context.parent[empty])]
    holders = shapes.holders[rows]
    silent = bodies.moves[holders] & np.isnan(bodies.effective_masses()[holders])
    silent &= (shapes.mass_elements[rows] < 0) & (shapes.density_elements[rows] >= 0)
    rows = rows[silent]
    rows = rows[~_weighed(bodies, shapes.holders[rows])]
    instances = context.first_children("instance_geometry")
    for row in rows.tolist():
        shape = int(shapes.elements[row])
        body = context.label(int(bodies.elements[shapes.holders[row]]))
        message = f"The geometry is empty, but {body} has its mass from the density of it."
        yield Hit(geometry_rules.NO_VOLUME, instances.get(shape, shape), message, (shape,), "url")


def _weighed(bodies: Bodies, holders: Array) -> Array:
    """Which bodies (n,) have instances that all state a mass."""
    masses = bodies.masses
    found = np.zeros(len(holders), np.bool_)
    for place, holder in enumerate(holders.tolist()):
        rows = bodies.instances(int(bodies.body[holder]))
        found[place] = len(rows) > 0 and bool((~np.isnan(masses[rows])).all())
    return found


CHECKS = (hulls, nothings)

"""Surfaces of bodies: closed, wound outwards, convex where they say so (§convex_mesh)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.shape_table import shapes_of
from colladaphy.meaning.surface_table import Surfaces, surfaces_of

__all__ = ["CHECKS"]

Array = NDArray[Any]


_TOLERANCE = 1e-3
"""How far a convex mesh may be dented, by its extent."""


def convex_meshes(context: Context) -> Iterator[Hit]:
    """Convex meshes that are open, inside out or dented."""
    elements = context.ordinals("convex_mesh")
    if not len(elements):
        return
    stated = context.leads("convex_mesh", "convex_hull_of").present
    surfaces = surfaces_of(context)
    geometries = context.parent[elements].astype(np.int64)
    rows = surfaces.rows_of(geometries)
    empty = _without_volume(surfaces)
    doubtful = empty | (surfaces.volumes < 0.0)
    doubtful |= surfaces.dents > _TOLERANCE * surfaces.extents
    doubtful = np.append(doubtful, False)[rows] & ~stated
    for place in np.flatnonzero(doubtful).tolist():
        element, geometry, row = int(elements[place]), int(geometries[place]), int(rows[place])
        name = context.label(geometry)
        if not surfaces.closed[row]:
            message, rule = f"The convex mesh of {name} has holes.", geometry_rules.OPEN
        elif not surfaces.consistent[row]:
            message, rule = f"Faces of {name} are wound both ways.", geometry_rules.MIXED_WINDING
        elif empty[row]:
            message = f"The convex mesh of {name} has no volume."
            rule = geometry_rules.NO_VOLUME
        elif surfaces.volumes[row] < 0.0:
            message, rule = f"The faces of {name} are wound inwards.", geometry_rules.INWARD
        else:
            message = f"{name} is dented by {surfaces.dents[row]:.3g}."
            rule = geometry_rules.NOT_CONVEX
        yield Hit(rule, element, message, (geometry,))


def _without_volume(surfaces: Surfaces) -> Array:
    """Which surfaces (n,) have no volume that could be told."""
    with np.errstate(over="ignore"):
        none = np.abs(surfaces.volumes) <= 1e-9 * surfaces.extents**3
    return np.asarray(none | ~surfaces.closed | ~surfaces.consistent)


def faces(context: Context) -> Iterator[Hit]:
    """Shapes of geometries that have nothing but points and lines."""
    shapes = shapes_of(context)
    if not len(shapes.mesh_rows):
        return
    there = context.ordinals("triangles", "polygons", "polylist", "trifans", "tristrips")
    others = context.ordinals("mesh", "spline", "brep")
    lacking = are_among(shapes.geometries, context.parent[others])
    lacking &= ~are_among(shapes.geometries, context.ancestor(there, "geometry"))
    for place in np.flatnonzero(lacking).tolist():
        row, geometry = int(shapes.mesh_rows[place]), int(shapes.geometries[place])
        content = _content(context, geometry, "mesh", "spline", "brep")
        message = f"{context.label(geometry)} is a <{context.name(content)}> without faces."
        if context.name(content) == "brep":
            message = f"{context.label(geometry)} is a <brep>, not a mesh."
        instances = context.first_children("instance_geometry")
        element = instances.get(int(shapes.elements[row]), int(shapes.elements[row]))
        yield Hit(geometry_rules.NO_FACES, element, message, (content,), "url")


def moving_meshes(context: Context) -> Iterator[Hit]:
    """Meshes of bodies that move whose mass or inertia has to be computed, and cannot."""
    shapes, surfaces = shapes_of(context), surfaces_of(context)
    rows = surfaces.rows_of(shapes.geometries)
    doubtful = np.append(_without_volume(surfaces), False)[rows]
    told: set[int] = set()
    for place in np.flatnonzero(doubtful & shapes.computed(shapes.mesh_rows)).tolist():
        row, geometry = int(rows[place]), int(shapes.geometries[place])
        element = _content(context, geometry, "mesh", "convex_mesh")
        if geometry in told or context.name(element) != "mesh":
            continue
        told.add(geometry)
        name, related = context.label(geometry), (int(shapes.elements[shapes.mesh_rows[place]]),)
        if not surfaces.closed[row]:
            message = f"The mesh of {name} has holes, and a body that moves is made of it."
            rule = geometry_rules.OPEN
        elif not surfaces.consistent[row]:
            message, rule = f"Faces of {name} are wound both ways.", geometry_rules.MIXED_WINDING
        else:
            message, rule = f"The mesh of {name} has no volume.", geometry_rules.NO_VOLUME
        yield Hit(rule, element, message, related)


def _content(context: Context, geometry: int, *names: str) -> int:
    return context.first_children(*names).get(geometry, geometry)


CHECKS = (faces, convex_meshes, moving_meshes)

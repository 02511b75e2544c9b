"""Surfaces of bodies: closed, wound outwards, convex where they say so (§convex_mesh)."""

from __future__ import annotations

from collections.abc import Iterator

from colladaphy.meaning import geometry_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.shape_table import shapes_of
from colladaphy.meaning.surface_table import surface_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]


_TOLERANCE = 1e-3
"""How far a convex mesh may be dented, by its extent."""


def convex_meshes(context: Context) -> Iterator[Hit]:
    """Convex meshes that are open, inside out or dented."""
    rows = context.rows(Rows, "convex_mesh")
    if not len(rows):
        return
    assert rows.ordinals is not None
    for element, hull_of in zip(
        rows.ordinals.tolist(), context.texts(rows, "convex_hull_of"), strict=True
    ):
        if hull_of is not None:
            continue
        geometry = int(context.parent[element])
        surface = surface_of(context, geometry)
        if surface is None:
            continue
        name = context.label(geometry)
        if not surface.is_closed:
            yield Hit(
                geometry_rules.OPEN, element, f"The convex mesh of {name} has holes.", (geometry,)
            )
        elif not surface.is_consistent:
            yield Hit(
                geometry_rules.MIXED_WINDING,
                element,
                f"Faces of {name} are wound both ways.",
                (geometry,),
            )
        elif abs(surface.volume) <= 1e-9 * _cube(surface.extent):
            yield Hit(
                geometry_rules.NO_VOLUME,
                element,
                f"The convex mesh of {name} has no volume.",
                (geometry,),
            )
        elif surface.volume < 0.0:
            message = f"The faces of {name} are wound inwards."
            yield Hit(geometry_rules.INWARD, element, message, (geometry,))
        elif surface.dent > _TOLERANCE * surface.extent:
            message = f"{name} is dented by {surface.dent:.3g}."
            yield Hit(geometry_rules.NOT_CONVEX, element, message, (geometry,))


def faces(context: Context) -> Iterator[Hit]:
    """Shapes of geometries that have nothing but points and lines."""
    shapes = shapes_of(context)
    if not shapes.meshes():
        return
    there = context.ordinals("triangles", "polygons", "polylist", "trifans", "tristrips")
    with_faces = set(context.ancestor(there, "geometry").tolist())
    others = context.first_children("mesh", "spline")
    for row, geometry in shapes.meshes():
        if geometry in others and geometry not in with_faces:
            name = context.name(others[geometry])
            message = f"{context.label(geometry)} is a <{name}> without faces."
            instances = context.first_children("instance_geometry")
            element = instances.get(int(shapes.elements[row]), int(shapes.elements[row]))
            yield Hit(geometry_rules.NO_FACES, element, message, (others[geometry],), "url")


def _cube(size: float) -> float:
    """Infinite where a power would raise OverflowError."""
    return size * size * size


def moving_meshes(context: Context) -> Iterator[Hit]:
    """Meshes of bodies that move whose mass or inertia has to be computed, and cannot."""
    shapes = shapes_of(context)
    told: set[int] = set()
    for row, geometry in shapes.meshes():
        if geometry in told or not shapes.computed(row):
            continue
        told.add(geometry)
        if context.name(_content(context, geometry)) != "mesh":
            continue
        surface = surface_of(context, geometry)
        if surface is None:
            continue
        element = _content(context, geometry)
        name, related = context.label(geometry), (int(shapes.elements[row]),)
        if not surface.is_closed:
            message = f"The mesh of {name} has holes, and a body that moves is made of it."
            yield Hit(geometry_rules.OPEN, element, message, related)
        elif not surface.is_consistent:
            yield Hit(
                geometry_rules.MIXED_WINDING,
                element,
                f"Faces of {name} are wound both ways.",
                related,
            )
        elif abs(surface.volume) <= 1e-9 * _cube(surface.extent):
            yield Hit(
                geometry_rules.NO_VOLUME, element, f"The mesh of {name} has no volume.", related
            )


def _content(context: Context, geometry: int) -> int:
    return context.first_children("mesh", "convex_mesh").get(geometry, geometry)


CHECKS = (faces, convex_meshes, moving_meshes)

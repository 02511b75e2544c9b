"""Shapes in Bullet's reading of them: planes the other way round, cylinders of half height.

See shared facts of the converter: a plane's equation is Ax + By + Cz = D, its normal is normalised
and D is not; a cylinder's height is taken for half of it; one radius counts (COLLADA 1.5 §plane,
§cylinder, §capsule).
"""

from __future__ import annotations

import math

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.aside import note_primitive
from colladaphy.conform.bullet.geometries import Geometries
from colladaphy.conform.bullet.markup import children, number_text, numbers_text
from colladaphy.conform.bullet.solids import (
    Solid,
    capsule_mesh,
    cylinder_mesh,
    mesh_solid,
    primitive_solid,
)
from colladaphy.conform.downgrade.draft import Draft, local
from colladaphy.conform.frames import floats_of

__all__ = ["geometry_of", "solid_of", "write_shape"]

_GEOMETRIES = ("instance_geometry", "plane", "box", "sphere", "cylinder", "capsule")


def geometry_of(shape: etree._Element) -> etree._Element:
    """The element that says what the shape is; the schema asks for exactly one."""
    return children(shape, *_GEOMETRIES)[0]


def _values(geometry: etree._Element) -> dict[str, list[float]]:
    return {
        local(child): floats_of(child)
        for child in geometry
        if local(child) in ("half_extents", "radius", "height", "equation")
    }


def solid_of(shape: etree._Element, geometries: Geometries) -> Solid | None:
    """Volume and centre of a shape in its own frame; None where it has none."""
    geometry = geometry_of(shape)
    if local(geometry) == "instance_geometry":
        surface = geometries.surface(geometry.get("url", ""))
        return None if surface is None else surface.solid
    return primitive_solid(local(geometry), _values(geometry))


def is_readable(shape: etree._Element, geometries: Geometries) -> bool:
    """Whether Bullet makes a shape of it."""
    geometry = geometry_of(shape)
    if local(geometry) != "instance_geometry":
        return True
    return geometries.surface(geometry.get("url", "")) is not None


def write_shape(
    draft: Draft, shape: etree._Element, geometries: Geometries, *, moves: bool
) -> None:
    """Change a shape so that Bullet reads what the standard means."""
    geometry = geometry_of(shape)
    values = _values(geometry)
    match local(geometry):
        case "plane":
            _write_plane(geometry)
        case "cylinder":
            _write_cylinder(draft, geometry, values, geometries)
        case "capsule":
            radii = values["radius"]
            if not radii[0] == radii[1] == radii[2]:
                _write_mesh(draft, geometry, capsule_mesh(values["height"][0], radii), geometries)
        case "instance_geometry":
            surface = geometries.surface(geometry.get("url", ""))
            if surface is not None:
                geometry.set("url", surface.url)
                if moves and not surface.convex:
                    message = f"Bullet takes the hull of the moving mesh {surface.url!r}."
                    draft.note(rules.CONVEX, shape, message)


def _write_plane(plane: etree._Element) -> None:
    equation = children(plane, "equation")[0]
    numbers = np.array(floats_of(equation))
    length = math.sqrt(float(numbers[:3] @ numbers[:3]))
    if 0.0 < length < math.inf:
        numbers = numbers / length if length != 1.0 else numbers
    numbers[3] = 0.0 - numbers[3]
    equation.text = numbers_text(numbers)


def _write_cylinder(
    draft: Draft,
    cylinder: etree._Element,
    values: dict[str, list[float]],
    geometries: Geometries,
) -> None:
    height, radii = values["height"][0], values["radius"]
    if radii[0] != radii[1] and _write_mesh(
        draft, cylinder, cylinder_mesh(height, radii), geometries
    ):
        return
    children(cylinder, "height")[0].text = number_text(height / 2)


def _write_mesh(
    draft: Draft,
    primitive: etree._Element,
    mesh: tuple[np.ndarray[tuple[int, int], np.dtype[np.float64]], np.ndarray],
    geometries: Geometries,
) -> bool:
    """Put a convex mesh in the place of a primitive, unless it would have no volume."""
    points, triangles = mesh
    if mesh_solid(points, triangles) is None:
        return False
    url = geometries.add(f"{local(primitive)}-bullet", points, triangles, convex=True)
    message = f"The <{local(primitive)}> with different radii became the convex mesh {url!r}."
    draft.note(rules.TESSELLATED, primitive, message)
    note_primitive(draft, primitive, geometries.element(url))
    instance = draft.make("instance_geometry", attributes={"url": url})
    primitive.addprevious(instance)
    parent = primitive.getparent()
    if parent is not None:
        parent.remove(primitive)
    return True

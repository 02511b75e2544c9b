"""Geometry of shapes: that of the common profile, and the exact values of the pe profile.

The frames differ: COLLADA's capsule and cylinder lie along y, the World's along x, so such a shape
is turned by -90 degrees about z; COLLADA's box has half extents, the World's full lengths; a mesh
keeps its vertices and is moved so that its centre of mass is the body's origin.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import differs
from colladaphy.mapper.storing.rows import Index, picked, where_there
from colladaphy.world.kinds import Kind
from colladaphy_schema import pe_columns as pe
from colladaphy_schema.geometry_columns import (
    BoxTypeRows,
    CapsuleTypeRows,
    CylinderTypeRows,
    InstanceGeometryTypeRows,
    PlaneTypeRows,
    SphereTypeRows,
)
from colladaphy_schema.physics_columns import RigidBodyTypeTechniqueCommonShapeRows

__all__ = ["add_exact_geometry", "add_geometry", "halves_are_exact", "is_turned"]

Array = NDArray[Any]

SPHERE, BOX, CAPSULE, CYLINDER, ELLIPSOID, PLANE = map(
    int, (Kind.SPHERE, Kind.BOX, Kind.CAPSULE, Kind.CYLINDER, Kind.ELLIPSOID, Kind.PLANE)
)
_LEAST = 5e-324


def is_turned(kinds: Array) -> Array:
    """Where the axis is y in COLLADA and x in the World."""
    return np.asarray((kinds == CAPSULE) | (kinds == CYLINDER))


def halves_are_exact(dimensions: Array) -> Array:
    """Where halved side lengths double to the same bits (not among the tiniest numbers)."""
    return ~differs(dimensions / 2.0 * 2.0, dimensions)


def add_geometry(
    rows: RigidBodyTypeTechniqueCommonShapeRows,
    kinds: Array,
    dimensions: Array,
    equations: Array,
    urls: list[str | None] | None,
) -> None:
    """Add the geometry of each shape: that of a url, where it has one, or of its kind.

    `equations` (n, 4) are those of planes in the frames of their rigid bodies.
    """
    if urls is not None:
        is_instance = np.fromiter((url is not None for url in urls), np.bool_, len(urls))
        instances, index = where_there(InstanceGeometryTypeRows, is_instance)
        instances.url = picked(urls, index)
        rows.instance_geometry = instances
        kinds = np.where(is_instance, -1, kinds)
    for kind in np.flatnonzero(np.bincount(kinds[kinds >= 0])).tolist():
        there = kinds == kind
        if kind == SPHERE:
            spheres, index = where_there(SphereTypeRows, there)
            spheres.radius = dimensions[index, 0]
            rows.sphere = spheres
        elif kind == BOX:
            boxes, index = where_there(BoxTypeRows, there)
            boxes.half_extents = np.maximum(dimensions[index, :3] / 2.0, _LEAST)
            rows.box = boxes
        elif kind == CYLINDER:
            cylinders, index = where_there(CylinderTypeRows, there)
            cylinders.height = dimensions[index, 3]
            cylinders.radius = dimensions[index, 1:3]
            rows.cylinder = cylinders
        elif kind in (CAPSULE, ELLIPSOID):
            continue
        else:
            assert kind == PLANE
            planes, index = where_there(PlaneTypeRows, there)
            planes.equation = equations[index]
            rows.plane = planes
    _add_capsules(rows, kinds, dimensions)


def _add_capsules(
    rows: RigidBodyTypeTechniqueCommonShapeRows, kinds: Array, dimensions: Array
) -> None:
    # COLLADA 1.5 has no ellipsoid, but a capsule of no height with three radii is one.
    upright = kinds == ELLIPSOID
    there = (kinds == CAPSULE) | upright
    if not there.any():
        return
    capsules, index = where_there(CapsuleTypeRows, there)
    upright, sizes = upright[index], dimensions[index]
    capsules.height = np.where(upright, 0.0, sizes[:, 3])
    capsules.radius = np.where(upright[:, None], sizes[:, :3], sizes[:, [1, 0, 2]])
    rows.capsule = capsules


def add_exact_geometry(
    rows: pe.ShapeTypeRows, kinds: Array, dimensions: Array, anchors: Array | None
) -> None:
    """Add the geometry with every dimension exact (thesis, listing 3), except where kinds are -1.

    `anchors` (n, 3) are points on planes, None for none.
    """
    for kind in np.flatnonzero(np.bincount(kinds[kinds >= 0])).tolist():
        there = kinds == kind
        if kind == PLANE:
            planes, index = where_there(pe.PlaneTypeRows, there)
            planes.normal = dimensions[index, :3]
            planes.displacement = dimensions[index, 3]
            if anchors is not None:
                planes.anchor = anchors[index]
            rows.plane = planes
        elif kind == SPHERE:
            spheres, index = where_there(pe.SphereTypeRows, there)
            spheres.radius = dimensions[index, 0]
            rows.sphere = spheres
        elif kind == BOX:
            boxes, index = where_there(pe.BoxTypeRows, there)
            boxes.lengths = dimensions[index, :3]
            rows.box = boxes
        elif kind == ELLIPSOID:
            ellipsoids, index = where_there(pe.EllipsoidTypeRows, there)
            ellipsoids.radii = dimensions[index, :3]
            rows.ellipsoid = ellipsoids
        elif kind == CAPSULE:
            capsules, index = where_there(pe.CapsuleRows, there)
            _rod(capsules, dimensions, index)
            rows.capsule = capsules
        else:
            assert kind == CYLINDER
            cylinders, index = where_there(pe.CylinderRows, there)
            _rod(cylinders, dimensions, index)
            rows.cylinder = cylinders


def _rod(rows: pe.CapsuleRows | pe.CylinderRows, dimensions: Array, index: Index) -> None:
    radii = pe.RadiiRows(len(rows))
    radii.value = dimensions[index, :3]
    rows.radii = radii
    rows.length = dimensions[index, 3]

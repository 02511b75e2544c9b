"""Shapes as text: geometry of the common profile, and the pe profile's exact values.

The frames differ: COLLADA's capsule and cylinder lie along y, the World's along x, so such a shape
is turned by -90 degrees about z; COLLADA's box has half extents, the World's full lengths; a mesh
keeps its vertices and is moved so that its centre of mass is the body's origin.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import column_texts, floats_text, row_texts, same_bits
from colladaphy.world.kinds import Kind
from colladaphy.world.meshes import Mesh

__all__ = ["AXIS_STEP", "geometry_texts", "profile_geometry", "settling_steps"]

Array = NDArray[Any]

AXIS_STEP = "<rotate>0 0 1 -90</rotate>"
"""Turns COLLADA's y axis of capsules and cylinders onto the World's x axis."""


def geometry_texts(
    kinds: Array, dimensions: Array, mesh_ids: Array, planes: Mapping[int, Sequence[float]]
) -> list[str]:
    """The geometry element of each of (n,) primitives.

    `planes` has normal and displacement of the plane in each row that is one, in the frame of the
    rigid_body.
    """
    texts = [""] * len(kinds)
    for kind in np.unique(kinds).tolist():
        rows = np.flatnonzero(kinds == kind)
        made = _of_kind(Kind(kind), rows, dimensions[rows], mesh_ids, planes)
        if len(rows) == len(kinds):
            return made
        for row, text in zip(rows.tolist(), made, strict=True):
            texts[row] = text
    return texts


def _of_kind(
    kind: Kind,
    rows: Array,
    dimensions: Array,
    mesh_ids: Array,
    planes: Mapping[int, Sequence[float]],
) -> list[str]:
    match kind:
        case Kind.SPHERE:
            radii = column_texts(dimensions[:, 0])
            return [f"<sphere><radius>{radius}</radius></sphere>" for radius in radii]
        case Kind.BOX:
            halves = row_texts(np.maximum(dimensions[:, :3] / 2.0, 5e-324))
            return [f"<box><half_extents>{half}</half_extents></box>" for half in halves]
        case Kind.CAPSULE:
            heights = column_texts(dimensions[:, 3])
            radii = row_texts(dimensions[:, [1, 0, 2]])
            return [
                f"<capsule><height>{height}</height><radius>{radius}</radius></capsule>"
                for height, radius in zip(heights, radii, strict=True)
            ]
        case Kind.CYLINDER:
            heights = column_texts(dimensions[:, 3])
            radii = row_texts(dimensions[:, [1, 2]])
            return [
                f"<cylinder><height>{height}</height><radius>{radius}</radius></cylinder>"
                for height, radius in zip(heights, radii, strict=True)
            ]
        case Kind.ELLIPSOID:
            # COLLADA 1.5 has no ellipsoid, but a capsule of no height with three radii is one.
            radii = row_texts(dimensions[:, :3])
            return [
                f"<capsule><height>0</height><radius>{radius}</radius></capsule>"
                for radius in radii
            ]
        case Kind.PLANE:
            return [
                f"<plane><equation>{floats_text(_equation(planes[row]))}</equation></plane>"
                for row in rows.tolist()
            ]
        case Kind.MESH:
            return [f'<instance_geometry url="#Mesh{id}"/>' for id in mesh_ids[rows].tolist()]
        case _:
            return [""] * len(rows)


def _equation(plane: Sequence[float]) -> tuple[float, float, float, float]:
    """Ax + By + Cz + D = 0 where the World has n·x = d."""
    a, b, c, displacement = plane
    return a, b, c, -displacement


def settling_steps(kind: Kind, mesh: Mesh | None) -> str:
    """The transforms that put a geometry into the body's own frame."""
    if kind in (Kind.CAPSULE, Kind.CYLINDER):
        return AXIS_STEP
    if mesh is not None:
        center = mesh.center
        if np.any(center != 0.0):
            return f"<translate>{floats_text((-center).tolist())}</translate>"
    return ""


def halves_are_exact(dimensions: Array) -> Array:
    """Where halved side lengths double to the same bits (not among the tiniest numbers)."""
    return np.asarray(np.all(same_bits(dimensions / 2.0 * 2.0, dimensions), axis=-1))


def profile_geometry(
    kind: Kind, dimensions: Sequence[float], anchor: Sequence[float] | None
) -> str:
    """The geometry of the pe profile, with every dimension exact (thesis, listing 3)."""
    x, y, z, length = dimensions
    match kind:
        case Kind.PLANE:
            point = "" if anchor is None else f"<pe:anchor>{floats_text(anchor)}</pe:anchor>"
            return (
                f"<pe:plane><pe:normal>{floats_text((x, y, z))}</pe:normal>{point}"
                f"<pe:displacement>{floats_text((length,))}</pe:displacement></pe:plane>"
            )
        case Kind.SPHERE:
            return f"<pe:sphere><pe:radius>{floats_text((x,))}</pe:radius></pe:sphere>"
        case Kind.BOX:
            return f"<pe:box><pe:lengths>{floats_text((x, y, z))}</pe:lengths></pe:box>"
        case Kind.ELLIPSOID:
            return f"<pe:ellipsoid><pe:radii>{floats_text((x, y, z))}</pe:radii></pe:ellipsoid>"
        case Kind.CAPSULE | Kind.CYLINDER:
            name = kind.name.lower()
            return (
                f"<pe:{name}><pe:radii>{floats_text((x, y, z))}</pe:radii>"
                f"<pe:length>{floats_text((length,))}</pe:length></pe:{name}>"
            )
        case _:
            return ""

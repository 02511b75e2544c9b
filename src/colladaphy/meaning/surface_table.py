"""The surfaces of geometries as triangles (COLLADA 1.5 §mesh)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.meaning.arrays import sources_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.primitives import groups_of, miscounted

__all__ = ["Surface", "surface_of"]

Array = NDArray[Any]


@dataclass(slots=True)
class Surface:
    """The faces of a geometry as triangles, equal points made one."""

    points: Array
    """(n, 3)."""
    triangles: Array
    """(m, 3), fans of the faces."""
    is_closed: bool
    is_consistent: bool
    """Whether faces that share an edge are wound alike."""
    edges: Array
    """(k, 2) the edges of faces, along their winding."""
    edge_faces: Array
    """(k,) the first triangle of the face of each edge."""

    @property
    def volume(self) -> float:
        """The signed volume; positive where it is wound outwards."""
        if not len(self.triangles):
            return 0.0
        middle = self.points.mean(axis=0)
        one, two, three = (self.points[self.triangles[:, k]] - middle for k in range(3))
        return float(np.sum(np.cross(one, two) * three)) / 6.0

    @property
    def extent(self) -> float:
        """The largest side of the box around it."""
        return float(np.ptp(self.points, axis=0).max(initial=0.0)) if len(self.points) else 0.0


def _rings(context: Context, geometry_of: dict[int, int]) -> dict[int, list[tuple[Array, Array]]]:
    """The corners, and the sizes, of the faces of each geometry."""
    inputs = inputs_of(context)
    found: dict[int, list[tuple[Array, Array]]] = {}
    # Of what is not counted right, nobody can tell the faces.
    wrong = {geometry_of.get(element, -1) for element in miscounted(context)}
    for group in groups_of(context):
        geometry = geometry_of.get(group.element, -1)
        row = inputs.named(group.element, "VERTEX")
        if geometry < 0 or geometry in wrong or row < 0 or group.name in ("lines", "linestrips"):
            continue
        corners = [values[int(inputs.offsets[row]) :: group.stride] for _, values in group.parts]
        made = found.setdefault(geometry, [])
        for part in corners:
            if group.name == "triangles":
                made.append((part[: len(part) // 3 * 3], np.full(len(part) // 3, 3)))
            elif group.name == "polylist":
                if group.vcount is not None and int(group.vcount[1].sum()) == len(part):
                    made.append((part, group.vcount[1]))
            elif group.name == "polygons":
                made.append((part, np.array([len(part)])))
            elif len(part) > 2:
                count = len(part) - 2
                first = np.broadcast_to(part[:1], (count,))
                if group.name == "tristrips":
                    first = part[:count]
                fan = np.stack([first, part[1:-1], part[2:]], axis=1)
                if group.name == "tristrips":
                    fan[1::2] = fan[1::2, ::-1]
                made.append((fan.reshape(-1), np.full(count, 3)))
    return found


def surface_of(context: Context, geometry: int) -> Surface | None:
    """The surface of a geometry; None where it has faulty indices, numbers or none at all."""
    known = context.shared(_known_surfaces)
    if geometry not in known:
        known[geometry] = _made(context, geometry)
    return known[geometry]


def _known_surfaces(context: Context) -> dict[int, Surface | None]:
    return {}


def _all_rings(context: Context) -> dict[int, list[tuple[Array, Array]]]:
    groups = np.array([group.element for group in groups_of(context)], np.int64)
    around = context.ancestor(groups, "geometry") if len(groups) else groups
    return _rings(context, dict(zip(groups.tolist(), around.tolist(), strict=True)))


def _vertices_of(context: Context) -> dict[int, int]:
    elements = context.ordinals("vertices")
    around = context.ancestor(elements, "geometry")
    return dict(zip(around.tolist(), elements.tolist(), strict=True))


def _made(context: Context, geometry: int) -> Surface | None:
    rings = context.shared(_all_rings).get(geometry)
    vertices = context.shared(_vertices_of).get(geometry)
    if not rings or vertices is None:
        return None
    source = inputs_of(context).source(vertices, "POSITION")
    points = None if source < 0 else sources_of(context).numbers(source)
    if points is None or points.shape[1] < 3 or not len(points) or not np.isfinite(points).all():
        return None
    corners = counted(np.concatenate([part for part, _ in rings]))
    sizes = counted(np.concatenate([part for _, part in rings]))
    if not len(corners) or int(corners.max()) >= len(points) or bool(np.any(sizes < 3)):
        return None
    distinct, inverse = np.unique(points[:, :3] + 0.0, axis=0, return_inverse=True)
    corners = inverse.reshape(-1)[corners]
    ends = np.cumsum(sizes)
    starts = ends - sizes
    after = np.append(corners[1:], 0)
    after[ends - 1] = corners[starts]
    faces = sizes - 2
    first = np.cumsum(faces) - faces
    owner = np.repeat(np.arange(len(sizes)), sizes)
    real = corners != after
    edges = np.stack([corners, after], axis=1)[real]
    owner = owner[real]
    number = np.arange(int(faces.sum())) - np.repeat(first, faces)
    begin = np.repeat(starts, faces)
    triangles = np.stack([corners[begin], corners[begin + number + 1],
                          corners[begin + number + 2]], axis=1)  # fmt: skip
    forward = edges[:, 0] * len(distinct) + edges[:, 1]
    backward = edges[:, 1] * len(distinct) + edges[:, 0]
    _, counts = np.unique(np.minimum(forward, backward), return_counts=True)
    closed = bool(np.all(counts % 2 == 0))
    there = np.sort(forward)
    consistent = bool(np.array_equal(there, np.sort(backward)))
    return Surface(distinct, triangles, closed, consistent, edges, first[owner])

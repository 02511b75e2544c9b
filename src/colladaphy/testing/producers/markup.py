"""The parts that files of all producers are made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from colladaphy.testing.markup import numbers, tag
from colladaphy.testing.producers.truth import Solid, Steps

__all__ = [
    "SIDES",
    "geometry",
    "matrix_element",
    "mesh",
    "primitive",
    "source",
    "steps_of",
    "transforms",
]

# A box's sides by its corners in the order of Solid.points, seen from outside.
SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def transforms(steps: Steps) -> str:
    """translate and rotate elements."""
    return "".join(tag(name, numbers(values)) for name, values in steps)


def matrix_element(matrix: NDArray[np.float64]) -> str:
    """A matrix element, row by row."""
    return tag("matrix", numbers(matrix.ravel().tolist()))


def steps_of(matrix: NDArray[np.float64]) -> Steps:
    """A rigid matrix as one translation and one rotation, as exporters write it."""
    turn = matrix[:3, :3]
    angle = float(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    if np.linalg.norm(axis) < 1e-6:
        # No turn, or half a turn: the axis is that of the symmetric part.
        values, vectors = np.linalg.eigh((turn + turn.T) / 2)
        axis = vectors[:, int(np.argmax(values))]
        angle = 0.0 if np.trace(turn) > 0 else np.pi
    axis = axis / np.linalg.norm(axis)
    where = ("translate", tuple(matrix[:3, 3].tolist()))
    return (where, ("rotate", (*axis.tolist(), float(np.degrees(angle)))))


def source(id: str, points: NDArray[np.float64], digits: str | None = None) -> str:
    """A source of x, y, z."""
    array = tag(
        "float_array",
        numbers(points.ravel().tolist()),
        id=f"{id}-array",
        count=points.size,
        digits=digits,
    )
    params = "".join(tag("param", name=axis, type="float") for axis in "XYZ")
    accessor = tag("accessor", params, source=f"#{id}-array", count=len(points), stride=3)
    return tag("source", array, tag("technique_common", accessor), id=id)


def mesh(
    id: str,
    solid: Solid,
    *,
    vertices: str | None = None,
    digits: str | None = None,
    primitive: str = "triangles",
    name: str = "mesh",
) -> str:
    """The mesh of a box: triangles, polygons or a polylist."""
    vertices = vertices or f"{id}-vertices"
    position = tag("input", semantic="POSITION", source=f"#{id}-positions")
    use = tag("input", semantic="VERTEX", source=f"#{vertices}", offset=0)
    if primitive == "triangles":
        corners = [c for a, b, d, e in SIDES for c in (a, b, d, a, d, e)]
        faces = tag("triangles", use, tag("p", " ".join(map(str, corners))), count=12)
    elif primitive == "polylist":
        corners = [c for side in SIDES for c in side]
        faces = tag(
            "polylist",
            use,
            tag("vcount", "4 4 4 4 4 4"),
            tag("p", " ".join(map(str, corners))),
            count=6,
        )
    else:
        faces = tag(
            "polygons", use, *(tag("p", " ".join(map(str, side))) for side in SIDES), count=6
        )
    return tag(
        name,
        source(f"{id}-positions", solid.points, digits),
        tag("vertices", position, id=vertices),
        faces,
    )


def geometry(id: str, solid: Solid, **options: str | None) -> str:
    """A geometry of the mesh of a box; options are those of `mesh`."""
    return tag("geometry", mesh(id, solid, **options), id=id, name=id)  # type: ignore[arg-type]


def primitive(solid: Solid, *, long: bool = False, two_radii: bool = False) -> str:
    """A primitive of the standard; with `long` in the forms of 1.4 that 1.5 has not."""
    match solid.kind:
        case "box":
            return tag("box", tag("half_extents", numbers(solid.size)))
        case "sphere":
            count = 3 if long else 1
            return tag("sphere", tag("radius", numbers(solid.size * count)))
    radius, height = solid.size
    count = 3 if solid.kind == "capsule" and not two_radii else 2
    return tag(
        solid.kind,
        tag("height", numbers([height])),
        tag("radius", numbers([radius] * count)),
    )

"""The outline that a shape has in a plane that it is symmetric to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from colladaphy.world import Body, Kind, rotations

if TYPE_CHECKING:
    from colladaphy.engines.planar import Frame

__all__ = ["Disc", "HalfPlane", "Outline", "OutlineError", "Polygon", "Stadium", "outline"]

Floats = NDArray[np.float64]


class OutlineError(Exception):
    """Why a shape has no outline that would collide as the shape does."""


@dataclass(frozen=True, slots=True)
class Disc:
    """A circle; all points in coordinates of the plane."""

    material: int
    center: Floats
    radius: float


@dataclass(frozen=True, slots=True)
class Polygon:
    """A convex polygon."""

    material: int
    corners: Floats


@dataclass(frozen=True, slots=True)
class Stadium:
    """All points within `radius` of a segment."""

    material: int
    start: Floats
    end: Floats
    radius: float


@dataclass(frozen=True, slots=True)
class HalfPlane:
    """Solid behind the line through `point` across `normal`."""

    material: int
    point: Floats
    normal: Floats


Outline = Disc | Polygon | Stadium | HalfPlane


def outline(body: Body, frame: Frame, tolerance: float, size: float) -> Outline:
    """The outline of a primitive in the plane of `frame`.

    Raises OutlineError, with the reason, where there is none: the shape is tilted against the
    plane, out of it, or of a kind whose section does not collide as the shape does.
    """
    material = body.material
    id = -1 if material is None else material.id
    position, orientation = body.position, body.orientation
    dimensions = body.dimensions
    if body.kind is Kind.PLANE:
        normal = body.normal
        if abs(float(frame.height(normal))) > tolerance:
            raise OutlineError("The surface of a plane does not stand on the plane of motion")
        flat = frame.flat(normal)
        flat = flat / np.hypot(flat[0], flat[1])
        return HalfPlane(id, frame.flat(normal) * body.displacement, flat)
    reach = max(size, float(np.max(dimensions)))
    if abs(float(frame.height(position)) - frame.offset) > tolerance * reach:
        raise OutlineError("The shape lies out of the plane")
    center = frame.flat(position)
    if body.kind is Kind.SPHERE:
        return Disc(id, center, float(dimensions[0]))
    axes = rotations.to_matrix(orientation).T
    heights = np.abs(frame.height(axes))
    along = heights >= 1.0 - tolerance**2 * 4
    across = heights <= 2 * tolerance
    match body.kind:
        case Kind.BOX:
            if not along.any():
                raise OutlineError("The box is tilted")
            return _rectangle(id, center, frame, axes, dimensions[:3] / 2, int(np.argmax(along)))
        case Kind.CYLINDER | Kind.CAPSULE:
            return _rod(body, id, center, frame, axes, along, across)
        case _:
            raise OutlineError(f"The engine knows no {body.kind.name.lower()}")


def _rectangle(
    id: int, center: Floats, frame: Frame, axes: Floats, halves: Floats, along: int
) -> Polygon:
    first, second = (axis for axis in range(3) if axis != along)
    a = frame.flat(axes[first]) * halves[first]
    b = frame.flat(axes[second]) * halves[second]
    return Polygon(id, np.array([center - a - b, center + a - b, center + a + b, center - a + b]))


def _rod(
    body: Body,
    id: int,
    center: Floats,
    frame: Frame,
    axes: Floats,
    along: NDArray[np.bool_],
    across: NDArray[np.bool_],
) -> Outline:
    cap, y, z, length = body.dimensions.tolist()
    name = body.kind.name.lower()
    if along[0]:
        if y != z:
            raise OutlineError(f"The {name} is elliptic")
        return Disc(id, center, y)
    if not across[0]:
        raise OutlineError(f"The {name} is tilted")
    if y != z and not (along[1] or along[2]):
        raise OutlineError(f"The elliptic {name} is tilted")
    radius = z if along[1] else y
    half = frame.flat(axes[0]) * (length / 2)
    if body.kind is Kind.CAPSULE:
        if cap != radius:
            raise OutlineError("The caps of the capsule are elliptic")
        return Stadium(id, center - half, center + half, radius)
    side = np.array([-half[1], half[0]]) / (length / 2) * radius
    corners = [center - half - side, center + half - side, center + half + side,
               center - half + side]  # fmt: skip
    return Polygon(id, np.array(corners))

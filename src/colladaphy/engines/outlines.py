"""The outlines that shapes have in a plane that they are symmetric to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.plane import Frame
from colladaphy.world import Kind, rotations

if TYPE_CHECKING:
    from colladaphy.world import Body, World

__all__ = ["Disc", "HalfPlane", "Outline", "Polygon", "Stadium", "outlines"]

Floats = NDArray[np.float64]


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


def outlines(
    world: World, frame: Frame, tolerance: float, size: float
) -> Iterator[tuple[int, int, Outline | str]]:
    """System id of the top-level body, that of the shape, and its outline in the plane of `frame`.

    Instead of the outline there is the reason why there is none: the shape is tilted against the
    plane, out of it, or of a kind whose section does not collide as the shape does. Bodies come
    in the order of their system ids, the shapes of a union in that of its members.
    """
    columns = world.columns()
    tops: NDArray[Any] = columns.kinds != Kind.UNION
    tops &= columns.kinds != Kind.EMPTY
    singles = _Shapes.of_columns(columns, np.flatnonzero(tops))
    place = 0
    for row, body in enumerate(world.bodies):
        if tops[row]:
            yield body.sid, body.sid, singles.outline(place, frame, tolerance, size)
            place += 1
            continue
        leaves = [leaf for leaf in _leaves(body) if leaf.kind is not Kind.EMPTY]
        if not leaves:
            continue
        parts = _Shapes.of_bodies(leaves)
        for index, leaf in enumerate(leaves):
            yield body.sid, leaf.sid, parts.outline(index, frame, tolerance, size)


def _leaves(body: Body) -> Iterator[Body]:
    """The primitives and meshes that a body is made of, in order."""
    members = body.members
    if not members:
        yield body
    for member in members:
        yield from _leaves(member)


class _Shapes:
    """Primitives by column, in world coordinates."""

    def __init__(
        self, kinds: Any, materials: Any, positions: Floats, orientations: Floats, dimensions: Any
    ) -> None:
        self._kinds = [Kind(kind) for kind in kinds]
        self._materials = materials
        self._positions = positions
        self._axes = np.swapaxes(rotations.to_matrix(orientations), -1, -2)
        self._dimensions = dimensions
        self._frame: Frame | None = None

    @classmethod
    def of_columns(cls, columns: Any, rows: NDArray[Any]) -> _Shapes:
        return cls(
            columns.kinds[rows].tolist(),
            columns.material_ids[rows].tolist(),
            columns.positions[rows],
            columns.orientations[rows],
            columns.dimensions[rows].tolist(),
        )

    @classmethod
    def of_bodies(cls, bodies: list[Body]) -> _Shapes:
        dimensions = [
            [*body.normal, body.displacement] if body.kind is Kind.PLANE else body.dimensions
            for body in bodies
        ]
        materials = [body.material for body in bodies]
        return cls(
            [body.kind for body in bodies],
            [-1 if material is None else material.id for material in materials],
            np.array([body.position for body in bodies]),
            np.array([body.orientation for body in bodies]),
            np.array(dimensions).tolist(),
        )

    def _see(self, frame: Frame) -> None:
        """Everything as the plane sees it, at once for all shapes."""
        self._frame = frame
        self._centers = frame.flat(self._positions)
        self._off = np.abs(frame.height(self._positions) - frame.offset).tolist()
        self._flat_axes = frame.flat(self._axes)
        self._heights = np.abs(frame.height(self._axes)).tolist()

    def outline(self, index: int, frame: Frame, tolerance: float, size: float) -> Outline | str:
        """The outline of one shape, or why it has none."""
        if self._frame is not frame:
            self._see(frame)
        kind, id, dimensions = self._kinds[index], self._materials[index], self._dimensions[index]
        if kind is Kind.PLANE:
            return _half_plane(id, frame, dimensions, tolerance)
        if self._off[index] > tolerance * max(size, *dimensions):
            return "The shape lies out of the plane"
        center = self._centers[index]
        if kind is Kind.SPHERE:
            return Disc(id, center, dimensions[0])
        heights = self._heights[index]
        along = [axis for axis in range(3) if heights[axis] >= 1.0 - 4 * tolerance**2]
        axes = self._flat_axes[index]
        match kind:
            case Kind.BOX:
                return _rectangle(id, center, axes, dimensions, along)
            case Kind.CYLINDER | Kind.CAPSULE:
                across = heights[0] <= 2 * tolerance
                return _rod(kind, id, center, axes, dimensions, along, across)
            case _:
                return f"The engine knows no {kind.name.lower()}"


def _half_plane(id: int, frame: Frame, dimensions: list[float], tolerance: float) -> Outline | str:
    normal = np.array(dimensions[:3])
    if abs(float(frame.height(normal))) > tolerance:
        return "The surface of a plane does not stand on the plane of motion"
    flat = frame.flat(normal)
    return HalfPlane(id, flat * dimensions[3], flat / np.hypot(flat[0], flat[1]))


def _rectangle(
    id: int, center: Floats, axes: Floats, lengths: list[float], along: list[int]
) -> Outline | str:
    if not along:
        return "The box is tilted"
    first, second = (axis for axis in range(3) if axis != along[0])
    a, b = axes[first] * (lengths[first] / 2), axes[second] * (lengths[second] / 2)
    return Polygon(id, np.array([center - a - b, center + a - b, center + a + b, center - a + b]))


def _rod(
    kind: Kind,
    id: int,
    center: Floats,
    axes: Floats,
    dimensions: list[float],
    along: list[int],
    across: bool,
) -> Outline | str:
    cap, y, z, length = dimensions
    name = kind.name.lower()
    if along == [0]:
        return f"The {name} is elliptic" if y != z else Disc(id, center, y)
    if not across:
        return f"The {name} is tilted"
    if y != z and not along:
        return f"The elliptic {name} is tilted"
    radius = z if along == [1] else y
    half = axes[0] * (length / 2)
    if kind is Kind.CAPSULE:
        if cap != radius:
            return "The caps of the capsule are elliptic"
        return Stadium(id, center - half, center + half, radius)
    side = np.array([-axes[0][1], axes[0][0]]) * radius
    corners = [center - half - side, center + half - side, center + half + side,
               center - half + side]  # fmt: skip
    return Polygon(id, np.array(corners))

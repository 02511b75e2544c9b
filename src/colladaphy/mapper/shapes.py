"""Shapes of the common profile as the World has them (thesis 4.2; COLLADA 1.5 §shape).

A `Shape` is one primitive or mesh with its pose in the rigid_body: COLLADA's capsules and cylinders
lie along y, the World's along x, so their poses differ from the file's by a quarter turn, except
where the file turns them back (as our own files do).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document.names import c, local_name
from colladaphy.document.nodes import pose_of_steps
from colladaphy.document.poses import IDENTITY, Pose, Quaternion
from colladaphy.mapper.profile import boolean, numbers, plane_dimensions
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.document import Document
    from colladaphy.mapper.geometries import Geometries
    from colladaphy.world.meshes import Mesh

__all__ = ["Shape", "ShapeError", "capsule_kind", "read_shape"]

_TURN = math.sqrt(0.5)
_Y_TO_X: Quaternion = (_TURN, 0.0, 0.0, _TURN)
"""Turns the World's axis x of capsules and cylinders onto COLLADA's y."""
_BACK = (0.0, 0.0, 1.0, -90.0)

_GEOMETRIES = ("sphere", "box", "capsule", "cylinder", "plane", "instance_geometry")


class ShapeError(ValueError):
    """A shape that a World cannot hold; `empty` where it has no volume."""

    def __init__(self, message: str, *, empty: bool = False) -> None:
        super().__init__(message)
        self.empty = empty


@dataclass(slots=True)
class Shape:
    """A shape of a rigid_body; None for values that it leaves to others."""

    element: etree._Element
    kind: Kind
    dimensions: tuple[float, float, float, float]
    pose: Pose
    """Of the World's body frame in the rigid_body; of a plane, see `kind`: the identity."""
    mesh: Mesh | None = None
    placed: Pose = IDENTITY
    """Where the file puts the geometry, whose centre of mass may be elsewhere."""
    hollow: bool = False
    mass: float | None = None
    density: float | None = None
    material: etree._Element | None = None


def read_shape(element: etree._Element, document: Document, geometries: Geometries) -> Shape:
    """Read a shape; ShapeError where the World cannot hold it."""
    hollow, mass, density, material = False, None, None, None
    steps: list[etree._Element] = []
    geometry: etree._Element | None = None
    for child in element:
        match local_name(child.tag):
            case "hollow":
                hollow = boolean(child)
            case "mass":
                mass = numbers(child)[0]
            case "density":
                density = numbers(child)[0]
            case "instance_physics_material" | "physics_material":
                material = child
            case "translate" | "rotate":
                steps.append(child)
            case name if name in _GEOMETRIES:
                geometry = child
    if geometry is None:
        raise ShapeError("The shape has no geometry.")
    name = local_name(geometry.tag)
    mesh = None
    placed = IDENTITY
    if name == "instance_geometry":
        mesh = geometries.mesh(geometry, document)
        kind, dimensions = Kind.MESH, (0.0, 0.0, 0.0, 0.0)
        placed = pose_of_steps(steps)
        pose = placed.then(Pose(_or_none(mesh.center.tolist())))
        if pose.position is not None and not any(pose.position):
            pose = Pose(None, pose.orientation)
    elif name == "plane":
        kind = Kind.PLANE
        dimensions = move_plane(pose_of_steps(steps), _plane(geometry))
        pose = IDENTITY
    else:
        kind, dimensions = primitive(geometry)
        pose = _axis_pose(steps) if kind in (Kind.CAPSULE, Kind.CYLINDER) else pose_of_steps(steps)
    return Shape(element, kind, dimensions, pose, mesh, placed, hollow, mass, density, material)


def _or_none(position: list[float]) -> tuple[float, float, float] | None:
    x, y, z = position
    return (x, y, z) if any(position) else None


def _axis_pose(steps: list[etree._Element]) -> Pose:
    if steps and local_name(steps[-1].tag) == "rotate" and numbers(steps[-1]) == _BACK:
        return pose_of_steps(steps[:-1])
    return pose_of_steps(steps).then(Pose(None, _Y_TO_X))


def primitive(geometry: etree._Element) -> tuple[Kind, tuple[float, float, float, float]]:
    """Kind and dimensions of a primitive; ShapeError where one of them is not positive."""
    values = _values(geometry)
    name = local_name(geometry.tag)
    kind: Kind
    needed: tuple[float, ...]
    match name:
        case "sphere":
            radius = values["radius"]
            # One number in COLLADA 1.5; the thesis writes three (listing 2).
            if len(radius) == 3 and not radius[0] == radius[1] == radius[2]:
                kind, made = Kind.ELLIPSOID, (radius[0], radius[1], radius[2], 0.0)
            else:
                kind, made = Kind.SPHERE, (radius[0], 0.0, 0.0, 0.0)
            needed = made[:3] if kind is Kind.ELLIPSOID else made[:1]
        case "box":
            x, y, z = values["half_extents"]
            kind, made = Kind.BOX, (2.0 * x, 2.0 * y, 2.0 * z, 0.0)
            needed = made[:3]
        case "capsule":
            kind, made = capsule_kind(values["height"][0], _radii(values["radius"], 3))
            needed = made[:3] if kind is Kind.ELLIPSOID else made
        case _:
            x, z = _radii(values["radius"], 2)
            kind, made = Kind.CYLINDER, (0.0, x, z, values["height"][0])
            needed = made[1:]
    if not all(0.0 < value < math.inf for value in needed):
        text = " ".join(map(str, needed))
        raise ShapeError(f"The {kind.name.lower()} has the dimensions {text}.", empty=True)
    return kind, made


def _values(geometry: etree._Element) -> dict[str, tuple[float, ...]]:
    """The numbers of a primitive's elements by name; what an extra holds is not looked at."""
    names = ((local_name(child.tag), child) for child in geometry)
    return {name: numbers(child) for name, child in names if name and name != "extra"}


def _radii(values: tuple[float, ...], count: int) -> tuple[float, ...]:
    """Radii of all axes where a file gives one for all."""
    return values if len(values) >= count else (values[0],) * count


def capsule_kind(
    height: float, radii: tuple[float, ...]
) -> tuple[Kind, tuple[float, float, float, float]]:
    """A capsule of COLLADA: without height it is an ellipsoid, and keeps its axes."""
    x, y, z = radii[:3]
    if height == 0.0:
        return Kind.ELLIPSOID, (x, y, z, 0.0)
    return Kind.CAPSULE, (y, x, z, height)


def _plane(geometry: etree._Element) -> tuple[float, float, float, float]:
    """Normal and displacement: the equation's A B C and -D, or as the thesis has them."""
    values = _values(geometry)
    stated = plane_dimensions(values)
    if stated is None:
        if "equation" not in values:
            raise ShapeError("The plane has neither an equation nor a normal.")
        a, b, d, constant = values["equation"]
        stated = (a, b, d, -constant)
    return unit_plane(stated)


def unit_plane(
    plane: tuple[float, float, float, float],
) -> tuple[float, float, float, float]:
    """The same plane with a normal of length one; one that has it to rounding stays as it is."""
    a, b, d, displacement = plane
    length = math.hypot(a, b, d)
    if not 0.0 < length < math.inf:
        raise ShapeError("The normal of the plane has no length.", empty=True)
    if abs(length - 1.0) <= 4e-10:
        return plane
    return a / length, b / length, d / length, displacement / length


def move_plane(
    pose: Pose, plane: tuple[float, float, float, float]
) -> tuple[float, float, float, float]:
    """The plane as it is seen from outside of a frame at `pose`."""
    if pose == IDENTITY:
        return plane
    a, b, d, displacement = plane
    normal = Pose(None, pose.orientation).point((a, b, d))
    shift = sum(x * y for x, y in zip(normal, pose.translation, strict=True))
    return unit_plane((*normal, displacement + shift))


SHAPE = c("shape")

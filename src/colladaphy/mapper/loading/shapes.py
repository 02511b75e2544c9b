"""Shapes of the common profile as the World has them (thesis 4.2; COLLADA 1.5 §shape).

COLLADA's capsules and cylinders lie along y, the World's along x, so their poses differ from the
file's by a quarter turn, except where the file turns them back (as our own files do).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses, rotate_vectors
from colladaphy.links.steps import Steps, poses_of_steps
from colladaphy.world.kinds import Kind
from colladaphy.world.shapes import NEEDED

__all__ = [
    "MaterialRefs",
    "ShapeColumns",
    "material_refs",
    "move_planes",
    "read_shapes",
    "unit_planes",
]

Array = NDArray[Any]

_TURN = math.sqrt(0.5)
_Y_TO_X: Final = np.array([_TURN, 0.0, 0.0, _TURN])
"""Turns the World's axis x of capsules and cylinders onto COLLADA's y."""
_BACK: Final = np.array([0.0, 0.0, 1.0, -90.0])

NONE, MISSING, EMPTY, FLAT = 0, 1, 2, 3
"""Faults of shapes: none; no geometry; a dimension that is not positive; a plane without normal."""


@dataclass(slots=True)
class MaterialRefs:
    """Which materials elements refer to, or hold."""

    ordinals: Array
    """(n,) the instance_physics_material or physics_material; -1 for none."""
    inline: Array
    """(n,) whether it is a material of its own."""
    urls: list[str]
    """(n,) references, empty for none."""

    def take(self, rows: Array) -> MaterialRefs:
        """Some of them."""
        return MaterialRefs(self.ordinals[rows], self.inline[rows],
                            [self.urls[row] for row in rows.tolist()])  # fmt: skip


@dataclass(slots=True)
class ShapeColumns:
    """Shapes, one a row; what they leave to others is masked out."""

    owner: Array
    """(n,) the row of the rigid_body, or of its instance."""
    ordinals: Array
    hollow: Array
    mass: Array
    has_mass: Array
    density: Array
    has_density: Array
    material: MaterialRefs
    kinds: Array
    """(n,) numbers of `Kind`."""
    dimensions: Array
    """(n, 4); of a plane in the frame of the rigid_body."""
    poses: Poses
    """Of the World's body frame in the rigid_body; of a mesh, where the file puts the geometry."""
    urls: list[str]
    """(n,) references to geometries."""
    faults: Array
    """(n,) why a World cannot hold it."""


def material_refs(elements: Any) -> MaterialRefs:
    """The materials of rows that have one at most, referred to or in place."""
    count = len(elements)
    ordinals = np.full(count, -1, np.int64)
    inline = np.zeros(count, np.bool_)
    urls = [""] * count
    instances = elements.instance_physics_material
    if instances.is_whole and count:
        return MaterialRefs(instances.ordinals.astype(np.int64), inline, list(instances.url))
    ordinals[instances.owner] = instances.ordinals
    for row, url in zip(instances.owner.tolist(), instances.url, strict=True):
        urls[row] = url
    own = elements.physics_material
    ordinals[own.owner] = own.ordinals
    inline[own.owner] = True
    return MaterialRefs(ordinals, inline, urls)


def read_shapes(shapes: Any, owner: Array) -> ShapeColumns:
    """The shapes of rigid_bodies or of their instances; `owner` says of which."""
    count = len(shapes)
    kinds = np.full(count, -1, np.int8)
    dimensions = np.zeros((count, 4))
    faults = np.full(count, MISSING, np.int8)
    urls = [""] * count
    steps = Steps.of(shapes)
    skipped = np.zeros(len(steps.owner), np.bool_)
    _sized(shapes, kinds, dimensions)
    # What a file turns by a quarter lies along x; everything else along the World's axis.
    long = (kinds == Kind.CAPSULE) | (kinds == Kind.CYLINDER)
    along = long.copy()
    if long.any() and len(steps.owner):
        back = steps.last() & steps.turns & long[steps.owner]
        back &= np.all(steps.values == _BACK, axis=1)
        skipped = back
        along[steps.owner[back]] = False
    poses = poses_of_steps(steps.without(skipped) if skipped.any() else steps)
    if along.any():
        rows = np.flatnonzero(along)
        quarter = Poses.of(len(rows), None, np.tile(_Y_TO_X, (len(rows), 1)))
        poses.put(rows, poses.take(rows).then(quarter))
    meshes = shapes.instance_geometry
    for row, url in zip(meshes.owner.tolist(), meshes.url, strict=True):
        kinds[row] = Kind.MESH
        urls[row] = url
    faults[kinds >= 0] = NONE
    for kind, needed in NEEDED.items():
        rows = np.flatnonzero(kinds == kind)
        sizes = dimensions[rows][:, needed]
        faults[rows[~np.all((sizes > 0.0) & (sizes < np.inf), axis=1)]] = EMPTY
    planes = shapes.plane
    if len(planes):
        rows = planes.owner
        kinds[rows] = Kind.PLANE
        local, good = unit_planes(planes.equation * np.array([1.0, 1.0, 1.0, -1.0]))
        faults[rows] = np.where(good, NONE, FLAT)
        moved, good = move_planes(poses.take(rows), local)
        faults[rows[~good]] = FLAT
        dimensions[rows] = moved
        poses.put(rows, Poses.none(len(rows)))
    hollow, mass, density = shapes.hollow, shapes.mass, shapes.density
    return ShapeColumns(
        owner=owner,
        ordinals=shapes.ordinals,
        hollow=hollow.per_owner(hollow.value, False) if len(hollow) else np.zeros(count, np.bool_),
        mass=_per_owner(mass),
        has_mass=mass.present,
        density=_per_owner(density),
        has_density=density.present,
        material=material_refs(shapes),
        kinds=kinds,
        dimensions=dimensions,
        poses=poses,
        urls=urls,
        faults=faults,
    )


def _per_owner(values: Any) -> Array:
    if not len(values):
        return np.full(values.owners, np.nan)
    return np.asarray(values.per_owner(values.value, np.nan))


def _sized(shapes: Any, kinds: Array, dimensions: Array) -> None:
    """Kinds and dimensions of primitives but planes."""
    spheres = shapes.sphere
    if len(spheres):
        kinds[spheres.owner] = Kind.SPHERE
        dimensions[spheres.owner, 0] = spheres.radius
    boxes = shapes.box
    if len(boxes):
        kinds[boxes.owner] = Kind.BOX
        dimensions[boxes.owner, :3] = 2.0 * boxes.half_extents
    capsules = shapes.capsule
    if len(capsules):
        height, radii = capsules.height, capsules.radius
        # Without height it is an ellipsoid, and keeps its axes.
        flat = height == 0.0
        kinds[capsules.owner] = np.where(flat, Kind.ELLIPSOID, Kind.CAPSULE)
        dimensions[capsules.owner, 3] = height
        dimensions[capsules.owner[flat], 3] = 0.0
        dimensions[capsules.owner, :3] = np.where(flat[:, None], radii, radii[:, [1, 0, 2]])
    cylinders = shapes.cylinder
    if len(cylinders):
        kinds[cylinders.owner] = Kind.CYLINDER
        dimensions[cylinders.owner, 1:3] = cylinders.radius
        dimensions[cylinders.owner, 3] = cylinders.height


def unit_planes(planes: Array) -> tuple[Array, Array]:
    """The same planes (n, 4) with normals of length one, and which have a normal.

    One that has it to rounding stays as it is.
    """
    with np.errstate(all="ignore"):
        length = np.sqrt(np.sum(planes[:, :3] * planes[:, :3], axis=1))
        made = planes.copy()
        off = np.flatnonzero(~(np.abs(length - 1.0) <= 4e-10))
        good = np.ones(len(planes), np.bool_)
        for row in off.tolist():
            exact = math.hypot(*planes[row, :3].tolist())
            good[row] = 0.0 < exact < math.inf
            if good[row] and abs(exact - 1.0) > 4e-10:
                made[row] = planes[row] / exact
    return made, good


def move_planes(poses: Poses, planes: Array) -> tuple[Array, Array]:
    """Planes (n, 4) as they are seen from outside of frames at poses, and which have a normal."""
    made = planes.copy()
    good = np.ones(len(planes), np.bool_)
    rows = np.flatnonzero(~poses.is_identity())
    if len(rows):
        here = poses.take(rows)
        with np.errstate(all="ignore"):
            normals = np.where(
                here.turned[:, None],
                rotate_vectors(here.orientations, planes[rows, :3]),
                planes[rows, :3],
            )
            x, y, z = (normals * here.positions).T
            shift = 0.0 + x + y + z
            moved = np.column_stack([normals, planes[rows, 3] + shift])
        made[rows], good[rows] = unit_planes(moved)
    return made, good

"""The methods of `World` that make single bodies (thesis 2.1; the creators of pe)."""

from __future__ import annotations

from typing import Any, Unpack

from numpy.typing import ArrayLike

from colladaphy.world import creating, rotations, values
from colladaphy.world.body import Body
from colladaphy.world.creating import BodyOptions, EmptyOptions
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import AnyMaterial
from colladaphy.world.meshes import Mesh
from colladaphy.world.storage import HasStorage, Storage

__all__ = [
    "create_body",
    "create_box",
    "create_capsule",
    "create_cylinder",
    "create_ellipsoid",
    "create_mesh",
    "create_plane",
    "create_sphere",
]


def create_sphere(
    self: HasStorage, uid: int, position: ArrayLike, radius: float, material: AnyMaterial,
    **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """A sphere."""
    sizes = (values.positive("radius", radius), 0.0, 0.0, 0.0)
    return _create(self._storage, Kind.SPHERE, uid, position, sizes, material, **options)


def create_box(
    self: HasStorage, uid: int, position: ArrayLike, lengths: ArrayLike, material: AnyMaterial,
    **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """A box of full side lengths (3,)."""
    x, y, z = values.positives("side length", lengths, 3)
    return _create(self._storage, Kind.BOX, uid, position, (x, y, z, 0.0), material, **options)


def create_capsule(
    self: HasStorage, uid: int, position: ArrayLike, radius: ArrayLike, length: float,
    material: AnyMaterial, **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """A capsule along x; `length` excludes the caps.

    `radius` is a number, or the semi-axes x (of the caps), y and z.
    """
    x, y, z = values.positives("radius", radius, 3)
    sizes = (x, y, z, values.positive("length", length))
    return _create(self._storage, Kind.CAPSULE, uid, position, sizes, material, **options)


def create_cylinder(
    self: HasStorage, uid: int, position: ArrayLike, radius: ArrayLike, length: float,
    material: AnyMaterial, **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """A cylinder along x. `radius` is a number, or the semi-axes y and z."""
    y, z = values.positives("radius", radius, 2)
    sizes = (0.0, y, z, values.positive("length", length))
    return _create(self._storage, Kind.CYLINDER, uid, position, sizes, material, **options)


def create_ellipsoid(
    self: HasStorage, uid: int, position: ArrayLike, radii: ArrayLike, material: AnyMaterial,
    **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """An ellipsoid of semi-axes (3,)."""
    x, y, z = values.positives("radius", radii, 3)
    return _create(
        self._storage, Kind.ELLIPSOID, uid, position, (x, y, z, 0.0), material, **options
    )


def create_plane(
    self: HasStorage, uid: int, normal: ArrayLike, displacement: float | None,
    material: AnyMaterial, *, position: ArrayLike | None = None, **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """A half space, solid where normal·x < displacement; fixed and infinite.

    The normal points out of the solid. Instead of the displacement (None), a point of the
    surface may be given as `position`, which is then kept.
    """
    anchor, sizes = creating.plane(normal, displacement, position)
    if "orientation" not in options:
        options["orientation"] = rotations.between((0.0, 0.0, 1.0), sizes[:3])
    return _create(self._storage, Kind.PLANE, uid, anchor, sizes, material, **options)


def create_mesh(
    self: HasStorage, uid: int, position: ArrayLike, vertices: ArrayLike | Mesh,
    faces: ArrayLike | None, material: AnyMaterial, *, convex: bool = False,
    **options: Unpack[BodyOptions],
) -> Body:  # fmt: skip
    """A body enclosed by a closed surface of triangles, its centre of mass at `position`.

    `vertices` (n, 3) and `faces` (m, 3), see `Mesh`; or a mesh of this World (faces None),
    which the bodies then share.
    """
    made = creating.create_mesh(
        self._storage, uid, position, vertices, faces, material, convex, **options
    )
    return Body(self._storage, made)


def create_body(
    self: HasStorage, uid: int, position: ArrayLike, mass: float, inertia: ArrayLike | None = None,
    **options: Unpack[EmptyOptions],
) -> Body:  # fmt: skip
    """A body of mass and inertia without any shape, which nothing collides with.

    The inertia is (3, 3) about the centre of mass in the body frame, or its diagonal (3,);
    None is that of a point, zero.
    """
    given: Any = {**options, "mass": values.mass(mass), "inertia": inertia}
    return _create(self._storage, Kind.EMPTY, uid, position, (0.0, 0.0, 0.0, 0.0), None, **given)


def _create(storage: Storage, *arguments: Any, **options: Unpack[BodyOptions]) -> Body:
    return Body(storage, creating.create(storage, *arguments, **options))

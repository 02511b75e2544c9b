"""Creation of bodies, one at a time and many at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.errors import WorldError
from colladaphy.world import rotations, values
from colladaphy.world.columns import BodyColumns, MemberColumns
from colladaphy.world.creation import infinite_unions, prepare, prepare_members, prepare_one
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import AnyMaterial
from colladaphy.world.meshes import Mesh, MeshSource, make_meshes
from colladaphy.world.rules import ARGUMENT, COLUMNS, DIMENSION, MESH, refuse
from colladaphy.world.storage import Storage

__all__ = ["BodyOptions", "EmptyOptions", "add_meshes", "create", "create_mesh", "extend", "plane"]


class BodyOptions(TypedDict, total=False):
    """What every creator takes besides pe's arguments; given values are stored as they are."""

    orientation: ArrayLike
    """Quaternion (w, x, y, z); a length far from one is normalised."""
    linear_velocity: ArrayLike
    angular_velocity: ArrayLike
    mass: float | None
    inertia: ArrayLike | None
    """(3, 3) about the centre of mass in the body frame, or its diagonal (3,)."""
    fixed: bool
    hollow: bool
    """The mass is spread over the surface."""
    sid: int | None
    name: str | None


class EmptyOptions(TypedDict, total=False):
    """What bodies without a shape take besides position, mass and inertia."""

    orientation: ArrayLike
    linear_velocity: ArrayLike
    angular_velocity: ArrayLike
    fixed: bool
    sid: int | None
    name: str | None


def create(
    storage: Storage,
    kind: Kind,
    uid: int,
    position: ArrayLike,
    dimensions: tuple[float, float, float, float],
    material: AnyMaterial,
    mesh_id: int = -1,
    *,
    orientation: ArrayLike = rotations.IDENTITY,
    linear_velocity: ArrayLike | None = None,
    angular_velocity: ArrayLike | None = None,
    mass: float | None = None,
    inertia: ArrayLike | None = None,
    fixed: bool = False,
    hollow: bool = False,
    sid: int | None = None,
    name: str | None = None,
) -> int:
    """Add a primitive of `dimensions` that are checked already; returns its system id.

    What has no shape has no material.
    """
    given: dict[str, Any] = {
        "uids": values.user_id(uid),
        "positions": values.vector("position", position),
        "orientations": values.quaternion(orientation),
        "material_ids": -1 if kind is Kind.EMPTY else storage.materials.resolve(material).id,
        "dimensions": dimensions,
        "mesh_ids": mesh_id,
        "fixed": values.flag("flag fixed", fixed),
        "hollow": values.flag("flag hollow", hollow),
    }
    if linear_velocity is not None:
        given["linear_velocities"] = values.vector("linear velocity", linear_velocity)
    if angular_velocity is not None:
        given["angular_velocities"] = values.vector("angular velocity", angular_velocity)
    if mass is not None:
        given["masses"] = values.mass(mass)
    if inertia is not None:
        given["inertias"] = values.inertia(inertia)
    if name is not None:
        name = values.text("name", name)
    filled = prepare_one(kind, given, storage.materials, storage.meshes)
    sid = values.new_system_id(sid, storage.next_body_sid, storage.__contains__)
    storage.next_body_sid = max(storage.next_body_sid, sid + 1)
    storage.top.append(sid, filled)
    if name is not None:
        storage.names[sid] = name
    return sid


def plane(
    normal: ArrayLike, displacement: float | None, position: ArrayLike | None
) -> tuple[NDArray[np.float64], tuple[float, float, float, float]]:
    """Position and dimensions of a plane; a point of it gives the displacement if there is none."""
    direction = values.normal(normal)
    x, y, z = direction.tolist()
    if displacement is None:
        anchor = values.vector("position", (0.0, 0.0, 0.0) if position is None else position)
        with np.errstate(all="ignore"):
            distance = float(sum((direction * anchor).tolist()))
        if not np.isfinite(distance):
            raise refuse(DIMENSION, "The displacement of the plane is out of range.")
    else:
        distance = values.finite("displacement", displacement)
        anchor = direction * distance if position is None else values.vector("position", position)
    return anchor, (x, y, z, distance)


def create_mesh(
    storage: Storage,
    uid: int,
    position: ArrayLike,
    vertices: ArrayLike | Mesh,
    faces: ArrayLike | None,
    material: AnyMaterial,
    convex: bool,
    **options: Unpack[BodyOptions],
) -> int:
    """Add a body of a mesh that the World has, or of a new one; returns its system id."""
    if isinstance(vertices, Mesh):
        mesh, added = vertices, False
        if storage.meshes.get(mesh.id) is not mesh:
            raise refuse(MESH, f"{mesh!r} does not belong to this World; see add_mesh.")
    elif faces is None:
        raise refuse(MESH, "The mesh has vertices but no faces.")
    else:
        mesh, added = add_meshes(storage, [(vertices, faces, convex)], None)[0], True
    sizes = (0.0, 0.0, 0.0, 0.0)
    try:
        return create(storage, Kind.MESH, uid, position, sizes, material, mesh.id, **options)
    except WorldError:
        if added:
            del storage.meshes[mesh.id]
        raise


def add_meshes(
    storage: Storage, sources: Sequence[MeshSource], ids: ArrayLike | None
) -> list[Mesh]:
    """Add meshes, all or, on WorldError, none."""
    try:
        count = len(sources)
        shaped = all(len(source) == 3 for source in sources)
    except TypeError:
        count, shaped = 0, False
    if not shaped:
        raise refuse(ARGUMENT, "Meshes are a list of (vertices, faces, convex) each.")
    meshes = storage.meshes
    if ids is None:
        first = max(meshes, default=-1) + 1
        numbers = list(range(first, first + count))
    else:
        numbers = values.column("ids", ids, np.int64, (count,)).tolist()
    distinct = len(set(numbers)) == count and meshes.keys().isdisjoint(numbers)
    if not distinct or min(numbers, default=0) < 0:
        raise refuse(MESH, "An id of a mesh is in use, or negative.")
    made = make_meshes(sources, numbers)
    meshes.update(zip(numbers, made, strict=True))
    return made


def extend(
    storage: Storage, columns: BodyColumns, members: MemberColumns | None
) -> NDArray[np.int64]:
    """Add many bodies, and the members of the unions among them; returns their system ids."""
    known = storage.materials, storage.meshes
    filled = prepare(columns, *known, unions=members is not None)
    count = len(filled["kinds"])
    if members is None:
        sids = every = values.new_system_ids(
            columns.sids, count, storage.next_body_sid, storage.__contains__
        )
        names = values.names(sids, columns.names)
    else:
        inner = prepare_members(members, *known)
        if columns.sids is None:
            raise refuse(COLUMNS, "Bodies beside members of unions need the column sids.")
        top_sids = values.column("sids", columns.sids, np.int64, (count,))
        inner_sids = values.column("sids", members.sids, np.int64, (len(inner["kinds"]),))
        every = np.concatenate([top_sids, inner_sids])
        every = values.new_system_ids(
            every, len(every), storage.next_body_sid, storage.__contains__
        )
        sids, inner_sids = every[:count], every[count:]
        filled["fixed"] = filled["fixed"] | infinite_unions(sids, filled, inner_sids, inner)
        names = values.names(sids, columns.names) | values.names(inner_sids, members.names)
        storage.inner.extend(inner_sids, inner)
        storage.children.update(_children(inner["parents"], inner_sids))
    storage.names.update(names)
    storage.top.extend(sids, filled)
    if len(every):
        storage.next_body_sid = max(storage.next_body_sid, int(every.max()) + 1)
    return sids


def _children(
    parents: NDArray[np.int64], sids: NDArray[np.int64]
) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Each union and its members, which stand in their order."""
    if not len(parents):
        return
    order = np.argsort(parents, kind="stable")
    parents, listed = parents[order], sids[order].tolist()
    starts = np.flatnonzero(np.diff(parents, prepend=0)).tolist()
    stops = [*starts[1:], len(listed)]
    for union, start, stop in zip(parents[starts].tolist(), starts, stops, strict=True):
        yield union, tuple(listed[start:stop])

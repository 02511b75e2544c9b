"""Creators of primitives, one at a time and many at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import rotations, values
from colladaphy.world.body import Body
from colladaphy.world.columns import BodyColumns, MemberColumns
from colladaphy.world.creation import infinite_unions, prepare, prepare_members, prepare_one
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import Material
from colladaphy.world.meshes import Mesh, MeshSource, make_meshes
from colladaphy.world.rules import COLUMNS, MESH, SYSTEM_ID, refuse
from colladaphy.world.viewing import Viewing

__all__ = ["BodyOptions", "Creating"]


class BodyOptions(TypedDict, total=False):
    """What every creator takes besides pe's arguments; given values are stored as they are."""

    orientation: ArrayLike
    """Quaternion (w, x, y, z); a length far from one is normalised."""
    linear_velocity: ArrayLike
    angular_velocity: ArrayLike
    mass: float
    inertia: ArrayLike
    """(3, 3) about the centre of mass in the body frame, or its diagonal (3,)."""
    fixed: bool
    hollow: bool
    """The mass is spread over the surface."""
    sid: int
    name: str


class Creating(Viewing):
    """Adds bodies. All creators raise WorldError where a dimension or a value is impossible."""

    def create_sphere(
        self,
        uid: int,
        position: ArrayLike,
        radius: float,
        material: Material | str,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """A sphere."""
        row = (values.positive("radius", radius), 0.0, 0.0, 0.0)
        return self._create(Kind.SPHERE, uid, position, row, material, options)

    def create_box(
        self,
        uid: int,
        position: ArrayLike,
        lengths: ArrayLike,
        material: Material | str,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """A box of full side lengths (3,)."""
        row = (*values.positives("side length", lengths, 3), 0.0)
        return self._create(Kind.BOX, uid, position, row, material, options)

    def create_capsule(
        self,
        uid: int,
        position: ArrayLike,
        radius: float | ArrayLike,
        length: float,
        material: Material | str,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """A capsule along x; `length` excludes the caps.

        `radius` is a number, or the semi-axes x (of the caps), y and z.
        """
        radii = values.positives("radius", radius, 3)
        row = (*radii, values.positive("length", length))
        return self._create(Kind.CAPSULE, uid, position, row, material, options)

    def create_cylinder(
        self,
        uid: int,
        position: ArrayLike,
        radius: float | ArrayLike,
        length: float,
        material: Material | str,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """A cylinder along x. `radius` is a number, or the semi-axes y and z."""
        radii = values.positives("radius", radius, 2)
        row = (0.0, *radii, values.positive("length", length))
        return self._create(Kind.CYLINDER, uid, position, row, material, options)

    def create_ellipsoid(
        self,
        uid: int,
        position: ArrayLike,
        radii: ArrayLike,
        material: Material | str,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """An ellipsoid of semi-axes (3,)."""
        row = (*values.positives("radius", radii, 3), 0.0)
        return self._create(Kind.ELLIPSOID, uid, position, row, material, options)

    def create_plane(
        self,
        uid: int,
        normal: ArrayLike,
        displacement: float | None,
        material: Material | str,
        *,
        position: ArrayLike | None = None,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """A half space, solid where normal·x < displacement; fixed and infinite.

        The normal points out of the solid. Instead of the displacement (None), a point of the
        surface may be given as `position`, which is then kept.
        """
        direction = values.normal(normal)
        if displacement is None:
            anchor = values.vector("position", (0.0, 0.0, 0.0) if position is None else position)
            distance = float(sum((direction * anchor).tolist()))
        else:
            distance = float(values.vector("displacement", (displacement, 0.0, 0.0))[0])
            anchor = direction * distance if position is None else values.vector("", position)
        row = (*direction.tolist(), distance)
        if "orientation" not in options:
            options["orientation"] = rotations.between((0.0, 0.0, 1.0), direction)
        return self._create(Kind.PLANE, uid, anchor, row, material, options)

    def create_mesh(
        self,
        uid: int,
        position: ArrayLike,
        vertices: ArrayLike | Mesh,
        faces: ArrayLike | None,
        material: Material | str,
        *,
        convex: bool = False,
        **options: Unpack[BodyOptions],
    ) -> Body:
        """A solid enclosed by a closed surface of triangles, its centre of mass at `position`.

        `vertices` (n, 3) and `faces` (m, 3), see `Mesh`; or a mesh of this World (faces None),
        which the bodies then share.
        """
        if isinstance(vertices, Mesh):
            mesh = vertices
            if self.meshes.get(mesh.id) is not mesh:
                raise refuse(MESH, f"{mesh!r} does not belong to this World; see add_mesh.")
        elif faces is None:
            raise refuse(MESH, "The mesh has vertices but no faces.")
        else:
            mesh = self.add_mesh(vertices, faces, convex=convex)
        row = (0.0, 0.0, 0.0, 0.0)
        return self._create(Kind.MESH, uid, position, row, material, options, mesh.id)

    def add_meshes(self, sources: Sequence[MeshSource], ids: ArrayLike | None = None) -> list[Mesh]:
        """Add many meshes at once: of each the vertices, the faces and whether it is convex.

        Either all are added or, on WorldError, none.
        """
        count = len(sources)
        if ids is None:
            first = max(self.meshes, default=-1) + 1
            numbers = list(range(first, first + count))
        else:
            numbers = values.column("ids", ids, np.int64, (count,)).tolist()
        if len(set(numbers)) < count or not self.meshes.keys().isdisjoint(numbers) or (
            min(numbers, default=0) < 0
        ):  # fmt: skip
            raise refuse(MESH, "The ids of meshes are different, new and not negative.")
        made = make_meshes(sources, numbers)
        self.meshes.update(zip(numbers, made, strict=True))
        return made

    def add_mesh(
        self, vertices: ArrayLike, faces: ArrayLike, *, convex: bool = False, id: int | None = None
    ) -> Mesh:
        """Add a mesh for any number of bodies to share."""
        number = max(self.meshes, default=-1) + 1 if id is None else id
        if number in self.meshes or number < 0:
            raise refuse(MESH, f"The mesh id {number} is in use, or negative.")
        mesh = Mesh(vertices, faces, convex=convex, id=number)
        self.meshes[number] = mesh
        return mesh

    def extend(
        self, columns: BodyColumns, members: MemberColumns | None = None
    ) -> NDArray[np.int64]:
        """Create many bodies at once; returns their system ids (n,).

        With `members`, some of the bodies may be unions, of the members whose parents they are,
        and members may be unions too. Either all are created or, on WorldError, none. Quaternions
        and normals have to be of length one.
        """
        filled = prepare(columns, self.materials, self.meshes, unions=members is not None)
        count = len(filled["kinds"])
        if members is None:
            sids = new_system_ids(columns.sids, count, self.next_body_sid, self.__contains__)
            names = names_of(sids, columns.names)
        else:
            inner = prepare_members(members, self.materials, self.meshes)
            if columns.sids is None:
                raise refuse(COLUMNS, "Bodies beside members of unions need the column sids.")
            given = [
                values.column("sids", columns.sids, np.int64, (count,)),
                values.column("sids", members.sids, np.int64, (len(inner["kinds"]),)),
            ]
            every = np.concatenate(given)
            every = new_system_ids(every, len(every), self.next_body_sid, self.__contains__)
            sids, inner_sids = every[:count], every[count:]
            filled["fixed"] = filled["fixed"] | infinite_unions(sids, filled, inner_sids, inner)
            names = {**names_of(sids, columns.names), **names_of(inner_sids, members.names)}
            self.inner.extend(inner_sids, inner)
            self.children.update(_children(inner["parents"], inner_sids))
            if len(inner_sids):
                self.next_body_sid = max(self.next_body_sid, int(inner_sids.max()) + 1)
        self.names.update(names)
        self.top.extend(sids, filled)
        if count:
            self.next_body_sid = max(self.next_body_sid, int(sids.max()) + 1)
        return sids

    def claim_sid(self, sid: int | None) -> int:
        """The system id for a new body: the one that is asked for if it is free, or the next."""
        if sid is None:
            sid = self.next_body_sid
        elif not 0 < sid < 2**63 - 1 or (sid < self.next_body_sid and sid in self):
            raise refuse(SYSTEM_ID, f"The system id {sid} is in use, or out of range.")
        self.next_body_sid = max(self.next_body_sid, sid + 1)
        return sid

    def _create(
        self,
        kind: Kind,
        uid: int,
        position: ArrayLike,
        dimensions: tuple[float, ...],
        material: Material | str,
        options: BodyOptions,
        mesh_id: int = -1,
    ) -> Body:
        given: dict[str, Any] = {
            "uids": values.user_id(uid),
            "positions": values.vector("position", position),
            "orientations": values.quaternion(options.get("orientation", rotations.IDENTITY)),
            "material_ids": self.materials.resolve(material).id,
            "dimensions": dimensions,
            "mesh_ids": mesh_id,
            "fixed": bool(options.get("fixed", False)),
            "hollow": bool(options.get("hollow", False)),
        }
        if "linear_velocity" in options:
            velocity = values.vector("linear velocity", options["linear_velocity"])
            given["linear_velocities"] = velocity
        if "angular_velocity" in options:
            velocity = values.vector("angular velocity", options["angular_velocity"])
            given["angular_velocities"] = velocity
        if options.get("mass") is not None:
            given["masses"] = values.mass(options["mass"])
        if options.get("inertia") is not None:
            given["inertias"] = values.inertia(options["inertia"])
        filled = prepare_one(kind, given, self.materials, self.meshes)
        sid = self.claim_sid(options.get("sid"))
        self.top.append(sid, filled)
        name = options.get("name")
        if name is not None:
            self.names[sid] = str(name)
        return self.handle(sid)


def new_system_ids(
    given: Any, count: int, following: int, is_used: Callable[[int], bool]
) -> NDArray[np.int64]:
    """System ids (n,) for new rows: the next ones, or those given, if they are free."""
    if given is None:
        return np.arange(following, following + count, dtype=np.int64)
    sids = values.column("sids", given, np.int64, (count,))
    if count == 0:
        return sids
    ascending = bool(np.all(sids[1:] > sids[:-1]))
    if sids.min() < 1 or sids.max() == 2**63 - 1 or not (
        ascending or len(np.unique(sids)) == count
    ):  # fmt: skip
        raise refuse(SYSTEM_ID, "System ids are positive and differ from each other.")
    if sids.min() < following:
        for sid in sids[sids < following].tolist():
            if is_used(sid):
                raise refuse(SYSTEM_ID, f"The system id {sid} is in use.")
    return sids


def names_of(sids: NDArray[np.int64], names: Sequence[str | None] | None) -> dict[int, str]:
    if names is None:
        return {}
    if len(names) != len(sids):
        raise refuse(COLUMNS, f"There are {len(names)} names for {len(sids)} rows.")
    pairs = zip(sids.tolist(), names, strict=True)
    return {sid: values.text("name", name) for sid, name in pairs if name is not None}


def _children(
    parents: NDArray[np.int64], sids: NDArray[np.int64]
) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Each union and its members, which stand in their order."""
    if not len(parents):
        return
    order = np.argsort(parents, kind="stable")
    parents, listed = parents[order], sids[order].tolist()
    starts = np.flatnonzero(np.diff(parents, prepend=0)).tolist()
    for union, start, stop in zip(
        parents[starts].tolist(), starts, [*starts[1:], len(listed)], strict=True
    ):
        yield union, tuple(listed[start:stop])

"""Light handles to the bodies of a World."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import planes, pushing, rotations, values, weighing
from colladaphy.world.kinds import Kind
from colladaphy.world.materials import AnyMaterial, Material
from colladaphy.world.meshes import Mesh
from colladaphy.world.rules import KIND, MASS, UNION_MEMBERS, KindError, refuse
from colladaphy.world.shapes import volume
from colladaphy.world.storage import Storage
from colladaphy.world.uniting import add_up_again, place

__all__ = ["Body"]

Floats = NDArray[np.float64]


class Body:
    """One body of a World: a view of its row, alive until the body is destroyed.

    Arrays that are returned are read-only copies; assign to change the World. Vectors are in the
    World's unit, quaternions are (w, x, y, z), angular velocities in rad/s in the world frame,
    inertias (3, 3) about the centre of mass in the body frame. A member of a union moves with it:
    its velocities, its being fixed and its sleep are the union's.
    """

    __slots__ = ("_storage", "sid")

    def __init__(self, storage: Storage, sid: int) -> None:
        self._storage = storage
        self.sid = sid
        """System id, unique within the World."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Body) and other.sid == self.sid and other._storage is self._storage

    def __hash__(self) -> int:
        return hash((id(self._storage), self.sid))

    def __repr__(self) -> str:
        if self.sid not in self._storage:
            return f"<body {self.sid}, destroyed>"
        name = f" {self.name!r}" if self.name else ""
        return f"<{self.kind.name.lower()} {self.sid}{name}>"

    def _get(self, column: str) -> Any:
        table, row = self._storage.locate(self.sid)
        return table.raw(column)[row]

    def _copy(self, column: str) -> Floats:
        return _frozen(self._get(column).copy())

    def _set(self, column: str, value: Any) -> None:
        table, row = self._storage.locate(self.sid)
        table.raw(column)[row] = value

    # --- what it is

    @property
    def kind(self) -> Kind:
        """Sphere, box, … union."""
        return Kind(int(self._get("kinds")))

    @property
    def uid(self) -> int:
        """User id: the user's own number, not necessarily unique."""
        return int(self._get("uids"))

    @uid.setter
    def uid(self, value: int) -> None:
        self._set("uids", values.user_id(value))

    @property
    def name(self) -> str | None:
        """The name, if it has one."""
        self._storage.locate(self.sid)
        return self._storage.names.get(self.sid)

    @name.setter
    def name(self, value: str | None) -> None:
        self._storage.locate(self.sid)
        if value is None:
            self._storage.names.pop(self.sid, None)
        else:
            self._storage.names[self.sid] = values.text("name", value)

    @property
    def parent(self) -> Body | None:
        """The union that it is a member of."""
        sid = self._storage.parent_of(self.sid)
        return None if sid is None else Body(self._storage, sid)

    @property
    def members(self) -> tuple[Body, ...]:
        """The members of a union in the order in which it was made of them, else none."""
        self._storage.locate(self.sid)
        return tuple(Body(self._storage, sid) for sid in self._storage.children.get(self.sid, ()))

    @property
    def root(self) -> Body:
        """The outermost union that it belongs to, or itself."""
        return Body(self._storage, self._storage.root_of(self.sid))

    @property
    def material(self) -> Material | None:
        """Its material; a union has one if all of its members have the same, what is empty none."""
        if self.kind is Kind.UNION:
            materials = {member.material for member in self.members} - {None}
            return materials.pop() if len(materials) == 1 else None
        id = int(self._get("material_ids"))
        return None if id < 0 else self._storage.materials[id]

    @material.setter
    def material(self, value: AnyMaterial) -> None:
        """Its surface changes (of a union, those of all members), its mass does not."""
        weighing.set_material(self._storage, self.sid, self._storage.materials.resolve(value).id)

    # --- where it is

    @property
    def position(self) -> Floats:
        """Centre of mass in the world frame (3,)."""
        return _frozen(self._storage.pose_of(self.sid)[0])

    @position.setter
    def position(self, value: ArrayLike) -> None:
        place(self._storage, self.sid, values.vector("position", value), None)

    @property
    def orientation(self) -> Floats:
        """Rotation from the body frame to the world frame (4,)."""
        return _frozen(self._storage.pose_of(self.sid)[1])

    @orientation.setter
    def orientation(self, value: ArrayLike) -> None:
        place(self._storage, self.sid, None, values.quaternion(value))

    @property
    def local_position(self) -> Floats:
        """Position relative to the union that it is a member of; else as `position`. Stored."""
        return self._copy("positions")

    @property
    def local_orientation(self) -> Floats:
        """Orientation relative to the union that it is a member of. Stored."""
        return self._copy("orientations")

    def rotate(self, x: float, y: float, z: float) -> None:
        """Turn about the fixed axes x, then y, then z through its centre, in radians."""
        angles = values.vector("angles", (x, y, z)).tolist()
        orientation = self._storage.pose_of(self.sid)[1].tolist()
        place(self._storage, self.sid, None, rotations.turned(orientation, *angles))

    # --- how it moves

    @property
    def linear_velocity(self) -> Floats:
        """Velocity of the centre of mass (3,)."""
        return _frozen(self._storage.velocity_of(self.sid)[0])

    @linear_velocity.setter
    def linear_velocity(self, value: ArrayLike) -> None:
        self._set_motion("linear_velocities", values.vector("linear velocity", value))

    @property
    def angular_velocity(self) -> Floats:
        """Angular velocity in the world frame (3,), rad/s."""
        return _frozen(self._storage.velocity_of(self.sid)[1])

    @angular_velocity.setter
    def angular_velocity(self, value: ArrayLike) -> None:
        self._set_motion("angular_velocities", values.vector("angular velocity", value))

    @property
    def force(self) -> Floats:
        """Force (3,) that acts on the centre of mass of its root during the next step."""
        return self.root._copy("forces")

    @force.setter
    def force(self, value: ArrayLike) -> None:
        self._set_motion("forces", values.vector("force", value))

    @property
    def torque(self) -> Floats:
        """Torque (3,) that acts on its root during the next step."""
        return self.root._copy("torques")

    @torque.setter
    def torque(self, value: ArrayLike) -> None:
        self._set_motion("torques", values.vector("torque", value))

    def _set_motion(self, column: str, value: Floats) -> None:
        table, row = self._storage.locate(self.sid)
        if table is not self._storage.top:
            raise refuse(UNION_MEMBERS, f"{self!r} moves with its union; set it on that.")
        table.raw(column)[row] = value

    def apply_force(self, force: ArrayLike, *, at: ArrayLike | None = None) -> None:
        """Add a force (3,) to those of the next step, with its torque.

        It acts at the point `at` (3,) of the world, or at the body's centre; on the union, if the
        body is a member. Forces add up until the step, after which they are zero. What is fixed
        bears them.
        """
        pushing.push(self._storage, self.sid, force, at)

    def apply_impulse(self, impulse: ArrayLike, *, at: ArrayLike | None = None) -> None:
        """Change velocities at once as a blow (3,), mass times velocity, at a point does.

        `at` as for `apply_force`. Joints pass it on when the World next runs. What is fixed bears
        it; WorldError where there is no mass, or no inertia, to be struck.
        """
        pushing.strike(self._storage, self.sid, impulse, at)

    def velocity_at(self, point: ArrayLike) -> Floats:
        """Velocity (3,) of the point of the body that is at `point` (3,) of the world."""
        return _frozen(pushing.velocity_at(self._storage, self.sid, point))

    @property
    def sleeping(self) -> bool:
        """True if an engine has put it to sleep."""
        return bool(self.root._get("sleeping"))

    @sleeping.setter
    def sleeping(self, value: bool) -> None:
        self.root._set("sleeping", values.flag("flag sleeping", value))

    # --- its mass

    @property
    def mass(self) -> float:
        """Mass, of infinite bodies 0."""
        return float(self._get("masses"))

    @mass.setter
    def mass(self, value: float) -> None:
        """The inertia is scaled with it; members of a union get their share, a union follows."""
        weighing.set_mass(self._storage, self.sid, value)

    @property
    def inertia(self) -> Floats:
        """Inertia (3, 3) about the centre of mass in the body frame."""
        return self._copy("inertias")

    @inertia.setter
    def inertia(self, value: ArrayLike) -> None:
        """(3, 3), or its diagonal (3,)."""
        weighing.set_inertia(self._storage, self.sid, value)

    def add_up(self) -> None:
        """Make a union the sum of its members again, after they were changed through columns.

        Mass, inertia and centre follow, and those of the unions that it is in.
        """
        if self.kind is not Kind.UNION:
            raise KindError(KIND.at(message=f"{self!r} is no union: it has no members."))
        add_up_again(self._storage, self.sid)

    @property
    def infinite(self) -> bool:
        """True for planes and for unions that hold one."""
        return self._storage.is_infinite(self.sid)

    @property
    def fixed(self) -> bool:
        """True if nothing moves it: its inverse mass and inertia are zero."""
        return bool(self.root._get("fixed"))

    @fixed.setter
    def fixed(self, value: bool) -> None:
        flag, root = values.flag("flag fixed", value), self.root
        if not root.infinite:
            root._set("fixed", flag)

    @property
    def inverse_mass(self) -> float:
        """1/mass, 0 for bodies that are fixed or have no mass."""
        mass = self.mass
        return 0.0 if self.fixed or mass == 0.0 else 1.0 / mass

    @property
    def inverse_inertia(self) -> Floats:
        """The inverse of the inertia, zero for bodies that are fixed or have none."""
        inertia = self.inertia
        if self.fixed or not np.any(inertia):
            return _frozen(np.zeros((3, 3)))
        return _frozen(np.asarray(np.linalg.inv(inertia), dtype=np.float64))

    @property
    def volume(self) -> float:
        """Enclosed volume; of a union the sum over its members; 0 for a plane."""
        kind = self.kind
        if kind is Kind.UNION:
            return sum(member.volume for member in self.members)
        if kind is Kind.MESH:
            return self.mesh.volume
        return float(volume(kind, *self._get("dimensions").tolist()))

    @property
    def density(self) -> float:
        """Mass over volume, 0 for a plane."""
        volume = self.volume
        return self.mass / volume if volume else 0.0

    @density.setter
    def density(self, value: float) -> None:
        """Mass and inertia follow."""
        volume = self.volume
        if not volume:
            raise KindError(KIND.at(message=f"{self!r} has no volume."))
        self.mass = values.positive("density", value, MASS) * volume

    # --- its shape

    def _dimension(self, what: str, kinds: tuple[Kind, ...]) -> Floats:
        kind = self.kind
        if kind not in kinds:
            raise KindError(KIND.at(message=f"A {kind.name.lower()} has no {what}."))
        return self.dimensions

    @property
    def dimensions(self) -> Floats:
        """Dimensions (4,) as `colladaphy.world.shapes` lays them out.

        Normal and displacement of a plane are in the frame of `local_position`.
        """
        table, row = self._storage.locate(self.sid)
        stored: Floats = table.raw("dimensions")[row]
        if table.raw("kinds")[row] == Kind.PLANE:
            pose = table.raw("positions")[row], table.raw("orientations")[row]
            return _frozen(planes.agreeing(stored, *pose))
        return _frozen(stored.copy())

    @property
    def hollow(self) -> bool:
        """True if its mass is spread over its surface."""
        return bool(self._get("hollow"))

    @property
    def radius(self) -> float:
        """Radius of a sphere; of a capsule or cylinder across y (see `radii`)."""
        row = self._dimension("radius", (Kind.SPHERE, Kind.CAPSULE, Kind.CYLINDER))
        return float(row[0] if self.kind is Kind.SPHERE else row[1])

    @property
    def radii(self) -> Floats:
        """Semi-axes x, y, z of an ellipsoid or capsule (x: of the caps), y, z of a cylinder."""
        row = self._dimension("radii", (Kind.ELLIPSOID, Kind.CAPSULE, Kind.CYLINDER))
        return row[1:3] if self.kind is Kind.CYLINDER else row[:3]

    @property
    def length(self) -> float:
        """Length of a cylinder, or of a capsule without its caps; along x."""
        return float(self._dimension("length", (Kind.CAPSULE, Kind.CYLINDER))[3])

    @property
    def lengths(self) -> Floats:
        """Full side lengths of a box (3,)."""
        return self._dimension("lengths", (Kind.BOX,))[:3]

    @property
    def normal(self) -> Floats:
        """Outward unit normal of a plane in the world frame (3,)."""
        local = self._dimension("normal", (Kind.PLANE,))[:3]
        parent = self.parent
        return local if parent is None else _frozen(rotations.rotate(parent.orientation, local))

    @property
    def displacement(self) -> float:
        """Distance of a plane from the origin along its normal: solid where n·x < d."""
        local = float(self._dimension("displacement", (Kind.PLANE,))[3])
        return local if self.parent is None else float(self.normal @ self.position)

    @property
    def mesh(self) -> Mesh:
        """The mesh of a mesh body, shared between bodies."""
        self._dimension("mesh", (Kind.MESH,))
        return self._storage.meshes[int(self._get("mesh_ids"))]


def _frozen(array: Floats) -> Floats:
    """A copy that nobody can take for the World's own memory."""
    array.flags.writeable = False
    return array

"""The World: bodies, unions, joints and materials in numpy columns."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from colladaphy.world import (
    attaching,
    creating,
    creators,
    pairing,
    uniting,
    values,
    weighing,
)
from colladaphy.world import joints as joining
from colladaphy.world.attributes import Column, Held, Setting
from colladaphy.world.belonging import sid_of
from colladaphy.world.body import Body
from colladaphy.world.columns import BodyColumns, JointColumns, MemberColumns
from colladaphy.world.handles import Handles
from colladaphy.world.joints import Joint, Joints
from colladaphy.world.materials import (
    AnyMaterial,
    Material,
    MaterialPair,
    Materials,
    MaterialValues,
    PairOverride,
)
from colladaphy.world.meshes import Mesh, MeshSource
from colladaphy.world.rules import ARGUMENT, BODY_GONE, UNION_MEMBERS, refuse
from colladaphy.world.storage import EngineState, Storage
from colladaphy.world.table import Table
from colladaphy.world.uniting import UnionOptions

__all__ = ["World"]

Floats = NDArray[np.float64]


class World:
    """Rigid bodies, joints and materials after the pe engine (thesis 2).

    Nothing is converted: lengths are in the World's own unit, masses in kg, angles in radians.
    Densities are in kg per cubic unit; those of pe's five materials are what pe has in SI.
    What cannot be is refused with a WorldError.

    Columns of the top-level bodies have one row a body, aligned with `bodies`. Every column is a
    writable view of the World's own memory, so that ``world.positions += v`` moves all bodies. A
    view is aligned until bodies are created, destroyed or joined to a union; take it anew after
    that. Numbers that are written through a view are not checked.
    """

    def __init__(
        self, gravity: ArrayLike = (0.0, 0.0, 0.0), *, unit: tuple[str, float] = ("meter", 1.0),
        up_axis: str = "Z_UP", time_step: float | None = None, name: str | None = None,
    ) -> None:  # fmt: skip
        if not isinstance(unit, (tuple, list)) or len(unit) != 2:
            raise refuse(ARGUMENT, f"The unit is {unit!r}, not a name and a size in metres.")
        self._storage = Storage()
        self.gravity = gravity
        self.unit_name, self.unit_meter = unit
        self.up_axis = up_axis
        self.time_step = time_step
        self.name = name
        self.time = 0.0
        self.step_count = 0
        self.engine_state = None

    materials = Held[Materials]("The materials, by name and by id.")
    meshes = Held[dict[int, Mesh]]("Meshes by id, each shared between any number of bodies.")
    names = Held[dict[int, str]]("Names of bodies by system id, of those that have one.")
    joint_names = Held[dict[int, str]]("Names of joints by system id, of those that have one.")
    children = Held[dict[int, tuple[int, ...]]]("Members of each union in their order, by sids.")
    joints_of = Held[dict[int, list[int]]]("The joints at each body that has some, by sids.")
    top = Held[Table]("The bodies that are not members of a union.")
    inner = Held[Table]("The members of unions, their poses relative to the union.")
    joint_table = Held[Table]("The joints.")

    # --- the scene

    name = Setting(values.optional(values.text), "The name of the scene, if it has one.")
    unit_name = Setting(values.text, "The name of the unit of length.")
    up_axis = Setting(values.text, "X_UP, Y_UP or Z_UP.")
    time_step = Setting(values.optional(values.number), "The step that the scene asks for.")
    time = Setting(values.finite, "The clock, in seconds.")
    step_count = Setting(values.whole, "How many steps engines have done.")
    engine_state = Setting(
        values.optional(values.instance(EngineState)), "What an engine needs to go on exactly."
    )

    @property
    def unit_meter(self) -> float:
        """The unit of length in metres. Nothing but pe's own densities follows a change of it."""
        return self._unit_meter

    @unit_meter.setter
    def unit_meter(self, value: float) -> None:
        self._unit_meter = values.positive("unit meter", value)
        self.materials.follow_unit(self._unit_meter)

    @property
    def gravity(self) -> Floats:
        """Acceleration (3,) of every body that is not fixed; writable."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: ArrayLike) -> None:
        self._gravity = values.vector("gravity", value)

    # --- bodies

    @property
    def bodies(self) -> Handles[Body]:
        """The top-level bodies in the order of their system ids."""
        return Handles(self._storage, self.top, Body, "bodies")

    def body(self, sid: int) -> Body:
        """The body, member or not, of a system id; WorldError if there is none."""
        sid = values.integer("system id", sid)
        if sid not in self:
            raise refuse(BODY_GONE, f"There is no body with the system id {sid}.")
        return Body(self._storage, sid)

    def bodies_by_uid(self, uid: int) -> list[Body]:
        """All bodies of a user id, members too, in the order of their system ids."""
        uid = values.user_id(uid)
        tables = (self.top, self.inner)
        found = [table.column("sids")[table.column("uids") == uid] for table in tables]
        return [Body(self._storage, sid) for sid in np.sort(np.concatenate(found)).tolist()]

    def bodies_by_name(self, name: str) -> list[Body]:
        """All bodies of a name, members too, in the order of their system ids."""
        name = values.text("name", name)
        found = sorted(sid for sid, own in self.names.items() if own == name)
        return [Body(self._storage, sid) for sid in found]

    def __contains__(self, body: object) -> bool:
        """True for a body of this World that is alive, member or not, or for its system id."""
        if isinstance(body, Body):
            return body._storage is self._storage and body.sid in self._storage
        if not isinstance(body, (int, np.integer)):
            return False
        return 0 < int(body) < 2**63 and int(body) in self._storage

    def destroy(self, body: Body) -> None:
        """Remove a top-level body, its members and the joints at it."""
        sid = sid_of(self._storage, body)
        if self.parent_of(sid) is not None:
            raise refuse(UNION_MEMBERS, f"{body!r} is a member of a union; destroy that.")
        for joint in tuple(self.joints_of.get(sid, ())):
            self._storage.destroy_joint(joint)
        self._storage.destroy(sid)

    # --- creators

    create_sphere = creators.create_sphere
    create_box = creators.create_box
    create_capsule = creators.create_capsule
    create_cylinder = creators.create_cylinder
    create_ellipsoid = creators.create_ellipsoid
    create_plane = creators.create_plane
    create_mesh = creators.create_mesh
    create_body = creators.create_body

    def create_union(
        self, uid: int, members: Sequence[Body], **options: Unpack[UnionOptions]
    ) -> Body:
        """Join top-level bodies to one body; a nested union counts as one body (thesis 2.1).

        By pe's rules, the centre of mass becomes the position, the orientation starts as
        identity, masses add up, inertias by the parallel-axis theorem; a fixed member fixes the
        union and a plane makes it infinite. Momentum is kept. Members keep their place in the
        world. Each of these values can be given instead, and is then stored as it is.

        The option `members_are_local` says that the poses of the members are already relative to
        the union: they are stored as they are. Joints at members go over to the union.
        """
        try:
            sids = [sid_of(self._storage, body) for body in members]
        except TypeError as error:
            raise refuse(ARGUMENT, f"{members!r} are no bodies.") from error
        return Body(self._storage, uniting.create_union(self._storage, uid, sids, **options))

    def extend(
        self, columns: BodyColumns, members: MemberColumns | None = None
    ) -> NDArray[np.int64]:
        """Create many bodies at once; returns their system ids (n,).

        With `members`, some of the bodies may be unions, of the members whose parents they are,
        and members may be unions too. Either all are created or, on WorldError, none. Quaternions
        and normals have to be of length one.
        """
        return creating.extend(self._storage, columns, members)

    # --- meshes and materials

    def add_mesh(
        self, vertices: ArrayLike, faces: ArrayLike, *, convex: bool = False, id: int | None = None
    ) -> Mesh:
        """Add a mesh for any number of bodies to share."""
        return self.add_meshes([(vertices, faces, convex)], None if id is None else [id])[0]

    def add_meshes(self, sources: Sequence[MeshSource], ids: ArrayLike | None = None) -> list[Mesh]:
        """Add many meshes at once: of each the vertices, the faces and whether it is convex.

        Either all are added or, on WorldError, none.
        """
        return creating.add_meshes(self._storage, sources, ids)

    def create_material(
        self, name: str, *, id: int | None = None, **numbers: Unpack[MaterialValues]
    ) -> Material:
        """Add a material (thesis 4.4). Names and ids are unique; WorldError on bad values."""
        return self.materials.create(name, id=id, **numbers)

    def pair(
        self, first: AnyMaterial, second: AnyMaterial, *, friction: str = "sum"
    ) -> MaterialPair:
        """What holds where two materials meet: pe's rules and what was set by hand.

        `friction`: how two frictions make one, which engines can be told too; "sum" as in pe,
        "average", "product" or "maximum".
        """
        materials = self.materials
        one, two = materials.resolve(first), materials.resolve(second)
        return pairing.pair(materials, one, two, friction)

    def set_pair(
        self, first: AnyMaterial, second: AnyMaterial, restitution: float | None = None,
        static_friction: float | None = None, dynamic_friction: float | None = None,
    ) -> None:  # fmt: skip
        """Set restitution and frictions of a pair; None leaves them to pe's rules."""
        one, two = self.materials.resolve(first), self.materials.resolve(second)
        self.materials.override(one, two, restitution, static_friction, dynamic_friction)

    @property
    def pair_overrides(self) -> tuple[PairOverride, ...]:
        """The pairs set by hand, ordered by the ids of their materials."""
        return self.materials.overrides

    # --- joints; a body of None is the world, and a member stands for its union

    @property
    def joints(self) -> Joints:
        """The joints in the order of their system ids."""
        return Joints(self._storage)

    def joint(self, sid: int) -> Joint:
        """The joint of a system id; WorldError if there is none."""
        sid = values.integer("system id", sid)
        self._storage.locate_joint(sid if 0 < sid < 2**63 else 0)
        return Joint(self._storage, sid)

    def joints_by_uid(self, uid: int) -> list[Joint]:
        """All joints of a user id, in the order of their system ids."""
        table, uid = self.joint_table, values.user_id(uid)
        found = table.column("sids")[table.column("uids") == uid]
        return [Joint(self._storage, sid) for sid in found.tolist()]

    def joints_by_name(self, name: str) -> list[Joint]:
        """All joints of a name, in the order of their system ids."""
        name = values.text("name", name)
        found = sorted(sid for sid, own in self.joint_names.items() if own == name)
        return [Joint(self._storage, sid) for sid in found]

    attach_fixed_joint = joining.attach_fixed_joint
    attach_hinge_joint = joining.attach_hinge_joint
    attach_slider_joint = joining.attach_slider_joint
    attach_ball_joint = joining.attach_ball_joint
    attach_joint = joining.attach_joint

    def extend_joints(self, columns: JointColumns) -> NDArray[np.int64]:
        """Create many joints at once, stored as they are given; returns their system ids (n,).

        Bodies are top-level ones. Either all are created or, on WorldError, none.
        """
        return attaching.extend_joints(self._storage, columns)

    def destroy_joint(self, joint: Joint) -> None:
        """Remove a joint; the bodies stay."""
        if not isinstance(joint, Joint):
            raise refuse(ARGUMENT, f"{joint!r} is not a joint.")
        if joint._storage is not self._storage:
            raise refuse(BODY_GONE, f"{joint!r} belongs to another World.")
        self._storage.destroy_joint(joint.sid)

    # --- columns

    uids = Column(np.int64, "User ids (n,).")
    positions = Column(np.float64, "Centres of mass (n, 3). A union takes its members along.")
    orientations = Column(np.float64, "Quaternions (w, x, y, z), (n, 4).")
    linear_velocities = Column(np.float64, "Velocities of the centres of mass (n, 3).")
    angular_velocities = Column(np.float64, "In rad/s, in the world frame (n, 3).")
    forces = Column(np.float64, "Forces (n, 3) that act during the next step.")
    torques = Column(np.float64, "Torques (n, 3) that act during the next step.")
    masses = Column(np.float64, "Masses (n,), 0 for infinite bodies.")
    inertias = Column(np.float64, "About the centre of mass, in the body frame (n, 3, 3).")
    fixed: Column[np.bool_] = Column(np.bool_, "True for bodies that nothing moves (n,).")
    sleeping: Column[np.bool_] = Column(
        np.bool_, "True for bodies that an engine has put to sleep (n,)."
    )
    material_ids = Column(np.int64, "Ids of materials (n,), -1 for a union.")
    hollow: Column[np.bool_] = Column(np.bool_, "True where the mass is on the surface (n,).")

    @property
    def sids(self) -> NDArray[np.int64]:
        """System ids (n,), ascending, read-only."""
        return self.top.frozen("sids")

    @property
    def kinds(self) -> NDArray[np.int8]:
        """Numbers of `Kind` (n,), read-only."""
        return self.top.frozen("kinds")

    @property
    def mesh_ids(self) -> NDArray[np.int64]:
        """Ids of meshes (n,), -1 for bodies that are none, read-only."""
        return self.top.frozen("mesh_ids")

    @property
    def dimensions(self) -> Floats:
        """Dimensions (n, 4) as `colladaphy.world.shapes` lays them out, read-only.

        Planes that were moved have their new normal and displacement.
        """
        return self._storage.dimensions_of(self.top)

    def columns(self) -> BodyColumns:
        """All columns of the top-level bodies at once, unions among them; `extend` takes these."""
        self._storage.dimensions_of(self.top)
        return BodyColumns(**self.top.views(self.names))

    @property
    def member_columns(self) -> MemberColumns:
        """The members of all unions by column; writable views, poses relative to the union."""
        self._storage.dimensions_of(self.inner)
        return MemberColumns(**self.inner.views(self.names))

    @property
    def joint_columns(self) -> JointColumns:
        """The joints by column; writable views."""
        return JointColumns(**self.joint_table.views(self.joint_names))

    # --- system ids

    # Counters, so that no id is used twice.
    next_body_sid = Setting(values.whole, "The system id that the next body gets.", of="_storage")
    next_joint_sid = Setting(values.whole, "The system id that the next joint gets.", of="_storage")

    def locate(self, sid: int) -> tuple[Table, int]:
        """The table and the row that hold a body; WorldError if there is none."""
        return self._storage.locate(sid)

    def parent_of(self, sid: int) -> int | None:
        """The system id of the union that a body is a member of, or None."""
        return self._storage.parent_of(sid)

    def root_of(self, sid: int) -> int:
        """The system id of the outermost union of a body, or its own."""
        return self._storage.root_of(sid)

    def differing_unions(self) -> list[Body]:
        """The unions whose mass, centre or inertia is not that of their members together.

        They were made with values of their own, or members were changed through columns
        (`Body.add_up` makes it good).
        """
        return [Body(self._storage, sid) for sid in weighing.differing_unions(self._storage)]

    def is_infinite(self, sid: int) -> bool:
        """True for planes and for unions that hold one."""
        return self._storage.is_infinite(sid)

    # --- time

    def run(self, steps: int, dt: float | None = None, **options: Any) -> Any:
        """Advance `steps` time steps of `dt`, as pe's `run`, and return the `Simulation`.

        `options` are those of `colladaphy.Simulation`, such as the engine. Its `report` says what
        is dropped or assumed; its own `run` goes on without setting up again.
        """
        simulation = import_module("colladaphy").Simulation(self, dt=dt, **options)
        simulation.run(steps)
        return simulation

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        return f"<World{name} of {len(self.top)} bodies, {len(self.joints)} joints>"

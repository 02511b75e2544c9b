"""Whole-world columns: views that are read and written at once for all bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.columns import (
    BODY_FIELDS,
    JOINT_FIELDS,
    MEMBER_FIELDS,
    BodyColumns,
    JointColumns,
    MemberColumns,
)
from colladaphy.world.core import Core
from colladaphy.world.kinds import Kind
from colladaphy.world.table import Table

__all__ = ["Viewing"]

Array = NDArray[Any]


def _column(name: str, description: str) -> property:
    def get(self: Core) -> Array:
        return self.top.column(name)

    def set_(self: Core, value: Any) -> None:
        self.top.column(name)[...] = value

    get.__doc__ = description
    return property(get, set_)


class Viewing(Core):
    """Columns of the top-level bodies, one row a body, aligned with `World.bodies`.

    Every column is a writable view of the World's own memory, so that ``world.positions += v``
    moves all bodies. A view is aligned until bodies are created, destroyed or joined to a union;
    take it anew after that. Values written through a view are not checked.
    """

    sids = property(lambda self: self._system_ids(), doc="System ids (n,), ascending, read-only.")
    uids = _column("uids", "User ids (n,).")
    positions = _column("positions", "Centres of mass (n, 3). A union takes its members along.")
    orientations = _column("orientations", "Quaternions (w, x, y, z), (n, 4).")
    linear_velocities = _column("linear_velocities", "Velocities of the centres of mass (n, 3).")
    angular_velocities = _column("angular_velocities", "In rad/s, in the world frame (n, 3).")
    forces = _column("forces", "Forces (n, 3) that act during the next step.")
    torques = _column("torques", "Torques (n, 3) that act during the next step.")
    masses = _column("masses", "Masses (n,), 0 for infinite bodies.")
    inertias = _column("inertias", "About the centre of mass, in the body frame (n, 3, 3).")
    fixed = _column("fixed", "True for bodies that nothing moves (n,).")
    sleeping = _column("sleeping", "True for bodies that an engine has put to sleep (n,).")
    material_ids = _column("material_ids", "Ids of materials (n,), -1 for a union.")
    hollow = _column("hollow", "True where the mass is on the surface (n,).")

    def _system_ids(self) -> Array:
        view = self.top.column("sids")
        view.flags.writeable = False
        return view

    @property
    def kinds(self) -> Array:
        """Numbers of `Kind` (n,), read-only."""
        view = self.top.column("kinds")
        view.flags.writeable = False
        return view

    @property
    def mesh_ids(self) -> Array:
        """Ids of meshes (n,), -1 for bodies that are none, read-only."""
        view = self.top.column("mesh_ids")
        view.flags.writeable = False
        return view

    @property
    def dimensions(self) -> Array:
        """Dimensions (n, 4) as `colladaphy.world.shapes` lays them out, read-only.

        Planes that were moved have their new normal and displacement.
        """
        return self._dimensions_in(self.top)

    def _dimensions_in(self, table: Table) -> Array:
        view = table.column("dimensions")
        for row in np.flatnonzero(table.column("kinds") == Kind.PLANE).tolist():
            view[row] = self.handle(int(table.raw("sids")[row])).dimensions
        view.flags.writeable = False
        return view

    @property
    def member_columns(self) -> MemberColumns:
        """The members of all unions by column; writable views, poses relative to the union."""
        self._dimensions_in(self.inner)
        column = self.inner.column
        sids, names = column("sids"), self.names
        return MemberColumns(
            sids=sids,
            **{key: column(key) for key in MEMBER_FIELDS},
            names=[names.get(sid) for sid in sids.tolist()] if names else None,
        )

    @property
    def joint_columns(self) -> JointColumns:
        """The joints by column; writable views."""
        column, names = self.joint_table.column, self.joint_names
        sids = column("sids")
        return JointColumns(
            sids=sids,
            **{key: column(key) for key in JOINT_FIELDS},
            names=[names.get(sid) for sid in sids.tolist()] if names else None,
        )

    def columns(self) -> BodyColumns:
        """All columns of the top-level bodies at once, unions among them; `extend` takes these."""
        views = {key: getattr(self, key) for key in ("sids", *BODY_FIELDS)}
        names = self.names
        return BodyColumns(
            **views, names=[names.get(sid) for sid in views["sids"].tolist()] if names else None
        )

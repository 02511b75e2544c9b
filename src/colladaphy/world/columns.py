"""Which numbers a World keeps of its bodies, as columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.table import Field

__all__ = ["BODY_FIELDS", "MEMBER_FIELDS", "BodyColumns", "MemberColumns"]

Array = NDArray[Any]

_SHAPE_FIELDS: Final[dict[str, Field]] = {
    "uids": (np.int64, ()),
    "kinds": (np.int8, ()),
    "positions": (np.float64, (3,)),
    "orientations": (np.float64, (4,)),
    "masses": (np.float64, ()),
    "inertias": (np.float64, (3, 3)),
    "material_ids": (np.int64, ()),
    "dimensions": (np.float64, (4,)),
    "hollow": (np.bool_, ()),
    "mesh_ids": (np.int64, ()),
}

BODY_FIELDS: Final[dict[str, Field]] = {
    **_SHAPE_FIELDS,
    "linear_velocities": (np.float64, (3,)),
    "angular_velocities": (np.float64, (3,)),
    "forces": (np.float64, (3,)),
    "torques": (np.float64, (3,)),
    "fixed": (np.bool_, ()),
    "sleeping": (np.bool_, ()),
}

MEMBER_FIELDS: Final[dict[str, Field]] = {**_SHAPE_FIELDS, "parents": (np.int64, ())}


@dataclass(slots=True, kw_only=True)
class BodyColumns:
    """Bodies by column, one row a body; both what `World.columns` gives and `extend` takes.

    Only `kinds` is always needed to create bodies. What is None has the creators' default: origin
    (for a plane its normal times its displacement), no rotation (for a plane the one that turns
    z onto its normal), at rest, mass and inertia from shape and material, material iron, the next
    free system ids, user id 0, no names. Given values are stored as they are.
    """

    kinds: Array
    """(n,) numbers of `Kind`."""
    sids: Array | None = None
    """(n,) system ids."""
    uids: Array | None = None
    """(n,) user ids."""
    positions: Array | None = None
    """(n, 3) centres of mass."""
    orientations: Array | None = None
    """(n, 4) quaternions (w, x, y, z)."""
    linear_velocities: Array | None = None
    """(n, 3)."""
    angular_velocities: Array | None = None
    """(n, 3) in rad/s, in the world frame."""
    forces: Array | None = None
    """(n, 3) that act during the next step."""
    torques: Array | None = None
    """(n, 3) that act during the next step."""
    masses: Array | None = None
    """(n,)."""
    inertias: Array | None = None
    """(n, 3, 3) about the centre of mass, in the body frame."""
    fixed: Array | None = None
    """(n,) True for bodies that nothing moves."""
    sleeping: Array | None = None
    """(n,) True for bodies that an engine has put to sleep."""
    material_ids: Array | None = None
    """(n,) ids of materials, -1 for a union."""
    dimensions: Array | None = None
    """(n, 4) as `colladaphy.world.shapes` lays them out."""
    hollow: Array | None = None
    """(n,) True where the mass is on the surface."""
    mesh_ids: Array | None = None
    """(n,) ids of meshes, -1 for none."""
    names: Sequence[str | None] | None = None


@dataclass(slots=True, kw_only=True)
class MemberColumns:
    """The members of unions by column, in ascending order of system ids.

    Positions and orientations are relative to the union that is the parent.
    """

    kinds: Array
    sids: Array
    uids: Array
    parents: Array
    """(n,) system ids of the unions, themselves members or not."""
    positions: Array
    orientations: Array
    masses: Array
    inertias: Array
    material_ids: Array
    dimensions: Array
    hollow: Array
    mesh_ids: Array

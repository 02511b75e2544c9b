"""Which numbers a World keeps of its bodies and joints, as columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.table import Field

__all__ = [
    "BODY_FIELDS",
    "JOINT_FIELDS",
    "MEMBER_FIELDS",
    "BodyColumns",
    "JointColumns",
    "MemberColumns",
]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Integers = NDArray[np.integer[Any]]

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

JOINT_FIELDS: Final[dict[str, Field]] = {
    "uids": (np.int64, ()),
    "bodies": (np.int64, (2,)),
    "positions": (np.float64, (2, 3)),
    "orientations": (np.float64, (2, 4)),
    "linear_limits": (np.float64, (2, 3)),
    "angular_limits": (np.float64, (2, 3)),
    "linear_springs": (np.float64, (3,)),
    "angular_springs": (np.float64, (3,)),
    "motors": (np.float64, (2,)),
    "enabled": (np.bool_, ()),
    "interpenetrate": (np.bool_, ()),
}


@dataclass(slots=True, kw_only=True)
class BodyColumns:
    """Bodies by column, one row a body; both what `World.columns` gives and `extend` takes.

    Only `kinds` is always needed to create bodies. What is None has the creators' default: origin
    (for a plane its normal times its displacement), no rotation (for a plane the one that turns
    z onto its normal), at rest, mass and inertia from shape and material, material iron, the next
    free system ids, user id 0, no names. Given values are stored as they are. Rows of unions need
    system ids, poses, masses and inertias, and their members beside them.
    """

    kinds: Integers
    """(n,) numbers of `Kind`."""
    sids: Integers | None = None
    """(n,) system ids."""
    uids: Integers | None = None
    """(n,) user ids."""
    positions: Floats | None = None
    """(n, 3) centres of mass."""
    orientations: Floats | None = None
    """(n, 4) quaternions (w, x, y, z)."""
    linear_velocities: Floats | None = None
    """(n, 3)."""
    angular_velocities: Floats | None = None
    """(n, 3) in rad/s, in the world frame."""
    forces: Floats | None = None
    """(n, 3) that act during the next step."""
    torques: Floats | None = None
    """(n, 3) that act during the next step."""
    masses: Floats | None = None
    """(n,)."""
    inertias: Floats | None = None
    """(n, 3, 3) about the centre of mass, in the body frame."""
    fixed: Bools | None = None
    """(n,) True for bodies that nothing moves."""
    sleeping: Bools | None = None
    """(n,) True for bodies that an engine has put to sleep."""
    material_ids: Integers | None = None
    """(n,) ids of materials, -1 for a union."""
    dimensions: Floats | None = None
    """(n, 4) as `colladaphy.world.shapes` lays them out."""
    hollow: Bools | None = None
    """(n,) True where the mass is on the surface."""
    mesh_ids: Integers | None = None
    """(n,) ids of meshes, -1 for none."""
    names: Sequence[str | None] | None = None


@dataclass(slots=True, kw_only=True)
class MemberColumns:
    """The members of unions by column, one row a member, in any order.

    Positions and orientations are relative to the union that is the parent; masses and inertias
    are those of the member. The rows of one parent are its members in their order. A World gives
    them in ascending order of system ids, and the order of members in `World.children`.
    """

    kinds: Integers
    sids: Integers
    uids: Integers
    parents: Integers
    """(n,) system ids of the unions, themselves members or not."""
    positions: Floats
    orientations: Floats
    masses: Floats
    inertias: Floats
    material_ids: Integers
    dimensions: Floats
    hollow: Bools
    mesh_ids: Integers
    names: Sequence[str | None] | None = None


@dataclass(slots=True, kw_only=True)
class JointColumns:
    """Joints by column, one row a joint; both what a World gives and `extend_joints` takes.

    Only `bodies` is always needed. What is None has the default of `World.attach_joint`: frames
    at the centres of the bodies, all axes locked, no springs, enabled, the next free system ids.
    """

    bodies: Integers
    """(n, 2) system ids of top-level bodies, 0 for the world."""
    sids: Integers | None = None
    """(n,) system ids of the joints."""
    uids: Integers | None = None
    """(n,) user ids."""
    positions: Floats | None = None
    """(n, 2, 3) origins of the frames, relative to each of the bodies."""
    orientations: Floats | None = None
    """(n, 2, 4) quaternions of the frames (w, x, y, z)."""
    linear_limits: Floats | None = None
    """(n, 2, 3) lower and upper limits along x, y, z of the first frame, ±inf for none."""
    angular_limits: Floats | None = None
    """(n, 2, 3) the same about the axes, in radians."""
    linear_springs: Floats | None = None
    """(n, 3) stiffness, damping, target length."""
    angular_springs: Floats | None = None
    """(n, 3) stiffness, damping, target angle in radians."""
    motors: Floats | None = None
    """(n, 2) speed and greatest force or torque along the only free axis; 0, 0 for none."""
    enabled: Bools | None = None
    """(n,) False for joints that do nothing at present."""
    interpenetrate: Bools | None = None
    """(n,) True where the two bodies do not collide with each other."""
    names: Sequence[str | None] | None = None

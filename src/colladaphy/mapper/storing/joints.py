"""Joints as rigid constraints (thesis 4.5, COLLADA 1.5 §rigid_constraint).

The reference body is body 1. Frames and linear limits are exact in the common profile; what is an
angle (orientations, angular limits, angular springs) is exact in the pe profile.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import DEGREE, degrees_exactly, differs
from colladaphy.mapper.storing.arrangement import Arrangement
from colladaphy.mapper.storing.geometries import PLANE
from colladaphy.mapper.storing.joint_profile import joint_profile
from colladaphy.mapper.storing.rows import float1, float3, labelled, transforms, where_there
from colladaphy.mapper.storing.turns import turns_of
from colladaphy.world import rotations
from colladaphy.world.columns import JOINT_FIELDS
from colladaphy_schema import physics_columns as physics

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["Joints", "arrange_joints", "constraint_instances", "constraints_of"]

Array = NDArray[Any]


@dataclass(slots=True)
class Joints:
    """The joints of a World, n rows in the order of the file."""

    values: dict[str, Array]
    """Their columns, ``sids`` and those of `JOINT_FIELDS`."""
    names: list[str | None] | None
    labels: list[str]
    """Their scoped ids."""
    model: Array
    """(n,) the physics model that each stands in, never descending."""
    at: Array
    """(n, 2) the rows of their bodies, -1 for the world."""
    at_plane: Array
    """(n, 2) which of these are planes."""


def arrange_joints(world: World, arrangement: Arrangement) -> Joints:
    """A joint stands in the model of body 1, or of body 2 where 1 is the world."""
    values = {name: world.joint_table.column(name) for name in ("sids", *JOINT_FIELDS)}
    ends = values["bodies"]
    at = np.full(ends.shape, -1)
    sids = arrangement.bodies["sids"]
    if len(sids):
        sorting = np.argsort(sids, kind="stable")
        found = sorting[np.minimum(np.searchsorted(sids, ends, sorter=sorting), len(sids) - 1)]
        at = np.where(ends != 0, found, -1)
    model = np.zeros(len(ends), np.int64)
    if len(ends):
        model = arrangement.model[np.where(ends[:, 0] != 0, at[:, 0], at[:, 1])]
    if len(arrangement.models) > 1:
        sorting = np.argsort(model, kind="stable")
        model, at = model[sorting], at[sorting]
        values = {name: column[sorting] for name, column in values.items()}
    names = None
    if world.joint_names:
        names = [world.joint_names.get(sid) for sid in values["sids"].tolist()]
    at_plane = np.zeros(at.shape, np.bool_)
    there = at >= 0
    at_plane[there] = arrangement.bodies["kinds"][at[there]] == PLANE
    return Joints(values, names, labelled("Joint", values["sids"]), model, at, at_plane)


def constraints_of(
    joints: Joints, arrangement: Arrangement, options: WriteOptions
) -> physics.RigidConstraintTypeRows:
    """The rigid_constraint of each joint."""
    rows = physics.RigidConstraintTypeRows(len(joints.labels), joints.model)
    rows.sid = joints.labels
    rows.name = joints.names
    positions, orientations = _frames(joints, arrangement)
    rows.ref_attachment = physics.RigidConstraintTypeRefAttachmentRows(len(rows))
    rows.attachment = physics.RigidConstraintTypeAttachmentRows(len(rows))
    rows.ref_attachment.rigid_body = _addresses(joints, arrangement, 0)
    rows.attachment.rigid_body = _addresses(joints, arrangement, 1)
    _attach(rows.ref_attachment, positions[:, 0], orientations[:, 0])
    _attach(rows.attachment, positions[:, 1], orientations[:, 1])
    degrees, exact = degrees_exactly(joints.values["angular_limits"])
    rows.technique_common = _common(joints.values, degrees, options)
    if options.profile != "none":
        rows.technique = joint_profile(
            joints.values, joints.names, joints.at_plane, np.all(exact, axis=(1, 2)),
            full=options.profile == "full",
        )  # fmt: skip
    return rows


def _attach(
    attachment: physics.RigidConstraintTypeRefAttachmentRows
    | physics.RigidConstraintTypeAttachmentRows,
    positions: Array,
    orientations: Array,
) -> None:
    moved = differs(positions, np.zeros(3))
    attachment.translate, attachment.rotate = transforms((positions, moved), turns_of(orientations))


def constraint_instances(joints: Joints) -> physics.InstanceRigidConstraintTypeRows:
    """The instance_rigid_constraint of each joint."""
    rows = physics.InstanceRigidConstraintTypeRows(len(joints.labels), joints.model)
    rows.constraint = joints.labels
    return rows


def _frames(joints: Joints, arrangement: Arrangement) -> tuple[Array, Array]:
    """The frames as a rigid_body has them: that of a plane is the world's, not the plane's own."""
    positions, orientations = joints.values["positions"], joints.values["orientations"]
    if joints.at_plane.any():
        positions, orientations = positions.copy(), orientations.copy()
        there, bodies = joints.at_plane, arrangement.bodies
        planes = joints.at[there]
        turns = bodies["orientations"][planes]
        with np.errstate(all="ignore"):
            moved = bodies["positions"][planes] + rotations.rotate(turns, positions[there])
            positions[there] = moved
            orientations[there] = rotations.multiply(
                rotations.normalize(turns), orientations[there]
            )
    return positions, orientations


def _addresses(joints: Joints, arrangement: Arrangement, side: int) -> list[str | None]:
    """The SID paths of the rigid bodies at one side, None for the world."""
    at = joints.at[:, side].tolist()
    sids = joints.values["bodies"][:, side].tolist()
    models = arrangement.model[joints.at[:, side]].tolist() if arrangement.model.size else at
    return [
        f"Model{model + 1}/Body{sid}" if row >= 0 else None
        for row, sid, model in zip(at, sids, models, strict=True)
    ]


def _common(
    values: dict[str, Array], degrees: Array, options: WriteOptions
) -> physics.RigidConstraintTypeTechniqueCommonRows:
    """What differs from the defaults, or all. A fixed joint is what these say (thesis 5.4)."""
    count = len(degrees)
    every = np.full(count, options.redundant)
    rows = physics.RigidConstraintTypeTechniqueCommonRows(count)
    enabled, index = where_there(
        physics.RigidConstraintTypeTechniqueCommonEnabledRows, ~values["enabled"] | every
    )
    enabled.value = values["enabled"][index]
    rows.enabled = enabled
    through, index = where_there(
        physics.RigidConstraintTypeTechniqueCommonInterpenetrateRows,
        values["interpenetrate"] | every,
    )
    through.value = values["interpenetrate"][index]
    rows.interpenetrate = through
    _add_limits(rows, values, degrees, every)
    _add_springs(rows, values)
    return rows


def _add_limits(
    rows: physics.RigidConstraintTypeTechniqueCommonRows,
    values: dict[str, Array],
    degrees: Array,
    every: Array,
) -> None:
    linear, nothing = values["linear_limits"], np.zeros((2, 3))
    turns = differs(values["angular_limits"], nothing) | every
    shifts = differs(linear, nothing) | every
    there = turns | shifts
    limits, index = where_there(physics.RigidConstraintTypeTechniqueCommonLimitsRows, there)
    swings, chosen = where_there(
        physics.RigidConstraintTypeTechniqueCommonLimitsSwingConeAndTwistRows, turns[index]
    )
    _fill_limits(swings, degrees[index][chosen])
    limits.swing_cone_and_twist = swings
    slides, chosen = where_there(
        physics.RigidConstraintTypeTechniqueCommonLimitsLinearRows, shifts[index]
    )
    _fill_limits(slides, linear[index][chosen])
    limits.linear = slides
    rows.limits = limits


def _fill_limits(
    rows: physics.RigidConstraintTypeTechniqueCommonLimitsSwingConeAndTwistRows
    | physics.RigidConstraintTypeTechniqueCommonLimitsLinearRows,
    limits: Array,
) -> None:
    each = np.ones(len(rows), np.bool_)
    rows.min = float3(limits[:, 0], each)
    rows.max = float3(limits[:, 1], each)


def _add_springs(
    rows: physics.RigidConstraintTypeTechniqueCommonRows, values: dict[str, Array]
) -> None:
    turns, shifts = values["angular_springs"], values["linear_springs"]
    turning, shifting = differs(turns, np.zeros(3)), differs(shifts, np.zeros(3))
    there = turning | shifting
    if not there.any():
        return
    springs, index = where_there(physics.RigidConstraintTypeTechniqueCommonSpringRows, there)
    angular, chosen = where_there(
        physics.RigidConstraintTypeTechniqueCommonSpringAngularRows, turning[index]
    )
    # Per degree, as COLLADA has it.
    with np.errstate(over="ignore"):
        degrees = turns[index][chosen] * np.array([DEGREE, DEGREE, 1.0 / DEGREE])
    _fill_spring(angular, np.nan_to_num(degrees))
    springs.angular = angular
    linear, chosen = where_there(
        physics.RigidConstraintTypeTechniqueCommonSpringLinearRows, shifting[index]
    )
    _fill_spring(linear, shifts[index][chosen])
    springs.linear = linear
    rows.spring = springs


def _fill_spring(
    rows: physics.RigidConstraintTypeTechniqueCommonSpringAngularRows
    | physics.RigidConstraintTypeTechniqueCommonSpringLinearRows,
    values: Array,
) -> None:
    each = np.ones(len(rows), np.bool_)
    rows.stiffness = float1(values[:, 0], each)
    rows.damping = float1(values[:, 1], each)
    rows.target_value = float1(values[:, 2], each)

"""How bodies move, and where they are: instances of rigid bodies, and nodes (thesis 5.4)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import degrees_exactly, differs
from colladaphy.mapper.storing.arrangement import Arrangement
from colladaphy.mapper.storing.geometries import PLANE
from colladaphy.mapper.storing.rows import labelled, masked, technique, transforms
from colladaphy.mapper.storing.turns import turns_of
from colladaphy.world import rotations
from colladaphy_schema.core_columns import TechniqueTypeRows
from colladaphy_schema.pe_columns import MotionRows
from colladaphy_schema.physics_columns import (
    InstanceRigidBodyTypeRows,
    InstanceRigidBodyTypeTechniqueCommonRows,
)
from colladaphy_schema.scene_columns import NodeTypeRows

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["instances_of", "nodes_of"]

Array = NDArray[Any]


def instances_of(
    arrangement: Arrangement, labels: list[str], options: WriteOptions
) -> InstanceRigidBodyTypeRows:
    """The instance_rigid_body of each body; `labels` are the scoped ids of their rigid bodies."""
    bodies, count = arrangement.bodies, len(labels)
    rows = InstanceRigidBodyTypeRows(count, arrangement.model)
    rows.body = labels
    rows.target = labelled("#Node", bodies["sids"])
    common = InstanceRigidBodyTypeTechniqueCommonRows(count)
    degrees, exact = degrees_exactly(bodies["angular_velocities"])
    common.angular_velocity = masked(degrees, _some(degrees))
    common.velocity = masked(bodies["linear_velocities"], _some(bodies["linear_velocities"]))
    rows.technique_common = common
    if options.profile != "none":
        is_exact = exact[:, 0] & exact[:, 1] & exact[:, 2]
        rows.technique = _motions(bodies, is_exact, options.profile == "full")
    return rows


def _motions(bodies: dict[str, Array], exact: Array, full: bool) -> TechniqueTypeRows:
    """What the node, and the common profile, do not say exactly."""
    planes = bodies["kinds"] == PLANE
    turned = differs(bodies["orientations"], rotations.IDENTITY)
    if planes.any():
        # A plane that says nothing is turned as its normal is.
        turned |= planes & differs(bodies["dimensions"][:, :2], np.zeros(2))
    every = np.full(len(exact), full)
    asleep = bodies["sleeping"]
    wanted = {
        "positions": every & ~planes,
        "orientations": turned | full,
        "linear_velocities": every,
        "angular_velocities": ~exact | full,
        "forces": _some(bodies["forces"]),
        "torques": _some(bodies["torques"]),
    }
    there = asleep.copy()
    for where in wanted.values():
        there |= where
    count = int(np.count_nonzero(there))
    whole = count == len(there)
    techniques = technique(count, None if whole else np.flatnonzero(there))
    values = {name: masked(bodies[name], where) if whole else
              masked(bodies[name][there], where[there])
              for name, where in wanted.items()}  # fmt: skip
    rows = MotionRows(count)
    rows.sleeping = masked(asleep[there], asleep[there])
    rows.position = values["positions"]
    rows.orientation = values["orientations"]
    rows.linear_velocity = values["linear_velocities"]
    rows.angular_velocity = values["angular_velocities"]
    rows.force = values["forces"]
    rows.torque = values["torques"]
    techniques.motion = rows
    return techniques


def nodes_of(world: World) -> NodeTypeRows:
    """The node of each body, which says where it is, in the order of system ids."""
    rows = NodeTypeRows(len(world.sids), np.zeros(len(world.sids), np.int64))
    rows.id = labelled("Node", world.sids)
    turns, turned = turns_of(world.orientations)
    moved = _some(world.positions)
    planes = world.kinds == PLANE
    if planes.any():
        # The equation of a plane is in world coordinates; its node stays at the origin.
        moved, turned = moved & ~planes, turned & ~planes
    rows.translate, rows.rotate = transforms((world.positions, moved), (turns, turned))
    return rows


def _some(values: Array) -> Array:
    """Where any of the numbers (n, 3) is not (positive) zero."""
    return differs(values, np.zeros(values.shape[1]))

"""Joints in the pe profile: what is an angle, and the frames beside planes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import differs
from colladaphy.mapper.storing.arrangement import kept_names
from colladaphy.mapper.storing.rows import masked, technique, where_there
from colladaphy.world import rotations
from colladaphy.world.kinds import JointKind
from colladaphy_schema import pe_columns as pe
from colladaphy_schema.core_columns import TechniqueTypeRows

__all__ = ["joint_profile"]

Array = NDArray[Any]

_KINDS = np.full((4, 4), JointKind.GENERAL.name.lower(), dtype=object)
"""The kind of joint by the numbers of axes that it is free to move along, and to turn about."""
for _axes, _kind in (
    ((0, 0), JointKind.FIXED),
    ((0, 1), JointKind.HINGE),
    ((1, 0), JointKind.SLIDER),
    ((0, 3), JointKind.BALL),
):
    _KINDS[_axes] = _kind.name.lower()


def joint_profile(
    values: dict[str, Array],
    names: list[str | None] | None,
    at_plane: Array,
    exact: Array,
    *,
    full: bool,
) -> TechniqueTypeRows:
    """What the common profile does not say exactly, or all.

    `exact` (n,) tells where degrees say the angular limits.
    """
    rows = pe.JointRows(len(exact))
    rows.kind = _kinds(values)
    rows.uid = values["uids"]
    rows.name = kept_names(names)
    rows.frame1 = _frame(values, 0, at_plane[:, 0] | full)
    rows.frame2 = _frame(values, 1, at_plane[:, 1] | full)
    rows.angular_limits = _limits(values["angular_limits"], ~exact | full)
    turning = differs(values["angular_springs"], np.zeros(3))
    rows.angular_spring = _spring(values["angular_springs"], turning)
    rows.motor = _motors(values["motors"])
    if full:
        rows.linear_limits = _limits(values["linear_limits"], np.ones(len(rows), np.bool_))
        shifting = differs(values["linear_springs"], np.zeros(3))
        rows.linear_spring = _spring(values["linear_springs"], shifting)
    techniques = technique(len(rows))
    techniques.joint = rows
    return techniques


def _kinds(values: dict[str, Array]) -> list[str | None]:
    free = [
        np.count_nonzero(limits[:, 0] != limits[:, 1], axis=1)
        for limits in (values["linear_limits"], values["angular_limits"])
    ]
    kinds: list[str | None] = _KINDS[free[0], free[1]].tolist()
    return kinds


def _frame(values: dict[str, Array], side: int, says_all: Array) -> pe.FrameTypeRows:
    orientations = np.ascontiguousarray(values["orientations"][:, side])
    turned = says_all | differs(orientations, rotations.IDENTITY)
    rows, index = where_there(pe.FrameTypeRows, turned)
    rows.position = masked(values["positions"][index, side], says_all[index])
    rows.orientation = orientations[index]
    return rows


def _limits(limits: Array, there: Array) -> pe.LimitsTypeRows:
    rows, index = where_there(pe.LimitsTypeRows, there)
    rows.min = limits[index, 0]
    rows.max = limits[index, 1]
    return rows


def _motors(motors: Array) -> pe.MotorTypeRows:
    rows, index = where_there(pe.MotorTypeRows, differs(motors, np.zeros(2)))
    rows.speed, rows.strength = motors[index, 0], motors[index, 1]
    return rows


def _spring(springs: Array, there: Array) -> pe.SpringTypeRows:
    rows, index = where_there(pe.SpringTypeRows, there)
    rows.stiffness = springs[index, 0]
    rows.damping = springs[index, 1]
    rows.target_value = springs[index, 2]
    return rows

"""Joints of kinematics: axes and limits (COLLADA 1.5 §joint, §revolute, §prismatic, §axis_info)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from colladaphy.findings import Severity
from colladaphy.meaning import kinematics_rules, physics_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.joints import look_like_radians
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]


def axes(context: Context) -> Iterator[Hit]:
    """Joints whose axes are none."""
    joints = context.rows(Rows, "revolute", "prismatic")
    values, elements = context.vectors(joints, "axis", 3)
    limits = context.children(joints, "limits", Rows)
    low, high = (context.scalars(limits, name)[0] for name in ("min", "max"))
    held = set(limits.owner[low == high].tolist())
    good = np.isfinite(values).all(axis=1) & np.nan_to_num(values).any(axis=1)
    for row in np.flatnonzero(~good & (elements >= 0)).tolist():
        shown = " ".join(f"{value:g}" for value in values[row].tolist())
        # Exporters write fixed joints so, with limits that leave one position.
        severity = Severity.WARNING if row in held else None
        yield Hit(kinematics_rules.AXIS, int(elements[row]), f"The axis is {shown}.",
                  severity=severity)  # fmt: skip


def limits(context: Context) -> Iterator[Hit]:
    """Limits that leave nothing."""
    rows = context.rows(Rows, "limits")
    if not len(rows):
        return
    assert rows.ordinals is not None
    keep = context.is_within(rows.ordinals, "revolute", "prismatic", "axis_info")
    rows = rows.select(keep)
    if not len(rows):
        return
    assert rows.ordinals is not None
    turns = context.is_within(rows.ordinals, "revolute")
    low, low_elements = context.scalars(rows, "min")
    high, high_elements = context.scalars(rows, "max")
    inner = {name: context.children(rows, name, Rows) for name in ("min", "max")}
    if np.isnan(low).any() or np.isnan(high).any():
        # In motions and kinematics systems the numbers stand in elements of their own.
        for name, values in (("min", low), ("max", high)):
            found, elements = context.scalars(inner[name], "float")
            rows_of = inner[name].owner
            values[rows_of] = np.where(elements >= 0, found, values[rows_of])
    there = (low_elements >= 0) & (high_elements >= 0)
    # A parameter in the place of a number is not looked at.
    stated = ~context.is_within(rows.ordinals, "axis_info")
    for row in np.flatnonzero(there & (~(low <= high) & (stated | (low > high)))).tolist():
        message = f"The lower limit is {low[row]:g}, the upper one {high[row]:g}."
        at, other = int(low_elements[row]), int(high_elements[row])
        if np.isnan(high[row]) and not np.isnan(low[row]):
            at, other = other, at
        yield Hit(kinematics_rules.LIMITS, at, message, (other,))
    turns &= look_like_radians(np.column_stack([low, high]))
    for row in np.flatnonzero(turns & there & (low <= high)).tolist():
        message = f"From {low[row]:g} to {high[row]:g} degrees is what radians look like."
        yield Hit(physics_rules.JOINT_RADIANS, int(low_elements[row]), message)


CHECKS = (axes, limits)

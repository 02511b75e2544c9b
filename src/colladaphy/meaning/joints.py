"""Rigid constraints: limits, springs and ends (COLLADA 1.5 §rigid_constraint; thesis 4.5)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Severity
from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.constraint_table import constraints_of, limits_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "look_like_radians"]

Array = NDArray[Any]


_FREE = (1.0, 0.0)
"""How Bullet and others write an axis without limits."""
_ANGLES = math.pi * np.array(
    [2.0, 1.5, 1.0, 5 / 6, 0.75, 2 / 3, 0.5, 1 / 3, 0.25, 1 / 6, 0.125, 1 / 12]
)


def look_like_radians(angles: Array) -> Array:
    """Where angles (n, m) are known parts of a circle in radians (n,).

    All of them but for those that are zero, or infinite; and there is one.
    """
    told = (angles != 0.0) & np.isfinite(angles)
    sizes = np.abs(angles)[:, :, None]
    known = (np.abs(sizes - _ANGLES) < 2e-4 * _ANGLES).any(axis=2)
    return np.asarray(told.any(axis=1) & (known | ~told).all(axis=1))


def limits(context: Context) -> Iterator[Hit]:
    """Limits that leave nothing, or that look like radians."""
    rows = context.rows(Rows, "limits")
    if not len(rows):
        return
    for name in ("linear", "swing_cone_and_twist"):
        groups = context.children(rows, name, Rows)
        low, low_elements = context.vectors(groups, "min", 3, 0.0)
        high, high_elements = context.vectors(groups, "max", 3, 0.0)
        there = (low_elements >= 0) & (high_elements >= 0)
        free = (low == _FREE[0]) & (high == _FREE[1])
        free |= np.isinf(low) & np.isinf(high)
        free |= ((low == 1.0) & (high == -1.0)).all(axis=1)[:, None]  # so do others, of all axes
        wrong = there & (~(low <= high) & ~free).any(axis=1)
        what = "linear" if name == "linear" else "angular"
        for row in np.flatnonzero(wrong).tolist():
            axis = int(np.flatnonzero(~(low[row] <= high[row]) & ~free[row])[0])
            message = (
                f"The {what} limits along {'xyz'[axis]} are from {low[row, axis]:g} to "
                f"{high[row, axis]:g}."
            )
            at, other = int(low_elements[row]), int(high_elements[row])
            if np.isnan(high[row, axis]) and not np.isnan(low[row, axis]):
                at, other = other, at
            yield Hit(
                physics_rules.JOINT_LIMITS,
                at,
                message,
                (other,),
            )
        if what == "angular":
            angles = np.where(np.tile(free, 2), 0.0, np.column_stack([low, high]))
            for row in np.flatnonzero(there & ~wrong & look_like_radians(angles)).tolist():
                shown = " ".join(f"{value:g}" for value in high[row].tolist())
                message = f"The angular limits are up to {shown} degrees."
                yield Hit(physics_rules.JOINT_RADIANS, int(low_elements[row]), message)


def springs(context: Context) -> Iterator[Hit]:
    """Springs that push away."""
    rows = context.rows(Rows, "spring")
    if not len(rows):
        return
    for name in ("linear", "angular"):
        groups = context.children(rows, name, Rows)
        pulls = np.ones(len(groups), np.bool_)
        for part, default in (("stiffness", 1.0), ("damping", 0.0), ("target_value", 0.0)):
            values, elements = context.scalars(groups, part, default)
            good = np.isfinite(values)
            if part == "target_value":
                good |= np.isinf(values) & ~pulls
            else:
                good &= values >= 0.0
            if part == "stiffness":
                pulls = values != 0.0
            for row in np.flatnonzero((elements >= 0) & ~good).tolist():
                message = f"The {part.replace('_', ' ')} of the {name} spring is {values[row]:g}."
                nothing = math.isnan(float(values[row]))
                yield Hit(physics_rules.JOINT_SPRING, int(elements[row]), message,
                          severity=Severity.ERROR if nothing else None)  # fmt: skip


def targets(context: Context) -> Iterator[Hit]:
    """Springs that pull to where no axis of the joint can be."""
    rows = context.rows(Rows, "rigid_constraint")
    common = context.children(rows, "technique_common", Rows)
    springs = context.children(common, "spring", Rows)
    if not len(springs):
        return
    for name, other in (("linear", "linear"), ("angular", "swing_cone_and_twist")):
        groups = context.children(springs, name, Rows)
        values, elements = context.scalars(groups, "target_value", 0.0)
        owners = common.owner[springs.owner[groups.owner]]
        low, high = (column[owners] for column in limits_of(context, other))
        free = (low < high) | ~(low <= high)
        outside = (low <= high) & ((values[:, None] < low) | (values[:, None] > high))
        wrong = (elements >= 0) & np.isfinite(values) & free.any(axis=1)
        wrong &= (outside | ~free).all(axis=1)
        wrong &= ~look_like_radians(np.column_stack([low, high]))
        for row in np.flatnonzero(wrong).tolist():
            shown = ", ".join(
                f"{low[row, axis]:g} to {high[row, axis]:g}" for axis in np.flatnonzero(free[row])
            )
            message = f"The {name} spring pulls to {values[row]:g}, but the limits are {shown}."
            yield Hit(physics_rules.JOINT_TARGET, int(elements[row]), message)


def ends(context: Context) -> Iterator[Hit]:
    """Joints of bodies with themselves, or between such as cannot move."""
    table, bodies = constraints_of(context), bodies_of(context)
    there = table.bodies >= 0
    alone = there[:, 0] & (table.bodies[:, 0] == table.bodies[:, 1])
    for row in np.flatnonzero(alone).tolist():
        body = int(bodies.elements[table.bodies[row, 0]])
        yield Hit(physics_rules.JOINT_SELF, int(table.attachments[row, 1]),
                  f"Both attachments are to {context.label(body)}.",
                  (int(table.attachments[row, 0]),), "rigid_body")  # fmt: skip
    moving = np.append(bodies.moves, False)[table.bodies]
    fixed = ~alone & (table.are_world | there).all(axis=1) & ~moving.any(axis=1)
    for row in np.flatnonzero(fixed).tolist():
        message = "Neither end of the joint is a body that moves."
        if table.are_world[row].all():
            message = "Both attachments are to the world."
        yield Hit(physics_rules.JOINT_FIXED, int(table.elements[row]), message)


CHECKS = (limits, springs, targets, ends)

"""How instances of bodies move (COLLADA 1.5 §instance_rigid_body)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import physics_rules, scene_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.radians import written_as_radians
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


def velocities(context: Context) -> Iterator[Hit]:
    """Velocities that are none, or of bodies that cannot move."""
    instances = context.rows(Rows, "instance_rigid_body")
    rows = context.children(instances, "technique_common", Rows)
    if not len(rows):
        return
    bodies = bodies_of(context)
    assert instances.ordinals is not None
    mine = np.searchsorted(bodies.elements, instances.ordinals[rows.owner])
    fixed = ~bodies.moves[mine]
    told = np.zeros(len(rows), np.bool_)
    for name in ("velocity", "angular_velocity"):
        values, elements = context.vectors(rows, name, 3, 0.0)
        there = elements >= 0
        wrong = there & ~np.isfinite(values).all(axis=1)
        for row in np.flatnonzero(wrong).tolist():
            shown = " ".join(f"{value:g}" for value in values[row].tolist())
            yield Hit(
                physics_rules.VELOCITY_NUMBER,
                int(elements[row]),
                f"The {name.replace('_', ' ')} is {shown}.",
            )
        moves = there & ~wrong & np.nan_to_num(values).any(axis=1) & fixed & ~told
        told |= moves
        for row in np.flatnonzero(moves).tolist():
            name_of = context.label(int(bodies.elements[mine[row]]))
            shown = " ".join(f"{value:g}" for value in values[row].tolist())
            message = f"{name_of} is not dynamic, but has the {name.replace('_', ' ')} {shown}."
            yield Hit(physics_rules.VELOCITY_FIXED, int(elements[row]), message)


def radians(context: Context) -> Iterator[Hit]:
    """Angular velocities that are known parts of a circle in radians, about one axis."""
    rows = context.rows(Rows, "instance_rigid_body")
    common = context.children(rows, "technique_common", Rows)
    values, elements = context.vectors(common, "angular_velocity", 3, 0.0)
    speeds = np.nan_to_num(values).sum(axis=1)
    alone = (values != 0.0).sum(axis=1) == 1
    for row in np.flatnonzero((elements >= 0) & alone & written_as_radians(speeds)).tolist():
        turned = math.degrees(speeds[row])
        message = (
            f"The angular velocity is {speeds[row]:g} degrees per second; as radians, it would be "
            f"{turned:.4g}."
        )
        yield Hit(scene_rules.RADIANS, int(elements[row]), message)


CHECKS = (velocities, radians)

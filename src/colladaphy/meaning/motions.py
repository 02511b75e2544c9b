"""How instances of bodies move (COLLADA 1.5 §instance_rigid_body)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
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
        values, elements = context.vectors(rows, name, 3)
        there = elements >= 0
        # Without text it is the default, zero.
        wrong = there & ~np.isfinite(values).all(axis=1)
        wrong &= ~_is_empty(context, rows, name)
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


def _is_empty(context: Context, rows: Rows, name: str) -> Array:
    found = context.children(rows, name, Rows)
    assert found.ordinals is not None
    empty = np.zeros(len(rows), np.bool_)
    lists, at = context.numbers(name, found.ordinals)
    empty[found.owner] = lists.offsets[at] == lists.offsets[at + 1]
    return empty


CHECKS = (velocities,)

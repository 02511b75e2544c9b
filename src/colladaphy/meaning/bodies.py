"""Rigid bodies: masses and inertias (COLLADA 1.5 §rigid_body, §inertia; thesis 3.3, 4.4)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import Bodies, bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.moments import faults_of_inertias, shown
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = [
    "CHECKS",
]

Array = NDArray[Any]


_LARGE, _SMALL = 1e3, 1e-5


def masses(context: Context) -> Iterator[Hit]:
    """Masses of bodies that are none."""
    bodies = bodies_of(context)
    there = bodies.mass_elements >= 0
    wrong = there & ~((bodies.masses >= 0.0) & (bodies.masses < np.inf))
    again = _repeated(bodies, bodies.masses[:, None], bodies.mass_elements)
    wrong &= ~again
    for row in np.flatnonzero(wrong).tolist():
        message = (
            f"The mass of {context.label(int(bodies.elements[row]))} is {bodies.masses[row]:g}."
        )
        yield Hit(physics_rules.MASS_VALUE, int(bodies.mass_elements[row]), message)
    zero = there & (bodies.masses == 0.0) & bodies.moves & ~again
    if zero.any():  # that a plane moves is told
        shapes = shapes_of(context)
        zero[shapes.holders[context.children(shapes.rows, "plane", Rows).owner]] = False
    # An instance may give the mass that the body has not.
    for row in np.flatnonzero(zero).tolist():
        mine = bodies.instances(row)
        if len(mine) and bool(np.all((bodies.masses[mine] > 0.0) | wrong[mine])):
            continue
        message = f"{context.label(int(bodies.elements[row]))} moves, but its mass is 0."
        yield Hit(physics_rules.MASS_ZERO, int(bodies.mass_elements[row]), message)


def inertias(context: Context) -> Iterator[Hit]:
    """Inertias that no body can have."""
    bodies = bodies_of(context)
    told = dict(_faulty_inertias(context))
    if not told:
        return
    again = _repeated(bodies, bodies.inertias, bodies.inertia_elements)
    for row, hit in told.items():
        if not (again[row] and int(bodies.body[row]) in told):
            yield hit


def _faulty_inertias(context: Context) -> Iterator[tuple[int, Hit]]:
    """What is wrong with inertias, by the rows of the bodies and instances that state them."""
    bodies = bodies_of(context)
    rows = np.flatnonzero(bodies.inertia_elements >= 0)
    if not len(rows):
        return
    faults = faults_of_inertias(bodies.inertias[rows], bodies.moves[rows])
    for place, (rule, message) in sorted(faults.items()):
        row = int(rows[place])
        yield row, Hit(rule, int(bodies.inertia_elements[row]), message)
    values = np.sort(bodies.inertias[rows], axis=1)
    moves = bodies.moves[rows].copy()
    moves[list(faults)] = False
    left = np.flatnonzero(moves)
    if not len(left):
        return
    shapes = shapes_of(context)
    most, least = shapes.inertia_bounds(rows[left])
    largest = values[left, 2]
    unknown = ~((most > 0.0) & (most < np.inf) & (least > 0.0))  # not known, or wrong themselves
    most[unknown], least[unknown] = np.inf, 0.0
    for place in np.flatnonzero(largest > _LARGE * most).tolist():
        row = int(rows[left[place]])
        message = (
            f"The inertia is {shown(bodies.inertias[row])}, but mass and shapes allow "
            f"{most[place]:.3g} at most."
        )
        yield row, Hit(physics_rules.INERTIA_SIZE, int(bodies.inertia_elements[row]), message)
    for place in np.flatnonzero(largest < _SMALL * least).tolist():
        row = int(rows[left[place]])
        message = (
            f"The inertia is {shown(bodies.inertias[row])}; of such a mass and size one expects "
            f"about {least[place]:.3g}."
        )
        yield row, Hit(physics_rules.INERTIA_SIZE, int(bodies.inertia_elements[row]), message)


def _repeated(bodies: Bodies, values: Array, elements: Array) -> Array:
    """Which instances (n,) state the values (n, m) of their bodies, of which it is told there."""
    there = bodies.is_instance & (elements >= 0) & (bodies.body >= 0)
    there &= elements[bodies.body] >= 0
    rows = np.flatnonzero(there)
    one, other = values[rows], values[bodies.body[rows]]
    there[rows] = ((one == other) | (np.isnan(one) & np.isnan(other))).all(axis=1)
    return np.asarray(there)


CHECKS = (masses, inertias)

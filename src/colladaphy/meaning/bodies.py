"""Rigid bodies: masses and inertias (COLLADA 1.5 §rigid_body, §inertia; thesis 3.3, 4.4)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import bodies_of
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
    for row in np.flatnonzero(wrong).tolist():
        message = (
            f"The mass of {context.label(int(bodies.elements[row]))} is {bodies.masses[row]:g}."
        )
        yield Hit(physics_rules.MASS_VALUE, int(bodies.mass_elements[row]), message)
    zero = there & (bodies.masses == 0.0) & bodies.moves
    if zero.any():  # that a plane moves is told
        shapes = shapes_of(context)
        zero[shapes.holders[context.children(shapes.rows, "plane", Rows).owner]] = False
    # An instance may give the mass that the body has not.
    for row in np.flatnonzero(zero).tolist():
        mine = bodies.instances(row)
        if len(mine) and bool(np.all(bodies.masses[mine] > 0.0)):
            continue
        message = f"{context.label(int(bodies.elements[row]))} moves, but its mass is 0."
        yield Hit(physics_rules.MASS_ZERO, int(bodies.mass_elements[row]), message)


def inertias(context: Context) -> Iterator[Hit]:
    """Inertias that no body can have."""
    bodies = bodies_of(context)
    rows = np.flatnonzero(bodies.inertia_elements >= 0)
    if not len(rows):
        return
    faults = faults_of_inertias(bodies.inertias[rows], bodies.moves[rows])
    for place, (rule, message) in sorted(faults.items()):
        yield Hit(rule, int(bodies.inertia_elements[rows[place]]), message)
    values = np.sort(bodies.inertias[rows], axis=1)
    moves = bodies.moves[rows].copy()
    moves[list(faults)] = False
    left = np.flatnonzero(moves)
    if not len(left):
        return
    shapes = shapes_of(context)
    most, least = shapes.inertia_bounds(rows[left])
    largest = values[left, 2]
    told = ~((most > 0.0) & (most < np.inf) & (least > 0.0))  # not known, or wrong themselves
    most[told], least[told] = np.inf, 0.0
    for place in np.flatnonzero(largest > _LARGE * most).tolist():
        yield Hit(physics_rules.INERTIA_SIZE, int(bodies.inertia_elements[rows[left[place]]]),
                  f"The inertia is {shown(bodies.inertias[rows[left[place]]])}, but mass and "
                  f"shapes allow {most[place]:.3g} at most.")  # fmt: skip
    for place in np.flatnonzero(largest < _SMALL * least).tolist():
        row = rows[left[place]]
        message = (
            f"The inertia is {shown(bodies.inertias[row])}; of such a mass and size one expects "
            f"about {least[place]:.3g}."
        )
        yield Hit(physics_rules.INERTIA_SIZE, int(bodies.inertia_elements[row]), message)


CHECKS = (masses, inertias)

"""Masses and inertias that no body can have: they are taken as they are, and told.

A World holds what its user gives it; what an engine makes of such values is the engine's.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Severity
from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.profile import Parts
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.loading.tensors import symmetric_parts
from colladaphy.mapper.loading.values import BodyValues
from colladaphy.meaning import physics_rules
from colladaphy.meaning.moments import are_impossible, faults_of_inertias

__all__ = ["note_impossible"]

Array = NDArray[Any]


def note_impossible(
    tables: Tables,
    found: FoundBodies,
    values: BodyValues,
    instances: BodyValues,
    profile: Parts,
    kept: Array,
) -> None:
    """Note what `validate` calls wrong in the masses and inertias of the bodies found.

    `values` are those that count, `instances` those of the instances alone. Each element is told
    once, as a warning: the World is loaded with what the file says. Nothing is told of what a
    World had when it was stored: of masses of bodies with a profile (`kept`, their rows in it, -1
    for none), and of inertias that are impossible in the profile, too.
    """
    moves = ~(values.has_dynamic & ~values.dynamic)
    told: set[tuple[int, int]] = set()

    def note(body: int, stated: Array, rule: Any, message: str) -> None:
        if stated[body]:
            home, element = found.homes[body], tables.body_instances.ordinals[found.rows[body]]
        else:
            home, element = found.body_homes[body], tables.bodies.ordinals[found.bodies[body]]
        element = int(element)
        if (int(home), element) in told:
            return
        told.add((int(home), element))
        resource = tables.pool.resources[int(home)]
        tables.resource.note(rule, element, message, home=resource, severity=Severity.WARNING)

    rows = np.flatnonzero(values.has_inertia)
    rows = rows[are_impossible(values.inertia[rows], moves[rows])]
    rows = rows[~_is_impossible(profile, kept[rows], moves[rows])]
    for place, (rule, message) in sorted(
        faults_of_inertias(values.inertia[rows], moves[rows]).items()
    ):
        note(int(rows[place]), instances.has_inertia, rule, message)
    zero = values.has_mass & (values.mass == 0.0) & moves & (kept < 0)
    for body in np.flatnonzero(zero).tolist():
        name = tables.bodies.texts("sid")[int(found.bodies[body])] or "?"
        message = f"The body {name!r} moves, but its mass is 0."
        note(body, instances.has_mass, physics_rules.MASS_ZERO, message)


def _is_impossible(profile: Parts, kept: Array, moves: Array) -> Array:
    """Which rows of the profile (n,), -1 for none, have an inertia that no body can have (n,)."""
    found = np.zeros(len(kept), np.bool_)
    rows = np.flatnonzero(kept >= 0)
    rows = rows[profile.has_inertia[kept[rows]]]
    tensors = symmetric_parts(profile.inertia[kept[rows]]).reshape(-1, 3, 3)
    finite = np.isfinite(tensors).all(axis=(1, 2))
    found[rows[~finite]] = True
    rows = rows[finite]
    found[rows] = are_impossible(np.linalg.eigvalsh(tensors[finite]), moves[rows])
    return found

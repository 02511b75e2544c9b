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
from colladaphy.meaning.moments import faults_of_inertias

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
    if len(rows):
        faults = faults_of_inertias(values.inertia[rows], moves[rows])
        for place, (rule, message) in sorted(faults.items()):
            body = int(rows[place])
            own = int(kept[body])
            if own < 0 or not (profile.has_inertia[own]
                               and _is_impossible(profile.inertia[own], moves[body])):  # fmt: skip
                note(body, instances.has_inertia, rule, message)
    zero = values.has_mass & (values.mass == 0.0) & moves & (kept < 0)
    for body in np.flatnonzero(zero).tolist():
        name = tables.bodies.texts("sid")[int(found.bodies[body])] or "?"
        message = f"The body {name!r} moves, but its mass is 0."
        note(body, instances.has_mass, physics_rules.MASS_ZERO, message)


def _is_impossible(tensor: Array, moves: bool) -> bool:
    """Whether a tensor (9,) is no inertia of a body."""
    whole = symmetric_parts(tensor[None]).reshape(3, 3)
    if not np.isfinite(whole).all():
        return True
    moments = np.linalg.eigvalsh(whole)
    return bool(faults_of_inertias(moments[None], np.array([moves])))

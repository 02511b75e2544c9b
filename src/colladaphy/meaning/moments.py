"""Principal moments of inertia that no body can have (COLLADA 1.5 §inertia)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Rule
from colladaphy.meaning import physics_rules

__all__ = ["are_impossible", "faults_of_inertias", "shown"]

Array = NDArray[Any]

_ROUNDING = 1e-3


def are_impossible(values: Array, moves: Array) -> Array:
    """Which inertias (n, 3) no body can have (n,); some of the bodies move (n,)."""
    good, zero, broken = _judged(values, moves)
    return ~good | zero | broken


def faults_of_inertias(values: Array, moves: Array) -> dict[int, tuple[Rule, str]]:
    """What is wrong with inertias (n, 3) of bodies of which some move (n,), by row."""
    found: dict[int, tuple[Rule, str]] = {}
    good, zero, broken = _judged(values, moves)
    for row in np.flatnonzero(~good | zero | broken).tolist():
        text = shown(values[row])
        if zero[row] and not broken[row]:
            message = f"The inertia of a body that moves is {text}."
            found[row] = physics_rules.INERTIA_ZERO, message
        else:
            rule = physics_rules.INERTIA_TRIANGLE if good[row] else physics_rules.INERTIA_VALUE
            found[row] = rule, f"The inertia is {text}."
    return found


def _judged(values: Array, moves: Array) -> tuple[Array, Array, Array]:
    """Which are numbers of an inertia (n,), are zero, and break the triangle inequality."""
    good = np.all((values >= 0.0) & (values < np.inf), axis=1)
    ordered = np.sort(np.where(good[:, None], values, 1.0), axis=1)
    zero = moves & (ordered[:, 0] == 0.0)
    none = moves & (ordered[:, 2] == 0.0)
    broken = ~none & (ordered[:, 0] + ordered[:, 1] < ordered[:, 2] * (1.0 - _ROUNDING))
    return good, zero, broken


def shown(values: Array) -> str:
    """Numbers for a message."""
    return " ".join(f"{value:g}" for value in values.tolist())

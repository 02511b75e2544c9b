"""Principal moments of inertia that no body can have (COLLADA 1.5 §inertia)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Rule
from colladaphy.meaning import physics_rules

__all__ = ["faults_of_inertias", "shown"]

Array = NDArray[Any]

_ROUNDING = 1e-3


def faults_of_inertias(values: Array, moves: Array) -> dict[int, tuple[Rule, str]]:
    """What is wrong with inertias (n, 3) of bodies of which some move (n,), by row."""
    found: dict[int, tuple[Rule, str]] = {}
    good = np.all((values >= 0.0) & (values < np.inf), axis=1)
    for row in np.flatnonzero(~good).tolist():
        found[row] = physics_rules.INERTIA_VALUE, f"The inertia is {shown(values[row])}."
    rows = np.flatnonzero(good)
    ordered = np.sort(values[rows], axis=1)
    zero = moves[rows] & (ordered[:, 0] == 0.0)
    none = moves[rows] & (ordered[:, 2] == 0.0)
    broken = ~none & (ordered[:, 0] + ordered[:, 1] < ordered[:, 2] * (1.0 - _ROUNDING))
    for place in np.flatnonzero(zero | broken).tolist():
        text = shown(values[rows[place]])
        if broken[place]:
            found[int(rows[place])] = physics_rules.INERTIA_TRIANGLE, f"The inertia is {text}."
        else:
            message = f"The inertia of a body that moves is {text}."
            found[int(rows[place])] = physics_rules.INERTIA_ZERO, message
    return found


def shown(values: Array) -> str:
    """Numbers for a message."""
    return " ".join(f"{value:g}" for value in values.tolist())

"""Physics materials: restitution and friction (COLLADA 1.5 §physics_material; thesis 4.4)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from colladaphy.meaning import physics_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]


def materials(context: Context) -> Iterator[Hit]:
    """Values of materials that are none, or out of range."""
    rows = context.children(context.rows(Rows, "physics_material"), "technique_common", Rows)
    if not len(rows):
        return
    values, elements = {}, {}
    for name in ("restitution", "static_friction", "dynamic_friction"):
        values[name], elements[name] = context.scalars(rows, name)
        there = elements[name] >= 0
        mine = values[name]
        most = 1.0 if name == "restitution" else np.inf
        nothing = there & np.isnan(mine)
        wrong = there & ~nothing & ~((mine >= 0.0) & (mine <= most) & np.isfinite(mine))
        spelled = name.replace("_", " ")
        for row in np.flatnonzero(nothing).tolist():
            yield Hit(
                physics_rules.MATERIAL_NUMBER, int(elements[name][row]), f"The {spelled} is NaN."
            )
        for row in np.flatnonzero(wrong).tolist():
            message = f"The {spelled} is {mine[row]:g}."
            if mine[row] == np.inf and most == np.inf:
                message = f"The {spelled} is INF, of which loading takes none."
            yield Hit(physics_rules.MATERIAL_RANGE, int(elements[name][row]), message)
    still, sliding = values["static_friction"], values["dynamic_friction"]
    for row in np.flatnonzero((sliding > still) & (still >= 0.0)).tolist():
        message = f"The dynamic friction is {sliding[row]:g}, the static one {still[row]:g}."
        yield Hit(physics_rules.MATERIAL_FRICTIONS, int(elements["dynamic_friction"][row]), message,
                  (int(elements["static_friction"][row]),))  # fmt: skip


CHECKS = (materials,)

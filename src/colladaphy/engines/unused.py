"""What of a World no engine here uses, said once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from colladaphy.engines.rules import (
    AWAKE,
    FRICTIONS,
    MATERIAL_UNUSED,
    STILL_VELOCITY,
    UNION_DIFFERS,
)
from colladaphy.engines.surfaces import differing, used_materials
from colladaphy.world.pairing import PairTable

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import World

__all__ = ["unused"]

_MOST = 5
_SILENT = {
    "young_modulus": "Young's modulus",
    "poisson_ratio": "Poisson's ratio",
    "stiffness": "the stiffness (but for the restitution of pairs)",
    "damping_normal": "the normal damping",
    "damping_tangential": "the tangential damping",
}


def unused(world: World, rule: str, *, sleep: bool) -> Iterator[Finding]:
    """Velocities of what is fixed, sleep where it is off, masses of members, and of materials.

    `rule` combines the frictions of two materials.
    """
    asleep = int(np.count_nonzero(world.sleeping & ~world.fixed))
    if asleep and not sleep:
        yield AWAKE.at(message=f"{asleep} bodies that sleep are woken.")
    moves = np.any(world.linear_velocities != 0, axis=1) | np.any(
        world.angular_velocities != 0, axis=1
    )
    still = np.flatnonzero(world.fixed & moves).tolist()
    if still:
        names = ", ".join(repr(world.bodies[row]) for row in still[:_MOST])
        more = f" and {len(still) - _MOST} more bodies" if len(still) > _MOST else ""
        yield STILL_VELOCITY.at(message=f"The engine takes no velocity of what is fixed: {names}"
                                f"{more}.")  # fmt: skip
    if unions := world.differing_unions():
        more = f" and {len(unions) - _MOST} more" if len(unions) > _MOST else ""
        names = ", ".join(map(repr, unions[:_MOST]))
        yield UNION_DIFFERS.at(message=f"Not the sum of their members: {names}{more}.")
    used, meets = used_materials(world)
    if not meets.any():
        return
    materials = [world.materials[id] for id in used.tolist()]
    named = [text for name, text in _SILENT.items() if any(getattr(m, name) for m in materials)]
    if named:
        message = f"Of the materials the engine does not use {', '.join(named)}."
        yield MATERIAL_UNUSED.at(message=message)
    pairs = differing(PairTable.of(world.materials, used.tolist(), rule), world, meets)
    if pairs:
        message = f"Static friction is dropped, dynamic friction taken: {pairs}."
        yield FRICTIONS.at(message=message)

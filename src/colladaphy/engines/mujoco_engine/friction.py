"""Friction between materials: one coefficient a geom where that will do, explicit pairs elsewhere.

MuJoCo takes the larger coefficient of two geoms. pe gives every pair of materials its own, so
pairs for which the larger one is wrong are listed one by one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

from colladaphy.engines.rules import FRICTION_SHARED, FRICTIONS, RESTITUTION

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import World

__all__ = ["Geom", "Surfaces", "surface_findings", "surfaces"]

_MOST_PAIRS = 200_000


@dataclass(frozen=True, slots=True)
class Geom:
    """What matters of a geom to its contacts."""

    name: str
    body: int
    """System id of its top-level body."""
    group: int
    """Geoms of one group cannot move against each other."""
    material: int


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Friction of each material, and the materials (first ≤ second) that need explicit pairs."""

    own: dict[int, float]
    special: dict[tuple[int, int], float]

    def pairs(self, geoms: list[Geom], apart: set[tuple[int, int]]) -> Iterator[tuple[Geom, Geom]]:
        """The pairs of geoms to be listed; `apart` are pairs of bodies that never collide."""
        by_material: dict[int, list[Geom]] = {}
        for geom in geoms:
            by_material.setdefault(geom.material, []).append(geom)
        for one, two in self.special:
            for a in by_material.get(one, ()):
                for b in by_material.get(two, ()):
                    bodies = (min(a.body, b.body), max(a.body, b.body))
                    if a.group != b.group and bodies not in apart:
                        yield a, b


def surfaces(world: World, counts: dict[int, tuple[int, int]]) -> tuple[Surfaces, list[Finding]]:
    """The plan for materials of which `counts` are (moving, fixed) shapes, by id."""
    used = sorted(counts)
    own = {id: world.pair(id, id).dynamic_friction for id in used}
    special: dict[tuple[int, int], float] = {}
    total = 0
    for one, two in combinations_with_replacement(used, 2):
        (moving1, fixed1), (moving2, fixed2) = counts[one], counts[two]
        friction = world.pair(one, two).dynamic_friction
        if friction != max(own[one], own[two]) and (moving1 or moving2):
            special[one, two] = friction
            total += moving1 * (moving2 + fixed2) + fixed1 * moving2
    if total > _MOST_PAIRS:
        message = f"{total} pairs of shapes have a friction of their own, more than {_MOST_PAIRS}."
        return Surfaces(own, {}), [FRICTION_SHARED.at(message=message)]
    return Surfaces(own, special), []


def surface_findings(world: World, counts: dict[int, tuple[int, int]]) -> list[Finding]:
    """What of the materials is dropped: restitution, and a static friction of its own."""
    bouncing: list[str] = []
    sticking: list[str] = []
    for one, two in combinations_with_replacement(sorted(counts), 2):
        (moving1, fixed1), (moving2, fixed2) = counts[one], counts[two]
        if one == two:
            meets = moving1 > 1 or (moving1 > 0 and fixed1 > 0)
        else:
            meets = bool(moving1 and (moving2 or fixed2)) or bool(fixed1 and moving2)
        if not meets:
            continue
        pair = world.pair(one, two)
        names = f"{world.materials[one].name} on {world.materials[two].name}"
        if pair.restitution:
            bouncing.append(f"{names} ({pair.restitution:g})")
        if pair.static_friction != pair.dynamic_friction:
            sticking.append(f"{names} ({pair.static_friction:g}, {pair.dynamic_friction:g})")
    findings = surfaces(world, counts)[1]
    if bouncing:
        message = f"Restitution is dropped: {_listed(bouncing)}."
        findings.append(RESTITUTION.at(message=message))
    if sticking:
        message = f"Static friction is dropped, dynamic friction taken: {_listed(sticking)}."
        findings.append(FRICTIONS.at(message=message))
    return findings


def _listed(names: list[str], most: int = 5) -> str:
    more = f" and {len(names) - most} more pairs" if len(names) > most else ""
    return ", ".join(names[:most]) + more

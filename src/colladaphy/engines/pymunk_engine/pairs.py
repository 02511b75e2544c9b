"""Restitution and friction where two materials meet.

pymunk multiplies a value of each shape; pe looks a pair up. Where all pairs of a scene have the
same values, their square roots do; otherwise every contact is looked up before it is solved.
"""

from __future__ import annotations

import math
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any

import pymunk

from colladaphy.engines.planar import Planarity

if TYPE_CHECKING:
    from colladaphy.world import Material, World
    from colladaphy.world.materials import MaterialPair

__all__ = ["Pairs", "materials_of"]

_FEW = 12  # materials whose pairs are worth comparing


def materials_of(world: World, plan: Planarity) -> list[Material]:
    """The materials of the shapes of a scene, by ascending ids."""
    ids = {outline.material for outlines in plan.outlines.values() for outline in outlines}
    return [world.materials[id] for id in sorted(ids)]


class Pairs:
    """What holds between the materials of a scene; keeps a copy, not the World."""

    def __init__(self, world: World, plan: Planarity) -> None:
        self._materials = world.materials.copy()
        self._known: dict[tuple[int, int], tuple[float, float]] = {}
        used = materials_of(world, plan)
        self._uniform: tuple[float, float] | None = None
        if len(used) <= _FEW:
            values = {
                self._values(first.id, second.id)
                for first, second in combinations_with_replacement(used, 2)
            }
            if len(values) == 1:
                restitution, friction = values.pop()
                self._uniform = math.sqrt(restitution), math.sqrt(friction)

    def _values(self, first: int, second: int) -> tuple[float, float]:
        key = (first, second)
        found = self._known.get(key)
        if found is None:
            pair: MaterialPair = self._materials.pair(
                self._materials[first], self._materials[second]
            )
            found = self._known[key] = (pair.restitution, pair.dynamic_friction)
        return found

    def dress(self, shape: pymunk.Shape, material: int) -> None:
        """Give a shape its material."""
        shape.collision_type = material
        if self._uniform is not None:
            shape.elasticity, shape.friction = self._uniform

    def attach(self, space: pymunk.Space) -> None:
        """Have the contacts of a space looked up, if need be."""
        if self._uniform is None:
            space.on_collision(pre_solve=self._pre_solve)

    def _pre_solve(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        one, two = arbiter.shapes
        arbiter.restitution, arbiter.friction = self._values(one.collision_type, two.collision_type)

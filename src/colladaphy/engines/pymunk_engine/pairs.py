"""Restitution and friction where two materials meet.

pymunk multiplies a value of each shape; pe looks a pair up. Where all pairs of a scene have the
same values, their square roots do; otherwise every contact is looked up before it is solved.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pymunk

from colladaphy.engines.planar import Planarity
from colladaphy.world.pairing import PairTable

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Pairs"]


class Pairs:
    """What holds between the materials of a scene; keeps a copy, not the World."""

    def __init__(self, world: World, plan: Planarity, rule: str) -> None:
        ids = {outline.material for outlines in plan.outlines.values() for outline in outlines}
        self._table = PairTable.of(world.materials, ids, rule)
        self._rows = {id: row for row, id in enumerate(self._table.ids.tolist())}
        self._uniform: tuple[float, float] | None = None
        bounce, friction = self._table.restitution.ravel(), self._table.dynamic.ravel()
        if len(bounce) and np.all(bounce == bounce[0]) and np.all(friction == friction[0]):
            self._uniform = math.sqrt(bounce[0]), math.sqrt(friction[0])

    def dress(self, shape: pymunk.Shape, material: int) -> None:
        """Give a shape its material."""
        shape.collision_type = self._rows[material]
        if self._uniform is not None:
            shape.elasticity, shape.friction = self._uniform

    def attach(self, space: pymunk.Space) -> None:
        """Have the contacts of a space looked up, if need be."""
        if self._uniform is None:
            space.on_collision(pre_solve=self._pre_solve)

    def _pre_solve(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        one, two = (shape.collision_type for shape in arbiter.shapes)
        arbiter.restitution = float(self._table.restitution[one, two])
        arbiter.friction = float(self._table.dynamic[one, two])

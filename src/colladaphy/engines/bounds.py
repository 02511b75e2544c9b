"""When a run has diverged: numbers that are not finite, or beyond all measure of the scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.rules import DIVERGED, refuse

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Bounds"]

Floats = NDArray[np.float64]

_MEASURE: Final = 1e6
"""How many times the size of the scene a body may move in one step."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """How far a body can sensibly move within one step."""

    way: float
    time_step: float

    @classmethod
    def of(cls, world: World, time_step: float) -> Bounds:
        """From the size of a World, and from the speeds, forces and gravity that it has."""
        moving = ~world.fixed
        masses = np.where(world.masses > 0, world.masses, np.inf)[moving]
        places = world.positions[moving]
        extent = places - places[:1]
        push = np.linalg.norm(world.forces[moving], axis=1) / masses
        way = max(
            float(np.abs(extent).max(initial=0.0)),
            float(np.abs(world.dimensions[moving]).max(initial=0.0)),
            float(np.abs(world.member_columns.dimensions).max(initial=0.0)),
            float(np.abs(world.linear_velocities[moving]).max(initial=0.0)) * time_step,
            float(np.abs(world.gravity).max()) * time_step**2,
            float(push.max(initial=0.0)) * time_step**2,
        )
        return cls(_MEASURE * way, time_step)

    def widened(self, world: World) -> Bounds:
        """These, or those of `world` as it is now, whichever are wider."""
        return Bounds(max(self.way, Bounds.of(world, self.time_step).way), self.time_step)

    def check(self, linear: Floats, *others: Floats, step: int) -> None:
        """EngineError unless all is finite and no linear velocity (n, 3) is beyond measure."""
        finite = all(bool(np.all(np.isfinite(values))) for values in (linear, *others))
        fastest = float(np.abs(linear).max(initial=0.0)) if finite else np.inf
        if fastest * self.time_step <= self.way:
            return
        what = "" if not finite else f": a body moves at {fastest:g}"
        raise refuse(DIVERGED, f"The simulation has diverged by step {step}{what}.")

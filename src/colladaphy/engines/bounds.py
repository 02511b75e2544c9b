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
        places = world.positions[moving]
        way = max(
            float(np.abs(places - places[:1]).max(initial=0.0)),
            float(np.abs(world.dimensions[moving]).max(initial=0.0)),
            float(np.abs(world.member_columns.dimensions).max(initial=0.0)),
            float(np.abs(world.gravity).max()) * time_step * time_step,
        )
        return cls(_MEASURE * way, time_step).widened(world)

    def widened(self, world: World) -> Bounds:
        """These, or wider ones if speeds or forces of `world` need them."""
        step = self.time_step
        speed = float(np.abs(world.linear_velocities).max(initial=0.0))
        force = float(np.abs(world.forces).max(initial=0.0))
        least = float(world.masses.min(initial=np.inf, where=world.masses > 0))
        if _MEASURE * max(speed * step, force * step * step / least) <= self.way:
            return self  # a quick look, at all bodies together
        moving = ~world.fixed
        speed = float(np.abs(world.linear_velocities[moving]).max(initial=0.0))
        masses = world.masses[moving, None]
        push = world.forces[moving] / np.where(masses > 0, masses, np.inf)
        pushed = float(np.abs(push).max(initial=0.0)) * self.time_step * self.time_step
        way = max(speed * self.time_step, pushed)
        return Bounds(max(self.way, _MEASURE * way), self.time_step)

    def check(self, linear: Floats, *others: Floats, step: int, most: float = np.inf) -> None:
        """EngineError unless no linear velocity (n, 3) is beyond measure, and all finite.

        Where the time step leaves no finite measure, every step goes beyond it.

        `most`: no number is larger, as the engine could not go on from it.
        """
        # The largest of numbers of which one is none is none, and not within any limit.
        largest = [float(np.abs(values).max(initial=0.0)) for values in (linear, *others)]
        finite = all(value <= most and value < np.inf for value in largest)
        fastest = largest[0] if finite else np.inf
        if fastest * self.time_step <= self.way < np.inf:
            return
        what = "" if not finite else f": a body moves at {fastest:g}"
        raise refuse(DIVERGED, f"The simulation has diverged by step {step}{what}.")

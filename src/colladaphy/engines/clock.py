"""The clock of a run: simulated time and number of steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from colladaphy.engines.rules import TIME_STEP, refuse

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Clock"]


@dataclass(slots=True)
class Clock:
    """Time in the World's unit of time, advanced by one addition a step.

    Adding once a step, and never multiplying, makes the clock independent of how a run is cut
    into pieces, to the last bit.
    """

    time: float
    step_count: int
    time_step: float

    @classmethod
    def of(cls, world: World) -> Self:
        """The clock of `world`; EngineError unless its time step is positive and finite."""
        time_step = world.time_step
        if time_step is None or not 0.0 < time_step < float("inf"):
            raise refuse(TIME_STEP, f"The time step is {time_step}.")
        return cls(float(world.time), int(world.step_count), float(time_step))

    def advance(self, count: int) -> None:
        """Let `count` steps pass."""
        for _ in range(count):
            self.time += self.time_step
        self.step_count += count

    def store(self, world: World) -> None:
        """Write time and number of steps into `world`."""
        world.time = self.time
        world.step_count = self.step_count

"""What was changed in a World since the engine and it agreed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.digest import static_parts

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Edits", "changed", "run_of"]

MOTION = (
    "positions",
    "orientations",
    "linear_velocities",
    "angular_velocities",
    "forces",
    "torques",
    "sleeping",
)
"""The columns that may change while an engine runs."""


class Edits:
    """Copies of what a World held when the engine last agreed with it."""

    def __init__(self) -> None:
        self._static: list[Any] = []
        self._motion: list[Any] = []
        self._shape: tuple[Any, ...] = ()

    @property
    def known(self) -> bool:
        """False if the engine has to load the World anyway."""
        return bool(self._motion)

    def forget(self) -> None:
        """The engine has failed, or is about to load."""
        self._static, self._motion, self._shape = [], [], ()

    def remember(self, world: World) -> None:
        """Engine and World agree in everything."""
        self._static = static_parts(world)
        self._shape = _shape(world)
        self.remember_motion(world)

    def accept(self, world: World) -> None:
        """Nothing was replaced between two runs, but ids may have been used up."""
        self._shape = _shape(world)

    def remember_motion(self, world: World) -> None:
        """Engine and World agree in what moves; nobody else had the World since they last did."""
        self._motion = _motion(world)

    def moved(self, world: World) -> bool:
        """True if motion, forces or the clock were changed."""
        return self._motion != _motion(world)

    def reshaped(self, world: World) -> bool:
        """True if the World is plainly another one: a quick look, `replaced` sees everything."""
        return self._shape != _shape(world)

    def replaced(self, world: World) -> bool:
        """True if anything but motion and forces was changed."""
        return self._static != static_parts(world)


def _motion(world: World) -> list[Any]:
    column = world.top.column
    return [world.time, world.step_count, *(column(name).tobytes() for name in MOTION)]


def _shape(world: World) -> tuple[Any, ...]:
    column = world.top.column
    return (
        len(world.top),
        len(world.joint_table),
        world.next_body_sid,
        world.next_joint_sid,
        world.gravity.tobytes(),
        world.time_step,
        *(column(name).tobytes() for name in ("masses", "fixed", "material_ids")),
    )


def changed(one: NDArray[Any], other: NDArray[Any]) -> bool:
    """True unless two columns are the same, bit by bit."""
    return one.shape != other.shape or np.asarray(one).tobytes() != np.asarray(other).tobytes()


def run_of(rows: NDArray[np.int64]) -> Any:
    """Ascending rows (n,), as a slice where they run without gaps, which is quicker."""
    if len(rows) and int(rows[-1]) - int(rows[0]) == len(rows) - 1:
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows

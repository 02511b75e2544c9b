"""How pymunk runs a World."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from colladaphy.engines.options import Options
from colladaphy.engines.rules import SETTINGS
from colladaphy.world.pairing import FRICTION_RULES

if TYPE_CHECKING:
    from colladaphy.findings import Finding

__all__ = ["PymunkOptions"]


@dataclass(frozen=True, slots=True)
class PymunkOptions(Options):
    """How pymunk runs a World.

    `substeps`: parts of a time step, each of them computed as one; the method is of first order.
    `iterations` over all contacts and joints, in each of them: more make them stiffer. `sleep`
    lets bodies that hardly move stop for good, until something touches them. `friction`: how two
    materials' frictions make that of the pair.
    """

    substeps: int = 1
    iterations: int = 20
    sleep: bool = False
    friction: str = "sum"

    CHOICES: ClassVar = {"friction": tuple(FRICTION_RULES)}

    def describe(self) -> Finding:
        """A finding that says what is computed with, and how exact it is."""
        sleep = "may sleep" if self.sleep else "never sleep"
        return SETTINGS.at(
            message=f"Symplectic Euler steps (order 1), {self.substeps} a time step, of "
            f"{self.iterations} iterations; bodies {sleep}."
        )

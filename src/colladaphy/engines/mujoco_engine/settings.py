"""What MuJoCo computes with: what the user asks for, and what is chosen by the scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from colladaphy.engines.options import Options
from colladaphy.engines.rules import SETTINGS
from colladaphy.world.pairing import FRICTION_RULES

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import World

__all__ = ["Chosen", "MujocoOptions", "resolve"]

SMALL: Final = 50
"""Bodies up to which the exact solver and the integrator of fourth order are worth their time."""
_ITERATIONS: Final = {"newton": 100, "cg": 30}
# The part of the way to what is wanted that a contact goes: at 1 redundant contacts could not be
# told apart, and the closer to it, the longer takes the solver.
_IMPEDANCE: Final = {"newton": 0.999, "cg": 0.99}
_STIFF: Final = 0.5  # rate of a damper, or rate squared of a spring, times the step


@dataclass(frozen=True, slots=True)
class MujocoOptions(Options):
    """How MuJoCo runs a World.

    `solver`: "newton" is exact, its time grows with the cube of the bodies in one heap; "cg" is
    for large scenes. `integrator`: "rk4" is of fourth order, but for the steps in which a body
    touches something or meets a limit; "implicitfast", "implicit" and "euler" are of first order.
    "auto" takes newton and rk4 for scenes of up to 50 bodies, and where no spring or damper is
    stiff. `sleep` lets bodies that hardly move stop for good, until something touches them.
    `friction`: how two materials' frictions make that of the pair.
    """

    solver: str = "auto"
    integrator: str = "auto"
    sleep: bool = False
    friction: str = "sum"

    CHOICES: ClassVar = {
        "solver": ("auto", "newton", "cg"),
        "integrator": ("auto", "rk4", "implicitfast", "implicit", "euler"),
        "friction": tuple(FRICTION_RULES),
    }


@dataclass(frozen=True, slots=True)
class Chosen:
    """The options with nothing left to choose."""

    solver: str
    integrator: str
    sleep: bool
    friction: str

    @property
    def iterations(self) -> int:
        """The most that the solver iterates in a step."""
        return _ITERATIONS[self.solver]

    @property
    def impedance(self) -> float:
        """How close contacts come to what is wanted: a rebound misses e by (1 + e)(1 - this)."""
        return _IMPEDANCE[self.solver]

    def describe(self) -> Iterator[Finding]:
        """A finding that says what is computed with, and how exact it is."""
        order = "order 4, but 1 where something touches" if self.integrator == "rk4" else "order 1"
        sleep = "may sleep" if self.sleep else "never sleep"
        message = f"Solver {self.solver}, integrator {self.integrator} ({order}); bodies {sleep}."
        yield SETTINGS.at(message=message)


def resolve(options: MujocoOptions, world: World) -> Chosen:
    """Choose by the scene what `options` leave open: by nothing that changes while it runs."""
    small = int(np.count_nonzero(~world.fixed)) <= SMALL
    solver, integrator = options.solver, options.integrator
    if solver == "auto":
        solver = "newton" if small else "cg"
    if integrator == "auto":
        exact = small and not options.sleep and not _stiff(world)
        integrator = "rk4" if exact else "implicitfast"
    return Chosen(solver, integrator, options.sleep, options.friction)


def _stiff(world: World) -> bool:
    """True if a spring or damper is too fast for an explicit integrator to follow."""
    dt = float(world.time_step or 0.0)
    for joint in world.joints:
        bodies = [body for body in (joint.body1, joint.body2) if body and not body.fixed]
        springs = joint.linear_spring, joint.angular_spring
        if not joint.enabled or not bodies or not any(any(spring[:2]) for spring in springs):
            continue
        mass = min(body.mass for body in bodies)
        moment = min(float(np.linalg.eigvalsh(body.inertia)[0]) for body in bodies)
        for (stiffness, damping, _), inertia in zip(springs, (mass, moment), strict=True):
            if damping * dt > _STIFF * inertia or stiffness * dt * dt > _STIFF * inertia:
                return True
    return False

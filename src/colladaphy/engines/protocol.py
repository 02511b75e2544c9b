"""What an engine is: something that runs a World in time, exactly and repeatably.

An engine copies a World into its own model (`load`), advances that (`step`), and writes the state
back (`store`). It never keeps a reference to the World between calls, so that the World can be
written, edited or compared meanwhile.

**Exactness.** The state of an engine after `load` is a function of what the World holds, and of
nothing else: not of the order of creation, of earlier runs, of the process or of hash seeds. So

- ``load(w)`` in two processes, on Worlds between which `colladaphy.world.compare` finds no
  difference, leads to the same bits after any number of steps;
- ``step(a); step(b)`` is ``step(a + b)``, bit by bit;
- ``store(w); load(w)`` on the running engine makes it equal to an engine in another process that
  loads `w` after a round trip through a file. A checkpoint does exactly that (`Simulation`), so the
  run that goes on is the run that is resumed. It need not equal the run without a checkpoint:
  whatever the engine cannot put into the World (contact caches, say) may be dropped by `load`.

Iterate over bodies in ascending system id, over joints in the order of `World.joints`; never over
sets, nor over dicts whose order depends on hashes.

**Own state.** What the engine needs beyond the World's columns goes into `World.engine_state`, as
the bytes that `colladaphy.engines.state.pack` makes of it; `unpack` hands them back to `load` only
if the engine's name, its version and the World are still those that were stored, so that edits of
the World always win. An engine without such state packs empty bytes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.world import JointKind, Kind, World

__all__ = ["Capabilities", "Contact", "Engine", "Steerable"]

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Capabilities:
    """What an engine can do in general; `Engine.check` says what it can do with one World."""

    planar: bool
    """True if all motion has to lie in one plane."""
    kinds: frozenset[Kind]
    """Kinds of bodies that can move or be collided with."""
    joints: frozenset[JointKind]
    """Kinds of joints."""
    restitution: bool
    """Coefficients of restitution are followed."""
    two_frictions: bool
    """Static and dynamic friction may differ."""
    random: bool = False
    """The engine draws random numbers: a seed matters."""


@dataclass(frozen=True, slots=True)
class Contact:
    """One point in which two bodies touch, in world coordinates."""

    first: int
    """System id of the top-level body with the smaller system id."""
    second: int
    """System id of the other one."""
    position: Vector
    normal: Vector
    """Unit vector that points from the first body to the second."""
    distance: float
    """Gap between the surfaces; negative where they overlap."""
    impulse: float = field(default=0.0)
    """Normal impulse of the last step (mass times velocity), 0 where the engine can't say."""


@runtime_checkable
class Engine(Protocol):
    """The protocol of engines. Created without arguments; `load` comes before all else."""

    @property
    def name(self) -> str:
        """Short, stable name as in ``--engine``: "pymunk"."""

    @property
    def version(self) -> str:
        """Version of the library underneath: own state is only good for the same one."""

    @property
    def capabilities(self) -> Capabilities:
        """What the engine can do in general."""

    def check(self, world: World) -> list[Finding]:
        """All that speaks against running `world`; changes neither the World nor the engine.

        Findings of severity error (rules of `colladaphy.engines.rules`) are refusals, every one of
        them listed, each naming its body or joint; warnings and infos say what is dropped or
        approximated. Must not need `world.time_step`.
        """

    def load(self, world: World, *, seed: int | None = None) -> None:
        """Build the model from `world`, which has a positive `time_step`, and take its clock.

        Takes poses, velocities, `forces` and `torques` (which act during the first step only),
        `sleeping`, the clock, and `engine_state` where `state.unpack` gives it. May be called again
        at any time and then starts afresh. Raises EngineError with the findings of `check` that
        are errors.
        """

    def step(self, count: int = 1) -> None:
        """Advance `count` steps of the World's `time_step`.

        Raises EngineError (rule ``engine-diverged``) when a pose or velocity is not finite any
        more; what was stored before is untouched then.
        """

    def store(self, world: World) -> None:
        """Write the state into the columns of `world`, the World that was loaded or its equal.

        Writes positions, orientations, linear and angular velocities of the bodies that move (those
        of fixed bodies are left as they are, bit by bit), `sleeping`, `forces` and `torques` (zero
        after a step), `time`, `step_count`, `engine_state`, and nothing else. The clock advances by
        adding the time step once a step (`clock.Clock`). Vectorised; must not disturb the run.
        """

    def contacts(self) -> list[Contact]:
        """The contacts of the last step, ordered by system ids; must not disturb the run."""


@runtime_checkable
class Steerable(Protocol):
    """What an engine can do besides, so that steering a run costs no more than running it."""

    def observe(self, world: World) -> None:
        """As `Engine.store`, but without `engine_state`: the run goes on."""

    def steer(self, world: World) -> bool:
        """Take up poses, velocities, forces and torques that were changed since `observe`.

        Nothing else of `world` was changed. False if that needs a `load`.
        """

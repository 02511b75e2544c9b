"""The engine itself: load, step, store."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from colladaphy.engines.bounds import Bounds
from colladaphy.engines.clock import Clock
from colladaphy.engines.digest import digest
from colladaphy.engines.edits import changed
from colladaphy.engines.mujoco_engine import memory, refusals
from colladaphy.engines.mujoco_engine.contacts import Touches
from colladaphy.engines.mujoco_engine.model import Model, build
from colladaphy.engines.mujoco_engine.motion import Motion
from colladaphy.engines.mujoco_engine.quiet import quiet
from colladaphy.engines.mujoco_engine.settings import MujocoOptions, resolve
from colladaphy.engines.mujoco_engine.stepping import Stepper
from colladaphy.engines.options import Value
from colladaphy.engines.protocol import Capabilities, Contact
from colladaphy.engines.rules import DIVERGED, LIBRARY, refuse
from colladaphy.engines.state import pack, unpack
from colladaphy.errors import EngineError
from colladaphy.findings import Finding, Severity
from colladaphy.world import JointKind, Kind

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["MujocoEngine"]

_WARNINGS = mujoco.mjtWarning
_FULL = (_WARNINGS.mjWARN_CONTACTFULL, _WARNINGS.mjWARN_CNSTRFULL)
_BAD = (_WARNINGS.mjWARN_BADQPOS, _WARNINGS.mjWARN_BADQVEL, _WARNINGS.mjWARN_BADQACC)


class MujocoEngine:
    """Runs a World with MuJoCo; options are those of `MujocoOptions`."""

    name = "mujoco"
    capabilities = Capabilities(
        planar=False,
        kinds=frozenset(Kind),
        joints=frozenset(JointKind),
        restitution=True,
        two_frictions=False,
    )

    def __init__(self, **options: Any) -> None:
        self._options = MujocoOptions.of(options)
        self.notices: list[Finding] = []
        """What was found at the last load."""
        self._checked: tuple[tuple[str, bool], list[Finding]] | None = None  # the last check
        self._key = ""
        self._model: Model | None = None
        self._motion: Motion | None = None
        self._data: Any = None
        self._clock = Clock(0.0, 0, 1.0)
        self._stepper: Stepper | None = None
        self._bounds = Bounds(np.inf, 0.0)
        self._given: list[Any] = []  # poses and velocities that the World and MuJoCo agree in
        self._pushed = False
        self._stepped = False

    @property
    def options(self) -> dict[str, Value]:
        """The options that the engine was made with."""
        return self._options.plain()

    @property
    def version(self) -> str:
        """Version of MuJoCo."""
        return str(mujoco.__version__)

    def check(self, world: World) -> list[Finding]:
        """See `Engine.check`."""
        fresh = unpack(world, self.name, self.version, self.options).data is None
        key = digest(world), fresh
        if self._checked is None or self._checked[0] != key:
            self._checked = key, refusals.check(world, self._options, fresh=fresh)
        return list(self._checked[1])

    def load(self, world: World, *, seed: int | None = None) -> None:
        """See `Engine.load`. The compiled model is kept while only the motion changes."""
        clock = Clock.of(world)
        key = digest(world, motion=False)
        if key != self._key or self._model is None or self._motion is None:
            self._key = ""
            errors = [f for f in self.check(world) if f.severity is Severity.ERROR]
            if errors:
                raise EngineError(errors)
            with quiet():
                chosen = resolve(self._options, world)
                model = self._model = build(world, chosen)
            self._motion = Motion(world, model)
            self._stepper = Stepper(
                model.compiled, model.surfaces, model.geom_rows, model.motors,
                fourth=chosen.integrator == "rk4",
            )  # fmt: skip
            self._key = key
        compiled = self._model.compiled
        self._data = mujoco.MjData(compiled)
        self._clock = clock
        self._stepped = False
        self._bounds = Bounds.of(world, clock.time_step)
        own = unpack(world, self.name, self.version, self.options).data
        self.notices = []
        with quiet():
            if own is None or not memory.recall(compiled, self._data, own):
                self._motion.put(world, self._data)
                self.notices = list(refusals.overlaps(world, self._model, self._data))
        self._given = self._motion.columns(world)
        self._push(world)

    def step(self, count: int = 1) -> None:
        """See `Engine.step`."""
        if count < 1:
            return
        try:
            with quiet():
                self._advance(count)
        except mujoco.FatalError as error:
            raise refuse(LIBRARY, f"MuJoCo gives up: {error}") from error
        self._stepped = True
        self._clock.advance(count)
        self._look_for_trouble()

    def _advance(self, count: int) -> None:
        assert self._stepper is not None
        for _ in range(count):
            self._stepper.step(self._data)
            if self._pushed:
                self._data.xfrc_applied[:] = 0.0
                self._pushed = False

    def _look_for_trouble(self) -> None:
        warnings = self._data.warning
        if any(warnings[kind].number for kind in _FULL):
            message = f"MuJoCo ran out of memory for contacts by step {self._clock.step_count}."
            raise refuse(LIBRARY, message)
        bad = any(warnings[kind].number for kind in _BAD)
        if bad:
            message = f"The simulation has diverged by step {self._clock.step_count}."
            raise refuse(DIVERGED, message)
        assert self._motion is not None
        linear, data = self._motion.free_speeds(self._data), self._data
        step = self._clock.step_count
        self._bounds.check(linear, data.qpos, data.qvel, step=step, most=refusals.MOST)

    def store(self, world: World) -> None:
        """See `Engine.store`."""
        assert self._model is not None
        self.observe(world)
        own = memory.remember(self._model.compiled, self._data)
        pack(world, self.name, self.version, own, self.options)

    def observe(self, world: World) -> None:
        """See `Steerable.observe`."""
        assert self._motion is not None
        motion, rows = self._motion, self._motion.rows
        if self._stepped:
            with quiet():
                motion.take(world, self._data)
            world.forces[rows] = 0.0
            world.torques[rows] = 0.0
            asleep = np.append(self._data.tree_asleep, -1) >= 0  # tree -1: held by what is fixed
            world.sleeping[rows] = asleep[motion.trees]
        self._clock.store(world)
        self._given = motion.columns(world)

    def steer(self, world: World) -> bool:
        """See `Steerable.steer`. A body that is moved by hand has to be woken: that is a load."""
        motion = self._motion
        if motion is None or self._options.sleep or Clock.of(world) != self._clock:
            return False
        given = motion.columns(world)
        if any(changed(one, other) for one, other in zip(given, self._given, strict=True)):
            with quiet():
                motion.put(world, self._data)
        self._given = given
        self._push(world)
        self._bounds = self._bounds.widened(world)
        return True

    def _push(self, world: World) -> None:
        assert self._motion is not None
        rows, ids = self._motion.rows, self._motion.ids
        applied = self._data.xfrc_applied
        applied[ids, :3], applied[ids, 3:] = world.forces[rows], world.torques[rows]
        self._pushed = bool(world.forces.any() or world.torques.any())

    def contacts(self) -> list[Contact]:
        """See `Engine.contacts`."""
        if not self._stepped or self._model is None:
            return []
        assert self._stepper is not None
        touches = self._stepper.touches or Touches.of(self._data)
        return touches.listed(self._model.geom_sids, self._clock.time_step)

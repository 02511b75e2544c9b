"""The engine itself: load, step, store."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from colladaphy.engines.clock import Clock
from colladaphy.engines.digest import digest
from colladaphy.engines.mujoco_engine import memory, refusals
from colladaphy.engines.mujoco_engine.model import Model, build
from colladaphy.engines.mujoco_engine.motion import Motion
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
    """Runs a World with MuJoCo."""

    name = "mujoco"
    capabilities = Capabilities(
        planar=False,
        kinds=frozenset(Kind),
        joints=frozenset(JointKind),
        restitution=False,
        two_frictions=False,
    )

    def __init__(self) -> None:
        self._key = ""
        self._model: Model | None = None
        self._motion: Motion | None = None
        self._data: Any = None
        self._clock = Clock(0.0, 0, 1.0)
        self._pushed = False
        self._stepped = False

    @property
    def version(self) -> str:
        """Version of MuJoCo."""
        return str(mujoco.__version__)

    def check(self, world: World) -> list[Finding]:
        """See `Engine.check`."""
        return refusals.check(world)

    def load(self, world: World, *, seed: int | None = None) -> None:
        """See `Engine.load`. The compiled model is kept while only the motion changes."""
        clock = Clock.of(world)
        key = digest(world, motion=False)
        if key != self._key or self._model is None or self._motion is None:
            self._key = ""
            errors = [f for f in refusals.check(world) if f.severity is Severity.ERROR]
            if errors:
                raise EngineError(errors)
            with _quiet():
                self._model = build(world)
            self._motion = Motion(world, self._model)
            self._key = key
        compiled = self._model.compiled
        self._data = mujoco.MjData(compiled)
        self._clock = clock
        self._stepped = False
        own = unpack(world, self.name, self.version).data
        with _quiet():
            if own is None or not memory.recall(compiled, self._data, own):
                self._motion.put(world, self._data)
        rows, ids = self._motion.rows, self._motion.ids
        push = np.concatenate([world.forces[rows], world.torques[rows]], axis=1)
        self._data.xfrc_applied[ids] = push
        self._pushed = bool(np.any(push))

    def step(self, count: int = 1) -> None:
        """See `Engine.step`."""
        if count < 1:
            return
        try:
            with _quiet():
                self._advance(count)
        except mujoco.FatalError as error:
            raise refuse(LIBRARY, f"MuJoCo gives up: {error}") from error
        self._stepped = True
        self._clock.advance(count)
        self._look_for_trouble()

    def _advance(self, count: int) -> None:
        assert self._model is not None
        if self._pushed:
            mujoco.mj_step(self._model.compiled, self._data)
            self._data.xfrc_applied[:] = 0.0
            self._pushed = False
            count -= 1
        if count:
            mujoco.mj_step(self._model.compiled, self._data, nstep=count)

    def _look_for_trouble(self) -> None:
        warnings = self._data.warning
        if any(warnings[kind].number for kind in _FULL):
            message = f"MuJoCo ran out of memory for contacts by step {self._clock.step_count}."
            raise refuse(LIBRARY, message)
        bad = any(warnings[kind].number for kind in _BAD)
        finite = np.all(np.isfinite(self._data.qpos)) and np.all(np.isfinite(self._data.qvel))
        if bad or not finite:
            message = f"The simulation has diverged by step {self._clock.step_count}."
            raise refuse(DIVERGED, message)

    def store(self, world: World) -> None:
        """See `Engine.store`."""
        assert self._model is not None and self._motion is not None
        motion, rows = self._motion, self._motion.rows
        if self._stepped:
            with _quiet():
                motion.take(world, self._data)
            world.forces[rows] = 0.0
            world.torques[rows] = 0.0
            asleep = np.append(self._data.tree_asleep, -1) >= 0  # tree -1: held by what is fixed
            world.sleeping[rows] = asleep[motion.trees]
        self._clock.store(world)
        own = memory.remember(self._model.compiled, self._data)
        pack(world, self.name, self.version, own)

    def contacts(self) -> list[Contact]:
        """See `Engine.contacts`."""
        if not self._stepped or self._model is None:
            return []
        data, sids = self._data, self._model.geom_sids
        found: list[Contact] = []
        force = np.zeros(6)
        for index in range(data.ncon):
            contact = data.contact[index]
            first, second = (int(sids[geom]) for geom in contact.geom)
            normal = np.array(contact.frame[:3])
            if first > second:
                first, second, normal = second, first, -normal
            mujoco.mj_contactForce(self._model.compiled, data, index, force)
            found.append(
                Contact(
                    first,
                    second,
                    tuple(contact.pos.tolist()),
                    tuple(normal.tolist()),
                    float(contact.dist),
                    float(force[0]) * self._clock.time_step,
                )
            )
        return sorted(found, key=lambda contact: (contact.first, contact.second))


@contextmanager
def _quiet() -> Iterator[None]:
    """What diverges is looked up in MuJoCo's data; it need not be told in other ways as well."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        with np.errstate(all="ignore"):
            yield
    finally:
        mujoco.set_mju_user_warning(before)

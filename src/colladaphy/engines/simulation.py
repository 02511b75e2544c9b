"""A run of a World by an engine, which can be stopped and resumed at the same bit."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Self
from weakref import ref

from colladaphy.engines.carrying import SceneDocument, save_scene
from colladaphy.engines.checkpoint_rules import STATE_NO_ENGINE
from colladaphy.engines.checkpoints import Checkpoints, open_checkpoint
from colladaphy.engines.diagnostics import ContactCount, Summary, summarise
from colladaphy.engines.edits import Edits
from colladaphy.engines.events import ContactEvent, ContactEvents
from colladaphy.engines.protocol import Steerable
from colladaphy.engines.rules import OVERTAKEN, SEED_UNUSED, STEPS, TIME_STEP_DEFAULT, refuse
from colladaphy.engines.selection import choose, create_engine
from colladaphy.engines.state import recorded_options, unpack
from colladaphy.errors import EngineError
from colladaphy.findings import Finding, Report, Severity

if TYPE_CHECKING:
    from colladaphy.engines.observers import Observer
    from colladaphy.engines.protocol import Contact, Engine
    from colladaphy.source import Limits
    from colladaphy.world import EngineState, World

__all__ = ["DEFAULT_TIME_STEP", "Simulation"]

DEFAULT_TIME_STEP = 1.0 / 240.0
_BREATH = 0.05  # seconds between two looks at whether to stop


class Simulation:
    """Runs `world`, in place, with an engine.

    `engine` is a name, "auto" (pymunk for planar scenes, else MuJoCo) or an `Engine`, which has
    its own options: ``MujocoEngine(solver="cg")``. `dt` is the time step; without it the World's
    own, or 1/240. Raises EngineError, with every reason, where the World cannot be run; what is
    dropped, approximated or assumed is in `report`.

    `forces`, called as ``forces(world, time)`` before each step with the World up to date, sets
    forces and torques, which act during that step. `on_contact` gets a `ContactEvent` whenever two
    bodies begin or cease to touch. `on_finding` gets what is in `report` up to then before the
    engine is set up, which can take long (``engine-setup``).

    `document` is the one that the World came from: checkpoints are written into it, by
    `Document.update`, so that they hold all else of it.

    Edits of the World between two runs are taken up by the next one. During a run `forces` and
    observers may change motion and forces, which the running engine takes up; anything else is
    refused (``engine-edit``).
    """

    def __init__(
        self,
        world: World,
        engine: str | Engine = "auto",
        dt: float | None = None,
        seed: int | None = None,
        *,
        forces: Callable[[World, float], object] | None = None,
        on_contact: Callable[[ContactEvent], object] | None = None,
        on_finding: Callable[[Finding], object] | None = None,
        document: SceneDocument | None = None,
    ) -> None:
        self.world = world
        self.document = document
        self._forces = forces
        self._events = ContactEvents(on_contact) if on_contact else None
        self.seed = seed
        self.report = Report()
        if dt is not None:
            world.time_step = float(dt)
        elif world.time_step is None:
            world.time_step = DEFAULT_TIME_STEP
            self.report.add(TIME_STEP_DEFAULT.at())
        if engine == "auto":
            self.engine, findings = choose(world)
        else:
            self.engine = create_engine(engine) if isinstance(engine, str) else engine
            findings = self.engine.check(world)
        self.report.extend(findings)
        if self.report.errors:
            raise EngineError(self.report.errors)
        if seed is not None and not self.engine.capabilities.random:
            self.report.add(SEED_UNUSED.at())
        options = getattr(self.engine, "options", None)
        own = unpack(world, self.engine.name, self.engine.version, options)
        self.report.extend(own.findings)
        self._steerable = self.engine if isinstance(self.engine, Steerable) else None
        self._edits = Edits()
        self._last: ref[ContactCount] | None = None
        if on_finding:
            for finding in self.report:
                on_finding(finding)
        self._load()
        self.report.extend(getattr(self.engine, "notices", ()))

    @classmethod
    def resume(
        cls,
        source: str | os.PathLike[str],
        engine: str | Engine = "auto",
        dt: float | None = None,
        seed: int | None = None,
        *,
        forces: Callable[[World, float], object] | None = None,
        on_contact: Callable[[ContactEvent], object] | None = None,
        on_finding: Callable[[Finding], object] | None = None,
        document: SceneDocument | None = None,
        limits: Limits | None = None,
    ) -> Self:
        """Go on from a checkpoint, or from the newest one that is whole in a folder.

        "auto" is the engine that wrote it, with its options, and so is its name: the same engine
        in the same version goes on to the last bit. Another one goes on from the World, with a
        finding. EngineError if there is no checkpoint that is whole (those that are not are in the
        report), or if the engine that wrote it is not there and no other one is named. Without a
        `document` the checkpoint's own is taken, if there is more in it than the World. `limits`
        are those of reading; what one of them keeps from being read is no fault of the file.
        """
        if Path(source).is_dir():
            found = Checkpoints(source).newest(limits)
        else:
            found = open_checkpoint(source, limits)
        world, passed = found.world, found.findings
        state = world.engine_state
        if state is not None and engine in ("auto", state.engine):
            engine = _maker(state)
        run = cls(
            world,
            engine,
            dt,
            seed,
            forces=forces,
            on_contact=on_contact,
            on_finding=on_finding,
            document=found.carried if document is None else document,
        )
        run.report.findings[:0] = passed
        return run

    def run(
        self,
        steps: int,
        *,
        observers: Sequence[Observer] = (),
        every: int = 1,
        checkpoints: Checkpoints | None = None,
        checkpoint_every: int = 0,
        before_checkpoint: Callable[[], None] | None = None,
        stop: Callable[[], bool] | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> Summary:
        """Advance `steps` steps, or until `stop` says so, and bring the World up to date.

        Observers are called at the start and then whenever the World's `step_count` is a multiple
        of `every`; checkpoints are written, after a call of `before_checkpoint`, whenever it is a
        multiple of `checkpoint_every`, which makes a resumed run write the same ones. `progress`
        gets the number of steps done, several times a second. Raises EngineError when the run
        diverges: the World is then as it was at the last observation or checkpoint, or at the
        start.
        """
        if steps < 0 or every < 1 or checkpoint_every < 0:
            message = f"Asked for {steps} steps, an interval of {every} and {checkpoint_every}."
            raise refuse(STEPS, message)
        self._take_up_edits()
        intervals = [checkpoint_every] if checkpoints and checkpoint_every else []
        if observers:
            intervals.append(every)
            self._notify(observers)
        if self._forces or self._events:
            intervals.append(1)
        pace = _Pace()
        start = count = self.world.step_count
        stale = False
        while count < start + steps and not (stop and stop()):
            chunk = min(start + steps - count, pace.chunk, *(i - count % i for i in intervals))
            if self._forces:
                if stale:
                    self._observe()
                self._forces(self.world, self.world.time)
                self._steer()
            stale = True
            self._step(chunk, pace)
            count += chunk
            if self._events:
                self._events.notice(self.engine.contacts(), count)
            if observers and count % every == 0:
                self._observe()
                stale = False
                self._notify(observers)
            if checkpoints and checkpoint_every and count % checkpoint_every == 0:
                if before_checkpoint:
                    before_checkpoint()
                self._save(checkpoints)
                stale = False
            if progress:
                progress(count - start)
        if count > start:
            self._store()
        return self.summary()

    def checkpoint(self, target: str | os.PathLike[str] | Checkpoints) -> Path:
        """Write a checkpoint to a file, or to the next place in a series; returns where.

        The run itself goes on from what was written, so that it equals the run that is resumed.
        It may differ in the last bits from a run without this checkpoint. Raises OutputError,
        with what was in the file before untouched; the run can go on.
        """
        self._take_up_edits()
        if isinstance(target, Checkpoints):
            return self._save(target)
        self._rebuild()
        save_scene(self.world, target, self.document)
        return Path(target)

    def _save(self, checkpoints: Checkpoints) -> Path:
        self._rebuild()
        return checkpoints.save(self.world, self.document)

    def _rebuild(self) -> None:
        """Make the running engine the one that a resumed run begins with."""
        self._store()
        self._load()

    def _load(self) -> None:
        self._edits.forget()
        self.engine.load(self.world, seed=self.seed)
        self._edits.remember(self.world)

    def _store(self) -> None:
        self.engine.store(self.world)
        self._edits.remember_motion(self.world)

    def _observe(self) -> None:
        """Bring the World up to date for somebody who looks at it."""
        if self._steerable:
            self._steerable.observe(self.world)
            self._edits.remember_motion(self.world)
        else:
            self._store()

    def _step(self, count: int, pace: _Pace) -> None:
        if self._last and (unread := self._last()):
            unread.read()
        self._last = None
        try:
            with pace:
                self.engine.step(count)
        except BaseException:
            self._edits.forget()  # an engine that failed is loaded anew
            raise
        pace.done(count)

    def _notify(self, observers: Sequence[Observer]) -> None:
        for observer in observers:
            observer(self.world)
        self._steer()

    def _steer(self) -> None:
        """Take up in the running engine what was changed while it runs, or refuse it."""
        edits = self._edits
        if edits.reshaped(self.world):
            raise refuse(OVERTAKEN, "More than motion and forces was changed during a run.")
        if edits.moved(self.world):
            self._take_up_motion()

    def _take_up_motion(self) -> None:
        engine = self.engine
        if self._steerable and self._steerable.steer(self.world):
            return
        errors = [f for f in engine.check(self.world) if f.severity is Severity.ERROR]
        if errors:
            raise EngineError(errors)
        self._load()

    def _take_up_edits(self) -> None:
        edits = self._edits
        if edits.known and not edits.replaced(self.world):
            edits.accept(self.world)
            if edits.moved(self.world):
                self._take_up_motion()
            return
        errors = [f for f in self.engine.check(self.world) if f.severity is Severity.ERROR]
        if errors:
            raise EngineError(errors)
        self._load()

    def contacts(self) -> list[Contact]:
        """The contacts of the last step."""
        return self.engine.contacts()

    def summary(self) -> Summary:
        """Energy, momentum and contacts as the World is now."""
        summary = summarise(self.world, self.engine.name, ContactCount(self.engine.contacts))
        self._last = ref(summary.count)
        return summary


def _maker(state: EngineState) -> Engine:
    """The engine that wrote a state, with its options; EngineError if it is not there."""
    try:
        return create_engine(state.engine, **(recorded_options(state) or {}))
    except EngineError as error:
        message = (
            f"The checkpoint was written by the engine {state.engine!r} {state.version}, which is "
            "not there."
        )
        raise EngineError((STATE_NO_ENGINE.at(message=message), *error.findings)) from error


class _Pace:
    """How many steps go at once, so that stopping never waits long."""

    def __init__(self) -> None:
        self.chunk = 1
        self._start = 0.0
        self._spent = 0.0

    def __enter__(self) -> None:
        self._start = monotonic()

    def __exit__(self, *_: object) -> None:
        self._spent = monotonic() - self._start

    def done(self, chunk: int) -> None:
        per_step = self._spent / chunk
        self.chunk = max(1, min(2 * self.chunk, int(_BREATH / max(per_step, 1e-9))))

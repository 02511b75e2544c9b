"""``colladaphy simulate``."""

from __future__ import annotations

import shlex
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from colladaphy.cli.console import note, say
from colladaphy.cli.files import source_of, target_of

if TYPE_CHECKING:
    from colladaphy.engines import Checkpoints, Simulation, Summary, Trajectory
    from colladaphy.findings import Finding
    from colladaphy.world import World

__all__ = ["command"]

EXIT_INTERRUPTED = 130


@click.command("simulate")
@click.argument("source", metavar="IN")
@click.argument("target", metavar="[OUT]", required=False)
@click.option(
    "--engine",
    type=click.Choice(["auto", "pymunk", "mujoco"]),
    default="auto",
    show_default=True,
    help="What runs it: pymunk runs planar scenes, mujoco all.",
)
@click.option(
    "--steps",
    type=click.IntRange(min=0),
    default=1000,
    show_default=True,
    metavar="N",
    help="Number of steps in all; --resume does what is left of them.",
)
@click.option(
    "--dt",
    type=click.FloatRange(min=0, min_open=True),
    metavar="T",
    help="Time step; without it the document's, or 1/240.",
)
@click.option("--seed", type=int, metavar="S", help="For engines that draw random numbers.")
@click.option(
    "--checkpoint-every",
    "interval",
    type=click.IntRange(min=1),
    metavar="K",
    help="Write a checkpoint every K steps.",
)
@click.option(
    "--checkpoint-dir",
    "folder",
    metavar="DIR",
    help="Where checkpoints go; without it IN with .checkpoints for its suffix.",
)
@click.option(
    "--keep",
    type=click.IntRange(min=1),
    default=3,
    show_default=True,
    metavar="N",
    help="How many checkpoints stay.",
)
@click.option("--resume", is_flag=True, help="Go on from the newest checkpoint that is whole.")
@click.option("--trajectory", metavar="FILE", help="Write the motion of all bodies to FILE (.npz).")
@click.option(
    "--trajectory-every",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    metavar="K",
    help="Record every K steps.",
)
def command(
    source: str,
    target: str | None,
    engine: str,
    steps: int,
    dt: float | None,
    seed: int | None,
    interval: int | None,
    folder: str | None,
    keep: int,
    resume: bool,
    trajectory: str | None,
    trajectory_every: int,
) -> int:
    """Run the World of the document IN, and write what became of it to OUT.

    Interrupted (Ctrl-C or a polite kill), it writes a checkpoint and says how to go on; the run
    that is resumed equals the run that was not interrupted, to the last bit, if both write their
    checkpoints at the same steps.
    """
    from colladaphy.engines import Checkpoints, Trajectory

    if source == "-" and folder is None and (interval or resume):
        raise click.UsageError("Give --checkpoint-dir where IN is standard input.")
    place = folder or ("stdin.checkpoints" if source == "-" else _beside(source))
    checkpoints = Checkpoints(place, keep=keep)
    world = _read(source)
    goal = world.step_count + steps
    simulation = _start(world, checkpoints, engine, dt, seed, resume, begin=bool(interval))
    recorder = Trajectory() if trajectory else None
    with _interruption() as interrupted:
        began = time.monotonic()
        before = simulation.world.step_count
        progress = _Progress(goal, before)
        summary = simulation.run(
            max(0, goal - before),
            observers=[recorder] if recorder else [],
            every=trajectory_every,
            checkpoints=checkpoints,
            checkpoint_every=interval or 0,
            stop=lambda: bool(interrupted),
            progress=progress,
        )
        spent = time.monotonic() - began
        progress.clear()
        stopped = summary.step_count < goal
        if stopped:
            _interrupt(simulation, checkpoints)
    _save(simulation.world, recorder, None if stopped else target, trajectory)
    if target != "-":
        _report(summary, summary.step_count - before, spent)
    return EXIT_INTERRUPTED if stopped else 0


def _beside(source: str) -> str:
    return str(Path(source).with_suffix(".checkpoints"))


def _read(source: str) -> World:
    import colladaphy

    document = colladaphy.read(source_of(source))
    _tell(document.report.findings)
    known = len(document.report)
    world: World = document.load()
    _tell(document.report.findings[known:])
    return world


def _start(
    world: World,
    checkpoints: Checkpoints,
    engine: str,
    dt: float | None,
    seed: int | None,
    resume: bool,
    *,
    begin: bool,
) -> Simulation:
    from colladaphy.engines import Simulation

    if resume:
        simulation = Simulation.resume(checkpoints.folder, engine, dt, seed)
        _tell(simulation.report.findings)
        note(f"Resumed at step {simulation.world.step_count}.")
        return simulation
    simulation = Simulation(world, engine, dt, seed)
    if begin:
        checkpoints.begin()
    _tell(simulation.report.findings)
    return simulation


def _tell(findings: list[Finding]) -> None:
    """Everything that is worth a look: no news is good news."""
    from colladaphy.findings import Severity

    for finding in findings:
        if finding.severity in (Severity.ERROR, Severity.WARNING):
            note(str(finding))


def _interrupt(simulation: Simulation, checkpoints: Checkpoints) -> None:
    path = simulation.checkpoint(checkpoints)
    note(f"Interrupted at step {simulation.world.step_count}; checkpoint: {path}")
    arguments = [argument for argument in sys.argv[1:] if argument != "--resume"]
    again = shlex.join(["colladaphy", *arguments, "--resume"])
    note(f"Go on with: {again}")


def _save(
    world: World, recorder: Trajectory | None, target: str | None, trajectory: str | None
) -> None:
    import colladaphy

    if recorder is not None and trajectory is not None:
        recorder(world)
        recorder.save(trajectory)
    if target is not None:
        colladaphy.write(world, target_of(target))


def _report(summary: Summary, steps: int, spent: float) -> None:
    def vector(values: tuple[float, ...]) -> str:
        return " ".join(f"{value:.6g}" for value in values)

    rate = f", {steps / spent:.0f} a second" if steps and spent > 0 else ""
    asleep = f", {summary.sleeping} asleep" if summary.sleeping else ""
    say(f"engine            {summary.engine}")
    say(f"steps             {steps}, up to {summary.step_count}{rate}")
    say(f"time              {summary.time:.6g} s")
    say(f"bodies            {summary.bodies} that can move{asleep}")
    say(f"contacts          {summary.contacts}")
    say(f"kinetic energy    {summary.kinetic_energy:.6g}")
    say(f"potential energy  {summary.potential_energy:.6g}")
    say(f"momentum          {vector(summary.momentum)}")
    say(f"angular momentum  {vector(summary.angular_momentum)}")


@contextmanager
def _interruption() -> Iterator[list[int]]:
    """Collects signals that ask to stop; a second one stops at once."""
    got: list[int] = []

    def remember(number: int, _: object) -> None:
        if got:
            raise KeyboardInterrupt
        got.append(number)

    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, remember) for number in numbers]
    try:
        yield got
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)


class _Progress:
    """Steps done and steps a second, on standard error while a person looks on."""

    def __init__(self, goal: int, start: int) -> None:
        self._goal = goal
        self._start = start
        self._seen = self._began = time.monotonic()
        self._shown = False
        self._on = sys.stderr.isatty()

    def __call__(self, done: int) -> None:
        now = time.monotonic()
        if not self._on or now - self._seen < 0.1:
            return
        self._seen = now
        self._shown = True
        rate = done / (now - self._began)
        line = f"\r\033[Kstep {self._start + done}/{self._goal}, {rate:.0f} a second"
        click.echo(line, err=True, nl=False)

    def clear(self) -> None:
        """Leave no trace."""
        if self._shown:
            click.echo("\r\033[K", err=True, nl=False)

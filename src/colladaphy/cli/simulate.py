"""``colladaphy simulate``."""

from __future__ import annotations

import shlex
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

import colladaphy
from colladaphy.cli.console import note, say
from colladaphy.cli.files import (
    convention_option,
    limits_option,
    source_of,
    target_of,
    units_options,
)
from colladaphy.cli.keeping import check_outputs, recorder_of, series
from colladaphy.cli.progress import Bar, waiting

if TYPE_CHECKING:
    from colladaphy.document import Document
    from colladaphy.engines import Checkpoints, Engine, Simulation, Summary
    from colladaphy.findings import Finding
    from colladaphy.source.limits import Limits
    from colladaphy.world import World

__all__ = ["command"]

EXIT_INTERRUPTED = 130


@click.command("simulate")
@click.argument("source", metavar="IN")
@click.argument("target", metavar="[OUT]", required=False)
@click.option(
    "--engine",
    metavar="NAME",
    default="auto",
    show_default=True,
    help="What runs it: pymunk (planar scenes), mujoco (all), or another one that is installed.",
)
@click.option(
    "--engine-option",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    help="A setting of the engine that --engine names (docs/engines.md); may be repeated.",
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
@click.option(
    "--trajectory",
    metavar="FILE",
    help="Write the motion of all bodies to FILE (.npz), or stream it to a folder (.zarr).",
)
@click.option(
    "--trajectory-every",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    metavar="K",
    help="Record every K steps.",
)
@convention_option
@limits_option
@units_options
def command(
    source: str,
    target: str | None,
    engine: str,
    settings: tuple[str, ...],
    steps: int,
    dt: float | None,
    seed: int | None,
    interval: int | None,
    folder: str | None,
    keep: int,
    resume: bool,
    trajectory: str | None,
    trajectory_every: int,
    convention: str,
    limits: Limits | None,
    si: bool,
    up_axis: str | None,
) -> int:
    """Run the World of the document IN, and write what became of it to OUT.

    OUT, and every checkpoint, is IN with the World written back into it: cameras, lights, visuals
    and all else of IN is still there. With --si or --up-axis, they are the World alone. With
    --convention, IN is mended as it is read; without, it has to be valid.

    Interrupted (Ctrl-C or a polite kill), it writes a checkpoint and says how to go on; the run
    that is resumed equals the run that was not interrupted, to the last bit, if both write their
    checkpoints at the same steps.
    """
    from colladaphy.engines import Simulation

    check_outputs(source, target, trajectory)
    chosen = _engine(engine, settings)
    named = click.get_current_context().get_parameter_source("convention")
    repair = named is click.core.ParameterSource.COMMANDLINE
    document, world = _read(source, convention if repair else None, limits, si, up_axis)
    # In another unit or other axes, the document's nodes and meshes are not the World's.
    alone = (world.unit_meter, world.up_axis) != (document.unit[1], document.up_axis)
    if alone:
        note("warning: In another unit or other axes, OUT and checkpoints are the World alone.")
    goal = world.step_count + steps
    checkpoints = series(source, folder, keep, resume=resume, begin=bool(interval))
    if resume:
        with waiting("Setting up the engine"):
            simulation = Simulation.resume(checkpoints.folder, chosen, dt, seed, limits=limits)
        _tell(simulation.report.findings)
        if _is_same(world, simulation.world) and not alone:
            simulation.document = document
        note(f"Resumed at step {simulation.world.step_count}.")
    else:
        with waiting("Setting up the engine"):
            simulation = Simulation(
                world,
                chosen,
                dt,
                seed,
                document=None if alone else document,
                on_finding=_announce,
            )
        _tell(simulation.report.findings)
    before = simulation.world.step_count
    recorder = recorder_of(trajectory, before) if trajectory else None
    with _interruption() as interrupted:
        began = time.monotonic()
        progress = Bar(f"{Path(source).name or source}: step", goal - before, unit="steps")
        summary = simulation.run(
            max(0, goal - before),
            observers=[] if recorder is None else [recorder],
            every=trajectory_every,
            checkpoints=checkpoints,
            checkpoint_every=interval or 0,
            before_checkpoint=None if recorder is None else recorder.save_again,
            stop=lambda: bool(interrupted),
            progress=progress,
        )
        spent = time.monotonic() - began
        progress.clear()
        stopped = summary.step_count < goal
        if recorder is not None:
            recorder(simulation.world)
            with _kept(simulation, checkpoints):
                recorder.save_again()
        if stopped:
            path = simulation.checkpoint(checkpoints)
            note(f"Interrupted at step {summary.step_count}; checkpoint: {path}")
            note(f"Go on with: {_again(checkpoints.folder)}")
    if target is not None and not stopped:
        with _kept(simulation, checkpoints):
            _write(simulation, source, target)
    if target != "-":
        _report(summary, summary.step_count - before, spent)
    return EXIT_INTERRUPTED if stopped else 0


def _write(simulation: Simulation, source: str, target: str) -> None:
    """Write the World back into the document, or by itself where that would lose other files."""
    document, world = simulation.document, simulation.world
    if document is None:
        colladaphy.write(world, target_of(target))
        return
    folders = {Path(file).resolve().parent for file in (source, target)}
    if document.related and len(folders) > 1:
        others = ", ".join(Path(file).name for file in document.related)
        note(f"warning: IN refers to {others}, not to be found from OUT's folder: OUT is the World "
             "alone. Write OUT beside IN to keep all else.")  # fmt: skip
        colladaphy.write(world, target_of(target))
        return
    known = len(document.report)
    document.update(world)
    _tell(document.report.findings[known:])
    # What was wrong in IN before, be it an animation's sampler, must not cost the run.
    document.write(target_of(target), check=False)


def _is_same(scene: World, resumed: World) -> bool:
    """Whether the document is still that of the checkpoint; says so where it is another one."""
    from colladaphy.engines import digest

    scene.time_step = resumed.time_step
    if digest(scene, motion=False) != digest(resumed, motion=False):
        note("warning: IN is not the scene of this checkpoint; the checkpoint goes on.")
        return False
    return True


def _engine(name: str, settings: tuple[str, ...]) -> str | Engine:
    """The engine with its settings; its name where there are none."""
    from colladaphy.engines import create_engine, engine_names

    if name != "auto" and name not in engine_names():
        known = ", ".join(("auto", *engine_names()))
        raise click.BadParameter(f"{name!r} is none of {known}.", param_hint="--engine")
    if not settings:
        return name
    if name == "auto":
        raise click.UsageError("--engine-option needs an --engine that it is a setting of.")
    pairs = [setting.partition("=") for setting in settings]
    wrong = next((setting for setting, (_, sign, _) in zip(settings, pairs, strict=True)
                  if not sign), None)  # fmt: skip
    if wrong is not None:
        raise click.BadParameter(f"{wrong!r} is not KEY=VALUE.", param_hint="--engine-option")
    return create_engine(name, **{key.strip(): value.strip() for key, _, value in pairs})


@contextmanager
def _kept(simulation: Simulation, checkpoints: Checkpoints) -> Iterator[None]:
    """Keep the run in a checkpoint if its result cannot be written."""
    try:
        yield
    except (colladaphy.ColladaError, OSError):
        path = simulation.checkpoint(checkpoints)
        note(f"The result could not be written; nothing of the run is lost: {path}")
        raise


def _again(folder: Path) -> str:
    """The command that goes on with this one."""
    context = click.get_current_context()
    given = click.core.ParameterSource.COMMANDLINE
    words: list[str] = []
    options: list[str] = []
    for parameter in context.command.params:
        name = parameter.name or ""
        if context.get_parameter_source(name) is not given or name in ("resume", "folder"):
            continue
        given_values = context.params[name]
        for value in given_values if isinstance(given_values, tuple) else (given_values,):
            if isinstance(parameter, click.Argument):
                words.append(str(value))
            else:
                options += [parameter.opts[0], str(value)]
    options += ["--checkpoint-dir", str(folder), "--resume"]
    return shlex.join([*context.command_path.split(), *words, *options])


def _read(
    source: str, convention: str | None, limits: Limits | None, si: bool, up_axis: str | None
) -> tuple[Document, World]:
    with waiting(f"Reading {source}"):
        document = colladaphy.read(
            source_of(source),
            repair=convention is not None,
            convention=convention or "auto",
            limits=limits,
        )
    _tell(document.report.findings)
    known = len(document.report)
    with waiting(f"Loading {source}"):
        world: World = document.load(si=si, up_axis=up_axis)
    _tell(document.report.findings[known:])
    return document, world


def _tell(findings: list[Finding]) -> None:
    """Everything that is worth a look: no news is good news."""
    from colladaphy.findings import Severity

    for finding in findings:
        if finding.severity in (Severity.ERROR, Severity.WARNING):
            note(str(finding))


def _announce(finding: Finding) -> None:
    """That setting up will take long is worth a word before it does."""
    from colladaphy.engines.rules import SETUP

    if finding.code == SETUP.code:
        note(finding.message)


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

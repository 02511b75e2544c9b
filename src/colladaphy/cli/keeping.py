"""What a simulation keeps, and where: checkpoints and trajectories, checked before it runs."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

import click

from colladaphy.cli.files import refuse_same

if TYPE_CHECKING:
    from colladaphy.engines import Checkpoints, Trajectory
    from colladaphy.world import World

__all__ = ["Stream", "check_outputs", "recorder_of", "series"]

_TRAJECTORIES = (".npz", ".zarr")


def recorder_of(file: str, step_count: int) -> Trajectory | Stream:
    """What records to `file`, after what is there of the run up to the step it begins with."""
    from colladaphy.engines import Trajectory

    if Path(file).suffix == ".zarr":
        return Stream(file, step_count)
    if step_count and Path(file).exists():
        return Trajectory.load(file, until=step_count)
    return Trajectory(file)


class Stream:
    """A trajectory that is on disk but for its last records."""

    def __init__(self, folder: str, step_count: int) -> None:
        from colladaphy.engines import ZarrTrajectory

        there = step_count > 0 and Path(folder).exists()
        self._trajectory = ZarrTrajectory(folder, append_until=step_count if there else None)

    def __call__(self, world: World) -> None:
        """Record how `world` is now."""
        self._trajectory(world)

    def save_again(self) -> None:
        """Write what is still in memory."""
        self._trajectory.flush()


def check_outputs(source: str, target: str | None, trajectory: str | None) -> None:
    """Refuse, before the run and not after it, what could not be written."""
    if trajectory is not None:
        if Path(trajectory).suffix not in _TRAJECTORIES:
            known = " nor ".join(_TRAJECTORIES)
            message = f"{trajectory!r} ends in neither {known}."
            raise click.BadParameter(message, param_hint="--trajectory")
        refuse_same("--trajectory", trajectory, [source, *([] if target is None else [target])])
    for option, name in (("OUT", target), ("--trajectory", trajectory)):
        if name is None or name == "-":
            continue
        folder = Path(name).absolute().parent
        if not folder.is_dir():
            raise click.BadParameter(f"There is no folder {str(folder)!r}.", param_hint=option)
        if not os.access(folder, os.W_OK):
            raise click.BadParameter(f"{str(folder)!r} is not writable.", param_hint=option)
        if option == "OUT" and Path(name).is_dir():
            raise click.BadParameter(f"{name!r} is a folder.", param_hint=option)


def series(source: str, folder: str | None, keep: int, *, resume: bool, begin: bool) -> Checkpoints:
    """The checkpoints of this run, which are never mixed with those of another."""
    from colladaphy.engines import Checkpoints

    if folder is None:
        if source == "-" and (resume or begin):
            raise click.UsageError("Give --checkpoint-dir where IN is standard input.")
        folder = "stdin.checkpoints" if source == "-" else _beside(source)
    checkpoints = Checkpoints(folder, keep=keep)
    there = checkpoints.paths()
    if resume and not there:
        raise click.UsageError(f"There is no checkpoint in {folder}; start without --resume.")
    if there and begin and not resume:
        raise click.UsageError(
            f"{folder} holds the checkpoints of a run already: go on with it (--resume), or name "
            "another folder (--checkpoint-dir)."
        )
    if there and not resume:  # needed only if this run is interrupted
        free = (Checkpoints(f"{folder}-{number}", keep=keep) for number in count(2))
        checkpoints = next(found for found in free if not found.paths())
    if begin and not resume:
        checkpoints.begin()
    return checkpoints


def _beside(source: str) -> str:
    return str(Path(source).with_suffix(".checkpoints"))

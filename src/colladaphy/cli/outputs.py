"""Which files a command reads, and which it writes: never one that it was not told to write."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import click

from colladaphy.errors import InputError, OutputError

__all__ = ["Job", "check_suffix", "jobs_of", "output_options"]

_SUFFIXES = (".dae", ".zae", ".xml")
_Function = TypeVar("_Function", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Job:
    """A document to read, and the file to write; None where nothing is written."""

    source: str
    target: str | None
    in_place: bool = False
    below: bool = False
    """Whether the target is in a folder of outputs, whose folders are made as they are needed."""

    def prepare(self) -> None:
        """Make the folder of the target, where that is ours to make."""
        if self.below and self.target is not None:
            folder = Path(self.target).parent
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                from colladaphy.source import rules

                message = f"The folder cannot be made: {error.strerror or error}."
                finding = rules.OUTPUT_FAILED.at(message=message, file=str(folder))
                raise OutputError(finding) from None


def output_options(function: _Function) -> _Function:
    """The arguments and options of a command that writes documents; see `jobs_of`."""
    for option in (
        click.option("--no-backup", is_flag=True, help="With --in-place: keep no .bak of it."),
        click.option("--in-place", is_flag=True, help="Write over IN, and keep it as IN.bak."),
        click.option("--force", is_flag=True, help="Replace files that exist."),
        click.option(
            "-o",
            "--output",
            metavar="OUT",
            help="The file, or for several IN the folder, to write.",
        ),
        click.argument("names", metavar="IN... [OUT]", nargs=-1, required=True),
    ):
        function = option(function)
    return function


def jobs_of(
    names: Sequence[str], output: str | None, *, in_place: bool, force: bool, writes: bool = True
) -> list[Job]:
    """What to read and where to write it.

    All names are inputs, but for the last of two where it cannot be mistaken: it does not exist,
    or `force` is given. A folder stands for the documents in it, which keep their places below it.
    UsageError for what would write over a file that was not named for it.
    """
    names = list(names)
    if not writes:
        if output is not None or in_place:
            raise click.UsageError(
                "Nothing is written with --dry-run: leave out -o and --in-place."
            )
        return [
            Job(source, None) for source, _ in _sources(names[:1] if _is_pair(names) else names)
        ]
    if in_place:
        if output is not None:
            raise click.UsageError("Use -o or --in-place, not both.")
        return [Job(source, source, in_place=True) for source, _ in _sources(names)]
    if output is None:
        output, names = _positional(names, force)
    several = len(names) > 1 or (names[0] != "-" and Path(names[0]).is_dir())
    if several or _is_folder(output):
        jobs = _into(names, Path(output), force)
    else:
        check_suffix(output)
        jobs = [Job(names[0], output)]
    _refuse_inputs(jobs)
    return jobs


def _is_pair(names: Sequence[str]) -> bool:
    """Whether the second of two names is none of a document that could be read."""
    return len(names) == 2 and names[1] != "-" and not Path(names[1]).exists()


def _positional(names: list[str], force: bool) -> tuple[str, list[str]]:
    """OUT and the IN before it, where there is no doubt."""
    if len(names) != 2:
        hint = "name it with -o OUT (a folder for several IN), or use --in-place"
        raise click.UsageError(f"It is not said where to write: {hint}.")
    output = names[1]
    if names[0] != "-" and Path(names[0]).is_dir() and not _is_folder(output):
        from colladaphy.source import rules

        hint = "The documents in it are written with -o FOLDER, or with --in-place."
        raise InputError(rules.FOLDER.at(file=names[0], hint=hint))
    there = output != "-" and os.path.lexists(output) and not _is_special(output)
    if there and not force:
        raise click.UsageError(
            f"{output!r} exists: is it to be read, or to be written? To write it, name it with "
            "-o, or use --force; to write several documents, name a folder with -o."
        )
    return output, names[:1]


def _is_special(name: str) -> bool:
    """Whether a name is that of a device or a pipe, where nothing can be lost."""
    path = Path(name)
    return path.exists() and not path.is_file() and not path.is_dir()


def _is_folder(name: str) -> bool:
    return name != "-" and (name.endswith(("/", os.sep)) or Path(name).is_dir())


def check_suffix(name: str) -> None:
    """BadParameter for the name of a file that says it is something else than COLLADA."""
    if name == "-" or _is_special(name) or name.lower().endswith(_SUFFIXES):
        return
    suffix = Path(name).suffix
    why = f"{suffix!r} is no suffix of COLLADA" if suffix else "it has no suffix"
    raise click.BadParameter(
        f"{name!r}: {why}. Name a .dae or .zae file, or a folder with a slash at its end.",
        param_hint="OUT",
    )


def _sources(names: Sequence[str]) -> Iterator[tuple[str, Path]]:
    """The documents that names mean, with the place that each has in a folder of outputs."""
    for name in names:
        path = Path(name)
        if name == "-" or not path.is_dir():
            yield name, Path(path.name)
            continue
        found = sorted(_documents(path))
        if not found:
            raise click.UsageError(f"There is no .dae or .zae in the folder {name!r}.")
        for file in found:
            yield str(file), file.relative_to(path)


def _documents(folder: Path) -> Iterator[Path]:
    for here, inner, files in os.walk(folder):
        inner[:] = [name for name in inner if not name.startswith(".")]
        for name in files:
            if name.lower().endswith((".dae", ".zae")) and not name.startswith("."):
                yield Path(here) / name


def _into(names: Sequence[str], folder: Path, force: bool) -> list[Job]:
    """Jobs that write into a folder."""
    if folder.exists() and not folder.is_dir():
        raise click.UsageError(f"Several documents need a folder, and {str(folder)!r} is a file.")
    if not folder.is_dir() and folder.suffix.lower() in _SUFFIXES:
        raise click.UsageError(
            f"Several documents need a folder; {str(folder)!r} looks like a file. "
            "If it is to be a folder, create it first."
        )
    jobs: list[Job] = []
    places: dict[Path, str] = {}
    for source, place in _sources(names):
        if source == "-":
            raise click.UsageError("Standard input has no name in a folder: use -o FILE.")
        target = folder / place
        if not target.name.lower().endswith(_SUFFIXES):
            target = target.with_name(target.name + ".dae")
        key = Path(os.path.realpath(target))
        if key in places:
            raise click.UsageError(f"{source!r} and {places[key]!r} would both be {str(target)!r}.")
        places[key] = source
        jobs.append(Job(source, str(target), below=True))
    known = {os.path.realpath(job.source) for job in jobs}
    there = [job.target for job in jobs
             if job.target and Path(job.target).exists()
             and os.path.realpath(job.target) not in known]  # fmt: skip
    if there and not force:
        more = f" and {len(there) - 1} more" if len(there) > 1 else ""
        raise click.UsageError(f"{there[0]!r}{more} exists; to replace what exists, use --force.")
    return jobs


def _refuse_inputs(jobs: Sequence[Job]) -> None:
    """Nothing that is read is written over, unless that is asked for."""
    sources = {_identity(job.source): job.source for job in jobs if job.source != "-"}
    for job in jobs:
        if job.target in (None, "-"):
            continue
        assert job.target is not None
        source = sources.get(_identity(job.target))
        if source is not None:
            raise click.UsageError(
                f"{job.target!r} is the input {source!r}: to write over it, use --in-place."
            )


def _identity(name: str) -> object:
    """What tells whether two names are one file: links of either kind are followed."""
    try:
        found = os.stat(name)  # noqa: PTH116 (its numbers are what is wanted)
    except (OSError, ValueError):
        return os.path.realpath(name)
    return found.st_dev, found.st_ino

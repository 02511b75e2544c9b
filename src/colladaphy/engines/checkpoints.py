"""Checkpoints in a folder: written atomically, rotated with care, and found again when whole."""

from __future__ import annotations

import contextlib
import io
import os
import re
import time
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from colladaphy.engines.carrying import SceneDocument, save_scene
from colladaphy.engines.checkpoint_rules import (
    CHECKPOINT_BROKEN,
    CHECKPOINT_NONE,
    CHECKPOINT_OTHER_RUN,
    CHECKPOINT_STATELESS,
)
from colladaphy.engines.digest import digest
from colladaphy.engines.rules import STEPS, refuse
from colladaphy.engines.state import recorded_digest
from colladaphy.errors import ColladaError, EngineError
from colladaphy.findings import Finding, Severity

if TYPE_CHECKING:
    from colladaphy.source import Limits
    from colladaphy.world import World

__all__ = ["Checkpoints", "Found", "open_checkpoint", "read_checkpoint"]

_PREFIX = "checkpoint-"
_NAME = re.compile(re.escape(_PREFIX) + r"(\d+)\.(?:dae|zae)")
_LEFTOVER = re.compile(r"\.colladaphy-(\d+-)?[0-9a-f]+\.tmp")
_ABANDONED = 600.0  # seconds after which a temporary file is nobody's


@dataclass(frozen=True, slots=True)
class Found:
    """A checkpoint that is whole, and what was passed over to find it."""

    path: Path
    world: World
    document: SceneDocument
    """The document that holds it."""
    findings: tuple[Finding, ...] = field(default=())

    @property
    def carried(self) -> SceneDocument | None:
        """The document, if there is more in it than the World; of a World alone there is none.

        So the checkpoints of a run that is resumed are those of the run that is not, to the byte.
        """
        from colladaphy.document import write

        alone = io.BytesIO()
        write(self.world, alone)
        return None if self.path.read_bytes() == alone.getvalue() else self.document


def read_checkpoint(path: str | os.PathLike[str]) -> World:
    """The World of a checkpoint, proven to be what was written; see `open_checkpoint`."""
    return open_checkpoint(path).world


def open_checkpoint(path: str | os.PathLike[str], limits: Limits | None = None) -> Found:
    """A checkpoint, proven to be what was written, within the limits of reading.

    EngineError (``engine-checkpoint-broken``) says why a file is not whole: it cannot be read, is
    not schema-valid, or its content does not fit its checksum. A scene without an engine's state is
    no checkpoint (``engine-checkpoint-stateless``).
    """
    from colladaphy.document import read

    shown = os.fsdecode(path)
    try:
        document = read(path, limits=limits)
        world: World = document.load()
    except ColladaError as error:
        reason = error.findings[0].message if error.findings else str(error)
        raise _broken(f"{Path(path).name} is not whole: {reason}", shown) from error
    if world.engine_state is None:
        message = f"{Path(path).name} is no checkpoint: it holds no state of an engine."
        raise EngineError(CHECKPOINT_STATELESS.at(message=message, file=shown))
    recorded = recorded_digest(world.engine_state)
    if recorded is None:
        raise _broken(f"{Path(path).name} has no checksum that can be understood.", shown)
    if recorded != digest(world):
        raise _broken(f"{Path(path).name} is not whole: it does not fit its checksum.", shown)
    return Found(Path(path), world, document)


def _broken(message: str, file: str) -> EngineError:
    return EngineError(CHECKPOINT_BROKEN.at(message=message, file=file, severity=Severity.ERROR))


class Checkpoints:
    """The checkpoints of one run, ``checkpoint-000000001000.dae`` after its 1000th step.

    Of the checkpoints up to the newest, `keep` stay. One is removed only when the newest has been
    read back and proven whole, so that at every moment the folder holds a good one, once it did.
    """

    def __init__(self, folder: str | os.PathLike[str], *, keep: int = 3) -> None:
        if keep < 1:
            raise refuse(STEPS, f"At least one checkpoint has to be kept, not {keep}.")
        self.folder = Path(folder)
        self.keep = keep

    def path(self, step_count: int) -> Path:
        """Where the checkpoint of a step is."""
        return self.folder / f"{_PREFIX}{step_count:012d}.dae"

    def paths(self) -> list[Path]:
        """The checkpoints in the folder, oldest first, whole or not."""
        try:
            names = sorted(entry.name for entry in self.folder.iterdir())
        except FileNotFoundError:
            return []
        except OSError as error:
            raise _unreadable(self.folder, error) from error
        steps = {name: int(match[1]) for name in names if (match := _NAME.fullmatch(name))}
        return [self.folder / name for name in sorted(steps, key=lambda name: (steps[name], name))]

    def begin(self) -> None:
        """Make the folder ready for a new run; EngineError if it holds another one's."""
        if self.paths():
            message = f"{self.folder} holds {len(self.paths())} checkpoints of a run already."
            raise refuse(CHECKPOINT_OTHER_RUN, message)
        self._make_folder()

    def save(self, world: World, document: SceneDocument | None = None) -> Path:
        """Write the checkpoint of `world` and remove those that are too many.

        `document` is the one that the World came from: it is updated, and all else of it is kept.
        OutputError if it cannot be written; EngineError if what was written cannot be read back.
        The older ones are untouched then.
        """
        self._make_folder()
        path = self.path(world.step_count)
        save_scene(world, path, document)
        older = [other for other in self.paths() if other != path and _step(other) <= _step(path)]
        surplus = older[: max(0, len(older) - self.keep + 1)]
        if surplus:
            read_checkpoint(path)
            for other in surplus:
                with contextlib.suppress(OSError):
                    other.unlink()
        self._sweep()
        return path

    def newest(self, limits: Limits | None = None) -> Found:
        """The newest checkpoint that is whole; findings name those that are not.

        EngineError if there is none, with the findings of all that were looked at.
        """
        passed: list[Finding] = []
        for path in reversed(self.paths()):
            try:
                found = open_checkpoint(path, limits)
            except EngineError as error:
                passed += (
                    CHECKPOINT_BROKEN.at(message=f.message, file=f.file) for f in error.findings
                )
                continue
            return replace(found, findings=tuple(passed))
        what = "No checkpoint is whole" if passed else "There is no checkpoint"
        message = f"{what} in {self.folder}."
        raise EngineError((CHECKPOINT_NONE.at(message=message, file=str(self.folder)), *passed))

    def _make_folder(self) -> None:
        from colladaphy.errors import OutputError
        from colladaphy.source.rules import OUTPUT_FAILED

        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            message = f"The folder for checkpoints cannot be made: {error.strerror}."
            raise OutputError(OUTPUT_FAILED.at(message=message, file=str(self.folder))) from error

    def _sweep(self) -> None:
        """Remove what killed processes left half-written long ago."""
        limit = time.time() - _ABANDONED
        with contextlib.suppress(OSError):
            for entry in self.folder.iterdir():
                if _LEFTOVER.fullmatch(entry.name) and entry.stat().st_mtime < limit:
                    entry.unlink()


def _step(path: Path) -> int:
    match = _NAME.fullmatch(path.name)
    return int(match[1]) if match else -1


def _unreadable(folder: Path, error: OSError) -> ColladaError:
    from colladaphy.errors import InputError
    from colladaphy.source.rules import UNREADABLE

    message = f"The folder of checkpoints cannot be read: {error.strerror}."
    return InputError(UNREADABLE.at(message=message, file=str(folder)))

"""The documents that arguments mean: files, folders and patterns."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from colladaphy.findings import Finding
from colladaphy.source import rules
from colladaphy.validation.configuration import Configurations
from colladaphy.validation.patterns import Patterns

__all__ = ["Gathered", "gather"]

_SUFFIXES = (".dae", ".zae")
_NAME = "Name a folder with documents, or documents themselves."
_SKIPPED = frozenset({"node_modules", "__pycache__"})


class Gathered:
    """What arguments mean: files to check, as they were written."""

    def __init__(self) -> None:
        self.files: list[str] = []
        self.faults: list[Finding] = []
        """Patterns that fit nothing, and folders that cannot be read or have no document."""
        self._seen: set[str] = set()

    def add(self, name: str) -> None:
        """One file, unless it was there before."""
        key = name if name == "-" else os.path.realpath(name)
        if key not in self._seen:
            self._seen.add(key)
            self.files.append(name)

    def refuse(self, error: OSError) -> None:
        """A folder that cannot be read."""
        message = f"The folder cannot be read: {error.strerror or error}."
        self.faults.append(rules.UNREADABLE.at(message=message, file=str(error.filename)))


def gather(
    arguments: Iterable[str],
    configurations: Configurations,
    exclude: Patterns | None = None,
    *,
    force_exclude: bool = False,
) -> Gathered:
    """Files by themselves, those in folders and below, those that fit a pattern: ``**/*.dae``.

    Folders give their ``.dae`` and ``.zae`` in any case, sorted, but none of hidden folders, and
    none that `exclude` or the configuration excludes. What is named itself is always there, unless
    exclusion is forced.
    """
    from glob import glob, has_magic

    exclude = exclude or Patterns()
    found = Gathered()

    def excluded(file: str) -> bool:
        path = Path(file)
        return exclude.match(path, None) or configurations.of(path.parent).excludes(path)

    for argument in arguments:
        pattern = argument != "-" and not os.path.lexists(argument) and has_magic(argument)
        # Path.glob has no patterns that begin at the root.
        named = sorted(glob(argument, recursive=True)) if pattern else [argument]  # noqa: PTH207
        if not named:
            message = f"No file fits the pattern {argument!r}."
            found.faults.append(rules.MISSING.at(message=message, file=argument))
        for name in named:
            files = [name]
            folder = name != "-" and os.path.isdir(name)  # noqa: PTH112 (no Path for each file)
            if folder:
                files = list(_documents(name, found.refuse))
                if not files and not pattern:
                    message = "There is no .dae or .zae file in this folder."
                    found.faults.append(rules.FOLDER.at(message=message, file=name, hint=_NAME))
            for file in files:
                chosen = folder or pattern or force_exclude
                if not chosen or file == "-" or not excluded(file):
                    found.add(file)
    return found


def _documents(folder: str, refuse: Callable[[OSError], None]) -> Iterator[str]:
    for here, folders, files in os.walk(folder, onerror=refuse):
        folders[:] = sorted(
            name for name in folders if not name.startswith(".") and name not in _SKIPPED
        )
        for name in sorted(files):
            if name.lower().endswith(_SUFFIXES):
                yield str(Path(here) / name)

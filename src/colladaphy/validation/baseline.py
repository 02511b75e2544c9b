"""Baselines: the findings that are known, so that only new ones are reported."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from colladaphy.errors import ConfigurationError
from colladaphy.findings import Report
from colladaphy.validation import rules
from colladaphy.validation.checking import Checked
from colladaphy.validation.fingerprints import Key, key_of, moved

__all__ = ["Baseline", "baseline_text"]

_VERSION = 1


class Baseline:
    """Known findings of files below the folder of the baseline's own file.

    A finding is known by its code, file, element, attribute and message, and as often as it was
    there when the baseline was written. Where siblings were added or removed, any element of the
    same path will do.
    """

    def __init__(self, file: Path, known: Counter[Key]) -> None:
        self._folder = file.resolve().parent
        self._left = known
        self._met: set[str] = set()
        self._alike: dict[Key, list[Key]] = {}
        for key in known:
            self._alike.setdefault(moved(key), []).append(key)

    @classmethod
    def read(cls, file: Path) -> Baseline:
        """ConfigurationError where it cannot be read, or is no baseline."""
        try:
            content = json.loads(file.read_bytes())
            known: Counter[Key] = Counter()
            if content["version"] != _VERSION:
                raise ValueError
            for entry in content["findings"]:
                key = tuple(entry[name] for name in ("code", "file", "path", "attribute",
                                                     "message"))  # fmt: skip
                if not all(isinstance(part, str) for part in key):
                    raise TypeError
                known[key] += int(entry["count"])
        except OSError as error:
            message = f"The baseline cannot be read: {error.strerror or error}."
            raise ConfigurationError(
                rules.BASELINE_UNREADABLE.at(message=message, file=str(file))
            ) from None
        except (ValueError, KeyError, TypeError, RecursionError):
            raise ConfigurationError(rules.BASELINE_BROKEN.at(file=str(file))) from None
        return cls(file, known)

    @property
    def gone(self) -> int:
        """How many findings of the files that were checked are there no more."""
        return sum(count for key, count in self._left.items() if key[1] in self._met)

    def apply(self, checked: Checked) -> Checked:
        """What is not known; a file that cannot be read is never known."""
        if not checked.readable:
            return checked
        report = checked.report
        keys = _keys(report, self._folder)
        self._met.add(_name(report.file or "", self._folder))
        # First those that are where they were, so that a new one among siblings is the one left.
        left = [
            (finding, key) for finding, key in zip(report, keys, strict=True) if not self._take(key)
        ]
        new = [
            finding
            for finding, key in left
            if not any(self._take(other) for other in self._alike.get(moved(key), ()))
        ]
        return replace(checked, report=Report(report.file, new), known=len(keys) - len(new))

    def _take(self, key: Key) -> bool:
        if self._left[key] < 1:
            del self._left[key]
            return False
        self._left[key] -= 1
        return True


def baseline_text(results: Iterable[Checked], file: Path) -> str:
    """The baseline of these results, to be written to `file`: sorted, an entry a line."""
    folder = file.resolve().parent
    known: Counter[Key] = Counter()
    for result in results:
        if result.readable:
            known.update(_keys(result.report, folder))
    entries = [_entry(key, count) for key, count in sorted(known.items())]
    lines = ",\n    ".join(json.dumps(entry) for entry in entries)
    listed = f"[\n    {lines}\n  ]" if lines else "[]"
    return f'{{\n  "version": {_VERSION},\n  "findings": {listed}\n}}\n'


def _entry(key: Key, count: int) -> dict[str, Any]:
    code, file, path, attribute, message = key
    return {"file": file, "code": code, "path": path, "attribute": attribute, "message": message,
            "count": count}  # fmt: skip


def _keys(report: Report, folder: Path) -> list[Key]:
    """The keys of the findings of a report."""
    names: dict[str, str] = {}
    keys = []
    for finding in report:
        file = finding.file or report.file or ""
        if file not in names:
            names[file] = _name(file, folder)
        keys.append(key_of(finding, names[file]))
    return keys


def _name(file: str, folder: Path) -> str:
    """The name of a file from the baseline's folder, alike on every system."""
    if file in ("", "-"):
        return file
    return Path(os.path.relpath(Path(file).resolve(), folder)).as_posix()

"""Where a finding stands, as other programs name places: a file on disk, and what is in it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from colladaphy.findings import Finding, Report

__all__ = ["Place", "labelled", "place_of", "split_member"]


@dataclass(frozen=True, slots=True)
class Place:
    """A file as one can open it, and where in it.

    In an archive, `member` is the entry and `within` the line and column of it; the archive itself
    has no lines.
    """

    file: str
    line: int | None = None
    column: int | None = None
    member: str | None = None
    within: str = ""


def place_of(finding: Finding, report: Report) -> Place:
    """The place of a finding; files below the current folder are named from there, with /."""
    file, member = split_member(finding.file or report.file or "-")
    name = _shown(file)
    if member is None:
        return Place(name, finding.line, finding.column)
    within = ":".join(str(part) for part in (member, finding.line, finding.column) if part)
    return Place(name, member=member, within=within)


def split_member(file: str) -> tuple[str, str | None]:
    """The archive and its entry that a name such as ``scene.zae!parts/arm.dae`` means."""
    if "!" not in file or os.path.lexists(file):
        return file, None
    at = file.find("!")
    while at >= 0:
        if Path(file[:at]).is_file() or file[:at].lower().endswith(".zae"):
            return file[:at], file[at + 1 :]
        at = file.find("!", at + 1)
    return file, None


def labelled(finding: Finding, place: Place) -> str:
    """The message; in archives after the place in them, which the file's own place cannot say."""
    return f"{place.within}: {finding.message}" if place.member else finding.message


def _shown(file: str) -> str:
    if file == "-":
        return file
    path = Path(file)
    if path.is_absolute():
        try:
            path = path.relative_to(Path.cwd())
        except ValueError:
            return path.as_posix()
    return path.as_posix()

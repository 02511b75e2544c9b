"""Reports to files."""

from __future__ import annotations

from collections.abc import Sequence

from colladaphy.cli.files import target_of
from colladaphy.findings import Report
from colladaphy.source import save
from colladaphy.validation.reporters import as_json, as_text

__all__ = ["write_reports"]


def write_reports(reports: Sequence[Report], file: str) -> None:
    """Write reports, as JSON where the file's name ends in .json, else as text."""
    if file.lower().endswith(".json"):
        text = as_json(reports)
    else:
        text = "\n".join(line for report in reports for line in as_text(report))
    save((text + "\n").encode("utf-8", "backslashreplace"), target_of(file))

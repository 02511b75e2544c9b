"""Reports to files."""

from __future__ import annotations

from colladaphy.cli.files import target_of
from colladaphy.findings import Report
from colladaphy.source import save
from colladaphy.validation.reporters import as_json, as_text

__all__ = ["write_report"]


def write_report(report: Report, file: str) -> None:
    """Write a report, as JSON where the file's name ends in .json, else as text."""
    text = as_json([report]) if file.lower().endswith(".json") else "\n".join(as_text(report))
    save((text + "\n").encode("utf-8", "backslashreplace"), target_of(file))

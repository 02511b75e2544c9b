"""The JSON report; ``report.schema.json`` says what is in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from colladaphy.findings import Finding, Report
from colladaphy.validation.checking import Checked
from colladaphy.validation.reporters.presentation import Presentation
from colladaphy.validation.reporters.totals import Totals
from colladaphy.validation.settings import Settings
from colladaphy.version import __version__

__all__ = ["FORMAT_VERSION", "as_json", "json_schema", "render"]

#: Counted up when a key is removed or means something else; new keys may come at any time.
FORMAT_VERSION = 1


def json_schema() -> str:
    """The JSON schema (draft 2020-12) that every JSON report keeps to."""
    return (Path(__file__).parent / "report.schema.json").read_text("utf-8")


def as_json(reports: Iterable[Report | Checked]) -> str:
    """All reports as one JSON document, in ASCII, so that no console can spoil it."""
    import json  # not for those who only offer this format

    results = [
        report if isinstance(report, Checked) else Checked(report, Settings()) for report in reports
    ]
    content = {
        "version": FORMAT_VERSION,
        "tool": {"name": "colladaphy", "version": __version__},
        "summary": Totals(results).as_dict(),
        "files": [_file(result) for result in results],
    }
    return json.dumps(content, indent=2)


def render(results: Iterable[Checked], _: Presentation) -> Iterator[str]:
    """The report as one text; every finding is in it."""
    yield as_json(results)


def _file(result: Checked) -> dict[str, Any]:
    report = result.report
    return {
        "path": report.file,
        "readable": result.readable,
        "valid": result.readable and report.valid,
        "counts": report.counts,
        "ignored": result.ignored,
        "in_baseline": result.known,
        "findings": [_finding(finding, report) for finding in report],
    }


def _finding(finding: Finding, report: Report) -> dict[str, Any]:
    return finding.as_dict() | {"file": finding.file or report.file}

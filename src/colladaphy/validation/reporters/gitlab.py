"""GitLab's code quality report (the format of Code Climate's issues)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from colladaphy.findings import Severity
from colladaphy.validation.checking import Checked
from colladaphy.validation.fingerprints import fingerprints
from colladaphy.validation.reporters.places import labelled, place_of
from colladaphy.validation.reporters.presentation import Presentation

__all__ = ["render"]

_LEVELS = {Severity.ERROR: "major", Severity.WARNING: "minor"}


def render(results: Iterable[Checked], _: Presentation) -> Iterator[str]:
    """The report as one text. A finding whose line is not known stands at the first."""
    found = [(finding, result.report) for result in results for finding in result.report]
    places = [place_of(finding, report) for finding, report in found]
    marks = fingerprints(
        (finding, f"{place.file}!{place.member or ''}")
        for (finding, _report), place in zip(found, places, strict=True)
    )
    issues = [
        {
            "type": "issue",
            "check_name": finding.code,
            "description": labelled(finding, place),
            "categories": ["Bug Risk"],
            "severity": _LEVELS.get(finding.severity, "info"),
            "fingerprint": mark,
            "location": {"path": place.file, "lines": {"begin": place.line or 1}},
        }
        for (finding, _report), place, mark in zip(found, places, marks, strict=True)
    ]
    yield json.dumps(issues, indent=2)

"""The JSON report."""

from __future__ import annotations

import json
from collections.abc import Iterable

from colladaphy.findings import Report

__all__ = ["as_json"]


def as_json(reports: Iterable[Report]) -> str:
    """All reports as one JSON document, in ASCII, so that no console can spoil it."""
    return json.dumps({"files": [report.as_dict() for report in reports]}, indent=2)

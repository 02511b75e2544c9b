"""Findings of one kind together, and no more of them than a reader wants."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from colladaphy.findings import Finding, Report

__all__ = ["Group", "grouped"]

_LISTED = 5


class Group(NamedTuple):
    """The findings of one kind in a file: those to show, and the rest."""

    shown: Sequence[Finding]
    rest: Sequence[Finding]

    def more(self) -> str:
        """``… and 23 more like it (lines 4, 9, …)``."""
        count = len(self.rest)
        lines = list(dict.fromkeys(found.line for found in self.rest if found.line is not None))
        listed = ", ".join(map(str, lines[:_LISTED])) + ", …" * (len(lines) > _LISTED)
        where = f" (line{'s' * (len(lines) > 1)} {listed})" if lines else ""
        return f"… and {count} more like it{where}"


def grouped(report: Report, most: int | None) -> list[Group]:
    """The findings of a report by their code and severity, in the order of each one's first."""
    kinds: dict[tuple[str, str], list[Finding]] = {}
    for finding in report:
        kinds.setdefault((finding.code, finding.severity), []).append(finding)
    return [Group(kind[:most], () if most is None else kind[most:]) for kind in kinds.values()]

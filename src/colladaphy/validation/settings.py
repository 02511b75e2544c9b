"""Which findings are reported, and how grave they are: what a configuration says of one file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from colladaphy.findings import Finding, Report, Severity

__all__ = ["ALL", "Settings", "fatal"]

#: The name that stands for every code.
ALL = "all"

_FATAL_STAGES = ("io", "xml")
_OF_REFERENCES = "io-reference-"


def fatal(code: str) -> bool:
    """Whether a finding of this code keeps a document from being read.

    Such findings are always reported, as errors: nothing is known about the rest.
    """
    return code.partition("-")[0] in _FATAL_STAGES and not code.startswith(_OF_REFERENCES)


@dataclass(frozen=True, slots=True)
class Settings:
    """How one document is checked, and what is reported of it.

    `select`, `ignore` and the keys of `severity` are codes, beginnings of codes (``schema``,
    ``physics-mass``) or ``all``. The longest that fits a code decides; `ignore` does where both
    are as long.
    """

    select: tuple[str, ...] = (ALL,)
    ignore: tuple[str, ...] = ()
    severity: Mapping[str, Severity] = field(default_factory=dict)
    collada_14: Severity | None = Severity.ERROR
    fail_level: Severity = Severity.ERROR

    def changed(self, keys: Mapping[str, Any]) -> Settings:
        """Other values for some; what `ignore` and `severity` say is added to what they said."""
        changes = dict(keys)
        if "ignore" in changes:
            changes["ignore"] = (*self.ignore, *changes["ignore"])
        if "severity" in changes:
            changes["severity"] = {**self.severity, **changes["severity"]}
        return replace(self, **changes)

    def reports(self, code: str) -> bool:
        """Whether findings of this code are reported."""
        return fatal(code) or _longest(code, self.select) > _longest(code, self.ignore)

    def level(self, finding: Finding) -> Severity:
        """How grave a finding is."""
        if fatal(finding.code):
            return finding.severity
        name = max(
            (name for name in self.severity if _fits(finding.code, name)), key=_weight, default=None
        )
        return finding.severity if name is None else self.severity[name]

    def apply(self, report: Report) -> tuple[Report, int]:
        """What is reported of a report, with these severities, and how much is left out."""
        kept = [finding for finding in report if self.reports(finding.code)]
        changed = [replace(finding, severity=self.level(finding)) for finding in kept]
        return Report(report.file, changed), len(report) - len(kept)

    def grave(self, finding: Finding) -> bool:
        """Whether a finding is grave enough to fail the check."""
        levels = list(Severity)
        return levels.index(finding.severity) <= levels.index(self.fail_level)


def _fits(code: str, name: str) -> bool:
    return name == ALL or code == name or code.startswith(f"{name}-")


def _weight(name: str) -> int:
    return 0 if name == ALL else len(name)


def _longest(code: str, names: Sequence[str]) -> int:
    return max((_weight(name) for name in names if _fits(code, name)), default=-1)

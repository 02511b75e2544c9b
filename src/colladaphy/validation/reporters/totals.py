"""What a whole run has found: how many files, findings and kinds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from colladaphy.findings import Severity
from colladaphy.validation.checking import Checked

__all__ = ["Totals", "counted"]

_PLURALS = {"error": "errors", "warning": "warnings", "info": "infos", "hint": "hints"}


def counted(counts: dict[str, int]) -> str:
    """Numbers of findings by severity, in words."""
    return ", ".join(
        f"{count} {severity if count == 1 else _PLURALS[severity]}"
        for severity, count in counts.items()
        if count
    )


class Totals:
    """The sums over all files, gathered as they come."""

    def __init__(self, results: Iterable[Checked] = ()) -> None:
        self.files = self.valid = self.unreadable = 0
        self.mendable = self.ignored = self.known = 0
        self.by_code: Counter[str] = Counter()
        self.by_severity: Counter[str] = Counter()
        self.mendable_codes: Counter[str] = Counter()
        for result in results:
            self.add(result)

    def add(self, result: Checked) -> None:
        """Count one file."""
        self.files += 1
        self.unreadable += not result.readable
        self.valid += result.readable and result.report.valid
        self.ignored += result.ignored
        self.known += result.known
        for finding in result.report:
            self.by_code[finding.code] += 1
            self.by_severity[str(finding.severity)] += 1
            if finding.repair is not None:
                self.mendable += 1
                self.mendable_codes[finding.code] += 1

    @property
    def findings(self) -> int:
        """How many findings there are in all."""
        return self.by_code.total()

    def as_dict(self) -> dict[str, Any]:
        """The sums as the JSON report spells them."""
        return {
            "files": self.files,
            "valid": self.valid,
            "not_valid": self.files - self.valid - self.unreadable,
            "unreadable": self.unreadable,
            "findings": self.findings,
            "fixable": self.mendable,
            "ignored": self.ignored,
            "in_baseline": self.known,
            "by_severity": {str(severity): self.by_severity[severity] for severity in Severity},
            "by_code": dict(sorted(self.by_code.items())),
        }

    def line(self) -> str:
        """``21 files: 1 valid, 20 not; 312 findings of 9 kinds, 280 mendable``."""
        parts = [_number(self.files, "file") + ": " + ", ".join(self._files())]
        if self.findings:
            found = f"{_number(self.findings, 'finding')} of {_number(len(self.by_code), 'kind')}"
            parts.append(found + (f", {self.mendable} mendable" if self.mendable else ""))
        parts += hidden(self.ignored, self.known)
        return "; ".join(parts)

    def _files(self) -> Sequence[str]:
        broken = self.files - self.valid - self.unreadable
        words = [f"{self.valid} valid"]
        if broken:
            words.append(f"{broken} not")
        if self.unreadable:
            words.append(f"{self.unreadable} unreadable")
        return words

    def statistics(self) -> list[str]:
        """A line a code, the most frequent first: number, code, whether repair mends it."""
        from colladaphy.validation.catalogue import find_rule

        rows = sorted(self.by_code.items(), key=lambda row: (-row[1], row[0]))
        width = max((len(code) for code in self.by_code), default=0)
        size = max((len(str(count)) for count in self.by_code.values()), default=0)
        lines = []
        for code, count in rows:
            rule = find_rule(code)
            mark = "[*]" if self.mendable_codes[code] else "   "
            summary = rule.summary if rule is not None else ""
            lines.append(f"{count:>{size}}  {code:{width}}  {mark} {summary}".rstrip())
        if self.mendable:
            lines.append(f"[*] 'colladaphy repair IN OUT' mends {self.mendable} of them.")
        return lines


def hidden(ignored: int, known: int) -> list[str]:
    """What was left out, in words; nothing where nothing was."""
    words = []
    if ignored:
        words.append(f"{ignored} left out by the configuration")
    if known:
        words.append(f"{known} known from the baseline")
    return words


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'s' * (count != 1)}"

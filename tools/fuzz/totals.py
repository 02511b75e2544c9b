"""What all rounds gave together, and how it is told."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from colladaphy.testing import Coverage
from colladaphy.validation.catalogue import all_rules
from tools.fuzz.rounds import Failure, Round

__all__ = ["Tally", "Totals", "merged"]


@dataclass
class Tally:
    """Of one property."""

    examples: int = 0
    rejected: int = 0
    seconds: float = 0.0
    failures: int = 0

    @property
    def rate(self) -> float:
        """Examples in a second of CPU time."""
        return self.examples / self.seconds if self.seconds else 0.0


@dataclass
class Totals:
    """Of all properties."""

    tallies: dict[str, Tally] = field(default_factory=dict)
    codes: Counter[str] = field(default_factory=Counter)
    components: set[str] = field(default_factory=set)
    failures: dict[str, Failure] = field(default_factory=dict)
    """By property and kind."""
    wall: float = 0.0

    def add(self, found: Round) -> list[Failure]:
        """Take up what a round gave; returns the failures that are new."""
        tally = self.tallies.setdefault(found.name, Tally())
        tally.examples += found.examples
        tally.rejected += found.rejected
        tally.seconds += found.seconds
        tally.failures += len(found.failures)
        self.codes.update(found.codes)
        self.components.update(str(component) for component in found.components)
        new = []
        for failure in found.failures:
            key = f"{failure.name}: {failure.kind}"
            if key not in self.failures:
                self.failures[key] = failure
                new.append(failure)
        return new

    def lines(self) -> list[str]:
        """The report, as text."""
        made = [f"{'property':34}{'examples':>10}{'rejected':>10}{'CPU h':>8}{'a second':>10}"
                f"{'failures':>10}"]  # fmt: skip
        for name, tally in sorted(self.tallies.items()):
            made.append(
                f"{name:34}{tally.examples:10,}{tally.rejected:10,}{tally.seconds / 3600:8.2f}"
                f"{tally.rate:10.1f}{tally.failures:10}"
            )
        every = self.tallies.values()
        made.append(
            f"{'all':34}{sum(each.examples for each in every):10,}"
            f"{sum(each.rejected for each in every):10,}"
            f"{sum(each.seconds for each in every) / 3600:8.2f}"
        )
        made.append(f"in {self.wall / 3600:.2f} hours of the clock, of all processes together")
        rules = {rule.code for rule in all_rules()}
        seen = rules & self.codes.keys()
        made.append(f"rules that were broken at least once: {len(seen)} of {len(rules)}")
        if missed := sorted(rules - seen):
            made.append("  never: " + ", ".join(missed))
        reachable = {str(component) for component in Coverage().reachable}
        made.append(
            f"components of the schema in documents: {len(reachable & self.components)} "
            f"of {len(reachable)}"
        )
        for key, failure in sorted(self.failures.items()):
            made.append(f"FAILED {key}\n  kept in {failure.file}")
        return made

    def save(self, path: Path) -> None:
        """Write the totals as JSON."""
        content = {
            "tallies": {name: asdict(tally) for name, tally in self.tallies.items()},
            "codes": dict(self.codes),
            "components": sorted(self.components),
            "failures": {key: asdict(failure) for key, failure in self.failures.items()},
            "wall": self.wall,
        }
        path.write_text(json.dumps(content, indent=1), "utf-8")


def merged(paths: list[Path]) -> Totals:
    """The sum of totals that were saved."""
    totals = Totals()
    for path in paths:
        content: dict[str, Any] = json.loads(path.read_text("utf-8"))
        for name, tally in content["tallies"].items():
            mine = totals.tallies.setdefault(name, Tally())
            for key, value in tally.items():
                setattr(mine, key, getattr(mine, key) + value)
        totals.codes.update(content["codes"])
        totals.components.update(content["components"])
        totals.wall += content["wall"]
        for key, failure in content["failures"].items():
            totals.failures.setdefault(key, Failure(**failure))
    return totals

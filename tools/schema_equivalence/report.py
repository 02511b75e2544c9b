"""What a comparison finds: differences, and how much was compared."""

from collections import Counter
from dataclasses import dataclass, field

KINDS = ("types", "elements", "attributes", "states")
"""What is counted: pairs of types, of element declarations, of attributes, of automaton states."""


@dataclass(frozen=True)
class Difference:
    """One thing that differs: where, in which respect, and what each side has."""

    path: str
    aspect: str
    ours: str
    official: str

    def __str__(self) -> str:
        return f"{self.path}: {self.aspect}: ours {self.ours}, official {self.official}"


@dataclass
class Comparison:
    """All differences, in the order of the walk, and the counts of what was compared."""

    differences: list[Difference] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)

    def expect(self, path: str, aspect: str, ours: object, official: object) -> bool:
        """Notes a difference unless both are equal; says whether they are."""
        if ours == official:
            return True
        self.differences.append(Difference(path, aspect, show(ours), show(official)))
        return False

    def counted(self) -> str:
        return ", ".join(f"{self.counts[kind]} {kind}" for kind in KINDS)


def show(value: object) -> str:
    """A value as it reads in a message: sets sorted, so that the output is deterministic."""
    if value is None:
        return "none"
    if isinstance(value, set | frozenset):
        return "{" + ", ".join(sorted(map(show, value))) + "}"
    if isinstance(value, tuple):
        return "(" + ", ".join(map(show, value)) + ")"
    return str(value)

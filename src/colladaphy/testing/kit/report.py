"""What the battery found out about an importer."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from hypothesis import strategies as st

__all__ = ["Check", "Failure", "ImporterReport", "MismatchError"]

_SHOWN = 4000
"""Characters of an example that the text of a report has at most."""


class MismatchError(AssertionError):
    """What an importer made of an example is not what it should be."""


@dataclass(frozen=True, slots=True)
class Check:
    """One property of an importer: examples, and what must hold of them.

    `holds` takes an example and a list, in which it leaves the document that the importer was
    given last, and raises `MismatchError` where something does not hold.
    """

    name: str
    about: str
    examples: st.SearchStrategy[Any]
    holds: Any


@dataclass(frozen=True, slots=True)
class Failure:
    """A check that an importer did not pass, with the smallest example that was found."""

    check: str
    about: str
    message: str
    """What is wrong: the differences, or the exception."""
    document: bytes | None
    """The document that the importer was given last."""
    error: BaseException

    def __str__(self) -> str:
        lines = [f"{self.check}: {self.about}", *(f"  {line}" for line in self.message.split("\n"))]
        if self.document is not None:
            text = self.document[:_SHOWN].decode("utf-8", "backslashreplace")
            more = len(self.document) - _SHOWN
            lines += ["  with this document:", *(f"    {line}" for line in text.split("\n"))]
            lines += [f"    … and {more} bytes more"] * (more > 0)
        return "\n".join(lines)


@dataclass(slots=True)
class ImporterReport:
    """Which checks ran, with how many examples, and which failed."""

    counts: dict[str, int] = field(default_factory=dict)
    """Examples that each check took, those of shrinking included."""
    failures: list[Failure] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether every check was passed."""
        return not self.failures

    def __str__(self) -> str:
        wrong = {failure.check for failure in self.failures}
        lines = [
            f"{'failed' if name in wrong else 'passed'}  {name} ({count} examples)"
            for name, count in self.counts.items()
        ]
        return "\n".join([*lines, *(f"\n{failure}" for failure in self.failures)])

"""What a reporter is told beside the results."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from colladaphy.validation.reporters.sources import Sources

__all__ = ["Paint", "Presentation", "plain", "printable"]

Paint = Callable[[str, str], str]


def plain(text: str, _: str) -> str:
    """A text without colour."""
    return text


def printable(text: str) -> str:
    """Tabs as spaces, and nothing that a terminal would obey: names and texts are of others."""
    if text.isprintable():
        return text
    return "".join(
        "    " if char == "\t" else char if char.isprintable() else "\ufffd" for char in text
    )


@dataclass(frozen=True, slots=True)
class Presentation:
    """How text is to look; formats for programs say everything and heed none of it."""

    paint: Paint = plain
    """Colours a text by the name of a severity."""
    most: int | None = None
    """How many findings of a kind are shown of each file; None: all."""
    quiet: bool = False
    """Whether only findings are shown: no line about each file, no summary."""
    statistics: bool = False
    """Whether the codes are counted in place of the findings."""
    sources: Sources = field(default_factory=Sources)

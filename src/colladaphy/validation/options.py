"""What a check may be told."""

from __future__ import annotations

from dataclasses import dataclass

from colladaphy.findings import Severity

__all__ = ["HUGE", "LARGE", "MANY", "NOTHING_BEHIND", "Options", "is_large"]

LARGE = 1 << 23
MANY = 150_000
"""Bytes and elements of documents of which no copy is mended, neither to look at what is behind
their faults of form, nor to tell which repair mends a finding: that takes many times as long as the
check. What is long but has few elements, as meshes are, is mended soon."""

HUGE = 1 << 25
"""Bytes of documents of which nothing is looked at behind their faults of form."""

NOTHING_BEHIND = "The document is large: what stands behind its faults was not looked at."


@dataclass(frozen=True, slots=True)
class Options:
    """How `validate` checks a document."""

    collada_14: Severity | None = Severity.ERROR
    """How much it matters that a document is COLLADA 1.4, not 1.5; None: not at all."""


def is_large(data: bytes) -> bool:
    """Whether no copy of a document is mended to check it."""
    if len(data) < LARGE:
        return False
    return len(data) >= HUGE or data.count(b"<") >= 2 * MANY  # start tags and end tags

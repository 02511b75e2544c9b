"""What can be wrong with kinematics in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

AXIS = Rule(
    "kinematics-axis",
    Severity.ERROR,
    "A joint has no axis.",
    "Give it a direction: x y z, not all zero.",
    "COLLADA 1.5 §axis",
    "Which way it turns or slides cannot be told.",
)
LIMITS = Rule(
    "kinematics-limits",
    Severity.ERROR,
    "The lower limit of a joint is above the upper one, or is no number.",
    "Exchange them; a joint without limits has no <limits>.",
    "COLLADA 1.5 §limits",
    "There is no position that it can have.",
)

RULES = (
    AXIS,
    LIMITS,
)

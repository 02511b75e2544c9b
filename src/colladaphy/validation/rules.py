"""What can be wrong with the configuration and the baseline of a check."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

_ERROR = Severity.ERROR
_DOCS = "colladaphy docs/validate.md §Configuration"
_BASELINE = "colladaphy docs/validate.md §Baseline"

UNREADABLE = Rule(
    "config-unreadable",
    _ERROR,
    "The configuration cannot be read.",
    "Check that the file is there and that you may read it; --isolated does without it.",
    _DOCS,
    "A check that leaves its configuration aside would report other findings than were asked for.",
)
SYNTAX = Rule(
    "config-syntax",
    _ERROR,
    "The configuration is not TOML.",
    "Correct the file at this place (https://toml.io).",
    _DOCS,
    "What stands behind the fault cannot be read, so nothing of the configuration is taken.",
)
UNKNOWN_KEY = Rule(
    "config-unknown-key",
    _ERROR,
    "The configuration has a key that there is not.",
    "Correct its spelling, or remove it.",
    _DOCS,
    "A misspelt key would be without effect, and nobody would notice.",
)
UNKNOWN_CODE = Rule(
    "config-unknown-code",
    _ERROR,
    "The configuration names a code or a stage that there is not.",
    "'colladaphy rules' lists all codes.",
    _DOCS,
    "A misspelt code would select or ignore nothing, and nobody would notice.",
)
WRONG_VALUE = Rule(
    "config-wrong-value",
    _ERROR,
    "A key of the configuration has a value that it cannot have.",
    "Correct the value.",
    _DOCS,
    "What was meant cannot be guessed.",
)
BASELINE_UNREADABLE = Rule(
    "config-baseline-unreadable",
    _ERROR,
    "The baseline cannot be read.",
    "Write it with --write-baseline FILE.",
    _BASELINE,
    "Without it, every known finding would be reported as a new one.",
)
BASELINE_BROKEN = Rule(
    "config-baseline-broken",
    _ERROR,
    "The file is not a baseline of this version.",
    "Write it anew with --write-baseline FILE.",
    _BASELINE,
    "Without it, every known finding would be reported as a new one.",
)

RULES = (
    UNREADABLE,
    SYNTAX,
    UNKNOWN_KEY,
    UNKNOWN_CODE,
    WRONG_VALUE,
    BASELINE_UNREADABLE,
    BASELINE_BROKEN,
)

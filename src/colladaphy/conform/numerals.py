"""Numbers as other countries and programs write them: commas, suffixes, unfinished exponents.

A comma is a decimal mark (``-9,81``), a separator (``1, 2, 3``) or both (``1,5, 2,5``). Which it
is, the tokens of a list say: it separates only where they need it, that is where a token would
hold two marks, or where only then there are as many numbers as belong there.
"""

from __future__ import annotations

import re

__all__ = ["may_lack_digits", "plain_numbers", "spelled_number"]

_SEPARATORS = re.compile(r"[\s;]+")
_DECIMAL = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?", re.ASCII)
# 1,234.5 and 1.234,5: with both signs there is no doubt which one groups.
_GROUPED = (
    (re.compile(r"[+-]?[0-9]{1,3}(?:,[0-9]{3})+\.[0-9]*(?:[eE][+-]?[0-9]+)?", re.ASCII), ","),
    (re.compile(r"[+-]?[0-9]{1,3}(?:\.[0-9]{3})+,[0-9]*(?:[eE][+-]?[0-9]+)?", re.ASCII), "."),
)
_MANTISSA = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
_UNFINISHED = re.compile(rf"({_MANTISSA})[eE][+-]?", re.ASCII)
_FORTRAN = re.compile(rf"({_MANTISSA})[dD]([+-]?[0-9]+)", re.ASCII)
_IN_BYTES = re.compile(rb"[0-9.][eE][+-]?[\s<\"']")
_SUFFIXED = re.compile(rf"({_MANTISSA}(?:[eE][+-]?[0-9]+)?)[fFdDlL]", re.ASCII)


def plain_numbers(text: str, low: int = 0, high: int = 1 << 30) -> tuple[str, bool]:
    """A list of numbers without commas and semicolons, and whether a comma was a decimal mark.

    `low` and `high` say how many numbers belong there. Nothing is left out: a list may be of
    another length, and what is no number stays what it is.
    """
    tokens = [token for part in _SEPARATORS.split(text) if (token := part.strip(","))]
    if not any("," in token for token in tokens):
        return " ".join(tokens), False
    split = [part for token in tokens for part in token.split(",") if part]
    decimals = [_decimal(token) for token in tokens]
    if any(word is None for word in decimals):
        return " ".join(split), False
    if low <= len(split) <= high and not low <= len(tokens) <= high:
        return " ".join(split), False
    return " ".join(word for word in decimals if word is not None), True


def _decimal(token: str) -> str | None:
    """A token whose one comma is a decimal mark; None where it cannot be one."""
    if "," not in token:
        return token
    if _DECIMAL.fullmatch(token):
        return token.replace(",", ".")
    for pattern, grouping in _GROUPED:
        if pattern.fullmatch(token):
            return token.replace(grouping, "").replace(",", ".")
    return None


def spelled_number(text: str) -> str | None:
    """A number that programs write and XML does not know: ``1e``, ``2.5f``, ``1d-3``."""
    if found := _UNFINISHED.fullmatch(text):
        return found[1]
    if found := _FORTRAN.fullmatch(text):
        return f"{found[1]}e{found[2]}"
    if found := _SUFFIXED.fullmatch(text):
        return found[1]
    return None


def may_lack_digits(data: bytes) -> bool:
    """Whether a text may hold numbers such as ``1e``, which libxml2 takes for valid."""
    return _IN_BYTES.search(data) is not None

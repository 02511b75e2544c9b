"""Names as COLLADA's attributes keep them, and ids that are made of system ids."""

from __future__ import annotations

__all__ = ["same_token", "system_id", "token"]

_BLANKS = str.maketrans("\t\n\r", "   ")


def token(text: str) -> str:
    """What a reader makes of `text` as xs:token: runs of blanks are one, none at the ends."""
    return " ".join(part for part in text.translate(_BLANKS).split(" ") if part)


def same_token(one: str, other: str | None) -> bool:
    """Whether two names are the same as xs:token, which keeps no runs of blanks."""
    return other is not None and token(one) == token(other)


def system_id(sid: str, prefix: str) -> int | None:
    """The system id that one of our own sids is made of (thesis 5.4)."""
    digits = sid.removeprefix(prefix)
    if digits == sid or not digits.isascii() or not digits.isdigit() or len(digits) > 18:
        return None
    return int(digits)

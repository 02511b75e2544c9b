"""Texts of simple types: a strategy for each type, and one fixed example of each."""

from __future__ import annotations

import math
import re
import string
from collections.abc import Callable
from datetime import datetime

from hypothesis import strategies as st

from colladaphy.conform.grammar import SimpleType

__all__ = ["example", "texts"]

INTEGERS: dict[str, tuple[int | None, int | None]] = {
    "integer": (None, None),
    "nonNegativeInteger": (0, None),
    "positiveInteger": (1, None),
    "long": (-(2**63), 2**63 - 1),
    "int": (-(2**31), 2**31 - 1),
    "short": (-(2**15), 2**15 - 1),
    "byte": (-(2**7), 2**7 - 1),
    "unsignedLong": (0, 2**64 - 1),
    "unsignedInt": (0, 2**32 - 1),
    "unsignedByte": (0, 2**8 - 1),
}
LIMIT = 2**63
"""How far integers without a bound go; and no list without a length is longer than LONGEST."""
LONGEST = 5

NAME_START = string.ascii_letters + "_" + "éλ"
NAME = NAME_START + string.digits + "-."
SEPARATORS = [" ", " ", " ", "  ", "\n", "\t "]

XML_CLASSES = {
    r"[\i-[:]]": f"[{NAME_START}]",
    r"[\c-[:]]": f"[{string.ascii_letters}{string.digits}_.éλ\\-]",
    r"[\i-[:\.]]": f"[{NAME_START}]",
    r"\{-~": "{~",  # libxml2 takes an escaped character for no start of a range
}
"""Character classes that Python's expressions lack, or not all read alike, with a few members."""

EXAMPLES = {
    "anyURI": "a",
    "boolean": "true",
    "dateTime": "2001-01-01T00:00:00Z",
    "double": "1",
    "float": "1",
    "hexBinary": "0F",
}
CANDIDATES = ("a", "#a", "a/b", "a@b")

_strategies: dict[int, tuple[SimpleType, st.SearchStrategy[str]]] = {}


def texts(simple: SimpleType) -> st.SearchStrategy[str]:
    """Valid texts of a simple type, in many lexical forms. References to ids are not made here."""
    known = _strategies.get(id(simple))  # the type is kept, so that its id stays its own
    if known is None:
        known = _strategies[id(simple)] = (simple, _texts(simple))
    return known[1]


def _texts(simple: SimpleType) -> st.SearchStrategy[str]:
    if simple.enumeration:
        return st.sampled_from(simple.enumeration)
    if simple.members:
        return st.one_of([texts(member) for member in simple.members])
    if simple.item is not None:
        return _lists(simple, texts(simple.item).filter(_is_one_item))
    if simple.pattern is not None:
        alphabet = st.characters(codec="utf-8", exclude_categories=("C", "Zl", "Zp"))
        return st.from_regex(expression(simple.pattern), fullmatch=True, alphabet=alphabet)
    return _primitives(simple)


def _is_one_item(text: str) -> bool:
    return text.split() == [text]


def _lists(simple: SimpleType, items: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    low, high = _length(simple)

    def join(parts: list[str], separator: str, padding: str) -> str:
        return padding + separator.join(parts) + padding

    return st.builds(
        join,
        st.lists(items, min_size=low, max_size=high),
        st.sampled_from(SEPARATORS),
        st.sampled_from(["", "", " ", "\n"]),
    )


def _length(simple: SimpleType) -> tuple[int, int]:
    low, high = simple.length or (0, LONGEST)
    return low, min(high, max(low, LONGEST))


def _primitives(simple: SimpleType) -> st.SearchStrategy[str]:
    kind = simple.primitive
    if kind in INTEGERS:
        low, high = _bounds(simple)
        return st.builds(_integer, st.integers(low, high), st.sampled_from(["", "", "+", "0"]))
    if kind in ("double", "float"):
        low_bound, high_bound = simple.bounds
        numbers = st.floats(low_bound, high_bound, width=64 if kind == "double" else 32)
        return st.builds(
            _number, numbers, st.sampled_from([repr, repr, "{:e}".format, "{:g}".format])
        )
    simple_kinds: dict[str, st.SearchStrategy[str]] = {
        "boolean": st.sampled_from(["true", "false", "1", "0", " true "]),
        "string": st.text(_characters(), max_size=12),
        "token": st.text(_characters(), max_size=12),
        "NCName": _names(),
        "ID": _names(),
        "Name": st.builds(str.__add__, _names(), st.sampled_from(["", "", ":a"])),
        "NMTOKEN": st.text(NAME, min_size=1, max_size=8),
        "anyURI": st.builds(
            str.__add__,
            st.sampled_from(
                ["", "#", "other.dae#", "https://example.org/a?b=c#", "./a%20b/", "λ/"]
            ),
            _names(),
        ),
        "dateTime": st.builds(_date_time, st.datetimes(), st.sampled_from(["", "Z", "+02:30"])),
        "hexBinary": st.builds(_hexadecimal, st.binary(max_size=6), st.booleans()),
    }
    return simple_kinds[kind]


def _bounds(simple: SimpleType) -> tuple[int, int]:
    lows = [bound[0] for bound in (simple.bounds, INTEGERS[simple.primitive])]
    highs = [bound[1] for bound in (simple.bounds, INTEGERS[simple.primitive])]
    return (
        max((bound for bound in lows if bound is not None), default=-LIMIT),
        min((bound for bound in highs if bound is not None), default=LIMIT),
    )


def _integer(number: int, prefix: str) -> str:
    return f"{prefix}{number}" if number >= 0 else str(number)


def _number(number: float, form: Callable[[float], str]) -> str:
    if math.isnan(number):
        return "NaN"
    if math.isinf(number):
        return "INF" if number > 0 else "-INF"
    return form(number)


def _characters() -> st.SearchStrategy[str]:
    return st.one_of(
        st.sampled_from(string.ascii_letters + string.digits + " &<>\"'\n\t"),
        st.characters(codec="utf-8", exclude_categories=("Cc", "Cs", "Cn")),
    )


def _names() -> st.SearchStrategy[str]:
    return st.builds(str.__add__, st.sampled_from(NAME_START), st.text(NAME, max_size=6))


def _date_time(moment: datetime, zone: str) -> str:
    return moment.isoformat() + zone


def _hexadecimal(data: bytes, upper: bool) -> str:
    return data.hex().upper() if upper else data.hex()


def expression(pattern: str) -> re.Pattern[str]:
    """A pattern of the schema as Python's, matching a part of what the schema's matches."""
    for theirs, ours in XML_CLASSES.items():
        pattern = pattern.replace(theirs, ours)
    if re.search(r"\\[iIcCpP]|-\[", pattern):
        raise ValueError(f"no translation of the pattern {pattern!r}")
    return re.compile(pattern)


def example(simple: SimpleType) -> str:
    """One valid text of a simple type, always the same."""
    if simple.enumeration:
        return simple.enumeration[0]
    if simple.members:
        return example(simple.members[0])
    if simple.item is not None:
        return " ".join([example(simple.item)] * max(1, _length(simple)[0]))
    if simple.pattern is not None:
        pattern = expression(simple.pattern)
        return next(text for text in CANDIDATES if pattern.fullmatch(text))
    if simple.primitive in INTEGERS:
        return str(_bounds(simple)[0]) if _bounds(simple)[0] > 0 else "0"
    return EXAMPLES.get(simple.primitive, "a")

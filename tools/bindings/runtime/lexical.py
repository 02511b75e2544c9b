"""Text to value and value to text, lexically as XML Schema 1.0 has it.

Python's own conversions accept more (``1_0``, ``infinity``, digits of other scripts), so each
function here first excludes what only Python knows. The texts come from an XML parser: control
characters other than white space do not occur in them.
"""

from __future__ import annotations

import base64
import re
from enum import Enum
from operator import index
from typing import Any, NoReturn, TypeVar

from lxml.etree import _Element
from xsdata.models.datatype import XmlDateTime

from colladaphy_schema.errors import CodecError, reject

E = TypeVar("E", bound=Enum)

_SPECIAL_FLOATS = {"INF": float("inf"), "-INF": float("-inf"), "NaN": float("nan")}
_SPECIAL_TEXTS = {"inf": "INF", "-inf": "-INF", "nan": "NaN"}
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
_BLANK = " \t\r\n"
_RUN = re.compile("[ \t\r\n]+")
_BREAK = re.compile("[\t\r\n]")
_HEX = re.compile("(?:[0-9A-Fa-f]{2})*")
_SPECIAL_IN_TEXT = re.compile("[&<>\x00-\x08\x0b-\x1f\ud800-\udfff\ufffe\uffff]")
_SPECIAL_IN_ATTRIBUTE = re.compile('[&<>"\x00-\x1f\ud800-\udfff\ufffe\uffff]')
_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;",
             "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}  # fmt: skip

float_repr = float.__repr__
int_repr = int.__repr__


# --- text to value -------------------------------------------------------------------------


def joined(element: _Element) -> str:
    """The text of an element of simple content with comments or instructions inside."""
    parts = [element.text or ""]
    for child in element:
        if isinstance(child.tag, str):
            reject(element, f"<{child.tag}> stands inside simple content")
        parts.append(child.tail or "")
    return "".join(parts)


def number(text: str, element: _Element) -> float:
    """One xs:double."""
    if text.isascii() and "n" not in text and "N" not in text and "_" not in text:
        try:
            return float(text)
        except ValueError:
            return _bad(text, "a number", element)
    return _special(text, element)


def numbers(text: str, element: _Element) -> list[float]:
    """A list of xs:double."""
    if text.isascii() and "n" not in text and "N" not in text and "_" not in text:
        try:
            return [*map(float, text.split())]
        except ValueError:
            return _bad(text, "a list of numbers", element)
    return [
        _SPECIAL_FLOATS[word] if word in _SPECIAL_FLOATS else _plain(word, element)
        for word in words(text)
    ]


def _special(text: str, element: _Element) -> float:
    word = text.strip(_BLANK)
    return _SPECIAL_FLOATS[word] if word in _SPECIAL_FLOATS else _plain(word, element)


def _plain(word: str, element: _Element) -> float:
    if not word.isascii() or "n" in word or "N" in word or "_" in word:
        _bad(word, "a number", element)
    return number(word, element)


def integer(text: str, element: _Element) -> int:
    """One xs:integer or type derived from it."""
    if text.isascii() and "_" not in text:
        try:
            return int(text)
        except ValueError:
            pass
    return _bad(text, "an integer", element)


def integers(text: str, element: _Element) -> list[int]:
    """A list of xs:integer."""
    if text.isascii() and "_" not in text:
        try:
            return [*map(int, text.split())]
        except ValueError:
            pass
    return _bad(text, "a list of integers", element)


def boolean(text: str, element: _Element) -> bool:
    """One xs:boolean."""
    value = _BOOLEANS.get(text)
    if value is None:
        value = _BOOLEANS.get(text.strip(_BLANK))
        if value is None:
            return _bad(text, "true, false, 1 or 0", element)
    return value


def booleans(text: str, element: _Element) -> list[bool]:
    """A list of xs:boolean."""
    return [boolean(word, element) for word in words(text)]


def words(text: str) -> list[str]:
    """The items of a list: split at XML's white space only."""
    return text.split() if text.isascii() else _RUN.sub(" ", text).strip(" ").split(" ")


def collapsed(text: str) -> str:
    """White space collapsed, as xs:token and xs:anyURI have it."""
    if " " in text or "\n" in text or "\t" in text or "\r" in text:
        return _RUN.sub(" ", text).strip(" ")
    return text


def normalized(text: str) -> str:
    """White space replaced, as xs:normalizedString has it."""
    return _BREAK.sub(" ", text)


def member(table: dict[str, E], text: str, element: _Element) -> E:
    """One value of an enumeration."""
    value = table.get(text)
    if value is None:
        value = table.get(collapsed(text))
        if value is None:
            return _bad(text, f"one of {', '.join(table)}", element)
    return value


def members(table: dict[str, E], text: str, element: _Element) -> list[E]:
    """A list of values of an enumeration."""
    return [member(table, word, element) for word in words(text)]


def moment(text: str, element: _Element) -> XmlDateTime:
    """One xs:dateTime."""
    try:
        return XmlDateTime.from_string(text.strip(_BLANK))
    except ValueError:
        return _bad(text, "a date and time such as 2024-01-31T12:00:00Z", element)


def hexadecimal(text: str, element: _Element) -> bytes:
    """One xs:hexBinary."""
    digits = text.strip(_BLANK)
    if _HEX.fullmatch(digits) is None:
        return _bad(text, "hexadecimal digits", element)
    return bytes.fromhex(digits)


def base64_bytes(text: str, element: _Element) -> bytes:
    """One xs:base64Binary."""
    try:
        return base64.b64decode(_RUN.sub("", text).encode("ascii"), validate=True)
    except ValueError:
        return _bad(text, "base64 text", element)


def length(element: _Element, value: list[Any], low: int | None, high: int | None) -> NoReturn:
    """Reject a list of the wrong length."""
    wanted = str(low) if low == high else f"{low or 0} to {'any number' if high is None else high}"
    reject(element, f"{wanted} values are needed, not {len(value)}")


def _bad(text: str, wanted: str, element: _Element) -> Any:
    shown = text if len(text) <= 60 else text[:57] + "..."
    reject(element, f"{shown!r} is not {wanted}")


# --- value to text -------------------------------------------------------------------------


def number_text(value: float) -> str:
    """A float as text that reads back to the same bits."""
    try:
        text = float_repr(value)
    except TypeError:
        text = float_repr(float(value))
    return _SPECIAL_TEXTS[text] if "n" in text else text


def numbers_text(values: Any) -> str:
    """A list of floats as text that reads back to the same bits."""
    try:
        text = " ".join(map(float_repr, values))
    except TypeError:
        text = " ".join([float_repr(float(value)) for value in values])
    return " ".join(map(number_text, values)) if "n" in text else text


def integer_text(value: int) -> str:
    """An integer in decimal digits."""
    return int_repr(value) if value.__class__ is int else int_repr(index(value))


def integers_text(values: Any) -> str:
    """A list of integers in decimal digits."""
    try:
        return " ".join(map(int_repr, values))
    except TypeError:
        return " ".join([int_repr(index(value)) for value in values])


def boolean_text(value: bool) -> str:
    """true or false."""
    return "true" if value else "false"


def base64_text(value: bytes) -> str:
    """Bytes as base64."""
    return base64.b64encode(value).decode("ascii")


def text_escaped(value: str) -> str:
    """A text as character data."""
    if _SPECIAL_IN_TEXT.search(value) is None:
        return value
    return _SPECIAL_IN_TEXT.sub(_entity, value)


def attribute_escaped(value: str) -> str:
    """A text as the value of an attribute, between double quotes."""
    if _SPECIAL_IN_ATTRIBUTE.search(value) is None:
        return value
    return _SPECIAL_IN_ATTRIBUTE.sub(_entity, value)


def _entity(match: re.Match[str]) -> str:
    character = match.group()
    if character not in _ENTITIES:
        raise CodecError(f"XML cannot hold the character U+{ord(character):04X}")
    return _ENTITIES[character]

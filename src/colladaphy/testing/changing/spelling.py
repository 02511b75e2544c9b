"""Other spellings of the same numbers, and of the same document."""

from __future__ import annotations

import math
from decimal import Decimal

from hypothesis import strategies as st
from lxml import etree

from colladaphy.testing.changing.elements import C, is_common

__all__ = ["SERIALIZATIONS", "respelled", "serialized", "spellings"]

spellings = st.sampled_from(
    ["plus", "short", "zeros", "bare", "exponent", "shifted", "capital", "mixed"]
)
_MIXED = ("plus", "short", "zeros", "bare", "exponent", "shifted", "capital")
_SEPARATORS = {"plus": " ", "short": "\n", "zeros": "  ", "bare": "\t", "exponent": "\r\n \t"}


def respelled(text: str, style: str) -> str:
    """A list of numbers, each the same double as before, spelled in a style."""
    separator = _SEPARATORS.get(style, " ")
    words = text.split()
    styles = [style] * len(words) if style != "mixed" else None
    spelled = [
        _spell(word, styles[place] if styles else _MIXED[place % len(_MIXED)])
        for place, word in enumerate(words)
    ]
    around = separator if style in ("short", "zeros") else ""
    return around + separator.join(spelled) + around


def _spell(word: str, style: str) -> str:
    try:
        number = Decimal(word)
    except ArithmeticError:
        return word
    if not number.is_finite() or not math.isfinite(float(word)):
        return word
    sign, digits, exponent = number.as_tuple()
    assert isinstance(exponent, int)
    text = "".join(map(str, digits))
    minus = "-" if sign else ""
    match style:
        case "plus":
            return word if minus or word.startswith("+") else f"+{word}"
        case "exponent":
            return f"{minus}{text}e{exponent}"
        case "capital":
            return f"{minus}{text[0]}.{text[1:]}E{exponent + len(text) - 1:+d}"
        case "shifted":
            return f"{minus}0.{text}E{exponent + len(text)}"
    if not -300 < exponent + len(text) < 25 or exponent < -30:
        return word
    plain = f"{abs(number):f}"
    whole, _, part = plain.partition(".")
    match style:
        case "short":
            part = part.rstrip("0")
            return minus + (f"{whole.lstrip('0')}.{part}" if part else f"{whole}")
        case "zeros":
            return f"{minus}00{whole}.{part}000"
        case _:
            return f"{minus}{whole}." if not part.strip("0") else f"{minus}{whole}.{part}"


SERIALIZATIONS = ("plain", "indented", "cdata", "prefix", "utf-16", "latin-1", "mark")
"""How the same elements can stand in a file."""


def serialized(root: etree._Element, form: str) -> bytes:
    """A document in one of SERIALIZATIONS; its elements are the same."""
    if form == "prefix":
        root = _prefixed(root)
    elif form == "cdata":
        for element in root.iter(f"{C}mass", f"{C}translate", f"{C}radius", f"{C}float_array"):
            if is_common(element) and len(element) == 0 and element.text:
                element.text = etree.CDATA(element.text)
    elif form == "indented":
        etree.indent(root, "\t")
    encoding = {"utf-16": "utf-16", "latin-1": "iso-8859-1"}.get(form, "utf-8")
    data = etree.tostring(root.getroottree(), encoding=encoding, xml_declaration=True)
    assert isinstance(data, bytes)  # text is only for the encoding "unicode"
    return b"\xef\xbb\xbf" + data if form == "mark" else data


def _prefixed(root: etree._Element) -> etree._Element:
    """The same elements, whose namespace has a prefix."""
    spaces = {prefix or "c": uri for prefix, uri in root.nsmap.items()}
    made = etree.Element(root.tag, nsmap=spaces)
    made.attrib.update(root.attrib)
    made.text = root.text
    made.extend(list(root))
    return made

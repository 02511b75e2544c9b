"""Lexical forms: is this text a valid value of that simple type, and if not, what was meant?"""

from __future__ import annotations

import re
from datetime import datetime
from functools import lru_cache
from urllib.parse import quote

from lxml import etree

from colladaphy.conform.grammar import SimpleType
from colladaphy.conform.numerals import plain_numbers, spelled_number

__all__ = ["is_valid", "mend", "name_from"]

_INTEGERS = {
    "integer": (None, None),
    "long": (-(2**63), 2**63 - 1),
    "int": (-(2**31), 2**31 - 1),
    "short": (-(2**15), 2**15 - 1),
    "byte": (-128, 127),
    "nonNegativeInteger": (0, None),
    "positiveInteger": (1, None),
    "unsignedLong": (0, 2**64 - 1),
    "unsignedInt": (0, 2**32 - 1),
    "unsignedShort": (0, 2**16 - 1),
    "unsignedByte": (0, 255),
}
_ANY = 1 << 30
_LONGEST_WHOLE = 40
_NAMES = ("NCName", "ID", "IDREF", "Name", "NMTOKEN")
_FLOAT = r"(?:[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|-?INF|NaN)"
_PLAIN = {
    "double": re.compile(_FLOAT, re.ASCII),
    "float": re.compile(_FLOAT, re.ASCII),
    "boolean": re.compile("true|false|0|1"),
    "NCName": re.compile(r"[A-Za-z_][A-Za-z0-9_.\-]*"),
    "Name": re.compile(r"[A-Za-z_:][A-Za-z0-9_.\-:]*"),
    "NMTOKEN": re.compile(r"[A-Za-z0-9_.\-:]+"),
    "anyURI": re.compile(r"#?[A-Za-z0-9_./\-]*"),
    "dateTime": re.compile(r"(?!)"),
    "hexBinary": re.compile(r"(?:[0-9A-Fa-f]{2})*"),
}
_PLAIN["ID"] = _PLAIN["IDREF"] = _PLAIN["NCName"]
_FLOAT_LIST = re.compile(rf"\s*(?:{_FLOAT}(?:\s+{_FLOAT})*)?\s*", re.ASCII)
_INTEGER = re.compile(r"[+-]?[0-9]+")
_ASKED = ("NCName", "ID", "IDREF", "Name", "NMTOKEN", "anyURI", "dateTime")
# What XML Schema's regular expressions have and Python's have not.
_SIDREF = re.compile(
    r"(?:[^\W\d][\w.\-]*|.)(?:/[^\W\d][\w\-]*)+(?:\.[^\W\d][\w.\-]*|(?:\([0-9]+\)){1,2})?"
)
_FOREIGN_FLOATS = {
    "inf": "INF", "+inf": "INF", "infinity": "INF", "+infinity": "INF", "1.#inf": "INF",
    "1.#inf00": "INF", "1.#j": "INF", "-inf": "-INF", "-infinity": "-INF", "-1.#inf": "-INF",
    "-1.#inf00": "-INF", "-1.#j": "-INF", "nan": "NaN", "-nan": "NaN", "1.#qnan": "NaN",
    "-1.#ind": "NaN", "1.#ind": "NaN", "-1.#qnan": "NaN", "1.#qnan0": "NaN", "-1.#ind00": "NaN",
    "-nan(ind)": "NaN", "nan(ind)": "NaN",
}  # fmt: skip


@lru_cache(maxsize=1)
def _oracle() -> etree.XMLSchema:
    elements = "".join(f'<xs:element name="{name}" type="xs:{name}"/>' for name in _ASKED)
    text = f'<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema">{elements}</xs:schema>'
    return etree.XMLSchema(etree.fromstring(text))


@lru_cache(maxsize=4096)
def _libxml_accepts(primitive: str, text: str) -> bool:
    element = etree.Element(primitive)
    element.text = text
    return bool(_oracle().validate(element))


def _atom_is_valid(text: str, kind: SimpleType) -> bool:
    primitive = kind.primitive
    if primitive not in ("string",):
        text = text.strip(" \t\r\n")
    if primitive in _INTEGERS:
        if not _INTEGER.fullmatch(text):
            return False
        low, high = _bounds(kind)
        if len(text) > _LONGEST_WHOLE:
            text = text.rstrip("0123456789") + (text.lstrip("+-").lstrip("0") or "0")
        if len(text) > _LONGEST_WHOLE:  # beyond all bounds that there are
            return low is None if text.startswith("-") else high is None
        value = int(text)
        return (low is None or value >= low) and (high is None or value <= high)
    plain = _PLAIN.get(primitive)
    if plain is not None and not plain.fullmatch(text):
        accepted = primitive in _ASKED and _libxml_accepts(primitive, text)
        if not accepted:
            return False
    if kind.enumeration and text not in kind.enumeration:
        return False
    return _fits_pattern(text, kind)


def _fits_pattern(text: str, kind: SimpleType) -> bool:
    if kind.pattern is None:
        return True
    if "#(.*)" in kind.pattern:
        return text.startswith("#") and "\n" not in text
    if "\\i" in kind.pattern:
        return _SIDREF.fullmatch(text) is not None
    return re.fullmatch(kind.pattern, text) is not None


def _bounds(kind: SimpleType) -> tuple[int | None, int | None]:
    low, high = _INTEGERS[kind.primitive]
    least, most = kind.bounds
    return (low if least is None else least, high if most is None else most)


def is_valid(text: str, kind: SimpleType) -> bool:
    """Whether `text` is in the lexical space of `kind`."""
    if kind.members:
        return any(is_valid(text, member) for member in kind.members)
    if kind.item is None:
        return _atom_is_valid(text, kind)
    if kind.length is None and kind.item.primitive == "double":
        return _FLOAT_LIST.fullmatch(text) is not None
    parts = text.split()
    if kind.length is not None and not kind.length[0] <= len(parts) <= kind.length[1]:
        return False
    return all(_atom_is_valid(part, kind.item) for part in parts)


def mend(text: str, kind: SimpleType) -> tuple[str | None, bool]:
    """What `text`, which is not valid, must have meant as a `kind`; None where nobody can know.

    The second value is True when the new text says less than the old one did.
    """
    if kind.members:
        for member in kind.members:
            mended, less = mend(text, member)
            if mended is not None:
                return mended, less
        return None, False
    if kind.item is not None:
        return _mend_list(text, kind)
    return _mend_atom(text, kind), False


def _mend_list(text: str, kind: SimpleType) -> tuple[str | None, bool]:
    assert kind.item is not None
    low, high = kind.length or (0, _ANY)
    if "," in text or ";" in text:
        if kind.item.primitive in ("double", "float"):
            text, _ = plain_numbers(text, low, high)
        else:
            text = re.sub(r"[,;]", " ", text)
    parts = text.split()
    mended: list[str] = []
    for part in parts:
        atom = part if _atom_is_valid(part, kind.item) else _mend_atom(part, kind.item)
        if atom is None:
            return None, False
        mended.append(atom)
    if len(mended) < low:
        if kind.name == "fx_color_type" and len(mended) == 3:
            mended.append("1")  # a colour without alpha is opaque
        else:
            return None, False
    return " ".join(mended[:high]), len(mended) > high


def _mend_atom(text: str, kind: SimpleType) -> str | None:
    text = text.strip()
    for attempt in _attempts(text, kind):
        if attempt is not None and _atom_is_valid(attempt, kind):
            return attempt
    return None


def _attempts(text: str, kind: SimpleType) -> list[str | None]:
    primitive = kind.primitive
    if kind.enumeration:
        plain = re.sub(r"[\s\-]+", "_", text).upper()
        same = [value for value in kind.enumeration if value.upper() == plain]
        return [*same, text.upper(), text.lower()]
    if kind.pattern is not None:
        return ["#" + text, text.replace(" ", ""), "./" + text.lstrip("#"), text.lstrip("#")]
    if primitive == "boolean":
        return [_boolean(text)]
    if primitive in ("double", "float"):
        plain = plain_numbers(text, 1, 1)[0]
        return [_FOREIGN_FLOATS.get(text.lower()), spelled_number(text), plain]
    if primitive in _INTEGERS:
        return [_integer(text, kind)]
    if primitive in _NAMES:
        return [name_from(text)] if text else []
    if primitive == "anyURI":
        return [_uri(text)]
    if primitive == "dateTime":
        return [_date_time(text)]
    return []


def _boolean(text: str) -> str | None:
    word = text.lower()
    if word in ("true", "yes", "on", "t", "y", "1.0"):
        return "true"
    return "false" if word in ("false", "no", "off", "f", "n", "0.0") else None


def _integer(text: str, kind: SimpleType) -> str | None:
    try:
        value = int(text) if _INTEGER.fullmatch(text) else float(text)
        if value != int(value):
            return None
    except (ValueError, OverflowError):
        return None
    low, high = _bounds(kind)
    value = int(value)
    value = value if low is None else max(low, value)
    return str(value if high is None else min(high, value))


def name_from(text: str) -> str:
    """An NCName that is as much like `text` as can be; the same for the same text."""
    name = re.sub(r"[^\w.\-]", "_", text.strip()) or "_"
    if not (name[0].isalpha() or name[0] == "_"):
        name = "_" + name
    return name if _libxml_accepts("NCName", name) else re.sub(r"[^A-Za-z0-9_.\-]", "_", name)


def _uri(text: str) -> str:
    text = re.sub(r"^(file:)//(?=[A-Za-z][:|]/)", r"\1///", text.replace("\\", "/"))
    if re.match(r"[A-Za-z]:/", text):
        text = "file:///" + text
    elif text.startswith("//") and " " not in text.partition("/")[0]:
        text = "file:" + text
    text = re.sub(r"%(?![0-9A-Fa-f]{2})", "%25", text)
    head, mark, fragment = text.partition("#")
    return quote(head, safe="/:?&=+,;@!$'()*~%") + mark + quote(fragment, safe="/:?&=+,;@!$'()*~%")


_DATES = (
    "%Y-%m-%dT%H:%M:%S.%f%z", "%Y-%m-%dT%H:%M:%S%z", "%Y-%m-%dT%H:%M:%S.%f", "%Y-%m-%dT%H:%M:%S",
    "%Y-%m-%dT%H:%M%z", "%Y-%m-%dT%H:%M", "%Y-%m-%d %H:%M:%S.%f", "%Y-%m-%d %H:%M:%S%z",
    "%Y-%m-%d %H:%M:%S", "%Y-%m-%d %H:%M", "%Y-%m-%d", "%Y/%m/%d", "%Y/%m/%d %H:%M:%S",
    "%a %b %d %H:%M:%S %Y", "%a %b %d %H:%M:%S %Z %Y", "%d/%m/%Y %H:%M:%S", "%d.%m.%Y",
    "%d.%m.%Y %H:%M:%S", "%Y%m%dT%H%M%S", "%Y%m%dT%H%M%S.%f", "%b %d %Y", "%Y-%m-%dT%H-%M-%S",
)  # fmt: skip


_LONGEST_DATE = 100
_ZONE = re.compile(r"([+-][0-9]{2}):?([0-9]{2})$")
_TIME = re.compile(r"[0-9][T ][0-9]")


def _date_time(text: str) -> str | None:
    if len(text) > _LONGEST_DATE:
        return None  # whatever it is, it is no date
    text = " ".join(text.split())
    zone = _ZONE.search(text)
    if zone is not None and _TIME.search(text):
        text = text[: zone.start()].rstrip() + zone[1] + zone[2]
    for layout in _DATES:
        try:
            return datetime.strptime(text, layout).isoformat()
        except ValueError:
            continue
    return None

"""What libxml2's validator says, put in plain words and under stable codes."""

from __future__ import annotations

import re
from typing import NamedTuple

from colladaphy.findings import Rule
from colladaphy.gate import rules

__all__ = ["Violation", "translate"]

# libxml2's codes for schema violations (xmlParserErrors, SCHEMAV_*), by the rule of ours.
_VALUE = frozenset({1824, 1825, 1826, *range(1829, 1841), 1857, 1858})
_LENGTH = frozenset({1830, 1831, 1832})
_CONTENT = frozenset({1827, 1828, 1841, 1842, 1843, 1844})
_KEYS = frozenset({1877, 1878, 1879})
_ELEMENT_CONTENT = 1871
_NO_DECLARATION = 1845
_ATTRIBUTE_UNKNOWN = frozenset({1866, 1867})
_ATTRIBUTE_MISSING = 1868

_SUBJECT = re.compile(r"^Element '([^']+)'(?:, attribute '([^']+)')?: ")
_NAMESPACE = re.compile(r"\{([^{}]*)\}")
_PREFIXES = {
    "http://www.collada.org/2008/03/COLLADASchema": "",
    "http://www.collada.org/2005/11/COLLADASchema": "",
    "urn:colladaphy:pe:1": "pe:",
    "http://www.w3.org/1998/Math/MathML": "math:",
    "http://www.w3.org/XML/1998/namespace": "xml:",
    "http://www.w3.org/2001/XMLSchema-instance": "xsi:",
}
_EXPECTED = re.compile(r"Expected is(?: one of)? \( (.*) \)", re.DOTALL)
_NOT_VALID = re.compile(
    r"^'(.*)' is not a valid value of the (?:local )?(?:atomic|list|union) type(?: '([^']+)')?",
    re.DOTALL,
)
_FACET = re.compile(r"^\[facet '(\w+)'\] ")
_QUOTED = re.compile(r"'([^']*)'", re.DOTALL)
_LONGEST = 60

_NUMBER = "a number such as 1.5, -2e3 or INF"
_NAME = "a name (a letter or _, then letters, digits, _ or -; no spaces, slashes or colons)"
_KINDS = {
    "float_type": _NUMBER,
    "float": _NUMBER,
    "xs:float": _NUMBER,
    "xs:double": _NUMBER,
    "bool_type": "true or false",
    "xs:boolean": "true or false",
    "int_type": "a whole number",
    "xs:int": "a whole number",
    "xs:integer": "a whole number",
    "xs:long": "a whole number",
    "uint_type": "a whole number that is not negative",
    "xs:unsignedInt": "a whole number that is not negative",
    "xs:unsignedLong": "a whole number that is not negative",
    "xs:nonNegativeInteger": "a whole number that is not negative",
    "sid_type": _NAME,
    "xs:ID": _NAME,
    "xs:NCName": _NAME,
    "xs:NMTOKEN": "a name without spaces",
    "xs:dateTime": "a date and time such as 2010-01-31T12:00:00Z",
    "xs:anyURI": "a URI",
}


class Violation(NamedTuple):
    """One complaint of the validator, in words of ours; `attribute` is its subject, if any."""

    rule: Rule
    message: str
    attribute: str | None
    value: str | None


def translate(code: int, text: str) -> Violation:
    """Put one message of libxml2 in plain words."""
    head = _SUBJECT.match(text)
    element = _short(head.group(1)) if head else "?"
    attribute = _short(head.group(2)) if head and head.group(2) else None
    said = " ".join((text[head.end() :] if head else text).split())
    subject = f"attribute {attribute!r} of <{element}>" if attribute else f"<{element}>"
    value: str | None = None
    rule: Rule = rules.OTHER
    message = f"{subject}: {_short(said)}"
    if code == _ELEMENT_CONTENT and said.startswith("Missing child"):
        rule = rules.MISSING_ELEMENT
        message = f"<{element}> lacks a child element; {_expected(said)}."
    elif code == _ELEMENT_CONTENT:
        rule = rules.UNEXPECTED_ELEMENT
        message = f"<{element}> is not expected here; {_expected(said)}."
    elif code == _NO_DECLARATION:
        rule = rules.UNKNOWN_ELEMENT
        message = f"The schema does not know the element <{element}>."
    elif code in _ATTRIBUTE_UNKNOWN:
        rule = rules.UNKNOWN_ATTRIBUTE
        message = f"<{element}> has no attribute {attribute!r}."
    elif code == _ATTRIBUTE_MISSING:
        quoted = _QUOTED.search(said)
        attribute = _short(quoted.group(1)) if quoted else "?"
        rule = rules.MISSING_ATTRIBUTE
        message = f"<{element}> lacks its attribute {attribute!r}."
    elif code in _CONTENT:
        rule = rules.UNEXPECTED_CONTENT
        message = f"<{element}> {_content(said)}."
    elif code in _VALUE:
        rule = rules.WRONG_LENGTH if code in _LENGTH else rules.INVALID_VALUE
        value, why = _value(said)
        message = f"{subject[0].upper()}{subject[1:]} {why}."
    elif code in _KEYS:
        rule = rules.BROKEN_KEY
    return Violation(rule, message, attribute, value)


def _short(text: str) -> str:
    """Names with the prefixes that people know, instead of namespaces."""
    return _NAMESPACE.sub(lambda match: _PREFIXES.get(match[1], f"{{{match[1]}}}"), text)


def _expected(said: str) -> str:
    match = _EXPECTED.search(said)
    if not match:
        return "nothing more may follow"
    names = [_short(name.strip()) for name in match[1].split(",")]
    shown = [
        "any element of another namespace" if name.startswith("##other") else f"<{name}>"
        for name in names
        if not name.startswith("##any")
    ]
    if not shown:
        return "any element may follow"
    # libxml2 names ten at most.
    more = ", ..." if len(shown) >= 10 else ""
    return f"expected {'one of ' if len(shown) > 1 else ''}{', '.join(shown)}{more}"


def _content(said: str) -> str:
    if said.startswith("Element content"):
        return "holds a value and may not have child elements"
    if "content type is empty" in said:
        return "must be empty"
    if "element-only" in said or "Character content" in said:
        return "may have child elements only, but has text"
    return f"has content that is not allowed ({said.rstrip('.')})"


def _value(said: str) -> tuple[str | None, str]:
    facet = _FACET.match(said)
    if facet:
        return _facet(facet[1], said[facet.end() :])
    match = _NOT_VALID.match(said)
    if not match and said.startswith("'"):  # libxml2 cuts its messages off
        return said[1:], f"has the value {_clip(said[1:])}, which its type does not allow"
    if not match:
        return None, f"has a value that is not allowed: {_short(said.rstrip('.'))}"
    value = match[1]
    kind = _short(match[2]) if match[2] else ""
    what = _KINDS.get(kind) or (f"a value of type {kind}" if kind else "a value of its type")
    if not value.strip():
        return value, f"is empty, but must be {what}"
    return value, f"has the value {_clip(value)}, which is not {what}"


def _facet(facet: str, said: str) -> tuple[str | None, str]:
    quoted = _QUOTED.findall(said)
    if facet in {"length", "minLength", "maxLength"} and len(quoted) >= 2:
        limit = {"length": "exactly", "minLength": "at least", "maxLength": "at most"}[facet]
        return None, f"has the length {quoted[0]}; {limit} {quoted[1]} is needed"
    if facet == "enumeration":
        value, _, allowed = said.removeprefix("The value ").partition(" is not an element of")
        names = ", ".join(_QUOTED.findall(allowed))
        return value.strip("'"), f"has the value {_clip(value.strip(chr(39)))}; allowed: {names}"
    if facet == "pattern":
        value = said.removeprefix("The value ").partition(" is not accepted")[0].strip("'")
        return value, f"has the value {_clip(value)}, which does not have the right form"
    return (quoted[0] if quoted else None), f"is out of range: {said.rstrip('.')}"


def _clip(value: str) -> str:
    return repr(value if len(value) <= _LONGEST else value[: _LONGEST - 3] + "...")

"""Numbers that libxml2 takes for valid, and no program can read.

Their exponent has no digits, as in ``1e`` or ``2.5E+``, or they are integers of thousands of
digits. They are rare, and looking for them costs as much as parsing, so that the gate leaves them
to whoever reads the number; a validation must find them all.
"""

from __future__ import annotations

import re
from copy import deepcopy

from lxml import etree

from colladaphy.findings import Finding
from colladaphy.gate.faults import violations
from colladaphy.gate.messages import Violation

__all__ = ["incomplete_numbers", "incomplete_violations", "may_hold_incomplete_numbers"]

# References, comments and CDATA may stand on either side.
_IN_BYTES = re.compile(rb"[0-9.;>\[]\0?[eE]\0?[+-]?\0?[\s<\"'&\]]")
_LONG = 1 << 16
_NUMBER = re.compile(r"(?<!\S)([+-]?[0-9.]+[eE][+-]?)(?!\S)")
# Makes a number invalid, and leaves names, URIs and free text as valid as they were.
_SPOILT = r"\1_"
_MARK = re.compile(r"([0-9.][eE][+-]?)_")
_MOST_DIGITS = 4300
"""What Python reads; a file of any use has a few dozen at most."""
_ENDLESS = re.compile(rf"(?<!\S)[+-]?[0-9]{{{_MOST_DIGITS + 1},}}(?!\S)")
# No integer, but as valid as it was where it is another number, or free text.
_NO_INTEGER = "1.500e0"
_BYTES = "xs:hexBinary"
"""Of which ``1e`` is a value."""
_SHOWN = f"a number of more than {_MOST_DIGITS} digits"


def may_hold_incomplete_numbers(data: bytes) -> bool:
    """False where the bytes of a document hold no such number."""
    if _may_be_endless(data):
        return True
    if len(data) < _LONG:
        return _IN_BYTES.search(data) is not None
    from colladaphy.gate.exponents import exponents

    return any(_IN_BYTES.match(data, place) is not None for place in exponents(data))


def _may_be_endless(data: bytes) -> bool:
    """Whether there are thousands of digits in a row: then there are in a row of places, too."""
    step = _MOST_DIGITS // 2
    places = data[::step]
    return any(
        places[number : number + 2].isdigit()
        and data[number * step : (number + 1) * step].isdigit()
        for number in range(len(places) - 1)
    )


def incomplete_numbers(tree: etree._ElementTree, data: bytes) -> list[Finding]:
    """A finding for every such number in a tree that the gate lets pass; `data` is its source."""
    return [
        violation.rule.at(element, violation.message)
        for element, violation in incomplete_violations(tree, data)
    ]


def incomplete_violations(
    tree: etree._ElementTree, data: bytes
) -> list[tuple[etree._Element, Violation]]:
    """The same, each with its element.

    Which texts are numbers is for the schema to say: a copy in which they are spoilt is validated.
    """
    if not may_hold_incomplete_numbers(data):
        return []
    copy = deepcopy(tree)
    etree.strip_tags(copy, etree.Comment, etree.ProcessingInstruction)
    spoilt = False
    for element in copy.iter(etree.Element):
        if element.text and (text := _spoilt(element.text)) != element.text:
            element.text = text
            spoilt = True
        for name, value in element.items():
            if (text := _spoilt(str(value))) != value:
                element.set(name, text)
                spoilt = True
    if not spoilt:
        return []
    twins = dict(zip(copy.iter(etree.Element), tree.iter(etree.Element), strict=True))
    known = set(violations(tree))
    return [
        (twins[element], violation._replace(message=_as_it_was(violation.message)))
        for element, violation in violations(copy)
        if (twins[element], violation) not in known and _BYTES not in violation.message
    ]


def _spoilt(text: str) -> str:
    return _ENDLESS.sub(_NO_INTEGER, _NUMBER.sub(_SPOILT, text))


def _as_it_was(message: str) -> str:
    return _MARK.sub(r"\1", message).replace(f"'{_NO_INTEGER}'", _SHOWN)

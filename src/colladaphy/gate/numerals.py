"""Numbers whose exponent has no digits, such as ``1e`` or ``2.5E+``: libxml2 takes them for valid.

They are rare, and looking for them costs as much as parsing, so that the gate leaves them to
whoever reads the number; a validation must find them all.
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


def may_hold_incomplete_numbers(data: bytes) -> bool:
    """False where the bytes of a document hold no such number."""
    if len(data) < _LONG:
        return _IN_BYTES.search(data) is not None
    from colladaphy.gate.exponents import exponents

    return any(_IN_BYTES.match(data, place) is not None for place in exponents(data))


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
        if element.text and _NUMBER.search(element.text):
            element.text = _NUMBER.sub(_SPOILT, element.text)
            spoilt = True
        for name, value in element.items():
            if _NUMBER.search(str(value)):
                element.set(name, _NUMBER.sub(_SPOILT, str(value)))
                spoilt = True
    if not spoilt:
        return []
    twins = dict(zip(copy.iter(etree.Element), tree.iter(etree.Element), strict=True))
    known = set(violations(tree))
    return [
        (twins[element], violation._replace(message=_MARK.sub(r"\1", violation.message)))
        for element, violation in violations(copy)
        if (twins[element], violation) not in known
    ]

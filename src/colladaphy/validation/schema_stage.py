"""Every deviation of a document from the schema, with the repair that mends it.

libxml2 judges whether there is one. It stops at the first wrong child of an element and looks at
nothing behind it: the other children are told by the content models (`conform.deviations`), and
what is in them by a copy in which all children are where they belong.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from lxml import etree

from colladaphy.conform.deviations import deviations
from colladaphy.conform.kinds import STRUCTURE
from colladaphy.gate import rules
from colladaphy.gate.faults import violations
from colladaphy.gate.messages import Violation
from colladaphy.meaning.hits import Hit
from colladaphy.validation.copies import Copy

__all__ = ["Found", "schema_hits", "with_schema_repairs"]

_CHILDREN = (rules.UNEXPECTED_ELEMENT, rules.MISSING_ELEMENT)
_NEAR = 4
"""How far up a repair may have been made: an element is set aside as a whole."""

Found = list[tuple[etree._Element, Violation]]


def schema_hits(document: Copy, first: Found) -> list[Hit]:
    """The deviations of a tree in the namespace of 1.5, of which libxml2 finds `first`."""
    if not first:
        return []
    numbers = document.by_element
    blamed = {element for element, violation in first if violation.rule in _CHILDREN}
    told: set[int] = set()
    hits: list[Hit] = []
    for deviation in deviations(document.tree.getroot(), blamed):
        number, parent = numbers[deviation.element], numbers[deviation.parent]
        told |= {number, parent}
        related = () if deviation.related is None else (numbers[deviation.related],)
        hits.append(Hit(deviation.rule, number, deviation.message, related))
    if hits:
        behind = document.mended(STRUCTURE)
        found = _placed(first, document), _placed(violations(behind.tree), behind)
    else:
        found = _placed(first, document), iter(())
    seen: set[tuple[int, str, str | None]] = set()
    for some in found:
        for number, above, violation in some:
            key = (number, violation.rule.code, violation.attribute)
            if key in seen or number < 0:
                continue
            if violation.rule in _CHILDREN and (number in told or above in told):
                continue
            seen.add(key)
            hits.append(Hit(violation.rule, number, violation.message, (), violation.attribute))
    return hits


def _placed(found: Found, copy: Copy) -> Iterator[tuple[int, int, Violation]]:
    """Violations with the numbers of their elements and of the elements around these."""
    for element, violation in found:
        above = element.getparent()
        yield copy.by_element[element], -1 if above is None else copy.by_element[above], violation


_SET_ASIDE = ("repair-unreadable-value", "repair-incomplete-element", "repair-unexpected-element",
              "repair-faulty-profile")  # fmt: skip
_VALUES = (
    "repair-lexical-form", "repair-decimal-comma", "repair-surplus-values", "repair-id-form",
    "repair-sid-form", "repair-empty-sid", "repair-missing-sid", "repair-shape-size",
    "repair-sphere-radius", "repair-inertia-matrix", "repair-body-reference",
    "upgrade-capsule-radius",
)  # fmt: skip
_MENDING: dict[str, tuple[str, ...]] = {
    rules.INVALID_VALUE.code: _VALUES,
    rules.WRONG_LENGTH.code: _VALUES,
    rules.UNKNOWN_ATTRIBUTE.code: ("repair-unknown-attribute",),
    rules.MISSING_ATTRIBUTE.code: (
        "repair-missing-attribute", "repair-missing-sid", "repair-missing-body",
        "repair-missing-target",
    ),
    rules.DUPLICATE_ID.code: ("repair-duplicate-id",),
    rules.UNEXPECTED_CONTENT.code: ("repair-unexpected-text", "repair-unexpected-element"),
    **{rule.code: tuple(sorted(STRUCTURE)) for rule in _CHILDREN},
}  # fmt: skip


def with_schema_repairs(hits: list[Hit], document: Copy, mended: Copy) -> list[Hit]:
    """Deviations with the codes of the repairs that mend them in a copy."""
    return [
        replace(hit, repair=hit.repair or _repair(hit, document.parents, mended.repaired))
        for hit in hits
    ]


def _repair(hit: Hit, parents: dict[int, int], repaired: dict[int, list[str]]) -> str | None:
    fitting = (*_MENDING.get(hit.rule.code, ()), *_SET_ASIDE)
    line = [hit.element]
    while len(line) <= _NEAR and line[-1] in parents:
        line.append(parents[line[-1]])
    for number in line:
        for code in repaired.get(number, ()):
            if code in fitting:
                return code
    return next((code for number in line for code in repaired.get(number, ())), None)

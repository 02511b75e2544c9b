"""Stage link: does every reference of a valid document lead where it should?

A reference of the physics that leads nowhere is an error: strict loading refuses it too. One of
the rest (a material, an image, the geometry of a shape, which costs one body) is a warning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document import rules
from colladaphy.errors import ColladaError
from colladaphy.findings import Finding, Severity
from colladaphy.gate.references import EXPECTED
from colladaphy.source import COLLADA_1_5
from colladaphy.source import rules as source_rules

if TYPE_CHECKING:
    from colladaphy.document import Document, Target

__all__ = ["check_links"]

_NS = f"{{{COLLADA_1_5}}}"

# References whose attributes name a part of the physics model that the parent instances.
_PARTS = {
    ("instance_rigid_body", "body"): "rigid_body",
    ("instance_rigid_constraint", "constraint"): "rigid_constraint",
}
# The elements without whose references a scene cannot be loaded.
_NEEDED = frozenset(
    {
        "instance_physics_scene",
        "instance_physics_model",
        "instance_rigid_body",
        "instance_rigid_constraint",
        "attachment",
        "ref_attachment",
    }
)
_WORLD = ("attachment", "ref_attachment")


def check_links(document: Document) -> list[Finding]:
    """Findings for every reference that leads nowhere, or to an element of the wrong kind."""
    findings: list[Finding] = []
    parts = _Parts(document)
    for element, attribute, expected in _references(document.tree):
        reference = element.get(attribute, "")
        name = element.tag.rpartition("}")[2]
        if not reference.strip() and name in _WORLD:
            continue  # the world itself
        severity = Severity.ERROR if name in _NEEDED else Severity.WARNING
        if not reference.strip():
            if attribute != "url":  # a body without a node stands at its model's place
                severity = Severity.WARNING
            message = f"The attribute {attribute!r} is empty, so it refers to nothing."
            findings.append(rules.MISSING.at(element, message, severity=severity))
            continue
        try:
            document.resolve(reference, element, expected)
        except ColladaError as error:
            findings.extend(_placed(finding, element, severity) for finding in error.findings)
    for (name, attribute), kind in _PARTS.items():
        for element in document.tree.iter(_NS + name):
            findings.extend(parts.check(element, attribute, kind))
    findings.sort(key=lambda finding: (finding.line or 0, finding.path or "", finding.code))
    return list(dict.fromkeys(findings))


def _references(
    tree: etree._ElementTree,
) -> Iterator[tuple[etree._Element, str, tuple[str, ...]]]:
    """References in the document's own content; what a technique holds is its own affair."""
    by_name: dict[str, list[tuple[str, tuple[str, ...]]]] = {}
    for (name, attribute), expected in EXPECTED.items():
        by_name.setdefault(_NS + name, []).append((attribute, expected))
    for element in tree.iter(*by_name):
        for attribute, expected in by_name[str(element.tag)]:
            if element.get(attribute) is not None and not _in_technique(element):
                yield element, attribute, expected


def _in_technique(element: etree._Element) -> bool:
    """Whether the element is foreign content; effect profiles have techniques of another kind."""
    for technique in element.iterancestors(_NS + "technique"):
        if technique.get("profile") is not None:
            return True
    return False


def _placed(finding: Finding, element: etree._Element, severity: Severity) -> Finding:
    """A finding about another file gets the place of the reference that led there."""
    if finding.code == source_rules.REFERENCE_REFUSED.code:  # not wrong, but cannot be checked
        return source_rules.REFERENCE_REFUSED.at(
            element, finding.message, severity=Severity.WARNING, hint=finding.hint
        )
    if finding.code == source_rules.REFERENCE_MISSING.code:
        rule = source_rules.REFERENCE_MISSING
        return rule.at(element, finding.message, severity=severity, hint=finding.hint)
    return replace(finding, severity=severity)


class _Parts:
    """Sids of rigid bodies and constraints, by the physics model that an instance refers to."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._sids: dict[tuple[etree._Element, str], frozenset[str]] = {}

    def check(self, element: etree._Element, attribute: str, kind: str) -> list[Finding]:
        """A finding where the instanced model has no part of that sid."""
        sid = element.get(attribute)
        instance = element.getparent()
        if sid is None or instance is None or _in_technique(element):
            return []
        try:
            model = self._document.resolve(instance.get("url", ""), instance, "physics_model")
        except ColladaError:
            return []  # reported at the instance
        if sid.rpartition("/")[2] in self._all(model, kind):
            return []
        message = f"The physics model {instance.get('url')!r} has no <{kind}> of sid {sid!r}."
        return [rules.MISSING.at(element, message)]

    def _all(self, model: Target, kind: str) -> frozenset[str]:
        """Sids in the model and in the models that it instances, each looked at once."""
        known = self._sids.get((model.element, kind))
        if known is not None:
            return known
        sids: set[str] = set()
        seen = {model.element}
        waiting = [model]
        while waiting:
            target = waiting.pop()
            sids.update(part.get("sid", "") for part in target.element.iterchildren(_NS + kind))
            for inner in target.element.iterchildren(_NS + "instance_physics_model"):
                try:
                    found = target.document.resolve(inner.get("url", ""), inner, "physics_model")
                except ColladaError:
                    continue
                if found.element not in seen:
                    seen.add(found.element)
                    waiting.append(found)
        self._sids[(model.element, kind)] = frozenset(sids)
        return self._sids[(model.element, kind)]

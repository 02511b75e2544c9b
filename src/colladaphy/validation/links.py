"""Stage link: does every reference of a valid document lead where it should?

A reference of the physics that leads nowhere is an error: strict loading refuses it too. One of
the rest (a material, an image, the geometry of a shape, which costs one body) is a warning.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from colladaphy.errors import ColladaError
from colladaphy.findings import Finding, Severity
from colladaphy.gate.references import EXPECTED
from colladaphy.links import rules
from colladaphy.links.names import c
from colladaphy.links.resource import Resource
from colladaphy.source import rules as source_rules
from colladaphy_schema.rows import Column, Rows

__all__ = ["check_links"]

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


def check_links(resource: Resource) -> list[Finding]:
    """Findings for every reference that leads nowhere, or to an element of the wrong kind."""
    findings: list[Finding] = []
    for (name, attribute), expected in EXPECTED.items():
        for number, reference in _attributes(resource, name, attribute):
            findings.extend(_check(resource, name, attribute, expected, number, reference))
    parts = _Parts(resource)
    for (name, attribute), kind in _PARTS.items():
        for number, sid in _attributes(resource, name, attribute):
            findings.extend(parts.check(number, sid, kind))
    findings.sort(key=lambda finding: (finding.line or 0, finding.path or "", finding.code))
    return list(dict.fromkeys(findings))


def _attributes(resource: Resource, name: str, attribute: str) -> Iterator[tuple[int, str]]:
    """The numbers of elements and their attributes; what a technique holds is its own affair."""
    rows = resource.columns.rows(Rows, c(name))
    if not len(rows):
        return
    assert rows.ordinals is not None
    column: Column[Any] = Column(attribute, "attribute", "string", optional=True)
    column.name = attribute
    for number, text in zip(
        rows.ordinals.tolist(), resource.columns.column(rows, column), strict=True
    ):
        if text is not None:
            yield number, text


def _check(
    resource: Resource, name: str, attribute: str, expected: tuple[str, ...], number: int,
    reference: str,
) -> list[Finding]:  # fmt: skip
    if reference[:1] == "#":
        target = resource.ids.get(reference[1:])
        if target is not None and resource.columns.local_name(target) in expected:
            return []
    if not reference.strip() and name in _WORLD:
        return []  # the world itself
    severity = Severity.ERROR if name in _NEEDED else Severity.WARNING
    if not reference.strip():
        if attribute != "url":  # a body without a node stands at its model's place
            severity = Severity.WARNING
        message = f"The attribute {attribute!r} is empty, so it refers to nothing."
        return [rules.MISSING.at(resource.element(number), message, severity=severity)]
    try:
        resource.follow(reference, number, expected)
    except ColladaError as error:
        return [_placed(finding, resource, number, severity) for finding in error.findings]
    return []


def _placed(finding: Finding, resource: Resource, number: int, severity: Severity) -> Finding:
    """A finding about another file gets the place of the reference that led there."""
    for rule, level in (
        (source_rules.REFERENCE_REFUSED, Severity.WARNING),  # not wrong, but cannot be checked
        (source_rules.REFERENCE_MISSING, severity),
    ):
        if finding.code == rule.code:
            element = resource.element(number)
            return rule.at(element, finding.message, severity=level, hint=finding.hint)
    return replace(finding, severity=severity)


class _Parts:
    """Sids of rigid bodies and constraints, by the physics model that an instance refers to."""

    def __init__(self, resource: Resource) -> None:
        self._resource = resource
        self._own: dict[tuple[int, str], dict[int, set[str]]] = {}
        self._all: dict[tuple[int, int, str], frozenset[str]] = {}
        self._models: dict[tuple[int, int], tuple[Resource, int] | None] = {}

    def check(self, number: int, sid: str, kind: str) -> list[Finding]:
        """A finding where the instanced model has no part of that sid."""
        resource = self._resource
        instance = resource.columns.parent_of(number)
        model = self._model(resource, instance)
        if model is None:
            return []  # reported at the instance
        if sid.rpartition("/")[2] in self._within(*model, kind):
            return []
        url = resource.columns.attribute_of(instance, "url") or ""
        message = f"The physics model {url!r} has no <{kind}> of sid {sid!r}."
        return [rules.MISSING.at(resource.element(number), message)]

    def _model(self, resource: Resource, instance: int) -> tuple[Resource, int] | None:
        key = (id(resource), instance)
        if key not in self._models:
            url = resource.columns.attribute_of(instance, "url") or ""
            try:
                self._models[key] = resource.follow(url, instance, "physics_model")
            except ColladaError:
                self._models[key] = None
        return self._models[key]

    def _within(self, resource: Resource, model: int, kind: str) -> frozenset[str]:
        """Sids in the model and in the models that it instances, each looked at once."""
        key = (id(resource), model, kind)
        if key not in self._all:
            sids: set[str] = set()
            seen = {(id(resource), model)}
            waiting = [(resource, model)]
            while waiting:
                home, inner = waiting.pop()
                sids |= self._parts(home, kind).get(inner, set())
                for instance in self._parts(home, "instance_physics_model").get(inner, ()):
                    found = self._model(home, int(instance))
                    if found is not None and (id(found[0]), found[1]) not in seen:
                        seen.add((id(found[0]), found[1]))
                        waiting.append(found)
            self._all[key] = frozenset(sids)
        return self._all[key]

    def _parts(self, home: Resource, kind: str) -> dict[int, set[str]]:
        """Sids by the number of the model; of instances of models their own numbers."""
        key = (id(home), kind)
        if key not in self._own:
            found: defaultdict[int, set[str]] = defaultdict(set)
            attribute = "url" if kind == "instance_physics_model" else "sid"
            for number, text in _attributes(home, kind, attribute):
                told = str(number) if attribute == "url" else text
                found[home.columns.parent_of(number)].add(told)
            self._own[key] = dict(found)
        return self._own[key]

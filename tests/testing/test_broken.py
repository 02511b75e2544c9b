"""Broken documents have the fault that they say, and near misses have not."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings

import colladaphy
from colladaphy import ColladaError
from colladaphy.testing import (
    BROKEN_RULES,
    HOSTILE_KINDS,
    BrokenDocument,
    broken_documents,
    hostile_inputs,
)
from colladaphy.validation.catalogue import all_rules, find_rule
from colladaphy.validation.tellers import tellers

EXAMPLES = max(2, settings().max_examples // 20)
few = settings(max_examples=EXAMPLES, suppress_health_check=list(HealthCheck), deadline=None)
HEAVY = ("archives", "width")
"""Hostile by their size: each takes seconds."""

NOT_IN_DOCUMENTS = {
    "io-folder": "of a path",
    "io-missing": "of a path",
    "io-not-binary": "of a stream",
    "io-too-large": "takes two gigabytes",
    "io-unreadable": "of a path",
    "link-unknown-scene": "of a call",
    "schema-broken-key": "the schema has no keys",
    "schema-violation": "what no other rule of the schema tells",
    "schema-wrong-namespace": "a root in no namespace of COLLADA is told before the schema is",
    "xml-too-many-elements": "takes sixty million elements",
}
"""Errors of validate that no document of reasonable size has."""


def codes(document: BrokenDocument) -> set[str]:
    return {finding.code for finding in colladaphy.validate(document.data)}


@pytest.mark.parametrize("rule", BROKEN_RULES)
def test_each_rule_is_broken_and_nearly_broken(rule: str) -> None:
    @few
    @given(broken_documents(rule), broken_documents(rule, near=True))
    def run(broken: BrokenDocument, near: BrokenDocument) -> None:
        assert broken.rule == near.rule == rule
        assert broken.is_broken and not near.is_broken
        assert rule in codes(broken), broken.about
        assert rule not in codes(near), near.about

    run()


def test_every_error_of_validate_has_both() -> None:
    """A rule without a strategy that breaks it, and one that nearly does, fails here."""
    errors = {
        rule.code
        for rule in all_rules()
        if str(rule.severity) == "error"
        and "validate" in tellers(rule.code)
        and not rule.code.startswith("config-")  # of a file of settings
    }
    assert errors - set(BROKEN_RULES) == NOT_IN_DOCUMENTS.keys()
    assert not NOT_IN_DOCUMENTS.keys() & set(BROKEN_RULES)


@few
@given(broken_documents(errors=True))
def test_errors_make_a_document_invalid(document: BrokenDocument) -> None:
    rule = find_rule(document.rule)
    assert rule is not None and str(rule.severity) == "error"
    assert not colladaphy.validate(document.data).valid


def test_examples_are_small() -> None:
    quick = settings(database=None, phases=[Phase.generate, Phase.shrink], max_examples=50)
    smallest = find(broken_documents("schema-missing-element"), lambda _: True, settings=quick)
    assert len(smallest.data) < 2000


def test_unknown_names_are_refused() -> None:
    with pytest.raises(ValueError, match="no document breaks 'io-missing'"):
        broken_documents("io-missing")
    with pytest.raises(ValueError, match="no kind 'speed'; there are bytes"):
        hostile_inputs("speed")


@pytest.mark.parametrize("kind", HOSTILE_KINDS)
def test_hostile_inputs_are_taken_or_refused(kind: str) -> None:
    refused = 0

    @settings(few, max_examples=max(3 if kind in HEAVY else 8, EXAMPLES))
    @given(hostile_inputs(kind))
    def run(data: bytes) -> None:
        nonlocal refused
        report = colladaphy.validate(data)
        refused += not report.valid
        for repair in (False, True):
            try:
                colladaphy.read(data, repair=repair).load()
            except ColladaError as error:
                assert error.findings
                assert repair or not report.valid

    run()
    assert refused, "none of them was hostile"

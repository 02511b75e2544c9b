"""The catalogue holds every rule of every room, each under a code of its own."""

from __future__ import annotations

import re
from collections import Counter
from importlib import import_module
from pathlib import Path

from tests.meaning.test_cases import FAULTS

import colladaphy
from colladaphy.errors import ColladaError
from colladaphy.findings import STAGES, Report, Rule
from colladaphy.validation.catalogue import all_rules, find_rule, rule_modules, similar_codes
from colladaphy.validation.tellers import _ROOMS, TELLERS, tellers


def test_codes_are_unique() -> None:
    counts = Counter(rule.code for rule in all_rules())
    assert [code for code, count in counts.items() if count > 1] == []


def test_every_rule_constant_is_listed() -> None:
    """A rule that is missing in its module's RULES would be missing in the catalogue."""
    for name in rule_modules():
        module = import_module(name)
        constants = {value for value in vars(module).values() if isinstance(value, Rule)}
        assert constants <= set(all_rules()), name


def test_rules_are_well_formed() -> None:
    for rule in all_rules():
        assert rule.stage in STAGES, rule.code
        assert re.fullmatch(r"[a-z]+(-[a-z0-9]+)+", rule.code), rule.code
        assert rule.summary and rule.why and rule.section, rule.code
        assert tellers(rule.code) and set(tellers(rule.code)) <= set(TELLERS), rule.code


def test_finding_rules() -> None:
    rule = find_rule("xml-doctype")
    assert rule is not None and rule.stage == "xml"
    assert find_rule("nothing") is None
    assert similar_codes("xml-doctipe")[0] == "xml-doctype"
    assert "xml-doctype" in similar_codes("doctype")


def told(report: Report, use: str) -> None:
    wrong = {finding.code for finding in report if use not in tellers(finding.code)}
    assert not wrong, (use, report.file, wrong)


def test_who_reports_a_rule(corpus_dir: Path) -> None:
    """Of the corpus and of faulty documents, each use reports only what it is said to report."""
    faulty = [parameter.values[0].text().encode() for parameter in FAULTS[::7]]
    for source in (*sorted(corpus_dir.glob("*.dae")), *faulty):
        told(colladaphy.validate(source), "validate")
        try:
            document = colladaphy.read(source, repair=True)
        except ColladaError as error:
            told(Report(str(source), list(error.findings)), "read")
            continue
        for finding in document.report:
            assert {"repair", "read"} & set(tellers(finding.code)), finding
        before = len(document.report)
        try:
            document.load()
        except ColladaError as error:
            told(Report(str(source), list(error.findings)), "read")
        told(Report(str(source), document.report.findings[before:]), "read")


def test_every_room_has_uses() -> None:
    """A new room's rules would otherwise be said to be validate's."""
    rooms = {name.split(".")[1] for name in rule_modules()}
    assert rooms == set(_ROOMS)

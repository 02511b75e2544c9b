"""The catalogue holds every rule of every room, each under a code of its own."""

from __future__ import annotations

import re
from collections import Counter
from importlib import import_module

from colladaphy.findings import STAGES, Rule
from colladaphy.validation.catalogue import all_rules, find_rule, rule_modules, similar_codes


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
        assert rule.summary, rule.code


def test_finding_rules() -> None:
    rule = find_rule("xml-doctype")
    assert rule is not None and rule.stage == "xml"
    assert find_rule("nothing") is None
    assert similar_codes("xml-doctipe")[0] == "xml-doctype"
    assert "xml-doctype" in similar_codes("doctype")

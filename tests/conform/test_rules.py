"""The rules themselves."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import colladaphy.conform
from colladaphy.findings import STAGES

MODULES = [
    import_module(f"colladaphy.conform.{path.stem}")
    for path in sorted(Path(colladaphy.conform.__file__).parent.glob("*_rules.py"))
]
RULES = [rule for module in MODULES for rule in module.RULES]


def test_rules_have_codes_of_their_own_and_say_what_to_do() -> None:
    codes = [rule.code for rule in RULES]
    assert len(set(codes)) == len(codes)
    for rule in RULES:
        assert rule.stage in STAGES
        assert rule.stage in ("upgrade", "repair", "convention")
        assert rule.summary
        assert rule.hint


def test_every_rule_has_a_test() -> None:
    folder = Path(__file__).parent
    tests = "".join(path.read_text("utf-8") for path in folder.glob("test_*.py"))
    assert [rule.code for rule in RULES if f'"{rule.code}"' not in tests] == []

"""Every rule of the house, collected from the rooms that report it."""

from __future__ import annotations

from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pathlib import Path

from colladaphy.findings import STAGES, Rule

__all__ = ["all_rules", "find_rule", "rule_modules", "similar_codes"]


def rule_modules() -> list[str]:
    """The names of all modules that hold a room's rules: ``rules.py`` and ``*_rules.py``."""
    home = Path(__file__).resolve().parent.parent
    found = {*home.rglob("rules.py"), *home.rglob("*_rules.py")}
    names = (".".join(path.relative_to(home).with_suffix("").parts) for path in found)
    return sorted(f"colladaphy.{name}" for name in names)


@cache
def all_rules() -> tuple[Rule, ...]:
    """All rules, by stage in the order of the pipeline, then by code."""
    rules = [rule for module in rule_modules() for rule in import_module(module).RULES]
    return tuple(sorted(rules, key=lambda rule: (STAGES.index(rule.stage), rule.code)))


def find_rule(code: str) -> Rule | None:
    """The rule of a code."""
    return next((rule for rule in all_rules() if rule.code == code), None)


def similar_codes(code: str) -> list[str]:
    """Codes that `code` may be a misspelling of, the likeliest first."""
    codes = [rule.code for rule in all_rules()]
    inside = [known for known in codes if code and code in known]
    return list(dict.fromkeys([*get_close_matches(code, codes, 3), *inside]))[:3]

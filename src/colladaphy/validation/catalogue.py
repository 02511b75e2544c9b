"""Every rule of the house, collected from the rooms that report it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from colladaphy.findings import STAGES, Rule
from colladaphy.source import extensions

__all__ = ["all_rules", "find_rule", "own_rules", "rule_modules", "similar_codes"]


def rule_modules() -> dict[str, Path]:
    """The modules that hold a room's rules, ``rules.py`` and ``*_rules.py``: files by name."""
    home = Path(__file__).resolve().parent.parent
    found = sorted({*home.rglob("rules.py"), *home.rglob("*_rules.py")})
    return {
        ".".join(("colladaphy", *path.relative_to(home).with_suffix("").parts)): path
        for path in found
    }


def all_rules() -> tuple[Rule, ...]:
    """Our rules, then those of other packages that are not broken."""
    return own_rules() + _offered()


@cache
def _offered() -> tuple[Rule, ...]:
    if not extensions.offered(extensions.RULES):
        return ()
    from colladaphy.meaning.checking import fault_of_rules

    known = {rule.code for rule in own_rules()}
    modules, _ = extensions.loaded(extensions.RULES, fault_of_rules)
    rules = {rule.code: rule for _, module in modules for rule in module.RULES}
    return tuple(rules[code] for code in sorted(rules.keys() - known))


@cache
def own_rules() -> tuple[Rule, ...]:
    """Our rules, by stage in the order of the pipeline, then by code.

    The modules of rules are run by themselves: to import them would bring in their rooms, and
    numpy with these.
    """
    from runpy import run_path

    rules = [rule for path in rule_modules().values() for rule in run_path(str(path))["RULES"]]
    return tuple(sorted(rules, key=lambda rule: (STAGES.index(rule.stage), rule.code)))


def find_rule(code: str) -> Rule | None:
    """The rule of a code."""
    return next((rule for rule in all_rules() if rule.code == code), None)


def similar_codes(code: str) -> list[str]:
    """Codes that `code` may be a misspelling of, the likeliest first."""
    from difflib import get_close_matches

    codes = [rule.code for rule in all_rules()]
    inside = [known for known in codes if code and code in known]
    return list(dict.fromkeys([*get_close_matches(code, codes, 3), *inside]))[:3]

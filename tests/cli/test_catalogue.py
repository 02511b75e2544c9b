"""``rules`` and ``explain``: what each code means, and who can report it."""

from __future__ import annotations

import json

import pytest

from colladaphy.cli import run
from colladaphy.validation import all_rules
from colladaphy.validation.tellers import TELLERS, tellers


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert run(list(arguments)) == 0
    return capsys.readouterr().out


def test_rules_stand_by_stage_and_say_who_reports_them(capsys: pytest.CaptureFixture[str]) -> None:
    lines = said(capsys, "rules").splitlines()
    stages = [line for line in lines if not line.startswith(" ")]
    assert stages == [f"{stage}:" for stage in dict.fromkeys(rule.stage for rule in all_rules())]
    for rule in all_rules():
        (line,) = [line for line in lines if line.split()[0] == rule.code]
        assert str(rule.severity) in line
        assert line.endswith(f"({', '.join(tellers(rule.code))})")


def test_rules_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    rules = json.loads(said(capsys, "rules", "--format", "json"))
    assert [rule["code"] for rule in rules] == [rule.code for rule in all_rules()]
    for rule in rules:
        assert rule["why"] and rule["section"] and rule["code"].startswith(rule["stage"])
        assert tuple(rule["by"]) == tellers(rule["code"])


def test_rules_of_one_use(capsys: pytest.CaptureFixture[str]) -> None:
    for use in TELLERS:
        rules = json.loads(said(capsys, "rules", "--by", use, "--format", "json"))
        assert {rule["code"] for rule in rules} == {
            rule.code for rule in all_rules() if use in tellers(rule.code)
        }
        assert rules
    assert said(capsys, "rules", "--by", "simulate", "--stage", "xml") == ""
    assert run(["rules", "--by", "nobody"]) == 2
    assert "validate" in capsys.readouterr().err


def test_explain_says_it_all(capsys: pytest.CaptureFixture[str]) -> None:
    for rule in all_rules():
        text = said(capsys, "explain", rule.code)
        assert rule.why and rule.section
        for part in (rule.code, rule.stage, rule.summary, rule.why, rule.section, rule.hint or ""):
            assert part in text
        assert ", ".join(tellers(rule.code)) in text

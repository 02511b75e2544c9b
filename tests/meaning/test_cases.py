"""Every rule has documents that it is not kept in, and documents that nearly are such.

A case is an edit of a document in `bases`, in which nothing is wrong. A fault gives exactly one
finding, of its rule, at the line that was edited; a near miss gives none.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest

import colladaphy
from colladaphy.findings import Finding
from colladaphy.meaning import SUBJECTS
from colladaphy.validation.catalogue import find_rule, rule_modules

HERE = Path(__file__).parent
GOLDEN = HERE / "golden.txt"
BASES = {path.stem: path for path in sorted((HERE / "bases").glob("*.dae"))}
ELSEWHERE = {"link-cycle", "link-missing", "link-wrong-type", "link-not-rigid",
             "link-several-places", "io-reference-refused", "io-reference-missing"}  # fmt: skip
"""Rules of other rooms that are reported here."""


@dataclass(frozen=True)
class Case:
    """One edit of a base."""

    name: str
    rule: str
    base: str
    edits: tuple[tuple[str, str], ...]
    at: str | None
    severity: str | None

    def text(self) -> str:
        """The document after the edits."""
        text = BASES[self.base].read_text("utf-8")
        for old, new in self.edits:
            assert old in text, (self.name, old)
            text = text.replace(old, new, 1)
        return text

    def line(self) -> int:
        """Where the finding should stand."""
        old, new = self.edits[-1]
        text, mark = self.text(), self.at or _changed(old, new)
        assert mark in text, (self.name, mark)
        return text[: text.index(mark)].count("\n") + 1

    def report(self, folder: Path) -> list[Finding]:
        """What validation finds in it."""
        path = folder / "case.dae"
        path.write_text(self.text(), "utf-8")
        (folder / "wood.png").touch()
        return list(colladaphy.validate(path))


def _changed(old: str, new: str) -> str:
    """The last line of an edit that is not in what was there before, and what follows it."""
    before = [line.strip() for line in old.splitlines()]
    lines = new.splitlines()
    number = max(i for i, line in enumerate(lines) if line.strip() and line.strip() not in before)
    return "\n".join(lines[number:]).strip()


def _unfolded(text: str | None) -> Any:
    return text and text.replace("\\n", "\n")


def _cases(kind: str) -> list[Any]:
    found = []
    for path in sorted((HERE / "cases").glob("*.toml")):
        content = tomllib.loads(path.read_text("utf-8"))
        for entry in content.get(kind, ()):
            case = Case(
                entry["name"], entry["rule"], entry.get("base", content["base"]),
                tuple((_unfolded(old), _unfolded(new)) for old, new in entry["edits"]),
                _unfolded(entry.get("at")),
                entry.get("severity"),
            )  # fmt: skip
            found.append(pytest.param(case, id=f"{path.stem}: {case.name}"))
    return found


FAULTS, NEAR = _cases("fault"), _cases("near")


@pytest.mark.parametrize("base", BASES)
def test_nothing_is_wrong_in_the_bases(base: str) -> None:
    assert [str(finding) for finding in colladaphy.validate(BASES[base])] == []


@pytest.mark.parametrize("case", FAULTS)
def test_a_fault_gives_one_finding_at_its_line(case: Case, tmp_path: Path) -> None:
    found = case.report(tmp_path)
    assert [(finding.code, finding.line) for finding in found] == [(case.rule, case.line())], found
    rule = find_rule(case.rule)
    assert rule is not None
    (finding,) = found
    assert str(finding.severity) == (case.severity or str(rule.severity))
    assert finding.column is not None and finding.path and finding.hint


@pytest.mark.parametrize("case", NEAR)
def test_a_near_miss_gives_none(case: Case, tmp_path: Path) -> None:
    assert [str(finding) for finding in case.report(tmp_path)] == []


def test_every_rule_has_a_fault_and_a_near_miss() -> None:
    own = [path for name, path in rule_modules().items() if name.startswith("colladaphy.meaning.")]
    assert own and SUBJECTS
    rules = {rule.code for path in own for rule in run_path(str(path))["RULES"]} | ELSEWHERE
    faults = {parameter.values[0].rule for parameter in FAULTS}
    near = {parameter.values[0].rule for parameter in NEAR}
    assert rules - faults == set(), "rules without a document that they are not kept in"
    assert rules - near == set(), "rules without a near miss"


def test_the_golden_report(tmp_path: Path) -> None:
    """All findings of all faults, word by word; `python -m tests.meaning.golden` writes it."""
    assert golden(tmp_path) == GOLDEN.read_text("utf-8")


def golden(folder: Path) -> str:
    """The text of the golden report."""
    lines = []
    for parameter in FAULTS:
        case: Case = parameter.values[0]
        lines.append(f"# {parameter.id}")
        for finding in case.report(folder):
            place = f"{finding.line}:{finding.column}"
            lines.append(f"{place}: {finding.severity} {finding.code}: {finding.message}")
            said = (("attribute", finding.attribute), ("sid", finding.sid))
            about = " ".join(f"{key}={value}" for key, value in said if value)
            lines.append(f"  {finding.path} {about}".rstrip())
            lines.extend(f"  beside {path}, line {line}" for path, line in finding.related)
            lines.append(f"  {finding.hint}")
    return "\n".join(lines) + "\n"

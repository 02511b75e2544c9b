"""JUnit XML: a suite a file, a test case a finding; files in which all is well are one case."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from xml.etree import ElementTree

from colladaphy.findings import Finding
from colladaphy.validation.checking import Checked
from colladaphy.validation.reporters.places import labelled, place_of
from colladaphy.validation.reporters.presentation import Presentation

__all__ = ["render"]

# What XML 1.0 cannot hold.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render(results: Iterable[Checked], _: Presentation) -> Iterator[str]:
    """The report as one text. What is not grave enough to fail a check is output, no failure."""
    root = ElementTree.Element("testsuites", name="colladaphy")
    sums = {"tests": 0, "failures": 0, "errors": 0}
    for result in results:
        suite = _suite(result)
        for name in sums:
            sums[name] += int(suite.get(name, 0))
        root.append(suite)
    for name, count in sums.items():
        root.set(name, str(count))
    ElementTree.indent(root)
    yield '<?xml version="1.0" encoding="utf-8"?>'
    yield ElementTree.tostring(root, "unicode")


def _suite(result: Checked) -> ElementTree.Element:
    report = result.report
    file = _clean(report.file or "-")
    suite = ElementTree.Element("testsuite", name=file)
    counts = {"failure": 0, "error": 0}
    for finding in report:
        case = ElementTree.SubElement(suite, "testcase", classname=file, name=_name(finding))
        kind = "" if not result.settings.grave(finding) else "failure"
        kind = kind if result.readable else "error"
        place = place_of(finding, report)
        if kind:
            counts[kind] += 1
            fault = ElementTree.SubElement(
                case, kind, type=str(finding.severity), message=_clean(labelled(finding, place))
            )
            fault.text = _clean(str(finding))
        else:
            ElementTree.SubElement(case, "system-out").text = _clean(str(finding))
    if not report.findings:
        ElementTree.SubElement(suite, "testcase", classname=file, name="validate")
    suite.set("tests", str(len(suite)))
    suite.set("failures", str(counts["failure"]))
    suite.set("errors", str(counts["error"]))
    return suite


def _name(finding: Finding) -> str:
    place = ":".join(str(part) for part in (finding.line, finding.column) if part)
    return _clean(f"{finding.code} {place}".strip())


def _clean(text: str) -> str:
    return _FORBIDDEN.sub("\ufffd", text)

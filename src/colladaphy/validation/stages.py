"""The stages of a check: io, xml, schema, meaning. The first that fails is the last that runs."""

from __future__ import annotations

from dataclasses import replace

from colladaphy.errors import InputError, XmlError
from colladaphy.findings import Report, unchanging
from colladaphy.gate import gate
from colladaphy.gate.numerals import incomplete_numbers
from colladaphy.links.resource import Resource
from colladaphy.meaning import check
from colladaphy.source import Limits, Parsed, Source, load, parse_loaded
from colladaphy.source import rules as source_rules
from colladaphy.source.places import locate
from colladaphy.validation.availability import availability

__all__ = ["validate"]

# Nothing could be read at all: there is no document to report about.
_UNREADABLE = frozenset(
    rule.code
    for rule in (
        source_rules.MISSING,
        source_rules.FOLDER,
        source_rules.UNREADABLE,
        source_rules.NOT_BINARY,
    )
)


def validate(source: Source, *, limits: Limits | None = None) -> Report:
    """Check a document and report everything that is wrong with it.

    Bad content is reported, never raised. InputError only where there is nothing to read: a
    missing file, a folder, no permission.
    """
    limits = limits or Limits()
    try:
        loaded = load(source, limits)
    except InputError as error:
        if any(finding.code in _UNREADABLE for finding in error.findings):
            raise
        file = next((finding.file for finding in error.findings if finding.file), None)
        return Report(file, list(error.findings))
    report = Report(loaded.file)
    try:
        parsed = parse_loaded(loaded)
    except XmlError as error:
        report.extend(error.findings)
        return report
    report.extend(gate(parsed.tree))
    report.extend(incomplete_numbers(parsed.tree, loaded.data))
    if report.valid:
        with unchanging():
            resource = _resource(parsed, loaded.data, Report(parsed.file), {})
            report.extend(check(resource, availability(parsed)))
    _locate(report, loaded.data)
    return report


def _locate(report: Report, data: bytes) -> None:
    """Give findings their columns, and lines that are exact in long documents too."""
    wanted = {
        finding.path
        for finding in report
        if finding.path and finding.column is None and finding.file == report.file
    }
    places = locate(data, wanted) if wanted else {}
    for index, finding in enumerate(report.findings):
        if finding.path in places and finding.path in wanted:
            line, column = places[finding.path]
            report.findings[index] = replace(finding, line=line, column=column)


def _resource(
    parsed: Parsed, data: bytes | None, report: Report, family: dict[str, Resource]
) -> Resource:
    def opener(file: str) -> Resource:
        other = parsed.parse_relative(file)
        return _resource(other, None, Report(other.file), family)

    return Resource(parsed.tree, data, file=parsed.file, report=report, opener=opener,
                    family=family)  # fmt: skip

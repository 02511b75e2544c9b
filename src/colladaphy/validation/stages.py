"""The stages of a check: io, xml, schema, meaning. The first that fails is the last that runs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from colladaphy.errors import DocumentError, InputError, XmlError
from colladaphy.findings import Report, Severity, unchanging
from colladaphy.gate import accepts, gate
from colladaphy.gate.numerals import incomplete_numbers
from colladaphy.links import rules as link_rules
from colladaphy.links.resource import Resource
from colladaphy.source import Limits, Loaded, Source, load, parse_loaded
from colladaphy.source import rules as source_rules
from colladaphy.source.places import locate
from colladaphy.validation.availability import availability
from colladaphy.validation.options import Options

if TYPE_CHECKING:
    from lxml import etree

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
_LARGE = 1 << 16
"""Bytes from which a tree costs more than to look first whether one is needed."""


def validate(
    source: Source, *, limits: Limits | None = None, options: Options | None = None
) -> Report:
    """Check a document and report everything that is wrong with it.

    Bad content is reported, never raised. InputError only where there is nothing to read: a
    missing file, a folder, no permission.
    """
    limits = limits or Limits()
    options = options or Options()
    try:
        loaded = load(source, limits)
    except InputError as error:
        if any(finding.code in _UNREADABLE for finding in error.findings):
            raise
        file = next((finding.file for finding in error.findings if finding.file), None)
        return Report(file, list(error.findings))
    report = Report(loaded.file)
    if len(loaded.data) >= _LARGE and accepts(loaded.data, limits):
        # Nothing is wrong with it up to here, and no tree is needed to know it.
        _check_meaning(report, loaded, None)
    else:
        try:
            parsed = parse_loaded(loaded)
        except XmlError as error:
            report.extend(error.findings)
            return report
        report.extend(gate(parsed.tree))
        report.extend(incomplete_numbers(parsed.tree, loaded.data))
        if report.valid:
            _check_meaning(report, loaded, parsed.tree)
    _locate(report, loaded.data)
    return report


def _check_meaning(report: Report, loaded: Loaded, tree: etree._ElementTree | None) -> None:
    from colladaphy.meaning import check

    family: dict[str, Resource] = {}
    with unchanging():
        report.extend(check(_resource(loaded, tree, family), availability(loaded)))
        seen = {loaded.file}
        while others := [other for other in family.values() if other.file not in seen]:
            for other in others:
                seen.add(other.file)
                # Of the documents that it leads to, only what keeps it from being loaded.
                report.extend(
                    finding
                    for finding in check(other)
                    if finding.severity is Severity.ERROR and finding.stage in ("link", "physics")
                )


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
    loaded: Loaded, tree: etree._ElementTree | None, family: dict[str, Resource]
) -> Resource:
    """A document, and the way to those that it refers to, which have to be valid too."""
    refused: dict[str, DocumentError] = {}

    def opener(file: str) -> Resource:
        if file in refused:
            raise refused[file]
        other = loaded.load_relative(file)
        faults = [finding for finding in gate(parse_loaded(other).tree)
                  if finding.severity is Severity.ERROR]  # fmt: skip
        if faults:
            message = f"The document {file!r} is not valid: {faults[0].message}"
            refused[file] = DocumentError(link_rules.MISSING.at(message=message))
            raise refused[file]
        return _resource(other, None, family)

    return Resource(tree, loaded.data, parser=lambda: parse_loaded(loaded).tree, file=loaded.file,
                    report=Report(loaded.file), opener=opener, family=family)  # fmt: skip

"""The stages of a check: io, xml, schema, link. The first that fails is the last that runs."""

from __future__ import annotations

from colladaphy.document import Document
from colladaphy.errors import InputError, XmlError
from colladaphy.findings import Report
from colladaphy.schema import gate
from colladaphy.source import Limits, Parsed, Source, load, parse_loaded
from colladaphy.source import rules as source_rules
from colladaphy.validation.links import check_links

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
    if report.valid:
        document = _document(parsed, report, {})
        report.extend(check_links(document))
    return report


def _document(parsed: Parsed, report: Report, family: dict[str, Document]) -> Document:
    def opener(file: str) -> Document:
        other = parsed.parse_relative(file)
        return _document(other, Report(other.file), family)

    return Document(parsed.tree, file=parsed.file, report=report, opener=opener, family=family)

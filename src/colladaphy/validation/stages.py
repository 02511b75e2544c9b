"""The stages of a check: io, xml, schema, meaning. Each is run on what the one before leaves."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from colladaphy.errors import DocumentError, InputError, XmlError
from colladaphy.findings import Finding, Report, Severity, unchanging
from colladaphy.gate import gate
from colladaphy.gate.faults import violations
from colladaphy.gate.messages import Violation
from colladaphy.gate.numerals import incomplete_violations
from colladaphy.links import rules as link_rules
from colladaphy.links.resource import Resource
from colladaphy.source import Limits, Loaded, Source, load, parse_loaded
from colladaphy.source import rules as source_rules
from colladaphy.source.mending import mend_text
from colladaphy.source.places import locate
from colladaphy.source.xml import COLLADA_1_5, root_start
from colladaphy.validation.availability import availability
from colladaphy.validation.options import HUGE, Options, is_large

if TYPE_CHECKING:
    from lxml import etree

    from colladaphy.columns.accepting import Verdict
    from colladaphy.columns.reading import Document as Columns
    from colladaphy.validation.behind import Came

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

    What stands behind a fault is looked at in a copy that is mended; findings are about the
    document as it came. Bad content is reported, never raised. InputError only where there is
    nothing to read: a missing file, a folder, no permission.
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
    verdict = _verdict(loaded, limits)
    if verdict is not None and verdict.accepted:
        # Nothing is wrong with it up to here, and no tree is needed to know it.
        _check_valid(report, loaded, None, verdict.columns)
    elif verdict is not None and (told := _told_without_a_tree(loaded, verdict, limits)):
        report.extend(told)
    else:
        try:
            tree = parse_loaded(loaded).tree
        except XmlError as error:
            report.extend(error.findings)
            again = _readable(loaded, report)
            if again is None:
                return report
            loaded, tree = again
        deviations = _deviations(tree, loaded.data)
        if deviations == []:
            _check_valid(report, loaded, tree)
        else:
            from colladaphy.validation.behind import check_behind
            from colladaphy_schema.codec import paused_collector

            with unchanging(), paused_collector():
                family: dict[str, Resource] = {}
                report.extend(check_behind(_came(loaded, tree, family), deviations, options))
                _check_others(report, loaded, family)
    _locate(report, loaded.data)
    return report


def _readable(loaded: Loaded, report: Report) -> tuple[Loaded, etree._ElementTree] | None:
    """A document that is no XML, as it is after its text is mended; None where it stays none."""
    data, changes = mend_text(loaded.data, root_start(loaded.data), loaded.file)
    if not changes:
        return None
    again = replace(loaded, data=data)
    try:
        tree = parse_loaded(again).tree
    except XmlError:
        return None
    report.findings = [replace(finding, repair=changes[0].code) for finding in report.findings]
    return again, tree


def _deviations(
    tree: etree._ElementTree, data: bytes
) -> list[tuple[etree._Element, Violation]] | None:
    """What libxml2 complains about; None where the document is not in the namespace of 1.5."""
    if not tree.getroot().tag.startswith(f"{{{COLLADA_1_5}}}"):
        return None
    return violations(tree, fresh=True) + incomplete_violations(tree, data)


def _verdict(loaded: Loaded, limits: Limits) -> Verdict | None:
    """What is known of a document without a tree; None where a tree costs less."""
    if len(loaded.data) < _LARGE:
        return None
    from colladaphy.columns.accepting import judge

    return judge(loaded.data, limits)


def _told_without_a_tree(loaded: Loaded, verdict: Verdict, limits: Limits) -> list[Finding]:
    """What is wrong with a very large document; none where only a tree of all of it can tell."""
    if verdict.thinned is None or len(loaded.data) < HUGE:
        return []
    from colladaphy.validation.repeating import check_rest
    from colladaphy_schema.codec import paused_collector

    with unchanging(), paused_collector():
        return check_rest(verdict.thinned, loaded, limits)


def _check_valid(
    report: Report,
    loaded: Loaded,
    tree: etree._ElementTree | None,
    columns: Columns | None = None,
) -> None:
    from colladaphy.meaning import findings_of, hits_of
    from colladaphy.validation.mendable import is_mendable

    family: dict[str, Resource] = {}
    with unchanging():
        resource = _resource(loaded, tree, family, columns=columns)
        hits = hits_of(resource, availability(loaded))
        told = any(map(is_mendable, hits)) and not is_large(loaded.data)
        if told or resource.has_other_spelling:
            from colladaphy.validation.behind import check_meaning

            came = _came(loaded, resource.tree, family)
            report.extend(check_meaning(came, resource, hits))
        else:
            report.extend(findings_of(resource.columns, resource.file, hits))
        _check_others(report, loaded, family)


def _came(loaded: Loaded, tree: etree._ElementTree, family: dict[str, Resource]) -> Came:
    from colladaphy.validation.behind import Came

    def read(shown: etree._ElementTree) -> Resource:
        return _resource(loaded, shown, family, changed=True)

    return Came(tree, loaded.data, loaded.file, read, availability(loaded))


def _check_others(report: Report, loaded: Loaded, family: dict[str, Resource]) -> None:
    """Of the documents that it leads to, only what keeps it from being loaded."""
    from colladaphy.meaning import check

    seen = {loaded.file}
    while others := [other for other in family.values() if other.file not in seen]:
        for other in others:
            seen.add(other.file)
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
    loaded: Loaded,
    tree: etree._ElementTree | None,
    family: dict[str, Resource],
    *,
    changed: bool = False,
    columns: Columns | None = None,
) -> Resource:
    """A document, and the way to those that it refers to, which have to be valid too.

    The tree is `changed` where it is not what the bytes were parsed to.
    """
    refused: dict[str, DocumentError] = {}

    def opener(file: str) -> Resource:
        if file in refused:
            raise refused[file]
        other = loaded.load_relative(file)
        if changed and other.file == loaded.file:
            return made
        faults = [finding for finding in gate(parse_loaded(other).tree)
                  if finding.severity is Severity.ERROR]  # fmt: skip
        if faults:
            message = f"The document {file!r} is not valid: {faults[0].message}"
            refused[file] = DocumentError(link_rules.MISSING.at(message=message))
            raise refused[file]
        return _resource(other, None, family)

    data = None if changed else loaded.data
    made = Resource(tree, data, parser=lambda: parse_loaded(loaded).tree, file=loaded.file,
                    report=Report(loaded.file), opener=opener, family=family,
                    columns=columns)  # fmt: skip
    return made

"""Reading and writing: the straight way from a file to a Document and back."""

from __future__ import annotations

import logging

from colladaphy.columns.accepting import Verdict, judge
from lxml import etree

from colladaphy.conform import conform
from colladaphy.document.document import Document
from colladaphy.document.writing import Output, document_bytes, write_world
from colladaphy.errors import SchemaError
from colladaphy.findings import Report, Severity
from colladaphy.gate import gate
from colladaphy.links.resource import Resource
from colladaphy.mapper import WriteOptions
from colladaphy.source import Limits, Loaded, Parsed, Source, load, parse_loaded
from colladaphy.world import World

__all__ = ["document_bytes", "document_of", "document_of_mended", "read", "write"]

_log = logging.getLogger("colladaphy.document")


def read(
    source: Source,
    *,
    repair: bool = False,
    convention: str = "auto",
    limits: Limits | None = None,
) -> Document:
    """Read a COLLADA document: a path, bytes or a binary file object, .dae or .zae.

    Only schema-valid COLLADA 1.5 is accepted, unless `repair` is asked for: then older versions
    are upgraded, known faults mended and the ways of other writers (`convention`) understood, and
    everything that was changed is in the document's report. Raises InputError, XmlError or
    SchemaError with all findings.
    """
    loaded = load(source, limits or Limits())
    resource = _read(loaded, repair=repair, convention=convention, family={})
    return Document(resource, archive=loaded.archive, member=loaded.member)


def document_of(parsed: Parsed, *, repair: bool, convention: str = "auto") -> Document:
    """The Document of a file that is parsed already; see `read`."""
    resource = _parsed(parsed, None, repair=repair, convention=convention, family={})
    return Document(resource, archive=parsed.archive, member=parsed.member)


def document_of_mended(
    parsed: Parsed, tree: etree._ElementTree, *, convention: str = "auto"
) -> Document:
    """The Document of what `conform` made of a file; see `read`."""

    def opener(file: str) -> Resource:
        other = parsed.load_relative(file)
        return _read(other, repair=True, convention=convention, family={})

    resource = Resource(tree, file=parsed.file, opener=opener, tolerant=True, member=parsed.member)
    return Document(resource, archive=parsed.archive, member=parsed.member)


def _read(
    loaded: Loaded, *, repair: bool, convention: str, family: dict[str, Resource]
) -> Resource:
    """One document of a family, without a tree where none is needed to know that it is valid."""
    verdict = Verdict(False) if repair else judge(loaded.data, loaded.limits)
    if not verdict.accepted:
        parsed = parse_loaded(loaded, mend=repair)
        data = None if repair else loaded.data
        return _parsed(parsed, data, repair=repair, convention=convention, family=family)
    _log.info("read %s with 0 findings", loaded.file or "a document")

    def opener(file: str) -> Resource:
        other = loaded.load_relative(file)
        return _read(other, repair=repair, convention=convention, family=family)

    return Resource(None, loaded.data, parser=lambda: parse_loaded(loaded).tree, file=loaded.file,
                    opener=opener, family=family, member=loaded.member,
                    columns=verdict.columns)  # fmt: skip


def _parsed(
    parsed: Parsed, data: bytes | None, *, repair: bool, convention: str,
    family: dict[str, Resource],
) -> Resource:  # fmt: skip
    """One document of a family, whose members are opened when references lead there."""
    report = Report(parsed.file)
    report.extend(parsed.findings)
    tree = parsed.tree
    if repair:
        tree, changes = conform(tree, file=parsed.file, convention=convention)
        report.extend(changes)
    faults = gate(tree, fresh=not repair)
    report.extend(faults)
    _log.info("read %s with %d findings", parsed.file or "a document", len(report))
    if any(fault.severity is Severity.ERROR for fault in faults):
        raise SchemaError(report.findings)

    def opener(file: str) -> Resource:
        other = parsed.load_relative(file)
        return _read(other, repair=repair, convention=convention, family=family)

    return Resource(tree, data, file=parsed.file, report=report, opener=opener, family=family,
                    tolerant=repair, member=parsed.member)  # fmt: skip


def write(
    content: World | Document, target: Output, *, options: WriteOptions | None = None
) -> None:
    """Write a World or a Document to a .dae or .zae file, or to a binary file object.

    Nothing is written that is not schema-valid COLLADA 1.5, and a file is replaced as a whole or
    not at all. A document that came from an archive keeps the other files of it. Raises SchemaError
    or OutputError.
    """
    if isinstance(content, Document):
        content.write(target)
    else:
        write_world(content, target, options)

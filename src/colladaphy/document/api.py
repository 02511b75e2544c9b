"""Reading and writing: the straight way from a file to a Document and back."""

from __future__ import annotations

import logging

from lxml import etree

from colladaphy.columns.accepting import judge
from colladaphy.columns.reading import Document as Columns
from colladaphy.conform import conform
from colladaphy.document.document import Document
from colladaphy.document.writing import Output, document_bytes, write_world
from colladaphy.errors import SchemaError
from colladaphy.findings import Report, Severity
from colladaphy.gate import gate
from colladaphy.links.resource import Resource
from colladaphy.links.settled import is_settled
from colladaphy.mapper import WriteOptions
from colladaphy.source import Limits, Loaded, Parsed, Source, load, parse_loaded
from colladaphy.world import World

__all__ = [
    "document_bytes",
    "document_of",
    "document_of_mended",
    "read",
    "settled_document",
    "write",
]

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


def _judged(loaded: Loaded, convention: str | None) -> tuple[bool, Columns | None]:
    """Whether a document is sure to be valid, and its columns where they were read on the way.

    With a convention, it has to be sure, too, that repair would change nothing.
    """
    verdict = judge(loaded.data, loaded.limits)
    if not verdict.accepted or convention is None:
        return verdict.accepted, verdict.columns
    columns = verdict.columns or Columns.of(loaded.data)
    return is_settled(columns, convention), columns


def settled_document(loaded: Loaded, convention: str = "auto") -> tuple[Document, Columns] | None:
    """What repair would read, with its columns, where it is sure that repair changes nothing."""
    settled, columns = _judged(loaded, convention)
    if not settled or columns is None:
        return None
    resource = _valid(loaded, columns, repair=True, convention=convention, family={})
    return Document(resource, archive=loaded.archive, member=loaded.member), columns


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
    settled, columns = _judged(loaded, convention if repair else None)
    if not settled:
        parsed = parse_loaded(loaded, mend=repair)
        data = None if repair else loaded.data
        return _parsed(parsed, data, repair=repair, convention=convention, family=family)
    return _valid(loaded, columns, repair=repair, convention=convention, family=family)


def _valid(
    loaded: Loaded, columns: Columns | None, *, repair: bool, convention: str,
    family: dict[str, Resource],
) -> Resource:  # fmt: skip
    """A document that is known to be valid, and has no tree until one is needed."""
    _log.info("read %s with 0 findings", loaded.file or "a document")

    def opener(file: str) -> Resource:
        other = loaded.load_relative(file)
        return _read(other, repair=repair, convention=convention, family=family)

    return Resource(None, loaded.data, parser=lambda: parse_loaded(loaded).tree, file=loaded.file,
                    opener=opener, family=family, member=loaded.member, tolerant=repair,
                    columns=columns)  # fmt: skip


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

"""Reading and writing: the straight way from a file to a Document and back."""

from __future__ import annotations

import logging
from os import PathLike
from typing import TYPE_CHECKING, BinaryIO

from lxml import etree

from colladaphy.document.document import Document
from colladaphy.document.values import bad_numbers
from colladaphy.errors import SchemaError
from colladaphy.findings import Report, Severity
from colladaphy.gate import gate
from colladaphy.source import Limits, Parsed, Source, packed_for, parse, save

if TYPE_CHECKING:
    from colladaphy.mapper import WriteOptions
    from colladaphy.world import World

__all__ = ["document_bytes", "read", "write"]

_log = logging.getLogger(__name__)

Output = str | PathLike[str] | BinaryIO


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
    parsed = parse(source, limits or Limits(), mend=repair)
    return document_of(parsed, repair=repair, convention=convention, family={})


def document_of(
    parsed: Parsed, *, repair: bool, convention: str, family: dict[str, Document]
) -> Document:
    """The Document of a parsed file; see `read`. `family` are the documents open already."""
    report = Report(parsed.file, list(parsed.findings))
    tree = parsed.tree
    if repair:
        from colladaphy.conform import conform

        tree, changes = conform(tree, file=parsed.file, convention=convention)
        report.extend(changes)
    faults = gate(tree, fresh=not repair)
    report.extend(faults)
    _log.info("read %s with %d findings", parsed.file or "a document", len(report))
    if any(fault.severity is Severity.ERROR for fault in faults):
        raise SchemaError(report.findings)

    def opener(file: str) -> Document:
        other = parsed.parse_relative(file)
        return document_of(other, repair=repair, convention=convention, family=family)

    return Document(
        tree,
        file=parsed.file,
        report=report,
        opener=opener,
        family=family,
        tolerant=repair,
        archive=parsed.archive,
        member=parsed.member,
    )


def write(
    content: World | Document, target: Output, *, options: WriteOptions | None = None
) -> None:
    """Write a World or a Document to a .dae or .zae file, or to a binary file object.

    Nothing is written that is not schema-valid COLLADA 1.5, and a file is replaced as a whole or
    not at all. A document that came from an archive keeps the other files of it. Raises SchemaError
    or OutputError.
    """
    if isinstance(content, Document):
        data = packed_for(target, document_bytes(content), content.archive, content.member)
    else:
        from colladaphy.mapper import store

        data = packed_for(target, store(content, options))
    save(data, target)
    _log.info("wrote %d bytes to %s", len(data), target)


def document_bytes(document: Document) -> bytes:
    """The document as UTF-8, checked again as it now is."""
    tree = document.tree
    data = etree.tostring(tree, encoding="UTF-8", xml_declaration=True)
    faults = gate(tree) or bad_numbers(tree, data=data)
    if faults:
        raise SchemaError(faults)
    return data

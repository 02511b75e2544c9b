"""Writing documents: checked as they are now, and replaced as a whole or not at all."""

from __future__ import annotations

import logging
from os import PathLike
from typing import BinaryIO

from lxml import etree

from colladaphy.document.values import bad_numbers
from colladaphy.errors import DocumentError, SchemaError
from colladaphy.findings import Severity, unchanging
from colladaphy.gate import gate
from colladaphy.links.resource import Resource
from colladaphy.mapper import WriteOptions, store
from colladaphy.meaning import check
from colladaphy.source import Archive, packed_for, save
from colladaphy.source.splitting import with_short_texts
from colladaphy.world import World

__all__ = ["Output", "document_bytes", "write_document", "write_world"]

_log = logging.getLogger("colladaphy.document")

Output = str | PathLike[str] | BinaryIO


def document_bytes(resource: Resource) -> bytes:
    """The document as UTF-8; SchemaError where it is not valid."""
    tree = resource.tree
    data = etree.tostring(tree, encoding="UTF-8", xml_declaration=True)
    faults = gate(tree) or bad_numbers(tree, data=data)
    if faults:
        raise SchemaError(faults)
    return with_short_texts(data)


def write_document(
    resource: Resource, target: Output, archive: Archive | None, member: str | None, checked: bool
) -> None:
    """Write a document; one that came from an archive keeps the other files of it.

    If it is to be `checked`, DocumentError where its meaning is wrong.
    """
    data = document_bytes(resource)
    if checked:
        with unchanging():
            wrong = [each for each in check(resource) if each.severity is Severity.ERROR]
        if wrong:
            raise DocumentError(wrong)
    _save(packed_for(target, data, archive, member), target)


def write_world(world: World, target: Output, options: WriteOptions | None) -> None:
    """Write a World as a document of its own."""
    _save(packed_for(target, with_short_texts(store(world, options))), target)


def _save(data: bytes, target: Output) -> None:
    save(data, target)
    _log.info("wrote %d bytes to %s", len(data), target)

"""Storing: a World as columns, and these as a document that has passed the gate."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.columns.writing import document_bytes
from colladaphy.errors import SchemaError
from colladaphy.gate import gate, is_valid_text
from colladaphy.mapper.storing.document import columns_of
from colladaphy_schema.codec import paused_collector
from colladaphy_schema.rows import Column, Rows

if TYPE_CHECKING:
    from colladaphy.findings import Finding
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["columns_of", "store"]

_log = logging.getLogger(__name__)


def store(world: World, options: WriteOptions | None = None) -> bytes:
    """The World as a schema-valid document in UTF-8; SchemaError if it should not be one."""
    with paused_collector():
        columns = columns_of(world, options)
        data = document_bytes(columns)
        faults = _faults(columns, data)
    if faults:
        raise SchemaError(faults)
    _log.info("stored %d bodies, %d joints in %d bytes", len(world.bodies), len(world.joints),
              len(data))  # fmt: skip
    return data


def _faults(columns: Rows, data: bytes) -> list[Finding]:
    """What is wrong with a document; the gate is asked where anything is."""
    ids = _ids(columns)
    if len(set(ids)) == len(ids) and is_valid_text(data):
        return []
    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    return gate(etree.ElementTree(etree.fromstring(data, parser)), fresh=True)


def _ids(rows: Rows) -> list[str]:
    """All ids of elements; libxml2 does not look whether one is there twice while it parses."""
    found: list[str] = []
    for field in rows.FIELDS:
        value = rows.known.get(field.name)
        if isinstance(value, Rows):
            found += _ids(value)
        elif isinstance(field, Column) and field.tag == "id" and isinstance(value, list):
            found += [id for id in value if id is not None]
    return found

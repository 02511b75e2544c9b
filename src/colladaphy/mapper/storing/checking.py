"""The gate on the way out: every document is valid by construction, and checked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from lxml import etree

from colladaphy.columns.sampling import sampled
from colladaphy.columns.writing import document_bytes
from colladaphy.gate import gate, is_valid_text
from colladaphy_schema.rows import Column, Rows

if TYPE_CHECKING:
    from colladaphy.findings import Finding

__all__ = ["faults_of", "has_unique_ids", "is_sure"]


_LARGE: Final = 1 << 16
"""Bytes from which columns hold enough that is alike to look for it."""


def is_sure(columns: Rows, data: bytes) -> bool:
    """Whether the document of some columns is known to be valid: where few of their rows are."""
    if len(data) < _LARGE:
        return False
    sample = document_bytes(sampled(columns))
    return is_valid_text(sample)


def faults_of(data: bytes, *, unique_ids: bool, sure: bool = False) -> list[Finding]:
    """What is wrong with the text of a document; the gate is asked where anything is.

    It is `sure` where its columns are known to make a valid document.
    """
    if unique_ids and (sure or is_valid_text(data)):
        return []
    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    return gate(etree.ElementTree(etree.fromstring(data, parser)))


def has_unique_ids(columns: Rows) -> bool:
    """Whether no id is there twice; libxml2 does not look for that while it parses."""
    ids = _ids(columns)
    return len(set(ids)) == len(ids)


def _ids(rows: Rows) -> list[str]:
    """All ids of elements."""
    found: list[str] = []
    for field in rows.FIELDS:
        value = rows.known.get(field.name)
        if isinstance(value, Rows):
            found += _ids(value)
        elif isinstance(field, Column) and field.tag == "id" and isinstance(value, list):
            found += [id for id in value if id is not None]
    return found

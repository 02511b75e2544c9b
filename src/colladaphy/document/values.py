"""Values that pass libxml2's reading of the schema, and are none: found by who reads them.

libxml2 takes ``1e`` for a valid xs:float. To look for such numbers costs as much as to parse a
document, so reading leaves them to decoding and loading, which stumble over them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from lxml import etree

from colladaphy.errors import ColladaError, SchemaError
from colladaphy.findings import Finding, Report
from colladaphy.gate import rules as schema_rules
from colladaphy.gate.numerals import incomplete_numbers
from colladaphy.links.resource import Resource
from colladaphy_schema.errors import CodecError

__all__ = ["bad_numbers", "schema_errors"]


@contextmanager
def schema_errors(resource: Resource) -> Iterator[None]:
    """Raise SchemaError, with all findings, where values of a document cannot be read.

    An error that no value of the document explains is passed on.
    """
    try:
        yield
    except ColladaError:
        raise
    except ValueError as error:
        faults = [
            finding
            for related in dict.fromkeys([resource, *resource.family.values()])
            for finding in bad_numbers(related.tree, related.file)
        ]
        faults = faults or list(_not_codable(error, resource.file))
        if not faults:
            raise
        raise SchemaError(faults) from error


def bad_numbers(
    tree: etree._ElementTree, file: str | None = None, data: bytes | None = None
) -> list[Finding]:
    """A finding for every number that lacks the digits of its exponent."""
    report = Report(file)
    data = etree.tostring(tree, encoding="UTF-8") if data is None else data
    report.extend(incomplete_numbers(tree, data))
    return report.findings


def _not_codable(error: ValueError, file: str | None) -> Iterable[Finding]:
    """What the codecs say: of an edited `Document.root`, mostly, which can hold anything."""
    if isinstance(error, CodecError):
        yield schema_rules.INVALID_VALUE.at(message=f"{error}.", file=file)

"""Mending a file as a whole: read any version, conform, check, and write it again."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from lxml import etree

from colladaphy.errors import SchemaError
from colladaphy.findings import Report
from colladaphy.gate import gate
from colladaphy.source import Limits, Parsed, Source, Target, packed_for, parse, save

__all__ = ["Mended", "mend", "unified_diff"]


@dataclass(frozen=True, slots=True)
class Mended:
    """A document before and after it was mended; `tree` is valid COLLADA 1.5."""

    parsed: Parsed
    tree: etree._ElementTree
    report: Report

    def save(self, target: Target, data: bytes | None = None) -> None:
        """Write the document atomically, or `data` in its stead.

        An archive's other files are kept where the target's name ends in .zae, and where the
        target is that archive itself, whatever its name.
        """
        if data is None:
            data = serialise(self.tree)
        save(packed_for(target, data, self.parsed.archive, self.parsed.member), target)


def mend(
    source: Source,
    *,
    convention: str = "auto",
    only: Collection[str] | None = None,
    limits: Limits | None = None,
) -> Mended:
    """Read a document of any version and make it valid COLLADA 1.5.

    `only` limits the changes to these codes. Every change is in the report. Raises InputError and
    XmlError where it cannot be read, and SchemaError with what is still wrong where it cannot be
    made valid.
    """
    from colladaphy.conform import conform

    parsed = parse(source, limits or Limits(), mend=True)
    tree, changes = conform(parsed.tree, file=parsed.file, convention=convention, only=only)
    report = Report(parsed.file, list(parsed.findings))
    report.extend(changes)
    faults = Report(parsed.file)
    faults.extend(gate(tree))
    if faults.findings:
        raise SchemaError(faults.findings)
    return Mended(parsed, tree, report)


def serialise(tree: etree._ElementTree) -> bytes:
    """A tree as the bytes of a UTF-8 file."""
    return etree.tostring(tree, encoding="UTF-8", xml_declaration=True) + b"\n"


def unified_diff(mended: Mended) -> Iterator[str]:
    """The lines of a unified diff from the document as it was to the mended one."""
    from difflib import unified_diff as compare

    name = mended.parsed.file or "-"
    before, after = (
        serialise(tree).decode().splitlines() for tree in (mended.parsed.tree, mended.tree)
    )
    return compare(before, after, name, f"{name} (mended)", lineterm="")

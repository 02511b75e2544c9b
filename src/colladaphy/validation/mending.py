"""Mending a file as a whole: read any version, conform, check, and write it again."""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.errors import SchemaError
from colladaphy.findings import Finding, Report
from colladaphy.gate import gate
from colladaphy.links.names import local_name
from colladaphy.source import (
    Limits,
    Parsed,
    Source,
    Target,
    load,
    packed_for,
    parse_loaded,
    save,
)
from colladaphy.source.splitting import with_short_texts
from colladaphy.validation.companions import Render, companions_of

if TYPE_CHECKING:
    from colladaphy.document import Document

__all__ = ["Mended", "backup", "mend", "serialise", "unified_diff"]


@dataclass(frozen=True, slots=True)
class Mended:
    """A document before and after it was mended; `tree` is valid COLLADA 1.5."""

    parsed: Parsed
    tree: etree._ElementTree
    report: Report
    settled: Document | None = None
    """The document, where it is known that nothing was to be changed in it."""
    alone: bool = False
    """Whether the tree is a World's own, which refers to nothing."""

    def save(
        self,
        target: Target,
        data: bytes | None = None,
        render: Render | None = None,
        *,
        force: bool = False,
    ) -> None:
        """Write the document atomically, or `data` in its stead, with the files it refers to.

        An archive's other files are kept where the target's name ends in .zae, and where the
        target is that archive itself, whatever its name. Elsewhere, what the document refers to
        is written beside it, documents as `render` makes them; files that exist are only replaced
        by `force`. What was taken along, and what was not, is added to the report.
        """
        if data is None:
            data = serialise(self.tree)
        others = None
        if isinstance(target, str) and not self.alone and not self._is_home(target):
            others = companions_of(self.parsed, self.tree, render or _mended)
            known = {(each.code, each.message, each.line) for each in self.report}
            self.report.extend(each for each in others.findings
                               if (each.code, each.message, each.line) not in known)  # fmt: skip
        packed = packed_for(target, data, self.parsed.archive, self.parsed.member,
                            {} if others is None else others.files)  # fmt: skip
        save(packed, target)
        if others is not None and packed is data:
            assert isinstance(target, str)
            self.report.extend(others.save_beside(target, force=force))

    def _is_home(self, target: str) -> bool:
        """Whether what the document refers to is where it was, as seen from the target."""
        if self.parsed.archive is not None:
            file = self.parsed.archive.file
            same = file is not None and os.path.realpath(file) == os.path.realpath(target)
            return same or target.lower().endswith(".zae")
        base = self.parsed.base
        here = Path(os.path.realpath(target)).parent
        if target.lower().endswith(".zae"):
            return base is None
        return base is None or Path(os.path.realpath(base)) == here

    @property
    def has_bodies(self) -> bool:
        """Whether the file has, or had, instances of rigid bodies."""
        return any(
            next(tree.iter("{*}instance_rigid_body"), None) is not None
            for tree in (self.tree, self.parsed.tree)
        )

    def merged(self, convention: str = "auto") -> Mended:
        """The same with what it refers to in other documents brought in."""
        from colladaphy.validation.merging import merged

        tree, findings = merged(self.parsed, self.tree, convention)
        report = Report(self.report.file, [*self.report, *findings])
        faults = gate(tree)
        if faults:
            raise SchemaError(faults)
        return Mended(self.parsed, tree, report)

    def document(self, convention: str = "auto") -> Document:
        """The document that it became."""
        from colladaphy.document.api import document_of_mended

        if self.settled is not None:
            return self.settled
        return document_of_mended(self.parsed, self.tree, convention=convention)

    def as_world(
        self, convention: str = "auto", *, si: bool, up_axis: str | None, kinematics: bool
    ) -> Mended:
        """The World of the document as a document of its own, in another unit or other axes.

        What else the document holds is named in the report.
        """
        from colladaphy.document.rules import ALONE
        from colladaphy.mapper import WriteOptions, store

        document = self.document(convention)
        world = document.load(si=si, up_axis=up_axis)
        self.report.extend(document.report)
        data = store(world, WriteOptions(kinematics=kinematics))
        tree = etree.ElementTree(etree.fromstring(data, etree.XMLParser(huge_tree=True)))
        kept = {child.tag for child in tree.getroot()}
        left = [child for child in self.tree.getroot().iterchildren(etree.Element)
                if child.tag not in kept and len(child)]  # fmt: skip
        for child in left:
            message = f"<{local_name(child.tag)}> was left out."
            self.report.add(ALONE.at(child, message))
        return Mended(self.parsed, tree, self.report, document, alone=True)

    def bodies(self, convention: str = "auto") -> tuple[int, list[Finding]]:
        """How many bodies the World of the document has, and a finding for each that it lacks."""
        from colladaphy.validation.statistics import skipped_bodies

        document = self.document(convention)
        known = len(document.report)
        world = document.load()
        # What the World lacked when it was written is told already.
        new = [] if self.alone else document.report.findings[known:]
        lost = skipped_bodies([*self.report, *new])
        return len(world.bodies), lost


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
    from colladaphy.document.api import settled_document

    loaded = load(source, limits or Limits())
    settled = settled_document(loaded, convention)
    parsed = parse_loaded(loaded, mend=True)
    if settled is not None:
        return Mended(parsed, parsed.tree, Report(parsed.file), settled[0])
    tree, changes = conform(parsed.tree, file=parsed.file, convention=convention, only=only)
    report = Report(parsed.file, list(parsed.findings))
    report.extend(changes)
    faults = Report(parsed.file)
    faults.extend(gate(tree))
    if faults.findings:
        raise SchemaError(faults.findings)
    return Mended(parsed, tree, report)


def backup(file: str) -> Path:
    """Keep a copy of a file beside it under a name that is free: ``.bak``, ``.bak2``, …"""
    path, number = Path(f"{file}.bak"), 2
    while path.exists():
        path, number = Path(f"{file}.bak{number}"), number + 1
    save(Path(file).read_bytes(), str(path))
    shutil.copymode(file, path)
    return path


def _mended(parsed: Parsed) -> tuple[etree._ElementTree, bytes]:
    """A document that another one refers to, mended as that one was."""
    from colladaphy.conform import conform

    tree, _ = conform(parsed.tree, file=parsed.file)
    return tree, serialise(tree)


def serialise(tree: etree._ElementTree) -> bytes:
    """A tree as the bytes of a UTF-8 file."""
    data = etree.tostring(tree, encoding="UTF-8", xml_declaration=True) + b"\n"
    return with_short_texts(data)


def unified_diff(mended: Mended) -> Iterator[str]:
    """The lines of a unified diff from the document as it was to the mended one."""
    from difflib import unified_diff as compare

    name = mended.parsed.file or "-"
    before, after = (
        serialise(tree).decode().splitlines() for tree in (mended.parsed.tree, mended.tree)
    )
    return compare(before, after, name, f"{name} (mended)", lineterm="")

"""One document of those that belong together: what the mapper needs to know of it.

A resource has the bytes or the tree of a schema-valid document, its columns, the report, and the
way to the documents that it refers to. `colladaphy.document.Document` is built on one.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from itertools import islice
from os.path import normpath, realpath
from pathlib import PurePath
from typing import Any
from urllib.parse import unquote

from lxml import etree

from colladaphy.columns.reading import Document as Columns
from colladaphy.conform.thesis_profile import in_our_spelling
from colladaphy.errors import ColladaError, DocumentError, InputError
from colladaphy.findings import Finding, Report, Rule, Severity, element_path
from colladaphy.links import addresses, rules
from colladaphy.links.names import COLLADA, PE, c
from colladaphy.links.sids import Sids
from colladaphy.source.rules import REFERENCE_REFUSED, UNREACHABLE
from colladaphy_schema.core_columns import AssetTypeRows, TechniqueTypeRows

__all__ = ["Resource"]

_log = logging.getLogger("colladaphy.document")
_LEVELS = {
    Severity.ERROR: logging.ERROR,
    Severity.WARNING: logging.WARNING,
    Severity.INFO: logging.INFO,
    Severity.HINT: logging.DEBUG,
}

Opener = Callable[[str], "Resource"]

_CONVENTION = "{urn:colladaphy:conform:1}convention"


class Resource:
    """A schema-valid document, without an idea of what it is for."""

    def __init__(
        self,
        tree: etree._ElementTree | None,
        data: bytes | None = None,
        *,
        parser: Callable[[], etree._ElementTree] | None = None,
        file: str | None = None,
        report: Report | None = None,
        opener: Opener | None = None,
        family: dict[str, Resource] | None = None,
        tolerant: bool = False,
        member: str | None = None,
        columns: Columns | None = None,
    ) -> None:
        self._tree = tree
        self._columns = columns
        self._parser = parser
        self.data = data
        """The bytes as they were read, where nothing was changed in them."""
        self.file = file
        self.report = Report(file) if report is None else report
        self.member = member
        """The name of the document in its archive."""
        self.opener = opener
        self.family: dict[str, Resource] = {} if family is None else family
        """The documents that were opened for references, by file and reference, and as "" the one
        that all began with, which the others may refer back to."""
        self.family.setdefault("", self)
        self.tolerant = tolerant
        """Whether references that lead nowhere are only reported, not refused."""
        self._shown: etree._ElementTree | None = None
        self._elements: list[etree._Element] | None = None
        self._asked = 0
        self._closed: dict[str, ColladaError] = {}
        self._told: set[Finding] = set()

    @property
    def tree(self) -> etree._ElementTree:
        """The document as an lxml tree, parsed when it is first needed."""
        if self._tree is None:
            assert self._parser is not None
            self._tree = self._parser()
        return self._tree

    def with_tree(self, tree: etree._ElementTree) -> Resource:
        """The same document after a change."""
        made = Resource(tree, None, file=self.file, report=self.report, opener=self.opener,
                        family=self.family, tolerant=self.tolerant, member=self.member)  # fmt: skip
        if self.family[""] is self:
            made.lead()
        return made

    def lead(self) -> None:
        """Be the one that the others of the family refer back to, instead of an earlier state."""
        self.family[""] = self

    @cached_property
    def columns(self) -> Columns:
        """The document as columns, its pe profile in our own spelling."""
        made = self._columns or Columns.of(self._bytes(), lambda: self.tree)
        self._columns = None
        if not self._is_thesis(made):
            return made
        self._shown = in_our_spelling(self.tree)
        if self._shown is None:
            return made
        return Columns.of(etree.tostring(self._shown, encoding="UTF-8"))

    def _bytes(self) -> bytes:
        return etree.tostring(self.tree, encoding="UTF-8") if self.data is None else self.data

    @staticmethod
    def _is_thesis(columns: Columns) -> bool:
        """Whether a technique of the pe profile begins with a name without its namespace."""
        techniques = columns.rows(TechniqueTypeRows, c("technique"))
        ours = columns.chosen(techniques, "profile", "pe")
        return columns.has_foreign_content(techniques.select(ours), f"{{{PE}}}")

    @property
    def has_other_spelling(self) -> bool:
        """Whether the columns are those of a copy, with the profile in our own spelling."""
        assert self.columns is not None
        return self._shown is not None

    @property
    def shown_tree(self) -> etree._ElementTree:
        """The tree whose elements are those of the columns."""
        assert self.columns is not None
        return self.tree if self._shown is None else self._shown

    def element(self, number: int) -> etree._Element:
        """The element of a number, in the tree."""
        if self._elements is None:
            self._asked += 1
            if self._asked <= 2:
                return next(islice(self.shown_tree.iter(etree.Element), number, None))
            self._elements = list(self.shown_tree.iter(etree.Element))
        return self._elements[number]

    def number(self, element: etree._Element) -> int:
        """The number of an element of the tree."""
        tree = self.shown_tree
        if self._shown is not None:
            element = tree.find(self.tree.getelementpath(element)) or element
        for number, other in enumerate(tree.iter(etree.Element)):
            if other is element:
                return number
        raise DocumentError(rules.MISSING.at(element, "The element is not of this document."))

    @cached_property
    def ids(self) -> dict[str, int]:
        """The first element of every id; content of techniques has none."""
        elements, texts = self.columns.with_attribute("id")
        return dict(zip(reversed(texts), reversed(elements.tolist()), strict=True))

    @cached_property
    def sids(self) -> Sids:
        """The elements by scoped id."""
        return Sids(self.columns)

    @cached_property
    def converted_digits(self) -> int | None:
        """The significant digits that values had which `conform` converted; None for none.

        What was computed from them has more, but is no more exact.
        """
        columns = self.columns
        for code in columns.codes_of(_CONVENTION):
            for element in columns.index.rows(code).tolist():
                digits = columns.attribute_of(element, "digits") or ""
                if digits.isdecimal():
                    return int(digits)
        return None

    @cached_property
    def _asset(self) -> AssetTypeRows:
        assets = self.columns.rows(AssetTypeRows, f"{{{COLLADA}}}asset")
        assert assets.ordinals is not None
        return assets.select(self.columns.index.parent[assets.ordinals] == 0)

    @property
    def unit(self) -> tuple[str, float]:
        """Name and length in metres of the document's unit of length."""
        unit = self._asset.unit
        if not len(unit):
            return "meter", 1.0
        return unit.name[0], float(unit.meter[0])

    @property
    def up_axis(self) -> str:
        """X_UP, Y_UP (the default) or Z_UP."""
        axes = self._asset.up_axis
        return next((axis for axis in axes if axis), "Y_UP")

    def follow(
        self, reference: str, origin: int, expected: str | tuple[str, ...] = ()
    ) -> tuple[Resource, int]:
        """What a reference at an element leads to (see `colladaphy.links.addresses`)."""
        return addresses.follow(self, reference, origin, expected)

    def related(self, file: str, origin: int) -> Resource:
        """The document that a relative reference names; each is read once.

        Raises DocumentError where the file cannot be reached (the same one, for the place that
        asked first, however often it is asked for), and what reading it raises.
        """
        known = self.family.get(f"{self.file}\n{file}")
        if known is None:
            if file in self._closed:
                raise self._closed[file]
            try:
                known = self._open(file)
            except ColladaError as error:
                self._closed[file] = self._unreachable(error, origin)
                raise self._closed[file] from None
            for other in self.family.values():
                if other._is_same(known):
                    known = other
            self.family[f"{self.file}\n{file}"] = known
        first = self.family[""]
        return first if first._is_same(known) else known

    @cached_property
    def _identity(self) -> str | None:
        """The file, whatever way led there, or the entry of an archive; None for mere bytes."""
        if self.member is not None:
            return f"!{self.member}"
        return None if self.file is None else realpath(self.file)

    def is_own(self, file: str) -> bool:
        """Whether a relative reference to a file is one to this document."""
        own, name = self.member or self.file, unquote(file)
        if own is None or PurePath(own).name != PurePath(name).name:
            return False
        where = str(PurePath(own).parent / name)
        return (f"!{normpath(where)}" if self.member else realpath(where)) == self._identity

    def _is_same(self, other: Resource) -> bool:
        return self._identity is not None and self._identity == other._identity

    def _open(self, file: str) -> Resource:
        if self.opener is None:
            message = f"The document refers to {file!r}, but it was not read from a file."
            raise InputError(REFERENCE_REFUSED.at(message=message))
        return self.opener(file)

    def _unreachable(self, error: ColladaError, origin: int) -> ColladaError:
        """Why a file cannot be opened, with the place that refers to it."""
        if any(finding.code not in UNREACHABLE for finding in error.findings):
            return error
        place: Any = self.element(origin)  # the stubs leave the type of sourceline open
        return DocumentError(
            replace(finding, file=self.file, line=place.sourceline, path=element_path(place))
            for finding in error.findings
        )

    def note_broken(self, error: ColladaError, severity: Severity | None = None) -> None:
        """Add why a reference cannot be followed, with another severity if need be.

        What was told before is not told again: a file that cannot be reached is one finding,
        however much of it is missed.
        """
        for finding in error.findings:
            if severity is not None:
                finding = replace(finding, severity=severity)
            if finding not in self._told:
                self._told.add(finding)
                self.report.add(finding)

    def note(
        self,
        rule: Rule,
        number: int | None = None,
        message: str | None = None,
        *,
        home: Resource | None = None,
        severity: Severity | None = None,
    ) -> None:
        """Add a finding about an element of `home`, or of this document, to this report."""
        where = self if home is None else home
        element = None if number is None else where.element(number)
        finding = rule.at(element, message, file=where.file or self.file, severity=severity)
        self.report.add(finding)
        _log.log(_LEVELS[finding.severity], "%s", finding)

"""A document: a valid tree, what was found on reading it, and the ways into it."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Literal

from lxml import etree

from colladaphy.document import rules
from colladaphy.document.index import Index
from colladaphy.document.names import c
from colladaphy.document.nodes import Placement
from colladaphy.document.references import Target, follow
from colladaphy.document.scenes import Scene, Scenes
from colladaphy.document.values import schema_errors
from colladaphy.errors import DocumentError
from colladaphy.findings import Report, Rule, Severity
from colladaphy_schema.codec import paused_collector

if TYPE_CHECKING:
    from colladaphy.mapper import WriteOptions
    from colladaphy.source import Archive
    from colladaphy.world import World
    from colladaphy_schema.document import Collada

__all__ = ["Document", "Prefer"]

_log = logging.getLogger(__name__)
_LEVELS = {
    Severity.ERROR: logging.ERROR,
    Severity.WARNING: logging.WARNING,
    Severity.INFO: logging.INFO,
    Severity.HINT: logging.DEBUG,
}

Prefer = Literal["newer", "profile", "common"]
Opener = Callable[[str], "Document"]


class Document:
    """A schema-valid COLLADA 1.5 document.

    `read` makes one from a file. `related` documents, which its references lead to, are opened
    with `opener` when they are first needed, and share one table of open documents.
    """

    def __init__(
        self,
        tree: etree._ElementTree,
        *,
        file: str | None = None,
        report: Report | None = None,
        opener: Opener | None = None,
        family: dict[str, Document] | None = None,
        tolerant: bool = False,
        archive: Archive | None = None,
        member: str | None = None,
    ) -> None:
        self._tree = tree
        self._root: Collada | None = None
        self._index: Index | None = None
        self._placement: Placement | None = None
        self._opener = opener
        self._family: dict[str, Document] = {} if family is None else family
        self.archive = archive
        """The archive that the document comes from, whose other files are kept on writing one."""
        self.member = member
        """The name of the document in its archive."""
        self.file = file
        self.tolerant = tolerant
        """Whether references that lead nowhere are only reported, not refused."""
        self.report = Report(file) if report is None else report
        """Everything that was found, changed or assumed about this document so far."""

    @property
    def tree(self) -> etree._ElementTree:
        """The document as an lxml tree, with the edits made to `root`.

        Raises SchemaError where those have values that XML or the schema cannot hold.
        """
        if self._root is not None:
            from colladaphy.document.merge import merge

            with schema_errors(self):
                merged = merge(self._tree, self._root)
            if merged is not self._tree:
                self._tree = merged
                self._index = None
                self._placement = None
        return self._tree

    @property
    def root(self) -> Collada:
        """The document as generated dataclasses; what is edited there is written.

        Raises SchemaError where a number lacks the digits of its exponent (``1e``).
        """
        if self._root is None:
            from colladaphy_schema import Collada
            from colladaphy_schema.codec import decode

            with schema_errors(self), paused_collector():
                self._root = decode(self._tree.getroot(), Collada)
        return self._root

    @property
    def is_as_read(self) -> bool:
        """Whether nobody can have edited `root`, so that the tree is as the schema has it."""
        return self._root is None

    @property
    def tree_as_read(self) -> etree._ElementTree:
        """The tree without the edits made to `root`, but for those that `tree` showed already."""
        return self._tree

    @property
    def family(self) -> list[Document]:
        """This document and those that were opened for the references of any of them."""
        return list(dict.fromkeys([self, *self._family.values()]))

    @property
    def index(self) -> Index:
        """Elements by id and by sid."""
        if self._index is None:
            self._index = Index(self._tree)
        return self._index

    @property
    def placement(self) -> Placement:
        """World transforms of the document's nodes."""
        if self._placement is None:
            self._placement = Placement(self)
        return self._placement

    @property
    def scenes(self) -> Scenes:
        """The physics scenes, to be chosen from."""
        return Scenes(self)

    @property
    def unit(self) -> tuple[str, float]:
        """Name and length in metres of the document's unit of length."""
        for element in self._asset("unit"):
            with schema_errors(self):
                return element.get("name", "meter"), float(element.get("meter", "1.0"))
        return "meter", 1.0

    @property
    def up_axis(self) -> str:
        """X_UP, Y_UP (the default) or Z_UP."""
        for element in self._asset("up_axis"):
            return (element.text or "").strip() or "Y_UP"
        return "Y_UP"

    def _asset(self, name: str) -> Iterable[etree._Element]:
        asset = self._tree.getroot().find(c("asset"))
        return () if asset is None else asset.iterchildren(c(name))

    def resolve(
        self, reference: str, origin: etree._Element, expected: str | tuple[str, ...] = ()
    ) -> Target:
        """What a reference at `origin` leads to, in this document or another.

        Raises DocumentError where it leads nowhere or to an element that is not `expected`.
        """
        return follow(self, reference, origin, expected)

    def related(self, file: str, origin: etree._Element) -> Document:
        """The document that a relative reference names; each is read once."""
        known = self._family.get(f"{self.file}\n{file}")
        if known is None:
            if self._opener is None:
                message = f"The document refers to {file!r}, but it was not read from a file."
                raise DocumentError(rules.MISSING.at(origin, message, file=self.file))
            known = self._opener(file)
            for other in self._family.values():
                if other.file is not None and other.file == known.file:
                    known = other
            self._family[f"{self.file}\n{file}"] = known
        return known

    def note(
        self,
        rule: Rule,
        element: etree._Element | None = None,
        message: str | None = None,
        *,
        file: str | None = None,
    ) -> None:
        """Add a finding about this document to its report."""
        finding = rule.at(element, message, file=file or self.file)
        self.report.add(finding)
        _log.log(_LEVELS[finding.severity], "%s", finding)

    def load(
        self,
        world: World | None = None,
        *,
        scenes: Iterable[Scene | str] | None = None,
        prefer: Prefer = "newer",
        si: bool = False,
        up_axis: str | None = None,
    ) -> World:
        """Load the instantiated scenes, or the chosen ones, into a World.

        Values stay in the document's unit and axes, unless `si` asks for metres or `up_axis` for
        another one; a `world` that is given keeps its own. `prefer` decides where the pe profile
        and the common profile differ: the newer of the two (thesis 6.2.1), or always
        one of them. What was skipped or assumed is added to `report`. Raises DocumentError where
        references make no sense; a document that was read with repair leaves out what they
        concern, and reports it. Raises SchemaError where a number lacks the digits of its exponent.
        """
        from colladaphy.mapper import load

        chosen = None
        if scenes is not None:
            known = self.scenes
            chosen = [known[scene] if isinstance(scene, str) else scene for scene in scenes]
        with schema_errors(self):
            return load(self, world, scenes=chosen, prefer=prefer, si=si, up_axis=up_axis)

    def add_scene(self, world: World, id: str, *, options: WriteOptions | None = None) -> Scene:
        """Store a World as one more physics scene, which is instantiated; all else is kept.

        `root` has to be taken anew afterwards. Raises DocumentError where the id is in use, or
        the World's unit or up axis is not the document's.
        """
        from colladaphy.document.adding import with_scene

        tree = self.tree
        mine, given = (self.unit[1], self.up_axis), (world.unit_meter, world.up_axis)
        if mine != given:
            message = f"The World has unit and up axis {given}, the document {mine}."
            raise DocumentError(rules.UNIT.at(message=message, file=self.file))
        self._tree = with_scene(tree, world, id, options)
        self._root = self._index = self._placement = None
        return self.scenes[id]

    def write(self, target: Any) -> None:
        """Write the document, checked and atomically, to a .dae, a .zae or a binary file object."""
        from colladaphy.document.api import write

        write(self, target)

    def __repr__(self) -> str:
        scenes = [
            element.get("id") or "without id"
            for library in self._tree.getroot().iterchildren(c("library_physics_scenes"))
            for element in library.iterchildren(c("physics_scene"))
        ]
        found = f"physics scenes {', '.join(scenes)}" if scenes else "no physics scenes"
        return f"<Document {self.file or 'in memory'}: {found}; {len(self.report)} findings>"

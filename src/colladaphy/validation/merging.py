"""Bringing in what a document refers to in others, so that it stands alone."""

from __future__ import annotations

import copy
from pathlib import Path
from posixpath import dirname, join, normpath
from urllib.parse import quote

from lxml import etree

from colladaphy.conform import conform
from colladaphy.conform.identifiers import rename_ids
from colladaphy.errors import ColladaError, InputError
from colladaphy.findings import Finding
from colladaphy.links.names import c, local_name
from colladaphy.source import Parsed, parse_loaded, rules
from colladaphy.source.references import relative_name
from colladaphy.validation.companions import IMAGES, file_references, placed

__all__ = ["merged"]

_SCENES = frozenset({c("library_physics_scenes"), c("library_kinematics_scenes")})


def merged(
    parsed: Parsed, tree: etree._ElementTree, convention: str = "auto"
) -> tuple[etree._ElementTree, list[Finding]]:
    """A document with the libraries of those that it refers to, and what was noticed.

    Their ids get other names where they are taken. A document that cannot be read stays referred
    to. Images keep their places: they are named from the new document's folder.
    """
    made = etree.ElementTree(copy.deepcopy(tree.getroot()))
    return made, _Merging(made, convention).all(parsed)


class _Merging:
    def __init__(self, tree: etree._ElementTree, convention: str) -> None:
        self._root = tree.getroot()
        self._convention = convention
        self._findings: list[Finding] = []
        self._taken = {element.get("id", "") for element in self._root.iter(etree.Element)}
        self._names: dict[str, dict[str, str] | None] = {}
        """What became of the ids of each file, by its name from the document; None: unreadable."""

    def all(self, parsed: Parsed) -> list[Finding]:
        """Bring in all documents, and those that they refer to."""
        waiting = [(parsed, [self._root], "")]
        for home, parts, folder in waiting:
            for part in parts:
                for element, key, value in list(file_references(part)):
                    waiting += self._bring(home, element, key, value, folder)
        return self._findings

    def _bring(
        self, home: Parsed, element: etree._Element, key: str, value: str, folder: str
    ) -> list[tuple[Parsed, list[etree._Element], str]]:
        """Let a reference lead to what is, or was, brought in; gives what is new."""
        file, mark, fragment = value.partition("#")
        if not mark:
            return []
        new: list[tuple[Parsed, list[etree._Element], str]] = []
        try:
            name = normpath(join(folder, relative_name(file)))
        except InputError as error:  # it is not relative, and means the same anywhere
            self._findings += placed(error, element, home.file)
            return []
        try:
            if name not in self._names:
                other = parse_loaded(home.load_relative(file), mend=True)
                new.append((other, self._take(other, name), dirname(name)))
        except ColladaError as error:
            self._names[name] = None
            unreachable = isinstance(error, InputError)
            self._findings += placed(error, element, home.file) if unreachable else error.findings
        known = self._names[name]
        head, slash, rest = fragment.partition("/")
        if known is not None:
            element.set(key, f"#{known.get(head, head)}{slash}{rest}")
        elif folder:  # from another folder, it has another name
            element.set(key, f"{quote(name)}#{fragment}")
        return new

    def _take(self, other: Parsed, name: str) -> list[etree._Element]:
        """The libraries of a document, put before the scene of this one."""
        tree, _ = conform(other.tree, file=other.file, convention=self._convention)
        root = tree.getroot()
        ids = [e.get("id", "") for e in root.iter(etree.Element) if e.get("id")]
        names = {old: self._free(old, Path(name).stem) for old in ids}
        rename_ids(root, {old: new for old, new in names.items() if new != old})
        self._names[name] = names
        self._taken.update(names.values())
        folder = dirname(name)
        for image in root.iterfind(f".//{IMAGES}") if folder else ():
            text = (image.text or "").strip()
            if text and ":" not in text and not text.startswith(("/", "#")):
                image.text = f"{quote(folder)}/{text}"
        libraries = [
            child
            for child in root.iterchildren(etree.Element)
            if local_name(child.tag).startswith("library_") and child.tag not in _SCENES
        ]
        before = next(
            (at for at, child in enumerate(self._root) if child.tag in (c("scene"), c("extra"))),
            len(self._root),
        )
        for library in reversed(libraries):
            library.tail = "\n"
            self._root.insert(before, library)
        message = f"{name!r} was brought in: {len(libraries)} libraries."
        self._findings.append(rules.MERGED.at(message=message))
        return libraries

    def _free(self, wish: str, stem: str) -> str:
        """An id that is not taken."""
        name, number = wish, 1
        while name in self._taken:
            name = f"{wish}-{number}" if not stem.isidentifier() else f"{wish}-{stem}-{number}"
            number += 1
        return name

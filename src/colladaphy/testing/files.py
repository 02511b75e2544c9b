"""Documents that lead to other files."""

from __future__ import annotations

import copy
import posixpath
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from lxml import etree

from colladaphy.source import pack
from colladaphy.testing.changing.elements import C, local
from colladaphy.testing.physics import physics_documents

__all__ = ["LinkedFiles", "linked_files"]

_NAMES = ("parts.dae", "sub/more parts.dae", "sub/ü.dae")
_REFERRING = ("url", "target", "source", "parent", "convex_hull_of")


@dataclass(frozen=True)
class LinkedFiles:
    """A document and the files that it leads to."""

    files: dict[str, bytes]
    """By name, relative to one folder; the first is the document itself."""
    alone: bytes
    """The same document in one file."""

    @property
    def main(self) -> str:
        """The name of the document itself."""
        return next(iter(self.files))

    def save(self, folder: Path) -> Path:
        """Writes all files into a folder; gives the path of the document itself."""
        for name, data in self.files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        return folder / self.main

    def archive(self) -> bytes:
        """The same as a .zae archive."""
        others = {name: data for name, data in self.files.items() if name != self.main}
        return pack(self.files[self.main], name=self.main, others=others)


@st.composite
def linked_files(draw: st.DrawFn) -> LinkedFiles:
    """Documents whose geometries, materials, nodes, models and scenes stand in up to three files.

    Each file is valid by itself, all together mean what `alone` means, and files may lead to each
    other in both directions.
    """
    data = draw(physics_documents(profiles=False, oddities=False))
    root = etree.fromstring(data)
    names = ["main.dae", *_NAMES]
    where: dict[str, str] = {}
    moved: dict[str, list[etree._Element]] = {}
    for library in root.findall(f"{C}*"):
        for part in library if local(library).startswith("library_") else ():
            name = draw(st.sampled_from(names))
            where.update({each.get("id", ""): name for each in part.iter() if each.get("id")})
            if name != "main.dae":
                moved.setdefault(name, []).append(part)
    trees = {"main.dae": root}
    for name in names:
        if name in moved:
            trees[name] = _part(root, moved[name])
    for library in list(root):
        if local(library).startswith("library_") and not len(library):
            root.remove(library)
    for name, tree in trees.items():
        _lead(tree, name, where)
    files = {name: etree.tostring(tree, encoding="utf-8") for name, tree in trees.items()}
    return LinkedFiles({name: bytes(text) for name, text in files.items()}, data)


def _part(root: etree._Element, parts: list[etree._Element]) -> etree._Element:
    """Another document, of what is taken out of the first."""
    namespaces: Any = root.nsmap  # None is the default namespace
    made = etree.Element(root.tag, nsmap=namespaces)
    made.attrib.update(root.attrib)
    made.append(copy.deepcopy(root[0]))
    libraries: dict[str, etree._Element] = {}
    for part in parts:
        library = part.getparent()
        assert library is not None
        name = str(library.tag)
        if name not in libraries:
            libraries[name] = etree.SubElement(made, name)
        libraries[name].append(part)
    return made


def _lead(tree: etree._Element, home: str, where: dict[str, str]) -> None:
    """Lets references lead to the files in which their targets stand."""
    for element in tree.iter(etree.Element):
        for name in _REFERRING:
            value = element.get(name, "")
            if value.startswith("#") and (file := where.get(value[1:], home)) != home:
                path = posixpath.relpath(file, posixpath.dirname(home) or ".")
                element.set(name, path.replace(" ", "%20") + value)

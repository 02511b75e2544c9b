"""The files that a document refers to, which go along where it is written elsewhere.

Models in other documents and images are named relative to the document; in another folder, and
outside of its archive, those names lead nowhere unless the files are there as well.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from posixpath import dirname, join, normpath
from typing import cast

from lxml import etree

from colladaphy.errors import ColladaError, InputError
from colladaphy.findings import Finding, element_path
from colladaphy.links.addresses import split_reference
from colladaphy.links.names import COLLADA
from colladaphy.source import Parsed, parse_loaded, rules, save
from colladaphy.source.references import relative_name

__all__ = ["IMAGES", "Companions", "Render", "companions_of", "file_references", "placed"]

_KEYS = ("url", "source", "target", "parent", "proxy", "convex_hull_of", "camera_node",
         "rigid_body")  # fmt: skip
_FOUND = etree.XPath(
    "descendant-or-self::*/@*[" + " or ".join(f"local-name() = '{key}'" for key in _KEYS) + "]"
    "[not(starts-with(., '#'))][not(ancestor::*[local-name() = 'technique'][@profile])]"
)
IMAGES = f"{{{COLLADA}}}init_from/{{{COLLADA}}}ref"
_DOCUMENTS = (".dae", ".xml")

Render = Callable[[Parsed], tuple[etree._ElementTree, bytes]]
"""Makes of a document that is referred to the one to write."""


@dataclass(slots=True)
class Companions:
    """Files by their names relative to the document, and what cannot go along."""

    files: dict[str, bytes] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)

    def save_beside(self, target: str, *, force: bool = False) -> list[Finding]:
        """Write the files into the folder of `target`; what is there already is not replaced."""
        folder = Path(os.path.realpath(target)).parent
        findings = []
        for name, data in self.files.items():
            path = folder / name
            if path.exists() and not force:
                if path.is_file() and path.read_bytes() == data:
                    continue
                message = f"{name!r} was not taken along: another file of that name is there."
                findings.append(rules.COMPANION_LEFT.at(message=message))
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            save(data, path)
            message = f"{name!r} was taken along, to {str(path)!r}."
            findings.append(rules.COMPANION_TAKEN.at(message=message))
        return findings


def companions_of(parsed: Parsed, tree: etree._ElementTree, render: Render) -> Companions:
    """The files that a document (`tree`, as it will be written) and those it leads to refer to."""
    found = Companions()
    # Each with its folder below that of the first document.
    waiting = [(parsed, tree, "")]
    seen: set[tuple[str, str]] = set()
    for current, content, folder in waiting:
        for element, url in _references(content):
            if (folder, url) in seen:
                continue
            seen.add((folder, url))
            try:
                name = normpath(join(folder, relative_name(url)))
                resource = current.open_relative(url)
            except InputError as error:
                found.findings += placed(error, element, current.file)
                continue
            if name.startswith("../") or name in found.files:
                continue
            if not name.lower().endswith(_DOCUMENTS):
                found.files[name] = resource.data
                continue
            try:
                other = parse_loaded(current.load_relative(url), mend=True)
                inner, data = render(other)
            except ColladaError as error:
                found.findings += error.findings
                found.files[name] = resource.data
                continue
            found.files[name] = data
            waiting.append((other, inner, dirname(name)))
    return found


def file_references(
    within: etree._Element | etree._ElementTree,
) -> Iterator[tuple[etree._Element, str, str]]:
    """References to other documents: the element, the attribute, and its value."""
    for value in cast("list[etree._ElementUnicodeResult]", _FOUND(within)):
        element, text = value.getparent(), str(value).strip()
        if element is not None and split_reference(text)[0]:
            yield element, str(value.attrname), text


def _references(tree: etree._ElementTree) -> Iterator[tuple[etree._Element, str]]:
    """The files that a document names, each with the element that does."""
    for element, _, value in file_references(tree):
        yield element, value.partition("#")[0]
    for image in tree.iterfind(f".//{IMAGES}"):
        name = (image.text or "").strip()
        if name and not name.startswith("#"):
            yield image, name


def placed(error: ColladaError, element: etree._Element, file: str | None) -> list[Finding]:
    """Why a file cannot be opened, with the place that refers to it."""
    line = cast("int | None", element.sourceline)
    return [
        replace(finding, file=file, line=line, path=element_path(element))
        for finding in error.findings
    ]

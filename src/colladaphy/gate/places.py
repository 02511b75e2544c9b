"""Elements by the paths of libxml2, and the paths and the order of elements."""

from __future__ import annotations

import re

from lxml import etree
from lxml.etree import _Element

from colladaphy.findings import Paths

__all__ = ["Places"]

_STEP = re.compile(r"([^/\[\]]+)(?:\[(\d+)\])?")


class Places(Paths):
    """Elements by libxml2's paths, beside paths of elements; linear for any number."""

    def __init__(self, root: _Element) -> None:
        super().__init__()
        self._root = root
        self._elements: dict[str, _Element] = {}
        self._children: dict[_Element, list[_Element]] = {}
        self._named: dict[tuple[_Element, str], list[_Element]] = {}

    def element(self, path: str) -> _Element:
        """The element that a path such as ``/*/*[2]/pe:body`` means."""
        known = self._elements.get(path)
        if known is None:
            parent, _, step = path.rpartition("/")
            known = self._child(self.element(parent), step) if parent else self._root
            self._elements[path] = known
        return known

    def _child(self, parent: _Element, step: str) -> _Element:
        match = _STEP.fullmatch(step)
        if match is None:
            return parent
        name, position = match[1], int(match[2] or 1)
        if name == "*":
            same = self._all(parent)
        else:
            key = (parent, name)
            if key not in self._named:
                self._named[key] = [
                    child for child in self._all(parent) if _prefixed(child) == name
                ]
            same = self._named[key]
        return same[position - 1] if position <= len(same) else parent

    def _all(self, parent: _Element) -> list[_Element]:
        children = self._children.get(parent)
        if children is None:
            children = list(parent.iterchildren(etree.Element))
            self._children[parent] = children
        return children


def _local(element: _Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _prefixed(element: _Element) -> str:
    return f"{element.prefix}:{_local(element)}" if element.prefix else _local(element)

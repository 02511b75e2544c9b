"""Finding elements by id and by sid without searching: one pass over the tree, then dictionaries.

COLLADA 1.5 §Address syntax; the thesis searched the tree for every reference (5.5), which made its
load superlinear (7).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator

from lxml import etree

from colladaphy.document.names import c, local_name

__all__ = ["Index"]

_INSTANCE_NODE = c("instance_node")
_VISUAL_SCENES = c("library_visual_scenes")
_TECHNIQUE = c("technique")
# What stands in a technique of some profile is that profile's own affair.
_WITH_ID = etree.XPath(
    "/descendant-or-self::*[@id][not(ancestor::*[local-name() = 'technique'][@profile])]"
)


class Index:
    """Ids, sids and instanced nodes of one tree."""

    def __init__(self, tree: etree._ElementTree) -> None:
        self._tree = tree
        self._ids: dict[str, etree._Element] | None = None
        self._shallow: dict[str, etree._Element] | None = None
        self._nodes: dict[str, etree._Element] | None = None
        self._scopes: dict[etree._Element, dict[str, etree._Element]] = {}
        self._instances: list[etree._Element] | None = None

    @property
    def ids(self) -> dict[str, etree._Element]:
        """The first element of every id, in document order; foreign content has none."""
        if self._ids is None:
            ids: dict[str, etree._Element] = {}
            for element in _elements(_WITH_ID(self._tree)):
                ids.setdefault(element.get("id", ""), element)
            self._ids = ids
        return self._ids

    def find(self, name: str) -> etree._Element | None:
        """The element of an id.

        What references mostly lead to stands directly in a library or in a visual scene, so that
        is looked at first (thesis 5.5), and all ids are collected only when that is not enough.
        Only inside of techniques, where the schema lets anything pass, an id can be there again.
        """
        if self._shallow is None:
            self._shallow = _children_by_id(
                library
                for library in self._tree.getroot().iterchildren("{*}*")
                if local_name(library.tag).startswith("library_")
            )
        found = self._shallow.get(name)
        if found is None:
            if self._nodes is None:
                self._nodes = _children_by_id(
                    scene
                    for library in self._tree.getroot().iterchildren(_VISUAL_SCENES)
                    for scene in library.iterchildren("{*}*")
                )
            found = self._nodes.get(name)
        return self.ids.get(name) if found is None else found

    def within(self, scope: etree._Element, sid: str) -> etree._Element | None:
        """The element of a sid below `scope`: the nearest first, breadth before depth."""
        found = self._scopes.get(scope)
        if found is None:
            found = {}
            waiting = deque(scope)
            while waiting:
                element = waiting.popleft()
                name = element.get("sid")
                if name is not None:
                    found.setdefault(name, element)
                if element.tag != _TECHNIQUE or element.get("profile") is None:
                    waiting.extend(element)
            self._scopes[scope] = found
        return found.get(sid)

    @property
    def node_instances(self) -> list[etree._Element]:
        """All instance_node elements in document order."""
        if self._instances is None:
            found = self._tree.iter(_INSTANCE_NODE)
            self._instances = [instance for instance in found if not _is_foreign(instance)]
        return self._instances


def _is_foreign(element: etree._Element) -> bool:
    techniques = element.iterancestors(_TECHNIQUE)
    return any(technique.get("profile") is not None for technique in techniques)


def _children_by_id(parents: Iterable[etree._Element]) -> dict[str, etree._Element]:
    """The first child of every id."""
    found: dict[str, etree._Element] = {}
    for parent in parents:
        for element in parent.iterchildren("{*}*"):
            name = element.get("id")
            if name is not None:
                found.setdefault(name, element)
    return found


def _elements(found: object) -> Iterator[etree._Element]:
    if isinstance(found, list):
        for element in found:
            if isinstance(element, etree._Element):
                yield element

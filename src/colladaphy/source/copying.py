"""Copies of whole trees."""

from __future__ import annotations

from copy import deepcopy

from lxml import etree

__all__ = ["copy_tree"]


def copy_tree(tree: etree._ElementTree) -> etree._ElementTree:
    """A deep copy, with comments and instructions outside of the root where they were.

    lxml copies those behind the root in the opposite order.
    """
    twin = deepcopy(tree)
    root = twin.getroot()
    behind = list(root.itersiblings())
    if [_content(node) for node in behind] != [
        _content(node) for node in tree.getroot().itersiblings()
    ]:
        for node in behind:
            root.addnext(node)
    return twin


def _content(node: etree._Element) -> tuple[object, ...]:
    return node.tag, node.text, getattr(node, "target", None)

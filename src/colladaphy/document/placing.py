"""Putting nodes into an indented document and taking them out, so that it stays one."""

from __future__ import annotations

from collections.abc import Iterator
from uuid import uuid4

from lxml import etree

from colladaphy_schema.registry import ELEMENTS

__all__ = [
    "MATH",
    "Holder",
    "indent",
    "indentation",
    "insert",
    "is_wildcard",
    "remove",
    "separator",
]

MATH = "{http://www.w3.org/1998/Math/MathML}math"


def is_wildcard(element: etree._Element) -> bool:
    """Whether the element is a technique of any content."""
    return etree.QName(element).localname == "technique" and "profile" in element.attrib


class Holder:
    """Keeps foreign content away from lxml while its surroundings are put into another place.

    lxml then drops namespace declarations that seem redundant, without regard to inner ones that
    hide the outer. What this could hurt is held as text, with an instruction in its place.
    """

    def __init__(self) -> None:
        self._target = f"held-{uuid4().hex}"
        self._texts: list[str] = []

    def hold(self, node: etree._Element, *, generic: bool) -> etree._Element:
        """What to put elsewhere for a node, which is still in its tree: the node or a stand-in.

        `generic` says that no schema describes the node.
        """
        for foreign in list(_foreign(node, generic)):
            if not _is_fragile(foreign):
                continue
            stand_in = etree.ProcessingInstruction(self._target, str(len(self._texts)))
            self._texts.append(etree.tostring(foreign, encoding="unicode", with_tail=False))
            if foreign is node:
                return stand_in
            parent = foreign.getparent()
            if parent is not None:
                stand_in.tail = foreign.tail
                parent.replace(foreign, stand_in)
        return node

    def release(self, tree: etree._ElementTree) -> etree._ElementTree:
        """The tree with everything that is held in its place."""
        if not self._texts:
            return tree
        text = etree.tostring(tree, encoding="unicode")
        for number in reversed(range(len(self._texts))):
            text = text.replace(f"<?{self._target} {number}?>", self._texts[number])
        parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
        return etree.ElementTree(etree.fromstring(text, parser))


def _foreign(node: etree._Element, generic: bool) -> Iterator[etree._Element]:
    """The outermost elements at or below a node that no schema describes."""
    if not isinstance(node.tag, str):
        return
    if generic:
        yield node
        return
    for element in node.iter(etree.Element):
        if element.tag == MATH or is_wildcard(element):
            for child in element.iterchildren(etree.Element):
                if element.tag == MATH or child.tag not in ELEMENTS:
                    yield child


def _is_fragile(foreign: etree._Element) -> bool:
    """Whether more than one namespace is declared inside, or one is used by an attribute."""
    parent = foreign.getparent()
    outer = set() if parent is None else set(parent.nsmap.items())
    declared: set[tuple[str | None, str]] = set()
    for element in foreign.iter(etree.Element):
        declared |= set(element.nsmap.items()) - outer
        if len(declared) > 1 or any(str(name).startswith("{") for name in element.attrib):
            return True
    return False


def separator(parent: etree._Element, mixed: bool) -> str | None:
    """The line break and indentation before a child; None where children are not indented."""
    text = parent.text
    if mixed or next(iter(parent), None) is None:
        return None
    if text is None or "\n" not in text or not text.isspace():
        return None
    return text[text.rindex("\n") :]


def indentation(parent: etree._Element, line: str | None) -> str:
    """By how much the children of an element are indented further than the element."""
    if line is None:
        return ""
    closing = parent[-1].tail or ""
    return line.removeprefix(closing) if line.startswith(closing or " ") else ""


def remove(parent: etree._Element, node: etree._Element, mixed: bool) -> None:
    """Take a node out; the last one's tail, which indents the end tag, passes to the one before."""
    before = node.getprevious()
    if not mixed and node.getnext() is None and _is_blank(node.tail):
        if before is None:
            parent.text = node.tail
        elif _is_blank(before.tail):
            before.tail = node.tail
    node.tail = None
    parent.remove(node)


def _is_blank(text: str | None) -> bool:
    return not text or text.isspace()


def insert(
    parent: etree._Element,
    previous: etree._Element | None,
    node: etree._Element,
    line: str | None,
) -> None:
    """Put a node behind another one, or first."""
    if previous is None:
        node.tail = line if len(parent) else None
        parent.insert(0, node)
        return
    tail, previous.tail = previous.tail, None
    node.tail = None
    previous.addnext(node)
    previous.tail = line if _is_blank(tail) else tail
    node.tail = tail if _is_blank(tail) else None


def indent(node: etree._Element, line: str | None, unit: str) -> None:
    """Indent a new element like its siblings; what no schema describes stays as it is."""
    if line is None or not unit or not len(node) or node.tag == MATH:
        return
    inner = line + unit
    node.text = inner if _is_blank(node.text) else node.text
    wild = is_wildcard(node)
    for child in node:
        if _is_blank(child.tail):
            child.tail = inner if child.getnext() is not None else line
        if isinstance(child.tag, str) and (not wild or child.tag in ELEMENTS):
            indent(child, inner, unit)

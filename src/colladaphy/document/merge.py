"""Saving an edited document without losing anything of the original.

Dataclasses do not hold comments, spelling of numbers, prefixes or white space. So the edited
dataclasses are not written over the original: three versions are compared, the original tree, what
its dataclasses looked like before the edits, and what they look like now. Where the latter two are
equal the original stays as it is; where they differ, as little as possible is changed in it.
"""

from __future__ import annotations

from copy import deepcopy
from typing import TYPE_CHECKING

from lxml import etree

from colladaphy.document.alignment import align, longest_increasing
from colladaphy_schema.codec import decode_document, encode, paused_collector
from colladaphy_schema.registry import ELEMENTS, PREFIXES

if TYPE_CHECKING:
    from colladaphy_schema.document import Collada

__all__ = ["merge"]

_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_MATH = "{http://www.w3.org/1998/Math/MathML}math"
_SCOPE: dict[str | None, str] = {
    **{prefix.rstrip(":") or None: uri for uri, prefix in PREFIXES.items()},
    "xsi": _XSI,
}
_DECLARATIONS = "".join(
    f' xmlns{f":{prefix}" if prefix else ""}="{uri}"' for prefix, uri in _SCOPE.items()
)


def merge(original: etree._ElementTree, edited: Collada) -> etree._ElementTree:
    """The original with the edits made to its dataclasses, and with nothing else changed.

    `edited` is what was decoded from `original`, edited in any way. The result decodes to exactly
    `edited`; it is `original` itself where nothing was edited, otherwise a new tree. New elements
    take the prefixes and, among indented siblings, the indentation of the original. Comments stay
    where they are, also beside what is removed. Linear in the size of the document.
    """
    with paused_collector():
        before, after = _text(decode_document(original)), _text(edited)
        if before == after:
            return original
        result = deepcopy(original)
        parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
        old, new = etree.fromstring(before, parser), etree.fromstring(after, parser)
        _patch(result.getroot(), old, new, generic=False)
    return result


def _text(collada: Collada) -> str:
    """The dataclasses as XML; both versions declare the same prefixes, used or not."""
    text = encode(collada, "COLLADA", _SCOPE)
    return f"<COLLADA{_DECLARATIONS}{text.removeprefix('<COLLADA')}"


def _patch(
    target: etree._Element, old: etree._Element, new: etree._Element, *, generic: bool
) -> None:
    """Make the changes from `old` to `new` in `target`, all versions of one element.

    `generic` says that the element is one that no schema describes, whose white space counts.
    """
    if not isinstance(target.tag, str):  # a comment or an instruction
        target.text = new.text
        return
    _patch_attributes(target, old, new)
    mixed = generic or new.tag == _MATH
    if old.text != new.text:
        target.text = new.text
        for child in target if len(new) == 0 and len(old) == 0 else ():
            child.tail = None  # text between comments was part of the old value
    nodes = _counterparts(target, old)
    before, after = list(old), list(new)
    origins = align(before, after)
    kept = {index for index, _ in origins if index is not None}
    for index, node in enumerate(nodes):
        if index not in kept:
            _remove(target, node, mixed)
    stable = longest_increasing([index for index, _ in origins if index is not None])
    previous: etree._Element | None = None
    separator = _separator(target, mixed)
    unit = _unit(target, separator)
    for (origin, changed), child in zip(origins, after, strict=True):
        inner = mixed or (_is_wildcard(target) and child.tag not in ELEMENTS)
        if origin is None:
            node = _insert(target, previous, deepcopy(child), separator)
            if not inner:
                _indent(node, separator, unit)
        else:
            node = nodes[origin]
            if origin not in stable:
                _remove(target, node, mixed)
                _insert(target, previous, node, separator)
            if changed:
                _patch(node, before[origin], child, generic=inner)
        if mixed or child.tail != (None if origin is None else before[origin].tail):
            node.tail = child.tail
        previous = node


def _counterparts(target: etree._Element, old: etree._Element) -> list[etree._Element]:
    """The nodes of the original that the nodes of `old` were decoded from, in their order.

    Decoding keeps the order of elements; comments and instructions it keeps in wildcards only.
    """
    nodes = list(target)
    if len(nodes) != len(old):
        nodes = [node for node in nodes if isinstance(node.tag, str)]
    return nodes


def _patch_attributes(target: etree._Element, old: etree._Element, new: etree._Element) -> None:
    before, after = _attributes(old), _attributes(new)
    for name in before.keys() - after.keys() & _attributes(target).keys():
        del target.attrib[name]
    for name, value in after.items():
        if before.get(name) == value:
            continue
        if name == f"{{{_XSI}}}type":
            value = _requalified(value, target)
        target.set(name, value)


def _attributes(element: etree._Element) -> dict[str, str]:
    return {str(name): str(value) for name, value in element.items()}


def _requalified(name: str, target: etree._Element) -> str:
    """The name of a type with the prefix that its namespace has in the original."""
    prefix, _, local = name.rpartition(":")
    uri = _SCOPE[prefix or None]
    bound = next(bound for bound, space in target.nsmap.items() if space == uri)
    return f"{bound}:{local}" if bound else local


def _is_wildcard(element: etree._Element) -> bool:
    """Whether the element is a technique of any content."""
    return etree.QName(element).localname == "technique" and "profile" in element.attrib


# --- white space ---------------------------------------------------------------------------


def _separator(parent: etree._Element, mixed: bool) -> str | None:
    """The line break and indentation before a child; None where children are not indented."""
    text = parent.text
    if mixed or not len(parent) or text is None or "\n" not in text or not text.isspace():
        return None
    return text[text.rindex("\n") :]


def _unit(parent: etree._Element, separator: str | None) -> str:
    """By how much the children of an element are indented further than the element."""
    if separator is None:
        return ""
    closing = parent[-1].tail or ""
    return separator.removeprefix(closing) if separator.startswith(closing or " ") else ""


def _remove(parent: etree._Element, node: etree._Element, mixed: bool) -> None:
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


def _insert(
    parent: etree._Element,
    previous: etree._Element | None,
    node: etree._Element,
    separator: str | None,
) -> etree._Element:
    """Put a node behind another one, or first."""
    if previous is None:
        node.tail = separator if len(parent) else None
        parent.insert(0, node)
        return node
    tail, previous.tail = previous.tail, None
    node.tail = None
    previous.addnext(node)
    previous.tail = separator if _is_blank(tail) else tail
    node.tail = tail if _is_blank(tail) else None
    return node


def _indent(node: etree._Element, separator: str | None, unit: str) -> None:
    """Indent a new element like its siblings; what no schema describes stays as it is."""
    if separator is None or not unit or not len(node) or node.tag == _MATH:
        return
    inner = separator + unit
    node.text = inner if _is_blank(node.text) else node.text
    wild = _is_wildcard(node)
    for child in node:
        if _is_blank(child.tail):
            child.tail = inner if child.getnext() is not None else separator
        if isinstance(child.tag, str) and (not wild or child.tag in ELEMENTS):
            _indent(child, inner, unit)

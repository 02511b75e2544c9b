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
from colladaphy.document.placing import (
    MATH,
    Holder,
    indent,
    indentation,
    insert,
    is_wildcard,
    remove,
    separator,
)
from colladaphy.source.copying import copy_tree
from colladaphy_schema.codec import decode_document, encode, paused_collector
from colladaphy_schema.registry import ELEMENTS, PREFIXES

if TYPE_CHECKING:
    from colladaphy_schema.document import Collada

__all__ = ["merge"]

_XSI = "http://www.w3.org/2001/XMLSchema-instance"
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
        result = copy_tree(original)
        parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
        old, new = etree.fromstring(before, parser), etree.fromstring(after, parser)
        holder = Holder()
        _patch(result.getroot(), old, new, holder, generic=False)
        return holder.release(result)


def _text(collada: Collada) -> str:
    """The dataclasses as XML; both versions declare the same prefixes, used or not."""
    text = encode(collada, "COLLADA", _SCOPE)
    return f"<COLLADA{_DECLARATIONS}{text.removeprefix('<COLLADA')}"


def _patch(
    target: etree._Element,
    old: etree._Element,
    new: etree._Element,
    holder: Holder,
    *,
    generic: bool,
) -> None:
    """Make the changes from `old` to `new` in `target`, all versions of one element.

    `generic` says that the element is one that no schema describes, whose white space counts.
    """
    if not isinstance(target.tag, str):  # a comment or an instruction
        target.text = new.text
        return
    _patch_attributes(target, old, new)
    mixed = generic or new.tag == MATH
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
            remove(target, node, mixed)
    stable = longest_increasing([index for index, _ in origins if index is not None])
    previous: etree._Element | None = None
    line = separator(target, mixed)
    unit = indentation(target, line)
    for (origin, changed), child in zip(origins, after, strict=True):
        inner = mixed or (is_wildcard(target) and child.tag not in ELEMENTS)
        if origin is None:
            node = holder.hold(child, generic=inner)
            node = deepcopy(node) if node is child else node
            insert(target, previous, node, line)
            if not inner:
                indent(node, line, unit)
        else:
            node = nodes[origin]
            if changed:
                _patch(node, before[origin], child, holder, generic=inner)
            if origin not in stable:
                moved = holder.hold(node, generic=inner)
                remove(target, node, mixed)
                insert(target, previous, moved, line)
                node = moved
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

"""Elements of a document put where the schema wants them, and numbers written into them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.placing import indent, indentation, insert, remove, separator
from colladaphy.links.names import PE, c

__all__ = [
    "TRANSFORMS",
    "child",
    "children",
    "drop",
    "local",
    "name_after",
    "numbers",
    "profile_element",
    "put",
    "put_first",
    "put_next",
    "replace_profile",
    "retarget",
]

TRANSFORMS = ("lookat", "matrix", "rotate", "scale", "skew", "translate")
_REFERENCES = (
    "url", "source", "target", "rigid_body", "parent", "first", "second", "convex_hull_of",
    "href", "node",
)  # fmt: skip


def local(element: etree._Element) -> str:
    """The name without its namespace; empty for comments and instructions."""
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def child(parent: etree._Element, name: str) -> etree._Element | None:
    """The first child of a name of COLLADA."""
    return parent.find(c(name))


def children(parent: etree._Element, *names: str) -> list[etree._Element]:
    """The children of some names of COLLADA, in their order."""
    return list(parent.iterchildren(*(c(name) for name in names)))


def put(parent: etree._Element, node: etree._Element, before: Sequence[str]) -> None:
    """Put a child in, behind all those of the names that come before it or that it has itself."""
    tags = {c(name) for name in (*before, local(node))}
    behind = parent.iterchildren(*tags, reversed=True)
    _insert(parent, next(behind, None), node)


def put_next(node: etree._Element, previous: etree._Element) -> None:
    """Put an element in behind another one."""
    parent = previous.getparent()
    assert parent is not None
    _insert(parent, previous, node)


def put_first(parent: etree._Element, nodes: Sequence[etree._Element], behind: str) -> None:
    """Put children in, in their order, behind the last one of a name."""
    previous: etree._Element | None = None
    for other in parent:
        if local(other) == behind:
            previous = other
    for node in nodes:
        _insert(parent, previous, node)
        previous = node


def _insert(parent: etree._Element, previous: etree._Element | None, node: etree._Element) -> None:
    line = separator(parent, False)
    unit = indentation(parent, line)
    insert(parent, previous, node, line)
    indent(node, line, unit)


def drop(node: etree._Element) -> None:
    """Take an element out of its parent."""
    parent = node.getparent()
    if parent is not None:
        remove(parent, node, False)


def numbers(values: NDArray[Any] | Sequence[float]) -> str:
    """Numbers so that they read back to the same bits."""
    flat = np.asarray(values, dtype=np.float64).reshape(-1).tolist()
    return " ".join(repr(value).removesuffix(".0") for value in flat)


def profile_element(owner: etree._Element, name: str) -> etree._Element | None:
    """The element of a name in the pe techniques of an element."""
    for technique in owner.iterchildren(c("technique")):
        if technique.get("profile") == "pe":
            found = technique.find(f"{{{PE}}}{name}")
            if found is not None:
                return found
    return None


def replace_profile(owner: etree._Element, name: str, made: etree._Element | None) -> None:
    """Put an element into the pe technique of another one in place of that of its name.

    A technique that is empty then is taken out; what else stands in techniques stays.
    """
    old = profile_element(owner, name)
    if old is not None:
        technique = old.getparent()
        assert technique is not None
        if made is not None:
            made.tail = old.tail
            technique.replace(old, made)
            return
        drop(old)
        if not len(technique):
            drop(technique)
        return
    if made is None:
        return
    for technique in owner.iterchildren(c("technique")):
        if technique.get("profile") == "pe":
            _insert(technique, technique[-1] if len(technique) else None, made)
            return
    technique = etree.Element(c("technique"))
    technique.set("profile", "pe")
    technique.append(made)
    put_behind(owner, technique)


def put_behind(owner: etree._Element, technique: etree._Element) -> None:
    """Put a technique behind the others, before what is extra."""
    behind = (
        other for other in owner.iterchildren("{*}*", reversed=True) if local(other) != "extra"
    )  # fmt: skip
    _insert(owner, next(behind, None), technique)


def name_after(wanted: str, taken: set[str]) -> str:
    """An id that is not taken: the wanted one, or with a number before it; it is taken then."""
    made, number = wanted, 1
    while made in taken:
        made = f"u{number}-{wanted}"
        number += 1
    taken.add(made)
    return made


def retarget(element: etree._Element, ids: dict[str, str], prefix: str = "") -> None:
    """Let references at and below an element follow ids that were renamed.

    Local references to others get `prefix`, the file that they lead to.
    """
    for inner in _typed(element):
        for name in _REFERENCES:
            value = inner.get(name)
            if value is None:
                continue
            mark = "#" if value.startswith("#") else ""
            head, slash, rest = value.removeprefix("#").partition("/")
            if head in ids:
                inner.set(name, f"{mark}{ids[head]}{slash}{rest}")
            elif prefix and mark:
                inner.set(name, f"{prefix}{value}")


def _typed(element: etree._Element) -> Iterator[etree._Element]:
    return element.iter(etree.Element)

"""Following references: ids, paths of sids, other files, members of an archive.

A reference is a URI (``#id``, ``file.dae#id``) or a SID address (``id/sid/sid``, ``./sid/sid``);
where an element of the common profile expects one, tools write the other, so both are understood
everywhere (COLLADA 1.5 §Address syntax, thesis 3.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from urllib.parse import unquote

from lxml import etree

from colladaphy.document import rules
from colladaphy.document.names import XML_BASE, local_name
from colladaphy.errors import DocumentError
from colladaphy.findings import Rule

if TYPE_CHECKING:
    from colladaphy.document.document import Document

__all__ = ["Target", "follow", "split_reference"]


@dataclass(frozen=True, slots=True)
class Target:
    """What a reference leads to, and the document that holds it."""

    document: Document
    element: etree._Element


def split_reference(reference: str) -> tuple[str, str, list[str]]:
    """The file (empty for the same), the id (or ".", or empty) and the sids of a reference."""
    reference = reference.strip()
    file, hash_sign, rest = reference.partition("#")
    if not hash_sign:
        head, *sids = reference.split("/")
        if head == "." or not _names_file(reference):
            return "", unquote(head), [unquote(sid) for sid in sids]
        return unquote(reference), "", []
    head, *sids = rest.split("/")
    return unquote(file), unquote(head), [unquote(sid) for sid in sids]


def _names_file(reference: str) -> bool:
    last = reference.rpartition("/")[2].lower()
    return last.endswith((".dae", ".xml", ".zae")) or "://" in reference


def follow(
    document: Document,
    reference: str,
    origin: etree._Element,
    expected: str | tuple[str, ...],
) -> Target:
    """The element that `reference` at `origin` leads to; its name must be one of `expected`.

    Raises DocumentError where there is none, or one of another name.
    """
    names = (expected,) if isinstance(expected, str) else expected
    file, head, sids = split_reference(reference)
    target = document
    if file:
        target = document.related(_with_base(file, origin), origin)
    element = _start(target, head, origin if not file else None)
    if element is None and not file and not sids:
        # A bare sid, as instance_rigid_body/@body and Bullet's attachments have it.
        element = _from_nearest_scope(target, origin, head)
    if element is None:
        raise _refusal(rules.MISSING, document, origin, reference, f"there is no {head!r}")
    for sid in sids:
        inner = target.index.within(element, sid)
        if inner is None:
            raise _refusal(
                rules.MISSING, document, origin, reference, f"{head!r} holds no sid {sid!r}"
            )
        element = inner
    if names and local_name(element.tag) not in names:
        found = local_name(element.tag)
        wanted = " or ".join(f"<{name}>" for name in names)
        raise _refusal(
            rules.WRONG_TYPE, document, origin, reference, f"it is a <{found}>, not a {wanted}"
        )
    return Target(target, element)


def _start(document: Document, head: str, origin: etree._Element | None) -> etree._Element | None:
    if head == ".":
        return None if origin is None else origin.getparent()
    if not head:
        return document.tree.getroot() if origin is None else None
    return document.index.find(head)


def _from_nearest_scope(
    document: Document, origin: etree._Element, sid: str
) -> etree._Element | None:
    scope = origin.getparent()
    while scope is not None:
        found = document.index.within(scope, sid)
        if found is not None:
            return found
        scope = scope.getparent()
    return None


def _with_base(file: str, origin: etree._Element) -> str:
    """`file` relative to the document, with every xml:base on the way up applied."""
    element: etree._Element | None = origin
    while element is not None:
        base = element.get(XML_BASE)
        if base and not file.startswith("/") and "://" not in file:
            folder = base.rpartition("/")[0]
            file = f"{folder}/{file}" if folder else file
        element = element.getparent()
    return file


def _refusal(
    rule: Rule, document: Document, origin: etree._Element, reference: str, why: str
) -> DocumentError:
    message = f"The reference {reference!r} cannot be followed: {why}."
    return DocumentError(rule.at(origin, message, file=document.file))

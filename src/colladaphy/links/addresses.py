"""Following references one by one: ids, paths of sids, other files, members of an archive.

A reference is a URI (``#id``, ``file.dae#id``) or a SID address (``id/sid/sid``, ``./sid/sid``);
where an element of the common profile expects one, tools write the other, so both are understood
everywhere (COLLADA 1.5 §Address syntax, thesis 3.1).
"""

from __future__ import annotations

from typing import Protocol, Self, TypeVar
from urllib.parse import unquote

from lxml import etree

from colladaphy.columns.reading import Document as Columns
from colladaphy.errors import DocumentError
from colladaphy.findings import Rule
from colladaphy.links import rules
from colladaphy.links.sids import Sids

__all__ = ["Linked", "follow", "split_reference"]


class Linked(Protocol):
    """A document as references see it: what leads to elements, and to other documents."""

    file: str | None

    @property
    def columns(self) -> Columns:
        """The document as columns."""

    @property
    def ids(self) -> dict[str, int]:
        """The first element of every id."""

    @property
    def sids(self) -> Sids:
        """The elements by scoped id."""

    def element(self, number: int) -> etree._Element:
        """The element of a number, in the tree."""

    def related(self, file: str, origin: int) -> Self:
        """The document that a relative reference names."""


_Document = TypeVar("_Document", bound=Linked)


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
    resource: _Document, reference: str, origin: int, expected: str | tuple[str, ...] = ()
) -> tuple[_Document, int]:
    """Where `reference` at the element `origin` leads to: an element with an `expected` name.

    The document comes with the number of the element in it.

    Raises DocumentError where there is none, or one of another name.
    """
    names = (expected,) if isinstance(expected, str) else expected
    file, head, sids = split_reference(reference)
    target = resource
    if file:
        target = resource.related(_with_base(resource, file, origin), origin)
    element = _start(target, head, origin if not file else None)
    if element is None and not file and not sids:
        # A bare sid, as instance_rigid_body/@body and Bullet's attachments have it.
        element = _from_nearest_scope(target.sids, head, origin)
    if element is None:
        raise _refusal(rules.MISSING, resource, origin, reference, f"there is no {head!r}")
    for sid in sids:
        inner = target.sids.within(element, sid)
        if inner is None:
            why = f"{head!r} holds no sid {sid!r}"
            raise _refusal(rules.MISSING, resource, origin, reference, why)
        element = inner
    found = target.columns.local_name(element)
    if names and found not in names:
        wanted = " or ".join(f"<{name}>" for name in names)
        why = f"it is a <{found}>, not a {wanted}"
        raise _refusal(rules.WRONG_TYPE, resource, origin, reference, why)
    return target, element


def _start(resource: Linked, head: str, origin: int | None) -> int | None:
    if head == ".":
        return None if origin is None else max(resource.columns.parent_of(origin), 0)
    if not head:
        return 0 if origin is None else None
    return resource.ids.get(head)


def _from_nearest_scope(sids: Sids, sid: str, origin: int) -> int | None:
    scope = sids.columns.parent_of(origin)
    while scope >= 0:
        found = sids.within(scope, sid)
        if found is not None:
            return found
        scope = sids.columns.parent_of(scope)
    return None


def _with_base(resource: Linked, file: str, origin: int) -> str:
    """`file` relative to the document, with every xml:base on the way up applied."""
    element = origin
    while element >= 0:
        base = resource.columns.attribute_of(element, "xml:base")
        if base and not file.startswith("/") and "://" not in file:
            folder = base.rpartition("/")[0]
            file = f"{folder}/{file}" if folder else file
        element = resource.columns.parent_of(element)
    return file


def _refusal(rule: Rule, resource: Linked, origin: int, reference: str, why: str) -> DocumentError:
    message = f"The reference {reference!r} cannot be followed: {why}."
    return DocumentError(rule.at(resource.element(origin), message, file=resource.file))

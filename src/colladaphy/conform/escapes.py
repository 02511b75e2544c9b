"""References in other spellings: percent-escapes, and ids with a suffix of their instance.

A reference is a URI, in which any character may be written as an escape (RFC 3986 §2.1); ids and
sids are compared without. OpenRAVE gives the ids of a model that is instanced in a document a
suffix, and says which in an extra of the instance.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from urllib.parse import unquote

from lxml import etree

from colladaphy.conform import reference_rules
from colladaphy.conform.context import Context, local, standard_elements_with

__all__ = ["mend_escapes", "mend_suffixes"]

_KEYS = (
    "url", "source", "target", "parent", "convex_hull_of", "proxy", "camera_node", "rigid_body",
    "axis", "joint", "link", "node", "ref", "body", "constraint",
)  # fmt: skip
_TEXTS = ("skeleton", "SIDREF", "param")


def _references(context: Context, sign: str) -> Iterator[tuple[etree._Element, str | None, str]]:
    """Elements with a reference that holds a sign: the attribute (None for text) and its value."""
    values = context.root.xpath("//@*[contains(., $sign)]", sign=sign)
    for found in values if isinstance(values, list) else ():
        value: Any = found
        element, key = value.getparent(), value.attrname
        if key in _KEYS and not any(
            local(above) == "technique" and above.get("profile") is not None
            for above in element.iterancestors()
        ):
            yield element, key, str(value)
    for element in context.all(*_TEXTS):
        if sign in (element.text or "") and not len(element):
            yield element, None, (element.text or "").strip()


def _set(element: etree._Element, key: str | None, value: str) -> None:
    if key is None:
        element.text = value
    else:
        element.set(key, value)


def mend_escapes(context: Context) -> None:
    """Write references within the document without escapes, where that is what is there."""
    found = list(_references(context, "%"))
    if not found:
        return
    ids = set(context.ids)
    sids = {e.get("sid", "") for e in standard_elements_with(context.root, "sid")}
    for element, key, value in found:
        file, mark, fragment = value.partition("#")
        if mark and file:
            continue  # in another file
        before = fragment if mark else value
        plain = unquote(before)
        known = ids if mark else ids | sids
        if before in known or plain == before:
            continue
        head, *steps = plain.split("/")
        there = plain in known or (head in known | {".", ""} and all(s in sids for s in steps))
        if there and context.wants(reference_rules.ESCAPED):
            new = mark + plain
            _set(element, key, new)
            label = "text" if key is None else key
            message = f"{label} {value!r} of <{local(element)}> holds escapes; is now {new!r}"
            context.note(reference_rules.ESCAPED, element, message)


def mend_suffixes(context: Context) -> None:
    """References to ids with the suffix that an instance gives to what it instances."""
    suffixes: dict[str, str] = {}
    for extra in context.all("extra"):
        instance = extra.getparent()
        if extra.get("type") == "idsuffix" and instance is not None:
            texts = [extra.get("name", ""), *(str(text).strip() for text in extra.itertext())]
            for text in filter(None, texts):
                suffixes.setdefault(text, instance.get("url", ""))
    if not suffixes:
        return
    lengths = sorted({len(suffix) for suffix in suffixes}, reverse=True)
    for element, key, value in list(_references(context, "#")):
        file, _, fragment = value.partition("#")
        head, slash, rest = fragment.partition("/")
        if file or not head or head in context.ids:
            continue
        for length in lengths:
            bare, suffix = head[:-length], head[-length:]
            url = suffixes.get(suffix)
            if url is None or not bare:
                continue
            where = "" if bare in context.ids else url.partition("#")[0]
            if (bare in context.ids or where) and context.wants(reference_rules.SUFFIXED):
                new = f"{where}#{bare}{slash}{rest}"
                _set(element, key, new)
                message = (
                    f"{value!r} of <{local(element)}> has the suffix {suffix!r} of an instance; "
                    f"is now {new!r}"
                )
                context.note(reference_rules.SUFFIXED, element, message)
                break

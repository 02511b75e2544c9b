"""The pe profile's own content: numbers that can be mended, and what has to be set aside.

A profile repeats in exact words what the common profile says, so that a document can do without a
part of it that nobody can read.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from lxml import etree

from colladaphy.conform import form_rules
from colladaphy.conform.context import Context, local, remove
from colladaphy.conform.grammar import SimpleType
from colladaphy.conform.lexical import is_valid, mend
from colladaphy.gate import is_valid_text, schema_folder

__all__ = ["PE", "known_tops", "mend_profiles"]

PE = "urn:colladaphy:pe:1"
_XS = "{http://www.w3.org/2001/XMLSchema}"
_NUMBERS = SimpleType("numbers", item=SimpleType("xs:double", primitive="double"))


def mend_profiles(context: Context, *, valid: bool) -> None:
    """Mend numbers in the pe profile, and set its elements aside that are not valid even then.

    `valid` says that the schema had nothing against the document; it lets unknown elements pass.
    """
    tops = [
        element
        for element in context.root.iter(f"{{{PE}}}*")
        if not str(getattr(element.getparent(), "tag", "")).startswith(f"{{{PE}}}")
    ]
    for top in () if valid else tops:
        _mend_numbers(context, top)
    known = all(top.tag in known_tops() for top in tops)
    if known and (valid or not tops or _is_valid(context.root)):
        return
    for top in tops:
        fault = _fault(top)
        if fault is not None and context.wants(form_rules.FAULTY_PROFILE):
            message = f"<pe:{local(top)}> cannot be read ({fault}); it is set aside as text"
            context.note(form_rules.FAULTY_PROFILE, top, message)
            parent = top.getparent()
            assert parent is not None
            holder = parent.getparent()
            text = etree.tostring(top, encoding="unicode", with_tail=False)
            context.keep(parent if holder is None else holder, "text", of="pe", value=text)
            remove(top)


def _mend_numbers(context: Context, top: etree._Element) -> None:
    for element in top.iter(f"{{{PE}}}*"):
        text = element.text or ""
        if len(element) or not text.strip() or is_valid(text, _NUMBERS):
            continue
        mended, _ = mend(text, _NUMBERS)
        if mended is not None and context.wants(form_rules.LEXICAL_FORM):
            message = f"<pe:{local(element)}> was {text.strip()!r}, is now {mended!r}"
            context.note(form_rules.LEXICAL_FORM, element, message)
            element.text = mended


def _is_valid(root: etree._Element) -> bool:
    return is_valid_text(etree.tostring(root, encoding="UTF-8"))


def _fault(top: etree._Element) -> str | None:
    """What is wrong with an element of the profile; None where nothing is."""
    alone = etree.fromstring(etree.tostring(top, with_tail=False, encoding="UTF-8"))
    schema = _schema()
    if schema.validate(etree.ElementTree(alone)):
        return None
    log: Any = schema.error_log
    words = str(next((entry.message for entry in log), "it is not valid"))
    return words.replace(f"{{{PE}}}", "").rstrip(".")


@cache
def _schema() -> etree.XMLSchema:
    return etree.XMLSchema(etree.parse(schema_folder() / "pe-profile.xsd"))


@cache
def known_tops() -> frozenset[str]:
    """The tags that an element of the profile may have where it begins."""
    root = etree.parse(schema_folder() / "pe-profile.xsd").getroot()
    return frozenset(f"{{{PE}}}{child.get('name')}" for child in root.iterchildren(_XS + "element"))

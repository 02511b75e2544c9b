"""Decimal commas, mended before anything looks at a number."""

from __future__ import annotations

from functools import cache

from lxml import etree

from colladaphy.conform import form_rules
from colladaphy.conform.context import Context, local, type_of
from colladaphy.conform.grammar import ComplexType, SimpleType, grammar
from colladaphy.conform.lexical import is_valid
from colladaphy.conform.numerals import plain_numbers, spelled_number

__all__ = ["mend_commas"]

_WITH_COMMA = etree.XPath(
    "//text()[contains(., ',') or contains(., ';')]/parent::*"
    "[not(ancestor-or-self::*[local-name() = 'technique'][@profile])]"
)
_ANY = 1 << 30
_WORDS = frozenset({"radius", "radius1", "radius2", "height", "size", "matrix"})
"""Numbers of older versions and of other places than those that the schema knows."""


def mend_commas(context: Context) -> None:
    """Numbers get points as decimal marks, and blanks between them."""
    found = _WITH_COMMA(context.root)
    assert isinstance(found, list)
    for element in found:
        assert isinstance(element, etree._Element)
        kind = None if not local(element) or len(element) else _numbers_type(element)
        text = element.text or ""
        if kind is None or is_valid(text, kind):
            continue
        new, decimal = plain_numbers(text, *_wanted(element, kind))
        new = " ".join(spelled_number(word) or word for word in new.split())
        rule = form_rules.DECIMAL_COMMA if decimal else form_rules.LEXICAL_FORM
        if context.wants(rule):
            element.text = new
            before = " ".join(text.split())
            message = f"<{local(element)}> was {_short(before)}, is now {_short(new)}"
            context.note(rule, element, message)


def _numbers_type(element: etree._Element) -> SimpleType | None:
    """The type of an element that holds numbers; None where it holds something else."""
    parent = element.getparent()
    outer = None if parent is None else type_of(parent)
    if outer is not None and (known := outer.children.get(local(element))) is not None:
        kind = known.type.value if isinstance(known.type, ComplexType) else known.type
    else:
        kind = _by_name().get(local(element))
    return kind if kind is not None and _is_number(kind) else None


def _is_number(kind: SimpleType) -> bool:
    return (kind.primitive if kind.item is None else kind.item.primitive) in ("double", "float")


def _wanted(element: etree._Element, kind: SimpleType) -> tuple[int, int]:
    """How many numbers belong into an element."""
    if kind.item is None:
        return 1, 1
    if kind.length is not None:
        return kind.length
    count = element.get("count", "").strip()
    return (int(count), int(count)) if count.isdecimal() and len(count) < 10 else (0, _ANY)


@cache
def _by_name() -> dict[str, SimpleType]:
    """Types of elements that only ever hold numbers, wherever they stand."""
    found: dict[str, SimpleType] = {}
    other: set[str] = set()
    for outer in grammar().values():
        for name, declaration in outer.children.items():
            inner = declaration.type
            kind = inner.value if isinstance(inner, ComplexType) else inner
            if kind is None or not _is_number(kind):
                other.add(name)
            else:
                found.setdefault(name, kind)
    found = {name: kind for name, kind in found.items() if name not in other}
    plain = SimpleType("numbers", item=SimpleType("xs:double", primitive="double"))
    return {**found, **dict.fromkeys(_WORDS, plain)}


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "…")

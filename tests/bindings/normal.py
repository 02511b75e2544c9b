"""Two independent views of a document, to hold the codecs against.

`normal` is a normal form of valid XML. It does not count: comments and instructions outside
wildcards; white space between elements; prefixes; attributes of the instance namespace, but for
xsi:type where the declared type is complex (where it is simple, dataclasses hold the plain value,
and xsi:type and what it brings are lost); the choice between an empty element and the schema's
default for it. Every simple value counts by its value, not its spelling. Everything else counts,
the presence of defaulted attributes included, and inside wildcards everything as written.

`same` says whether our dataclasses equal those that xsdata's parser built of the same document,
where they may differ only in what xsdata does not keep or do.
"""

from __future__ import annotations

import dataclasses
import re
from copy import deepcopy
from typing import Any

from lxml import etree
from xsdata.formats.dataclass.models.generics import AnyElement as TheirElement
from xsdata.formats.dataclass.models.generics import DerivedElement

from colladaphy.conform.grammar import (
    ComplexType,
    Declaration,
    SimpleType,
    grammar,
    root_declaration,
)
from colladaphy_schema.codec import AnyElement, Comment, ProcessingInstruction

XSI = "{http://www.w3.org/2001/XMLSchema-instance}"
NUMBERS = {"double", "float"}
EXACT = {"string", "anyType", "normalizedString"}
TEXTS = {"token", "NCName", "Name", "ID", "IDREF", "NMTOKEN", "anyURI", "language"}


def value(text: str, kind: SimpleType) -> Any:
    """The value of a text, so that two spellings of one value are equal."""
    if kind.item is not None:
        return [value(word, kind.item) for word in text.split()]
    if kind.members:
        return " ".join(text.split())
    if kind.primitive in EXACT:
        return text
    text = " ".join(text.split())
    if kind.primitive in NUMBERS:
        return repr(float(text.replace("INF", "inf")))
    if kind.primitive == "boolean":
        return text in ("true", "1")
    if kind.primitive == "hexBinary":
        return text.upper()
    if kind.primitive == "dateTime":
        return re.sub(r"(\.\d*?)0*(?=$|[Z+-])", r"\1", text).replace(".Z", "Z")
    return text if kind.primitive in TEXTS else int(text)


def normal(document: etree._Element) -> Any:
    """The normal form of a whole document."""
    return _element(document, root_declaration())


def _element(element: etree._Element, declaration: Declaration) -> Any:
    declared = declaration.type
    derived = element.get(f"{XSI}type")
    kind = grammar()[derived.rpartition(":")[2]] if derived else declared
    attributes = {
        name: text
        for name, text in element.items()
        if not name.startswith(XSI) or name == f"{XSI}type"
    }
    if isinstance(declared, SimpleType):
        kind = declared
    if isinstance(kind, SimpleType):
        return element.tag, value(_text(element) or declaration.default or "", kind)
    return element.tag, _attributes(attributes, kind), _content(element, kind, declaration.default)


def _attributes(attributes: dict[str, str], kind: ComplexType) -> dict[str, Any]:
    return {
        name: value(text, kind.attributes[name].type)
        if name in kind.attributes
        else text.rpartition(":")[2]
        for name, text in attributes.items()
    }


def _content(element: etree._Element, kind: ComplexType, default: str | None) -> Any:
    if kind.value is not None:
        return value(_text(element) or default or "", kind.value)
    if kind.anything:
        mixed = _local(element) == "math"
        return [
            None if _is_blank(element.text, mixed) else element.text,
            [
                (_node(child), None if _is_blank(child.tail, mixed) else child.tail)
                for child in element
            ],
        ]
    return [
        _element(child, kind.children[_local(child)])
        for child in element
        if isinstance(child.tag, str)
    ]


def _is_blank(text: str | None, mixed: bool) -> bool:
    return not text or (not mixed and text.isspace())


def _node(node: etree._Element) -> Any:
    """An element, comment or instruction of a wildcard, as it is written."""
    if not isinstance(node.tag, str):
        return str(node)
    children = [(_node(child), child.tail or "") for child in node]
    return node.tag, node.prefix, dict(node.attrib), node.text or "", children


def _local(element: etree._Element) -> str:
    return str(etree.QName(element).localname)


def _text(element: etree._Element) -> str:
    return (element.text or "") + "".join(child.tail or "" for child in element)


def with_defaults(document: etree._Element) -> etree._Element:
    """A copy in which empty elements hold the schema's default for them, in so many words."""
    copy = deepcopy(document)
    _fill(copy, root_declaration())
    return copy


def _fill(element: etree._Element, declaration: Declaration) -> None:
    derived = element.get(f"{XSI}type")
    kind = grammar()[derived.rpartition(":")[2]] if derived else declaration.type
    if declaration.default is not None and not _text(element):
        element.text = declaration.default
    if isinstance(kind, ComplexType) and not kind.anything:
        for child in element:
            if isinstance(child.tag, str):
                _fill(child, kind.children[_local(child)])


def same(ours: Any, theirs: Any) -> bool:
    """Whether two objects are equal, but for what xsdata drops or leaves as it is.

    It drops comments and instructions, and white space, in wildcards; it leaves white space in
    texts that the schema collapses.
    """
    if isinstance(ours, AnyElement):
        return _same_node(ours, theirs)
    if isinstance(ours, float) and isinstance(theirs, float):
        return repr(ours) == repr(theirs)
    if isinstance(ours, str) and isinstance(theirs, str):
        return ours.split() == theirs.split()
    if isinstance(ours, list):
        kept = [x for x in ours if not isinstance(x, Comment | ProcessingInstruction)]
        kept = [x for x in kept if not (isinstance(x, str) and x.isspace())]
        return len(kept) == len(theirs) and all(map(same, kept, theirs))
    if dataclasses.is_dataclass(ours) and type(ours).__module__.startswith("colladaphy_schema"):
        if isinstance(theirs, DerivedElement):
            theirs = theirs.value
        return type(ours) is type(theirs) and all(
            same(getattr(ours, f.name), getattr(theirs, f.name)) for f in dataclasses.fields(ours)
        )
    return bool(type(ours) is type(theirs) and ours == theirs)


def _same_node(ours: AnyElement, theirs: Any) -> bool:
    if isinstance(theirs, str):  # an element of any type that holds text only
        return not ours.children and same(ours.text or "", theirs)
    assert isinstance(theirs, TheirElement)
    children = [child for child in ours.children if isinstance(child, AnyElement)]
    texts = "".join(child.tail or "" for child in ours.children)
    their_children = [child for child in theirs.children if isinstance(child, TheirElement)]
    their_texts = "".join(child.tail or "" for child in their_children) + "".join(
        child for child in theirs.children if isinstance(child, str)
    )
    return (
        ours.qname == theirs.qname
        and ours.attributes.keys() == theirs.attributes.keys()
        and same((ours.text or "") + texts, (theirs.text or "") + their_texts)
        and len(children) == len(their_children)
        and all(map(_same_node, children, their_children))
    )

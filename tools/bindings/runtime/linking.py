"""Joins the codec modules of the areas, so that an area is imported only when it is needed.

A codec module calls functions of another area through stubs; the first call of one imports the
other area and puts its functions in place of all stubs for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any

from lxml.etree import _Element

from colladaphy_schema import registry
from colladaphy_schema.errors import CodecError, reject
from colladaphy_schema.lexical import attribute_escaped, collapsed, text_escaped
from colladaphy_schema.nodes import (
    AnyElement,
    Comment,
    ProcessingInstruction,
    Scope,
    attribute_name,
    read_node,
    write_node,
)

XSI_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
PACKAGE = "colladaphy_schema"
REQUIRED: Any = object()
new = object.__new__

Decoder = Callable[..., Any]
Encoder = Callable[[Any, Callable[[str], None], str, str], None]


class Stated:
    """Base of classes that remember which defaults their XML states in so many words.

    `_stated` names the fields that were present although they equal their default, so that
    writing neither drops them nor adds others. It takes no part in comparison.
    """

    __slots__ = ("_stated",)
    _stated: tuple[str, ...]


def stated(obj: Any) -> tuple[str, ...]:
    """The fields whose default was stated; none for an object that was not read."""
    result: tuple[str, ...] = getattr(obj, "_stated", ())
    return result


class Links:
    """The stubs of one codec module, and the tables they stand in."""

    def __init__(self, module: dict[str, Any], areas: dict[str, tuple[str, ...]]) -> None:
        self.module = module
        self.areas = areas
        self.tables: Iterable[dict[str, Decoder]] = ()
        for area, names in areas.items():
            for name in names:
                module[f"decode_{name}"] = self._stub(area, f"decode_{name}")
                module[f"encode_{name}"] = self._stub(area, f"encode_{name}")

    def _stub(self, area: str, function: str) -> Callable[..., Any]:
        def stub(*args: Any) -> Any:
            self._link(area)
            return self.module[function](*args)

        return stub

    def _link(self, area: str) -> None:
        codec = codec_module(area)
        replaced: dict[Any, Any] = {}
        for name in self.areas[area]:
            for function in (f"decode_{name}", f"encode_{name}"):
                target = getattr(codec, function)
                replaced[self.module[function]] = target
                self.module[function] = target
        for table in self.tables:
            for key, value in table.items():
                if value in replaced:
                    table[key] = replaced[value]


def codec_module(area: str) -> Any:
    """The codec module of an area."""
    return import_module(f"{PACKAGE}.{area}_codec")


def decoder_of(cls: type) -> Decoder:
    """The decode function of a generated class."""
    return _function(cls, "decode")


def encoder_of(cls: type) -> Encoder:
    """The encode function of a generated class."""
    return _function(cls, "encode")


def _function(cls: type, kind: str) -> Callable[..., Any]:
    package, _, area = cls.__module__.rpartition(".")
    if package != PACKAGE:
        raise CodecError(f"{cls.__qualname__} is not a class of the schema")
    found: Callable[..., Any] | None = getattr(codec_module(area), f"{kind}_{cls.__name__}", None)
    if found is None:
        raise CodecError(f"{cls.__qualname__} cannot stand for an element")
    return found


# --- xsi:type ------------------------------------------------------------------------------


def derivation(element: _Element, name: str, derived: dict[str, tuple[str, str]]) -> Any:
    """The decode function for the type that xsi:type names; None for the declared type."""
    prefix, colon, local = collapsed(name).rpartition(":")
    uri = element.nsmap.get(prefix if colon else None, "")
    qname = f"{{{uri}}}{local}"
    if qname not in derived:
        reject(element, f"type {name!r} is not derived from the element's type")
    area, cls = derived[qname]
    return getattr(codec_module(area), f"decode_{cls}") if area else None


def encode_derived(
    obj: Any, write: Callable[[str], None], tag: str, indent: str, derived: dict[str, Any]
) -> None:
    """Write an object of a derived class, with xsi:type saying which."""
    cls = obj.__class__
    area = cls.__module__.rpartition(".")[2]
    for qname, place in derived.items():
        if place == (area, cls.__name__):
            uri, _, local = qname[1:].partition("}")
            chunks: list[str] = []
            encoder_of(cls)(obj, chunks.append, tag, indent)
            head = f"{indent}<{tag}"
            prefix = registry.PREFIXES[uri]
            chunks[0] = f'{head} xsi:type="{prefix}{local}"{chunks[0][len(head) :]}'
            write("".join(chunks))
            return
    raise CodecError(f"{cls.__name__} cannot stand in <{tag}>")


def choose(
    table: dict[type, tuple[Encoder, str]],
    names: dict[tuple[str, str], str],
    obj: Any,
) -> tuple[Encoder, str]:
    """The encoder and tag for an object in a field of several types; kept in `table`."""
    for cls in type(obj).__mro__:
        if cls in table:
            table[type(obj)] = table[cls]
            return table[cls]
        tag = names.get((cls.__module__.rpartition(".")[2], cls.__name__))
        if tag is not None:
            # the encoder of the declared class writes xsi:type for a derived one
            table[type(obj)] = encoder_of(cls), tag
            return table[type(obj)]
    wanted = ", ".join([*names.values(), *(tag for _, tag in table.values())])
    raise CodecError(f"{type(obj).__name__} cannot stand where {wanted} may")


def leaf(text: Callable[[Any], str]) -> Encoder:
    """The encoder of a plain value that `text` turns into escaped text."""

    def write_leaf(value: Any, write: Callable[[str], None], tag: str, indent: str) -> None:
        write(f"{indent}<{tag}>{text(value)}</{tag}>")

    return write_leaf


def write_generic(node: Any, write: Callable[[str], None], tag: str, indent: str) -> None:
    """The encoder of an element of any type."""
    write(indent)
    encode_generic(node, write)


# --- wildcards -----------------------------------------------------------------------------


def wildcard(element: _Element) -> list[object]:
    """The content of a wildcard in element content: white space between nodes means nothing."""
    items: list[object] = []
    if element.text and not element.text.isspace():
        items.append(element.text)
    for child in element:
        items.append(_item(child))
        if child.tail and not child.tail.isspace():
            items.append(child.tail)
    return items


def mixed(element: _Element) -> list[object]:
    """The content of a wildcard in mixed content: all text is kept."""
    items: list[object] = [element.text] if element.text else []
    for child in element:
        items.append(_item(child))
        if child.tail:
            items.append(child.tail)
    return items


def _item(child: _Element) -> object:
    place = registry.ELEMENTS.get(child.tag) if isinstance(child.tag, str) else None
    if place is None:
        return read_node(child, tail=False)
    return getattr(codec_module(place[0]), f"decode_{place[1]}")(child)


def generic(element: _Element) -> object:
    """An element of any type."""
    return read_node(element, tail=False)


_SCOPE: Scope = {prefix.rstrip(":") or None: uri for uri, prefix in registry.PREFIXES.items()}
_NAMES = {place: qname for qname, place in registry.ELEMENTS.items()}


def encode_wildcard(items: Iterable[object], write: Callable[[str], None], indent: str) -> None:
    """Write the content of a wildcard."""
    for item in items:
        if isinstance(item, str):
            write(text_escaped(item))
        elif isinstance(item, AnyElement | Comment | ProcessingInstruction):
            write(indent)
            encode_generic(item, write)
        else:
            cls = type(item)
            qname = _NAMES.get((cls.__module__.rpartition(".")[2], cls.__name__))
            if qname is None:
                raise CodecError(f"{cls.__name__} is not an element of the schema")
            uri, _, local = qname[1:].partition("}")
            encoder_of(cls)(item, write, registry.PREFIXES[uri] + local, indent)


def encode_generic(node: Any, write: Callable[[str], None]) -> None:
    """Write an element of any type."""
    chunks: list[str] = []
    write_node(node, chunks, _SCOPE)
    write("".join(chunks))


def other_attributes(values: dict[str, str]) -> str:
    """Attributes that only a wildcard allows, as the inside of a start tag."""
    chunks: list[str] = []
    declared: Scope = {}
    inner = dict(_SCOPE)
    for name, value in values.items():
        chunks.append(f' {attribute_name(name, inner, declared)}="{attribute_escaped(value)}"')
    return "".join(
        [f' xmlns:{prefix}="{attribute_escaped(uri)}"' for prefix, uri in declared.items()] + chunks
    )

"""Validating the text of a document while it is parsed, without a tree.

It takes no memory, but does not say what is wrong. That is for the `gate` to say, about a tree.
"""

from __future__ import annotations

import re
from typing import Any, BinaryIO, cast

from lxml import etree

from colladaphy.gate.numerals import may_hold_incomplete_numbers
from colladaphy.gate.schema import PE, compiled, wrapped
from colladaphy.source.limits import LIBXML2_TEXT, Limits
from colladaphy.source.plain import after_declaration, in_short_pieces, is_plain
from colladaphy.source.xml import COLLADA_1_5

__all__ = ["accepts", "is_valid", "is_valid_text"]

# Whatever could be the attribute `id`, in a comment or a text too.
_ID = re.compile(rb"id(?<=[ \t\r\n]id)[ \t\r\n]*=[ \t\r\n]*[\"'][ \t\r\n]*([^\"' \t\r\n]*)")
_DECLARED = re.compile(rb"xmlns(?::[^\s=<>\"'&]*)?[ \t\r\n]*=[ \t\r\n]*(?:\"([^\"]*)\"|'([^']*)')")
# What is certain to be the name of a namespace; parsers refuse what is no URI, and XML's own.
_NAMESPACE = re.compile(
    rb"urn:[A-Za-z0-9][A-Za-z0-9-]*:[A-Za-z0-9:._-]+"
    rb"|https?://(?!www\.w3\.org/(?:2000/xmlns|XML/))[A-Za-z0-9.-]+(?:/[A-Za-z0-9._~-]*)*"
)
_MATHML = b"http://www.w3.org/1998/Math/MathML"
_SMALL = 1 << 16
"""Documents whose trees cost less than the second schema."""
_WRAPPER = b"colladaphy.gate"
"""The prefix of the wrapper, which no document may use."""
_DEFAULTS = Limits()


def accepts(data: bytes, limits: Limits = _DEFAULTS) -> bool:
    """Whether a document is sure to be read and valid, for little more than it takes to validate.

    True: parsing it within `limits` raises nothing, and neither the `gate` nor
    `incomplete_numbers` finds anything. False: something is wrong, or a tree must tell; it does
    for encodings other than UTF-8, for CDATA, and for a technique with foreign content beside the
    pe profile's. To small documents with that profile a tree is no burden.
    """
    return (
        is_plain(data, limits)
        and (schema := _schema_for(data)) is not None
        and _ids_are_unique(data)
        and not may_hold_incomplete_numbers(data)
        and _wrapped_passes(data, schema)
    )


def is_valid(tree: etree._ElementTree) -> bool:
    """Whether libxml2 finds nothing wrong with a tree, whatever there is to find.

    Its text is validated: validating a tree leaves ids behind in it.
    """
    return is_valid_text(etree.tostring(tree.getroot(), encoding="UTF-8"))


def is_valid_text(data: bytes) -> bool:
    """Whether the text of a document passes libxml2's validation; False if it is not well-formed.

    It does not say whether an id is there twice.
    """
    if in_short_pieces(data, LIBXML2_TEXT):
        return _passes(data, compiled())
    parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError:
        return False
    return compiled().validate(root)


def _schema_for(data: bytes) -> etree.XMLSchema | None:
    """The schema that tells of unknown elements of the pe profile, too, if it is there."""
    declared = {double or single for double, single in _DECLARED.findall(data)}
    if not all(map(_NAMESPACE.fullmatch, declared)):
        return None
    if PE.encode() not in data:
        return wrapped("lax")
    if len(data) < _SMALL or _MATHML in data:  # the content of MathML is open to everything
        return None
    return wrapped("strict")


def _ids_are_unique(data: bytes) -> bool:
    ids = _ID.findall(data)
    if b"&" in data and any(b"&" in name for name in ids):
        return False
    return len(set(ids)) == len(ids)


def _wrapped_passes(data: bytes, schema: etree.XMLSchema) -> bool:
    """Whether a plain document passes, one level down.

    Without a tree libxml2 allows one level more than with one. (A parser that is fed allows any.)
    """
    start = after_declaration(data)
    if start is None or _WRAPPER in data:
        return False
    parser = _parser(schema, huge=False)
    try:
        etree.parse(cast("BinaryIO", _Wrapped(data, start)), parser)
    except etree.XMLSyntaxError:
        return False
    return not len(parser.error_log)


def _passes(data: bytes, schema: etree.XMLSchema) -> bool:
    parser = _parser(schema, huge=True)
    try:
        etree.fromstring(data, parser)
    except etree.XMLSyntaxError:
        return False
    return not len(parser.error_log)


def _parser(schema: etree.XMLSchema, *, huge: bool) -> etree.XMLParser:
    nothing: Any = _Nothing()
    return etree.XMLParser(
        target=nothing,
        schema=schema,
        huge_tree=huge,
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
    )


class _Wrapped:
    """A file that holds a document within the wrapper, read without copying the whole."""

    def __init__(self, data: bytes, start: int) -> None:
        self._data = data
        self._place = start
        self._head = b'<%s:document xmlns:%s="%s">' % (_WRAPPER, _WRAPPER, COLLADA_1_5.encode())
        self._tail = b"</%s:document>" % _WRAPPER

    def read(self, size: int) -> bytes:
        """The next bytes; none at the end."""
        if self._head:
            part, self._head = self._head, b""
        elif self._place < len(self._data):
            part = self._data[self._place : self._place + size]
            self._place += size
        else:
            part, self._tail = self._tail, b""
        return part


class _Nothing:
    """A parser's target that takes no events."""

    def close(self) -> None:
        """Called at the end."""

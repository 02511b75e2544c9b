"""Elements to dataclasses and back.

The functions behind this module are generated, one pair a class. They expect elements that the
schema has accepted; what they cannot hold raises `CodecError`.
"""

from __future__ import annotations

import gc
import re
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from lxml.etree import _Element, _ElementTree

from colladaphy_schema import registry
from colladaphy_schema.errors import CodecError
from colladaphy_schema.linking import decoder_of, encoder_of
from colladaphy_schema.nodes import AnyElement, Comment, ProcessingInstruction

if TYPE_CHECKING:
    from colladaphy_schema.document import Collada

__all__ = [
    "AnyElement",
    "CodecError",
    "Comment",
    "ProcessingInstruction",
    "decode",
    "decode_document",
    "encode",
    "encode_document",
    "paused_collector",
]

T = TypeVar("T")

COLLADA_NAMESPACE = "http://www.collada.org/2008/03/COLLADASchema"
XSI_NAMESPACE = "http://www.w3.org/2001/XMLSchema-instance"

_lock = threading.Lock()
_pauses = 0
_was_enabled = False


@contextmanager
def paused_collector() -> Iterator[None]:
    """Keep the garbage collector from running; may be nested, and used by several threads.

    Building a large document makes many objects and no garbage in cycles, but every so many
    allocations would start a collection that walks all of them.
    """
    global _pauses, _was_enabled
    with _lock:
        if _pauses == 0:
            _was_enabled = gc.isenabled()
            gc.disable()
        _pauses += 1
    try:
        yield
    finally:
        with _lock:
            _pauses -= 1
            if _pauses == 0 and _was_enabled:
                gc.enable()


def decode(element: _Element, cls: type[T]) -> T:
    """The dataclass of an element; its name is not looked at, only its content.

    Raises CodecError where the element does not hold what `cls` describes.
    """
    result: T = decoder_of(cls)(element)
    return result


def encode(
    obj: Any, tag: str, nsmap: Mapping[str | None, str] | None = None, *, indent: str = ""
) -> str:
    """An element as XML text.

    `tag` is a local name or Clark notation; a local name is taken in the namespace of the
    object's class. The element declares the prefixes that it needs and that `nsmap` (what is
    declared around it) does not bind already. `indent` is "" or a line break and the blanks to
    indent by, such as ``"\\n"``. Raises CodecError for what XML or the schema cannot hold.
    """
    uri, _, local = tag[1:].rpartition("}") if tag[:1] == "{" else ("", "", tag)
    if not uri:
        area = type(obj).__module__.rpartition(".")[2]
        uri = registry.NAMESPACES.get(area, COLLADA_NAMESPACE)
    if uri not in registry.PREFIXES:
        raise CodecError(f"{uri} is not a namespace of the schema")
    chunks: list[str] = []
    name = registry.PREFIXES[uri] + local
    try:
        encoder_of(type(obj))(obj, chunks.append, name, indent)
    except CodecError:
        raise
    except (TypeError, AttributeError, ValueError) as error:
        raise CodecError(f"{type(obj).__name__} holds a value of a wrong type: {error}") from error
    text = "".join(chunks)
    head = len(indent) + 1 + len(name)
    return f"{text[:head]}{_declarations(text, dict(nsmap or {}))}{text[head:]}"


def _declarations(text: str, scope: dict[str | None, str]) -> str:
    """The namespace declarations that an encoded text needs; the default one always."""
    needed: list[tuple[str | None, str]] = []
    for uri, prefix in registry.PREFIXES.items():
        if not prefix or _uses(text, prefix):
            needed.append((prefix.rstrip(":") or None, uri))
    if _uses(text, "xsi:"):
        needed.append(("xsi", XSI_NAMESPACE))
    return "".join(
        f' xmlns{f":{prefix}" if prefix else ""}="{uri}"'
        for prefix, uri in needed
        if scope.get(prefix) != uri
    )


def _uses(text: str, prefix: str) -> bool:
    """Whether a prefix stands in a text, as a name's or in a value that may be one."""
    return prefix in text and re.search(rf"(?<![\w.\-]){prefix}", text) is not None


def decode_document(tree: _ElementTree | _Element) -> Collada:
    """The dataclass of a whole document; the garbage collector rests meanwhile."""
    from colladaphy_schema.document_codec import decode_Collada

    root = tree if isinstance(tree, _Element) else tree.getroot()
    if root.tag != f"{{{COLLADA_NAMESPACE}}}COLLADA":
        raise CodecError(f"the root is {root.tag}, not COLLADA 1.5")
    with paused_collector():
        result: Collada = decode_Collada(root)
    return result


def encode_document(collada: Collada, *, indent: str = "") -> str:
    """A whole document as XML text, with its declaration; encode it as UTF-8 to save it.

    `indent` is "" for no white space between elements, or a line break such as ``"\\n"``.
    """
    text = encode(collada, "COLLADA", indent=indent)
    return f'<?xml version="1.0" encoding="UTF-8"?>{text if indent else chr(10) + text}'

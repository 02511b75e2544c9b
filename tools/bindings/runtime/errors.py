"""What the codecs raise."""

from __future__ import annotations

from typing import NoReturn

from lxml.etree import _Element


class CodecError(ValueError):
    """An element does not hold what its type says, or an object holds what XML cannot say."""


def reject(element: _Element, message: str) -> NoReturn:
    """Raise CodecError about an element, with its line."""
    raise CodecError(f"line {element.sourceline}: <{_local(element)}>: {message}")


def unexpected(parent: _Element, child: _Element) -> None:
    """Pass over comments and instructions; reject an element that its parent cannot hold."""
    if isinstance(child.tag, str):
        reject(child, f"unexpected {child.tag} in <{_local(parent)}>")


def attribute(element: _Element, name: str) -> None:
    """Pass over attributes of XML Schema's instance namespace; reject any other unknown one."""
    if not name.startswith("{http://www.w3.org/2001/XMLSchema-instance}"):
        reject(element, f"unexpected attribute {name}")


def missing(element: _Element, name: str) -> NoReturn:
    """Reject an element without something that is required."""
    reject(element, f"{name} is missing")


def _local(element: _Element) -> str:
    return str(element.tag).rpartition("}")[2]

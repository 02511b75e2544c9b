"""Elements as text."""

from __future__ import annotations

from collections.abc import Iterable

from colladaphy.conform.grammar import NAMESPACE

__all__ = ["NS_1_4", "NS_1_5", "collada", "dates", "library", "numbers", "tag"]

NS_1_5 = NAMESPACE
NS_1_4 = "http://www.collada.org/2005/11/COLLADASchema"
_INFINITE = {float("inf"): "INF", float("-inf"): "-INF"}


def tag(name: str, /, *content: str, **attributes: object) -> str:
    """An element; attributes of None are left out, and so are underscores at the end of names."""
    written = "".join(
        f' {key.rstrip("_")}="{value}"' for key, value in attributes.items() if value is not None
    )
    inner = "".join(content)
    return f"<{name}{written}>{inner}</{name}>" if inner else f"<{name}{written}/>"


def numbers(values: Iterable[float]) -> str:
    """Numbers as XML Schema spells them."""
    return " ".join(_INFINITE.get(float(value)) or repr(float(value)) for value in values)


def library(name: str, *content: str) -> str:
    """A library, where there is anything in it."""
    return tag(f"library_{name}", *content) if any(content) else ""


def collada(version: str, *content: str, namespaces: str = "") -> bytes:
    """A document of a version."""
    uri = NS_1_5 if version.startswith("1.5") else NS_1_4
    inner = "".join(content)
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        f'<COLLADA xmlns="{uri}"{namespaces} version="{version}">{inner}</COLLADA>'
    ).encode()


def dates(form: str = "2016-05-04T03:02:01Z") -> str:
    """When a document was made."""
    return tag("created", form) + tag("modified", form)

"""Markup as text: escaping, and the few elements that stand everywhere."""

from __future__ import annotations

from colladaphy.document.names import COLLADA, PE

__all__ = ["COLLADA", "PE", "attribute", "escape", "pe_technique", "token"]

_ESCAPES = str.maketrans(
    {
        "&": "&amp;",
        "<": "&lt;",
        ">": "&gt;",
        '"': "&quot;",
        "\t": "&#9;",
        "\n": "&#10;",
        "\r": "&#13;",
    }
)


def escape(text: str) -> str:
    """Text for an attribute or an element, so that every character survives."""
    return text.translate(_ESCAPES)


def attribute(name: str, value: object) -> str:
    """An attribute with the blank before it; nothing for None."""
    return "" if value is None else f' {name}="{escape(str(value))}"'


def token(text: str) -> str:
    """What a reader makes of `text` as xs:token: runs of blanks are one, none at the ends."""
    return " ".join(part for part in text.translate(_BLANKS).split(" ") if part)


_BLANKS = str.maketrans("\t\n\r", "   ")


def pe_technique(content: str) -> str:
    """A technique of the pe profile; nothing for no content."""
    return f'<technique profile="pe">{content}</technique>' if content else ""

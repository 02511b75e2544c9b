"""Names of the document's namespaces and of the elements that references lead to."""

from __future__ import annotations

__all__ = ["COLLADA", "MOST_INSTANCES", "PE", "XML_BASE", "c", "local_name", "p"]

COLLADA = "http://www.collada.org/2008/03/COLLADASchema"
PE = "urn:colladaphy:pe:1"
MOST_INSTANCES = 1_000_000
"""Instances of physics models, those within models included, that a scene may expand to."""
XML_BASE = "{http://www.w3.org/XML/1998/namespace}base"


def c(name: str) -> str:
    """The tag of a COLLADA element."""
    return f"{{{COLLADA}}}{name}"


def p(name: str) -> str:
    """The tag of an element of the pe profile."""
    return f"{{{PE}}}{name}"


def local_name(tag: object) -> str:
    """The name without its namespace; empty for comments and processing instructions."""
    return tag.rpartition("}")[2] if isinstance(tag, str) else ""

"""Names and small expressions that both emitters share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from tools.bindings.model import Branch, Field, Record, Value

PACKAGE = "colladaphy_schema"
COLLADA = "http://www.collada.org/2008/03/COLLADASchema"
# What an encoded document calls the namespaces of the schema.
PREFIXES = {
    COLLADA: "",
    "urn:colladaphy:pe:1": "pe:",
    "http://www.w3.org/1998/Math/MathML": "mml:",
}


@dataclass
class Needs:
    """What the functions of one module need beside themselves."""

    module: str
    classes: dict[str, set[str]] = field(default_factory=dict)  # by area, imported at once
    functions: dict[str, set[str]] = field(default_factory=dict)  # by area, linked when called
    enumerations: dict[str, Record] = field(default_factory=dict)
    tables: list[str] = field(default_factory=list)  # source of tables, after all functions
    decode_tables: list[str] = field(default_factory=list)

    def use_class(self, record: Record) -> str:
        self.classes.setdefault(record.module, set()).add(record.name)
        return record.name

    def use_function(self, record: Record) -> None:
        if record.module != self.module:
            self.functions.setdefault(record.module, set()).add(record.name)

    def use_enumeration(self, record: Record) -> str:
        self.use_class(record)
        self.enumerations[record.name] = record
        return f"VALUES_{record.name}"

    def default(self, source: Field) -> str:
        """The default of a field as source text."""
        assert source.default is not None
        return source.default.removeprefix("enum:")


def tag_of(qname: str) -> str:
    """An element's name as it is written, with its prefix."""
    uri, _, local = qname[1:].partition("}")
    return PREFIXES[uri] + local


def attribute_of(qname: str) -> str:
    """An attribute's name as it is written."""
    if qname[0] != "{":
        return qname
    uri, _, local = qname[1:].partition("}")
    if uri != "http://www.w3.org/XML/1998/namespace":
        raise ValueError(f"attribute {qname} has no known prefix")
    return f"xml:{local}"


def text_field(record: Record) -> Field | None:
    """The field that holds the text of simple content."""
    return next((f for f in record.fields if f.form == "text"), None)


def takes_empty(record: Record) -> bool:
    """Whether the decode function takes the element's default text."""
    return text_field(record) is not None


def ancestry(record: Record) -> Iterator[Record]:
    """The record and its bases."""
    step: Record | None = record
    while step is not None:
        yield step
        step = step.base


def indented(lines: Iterable[str], depth: int = 1) -> list[str]:
    """Lines of source text, further in."""
    return ["    " * depth + line for line in lines]


__all__ = [
    "COLLADA", "PACKAGE", "PREFIXES", "Branch", "Field", "Needs", "Record", "Value",
    "ancestry", "attribute_of", "indented", "tag_of", "takes_empty", "text_field",
]  # fmt: skip

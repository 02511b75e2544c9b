"""The content models of our COLLADA 1.5 schema, as data that repairs can reason with.

libxml2 says that a document is wrong; to mend it, one must know what would be right: which
children an element may have and in which order, which attributes, which lexical forms. This
module reads that once from the project's own schema files.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from lxml import etree

from colladaphy.gate import schema_folder

__all__ = [
    "NAMESPACE",
    "XSI",
    "Attribute",
    "ComplexType",
    "Declaration",
    "Group",
    "SimpleType",
    "all_types",
    "grammar",
    "required",
    "root_declaration",
    "stated_type",
]

XSI = "{http://www.w3.org/2001/XMLSchema-instance}"
NAMESPACE = "http://www.collada.org/2008/03/COLLADASchema"
_XS = "{http://www.w3.org/2001/XMLSchema}"
_UNBOUNDED = 1 << 30


@dataclass(slots=True)
class SimpleType:
    """A simple type: a built-in `primitive` with facets, or a list or a union of others."""

    name: str
    primitive: str = "string"
    item: SimpleType | None = None
    members: tuple[SimpleType, ...] = ()
    enumeration: tuple[str, ...] = ()
    pattern: str | None = None
    length: tuple[int, int] | None = None
    bounds: tuple[int | None, int | None] = (None, None)


@dataclass(slots=True)
class Attribute:
    """An attribute of a complex type."""

    name: str
    type: SimpleType
    required: bool
    default: str | None


@dataclass(slots=True)
class Declaration:
    """An element in a content model, with how often it may stand there."""

    name: str
    type: ComplexType | SimpleType
    default: str | None
    low: int
    high: int
    namespace: str = NAMESPACE

    @property
    def tag(self) -> str:
        """The tag of such an element, as lxml has it."""
        return f"{{{self.namespace}}}{self.name}"


@dataclass(slots=True)
class Group:
    """A sequence or a choice of particles."""

    kind: str
    parts: list[Declaration | Group]
    low: int
    high: int

    def declarations(self) -> list[Declaration]:
        """Every element in the group, in document order of the schema."""
        found: list[Declaration] = []
        for part in self.parts:
            found.extend([part] if isinstance(part, Declaration) else part.declarations())
        return found


@dataclass(slots=True, eq=False)
class ComplexType:
    """A complex type: attributes, and either a content model, a simple value, or anything."""

    name: str
    attributes: dict[str, Attribute] = field(default_factory=dict)
    content: Group | None = None
    value: SimpleType | None = None
    anything: bool = False
    base: ComplexType | None = None
    children: dict[str, Declaration] = field(default_factory=dict)
    _codes: dict[str, str] = field(default_factory=dict)
    _regex: re.Pattern[str] | None = None

    def derives_from(self, other: ComplexType) -> bool:
        """Whether this is `other` or a type derived from it."""
        kind: ComplexType | None = self
        while kind is not None and kind is not other:
            kind = kind.base
        return kind is not None

    def finish(self) -> None:
        """Index the children once the content model is complete."""
        if self.content is not None and not self.children:
            for declaration in self.content.declarations():
                self.children.setdefault(declaration.name, declaration)

    def matches(self, names: list[str]) -> bool:
        """Whether children of these names, in this order, are valid here."""
        if self._regex is None:
            self._codes = {name: chr(0x4E00 + i) for i, name in enumerate(self.children)}
            pattern = "" if self.content is None else _pattern(self.content, self._codes)
            self._regex = re.compile(pattern)
        try:
            text = "".join([self._codes[name] for name in names])
        except KeyError:
            return False
        return self._regex.fullmatch(text) is not None


def _pattern(particle: Declaration | Group, codes: dict[str, str]) -> str:
    if isinstance(particle, Declaration):
        inner = codes[particle.name]
    else:
        joint = "" if particle.kind == "sequence" else "|"
        inner = "(?:" + joint.join(_pattern(part, codes) for part in particle.parts) + ")"
    low, high = particle.low, particle.high
    if (low, high) == (1, 1):
        return inner
    return f"{inner}{{{low},{'' if high >= _UNBOUNDED else high}}}"


class _Reader:
    def __init__(self, path: Path) -> None:
        self.nodes: dict[tuple[str, str], etree._Element] = {}
        self.simple: dict[str, SimpleType] = {}
        self.complex: dict[str, ComplexType] = {}
        self.groups: dict[str, Declaration | Group | None] = {}
        self.pending: dict[ComplexType, etree._Element] = {}
        self._collect(path.resolve(), set())

    def _collect(self, path: Path, seen: set[Path]) -> None:
        if path in seen:
            return
        seen.add(path)
        for node in etree.parse(str(path)).getroot().iterchildren(tag=etree.Element):
            kind = node.tag.removeprefix(_XS)
            if kind == "include":
                self._collect((path.parent / node.get("schemaLocation", "")).resolve(), seen)
            elif name := node.get("name"):
                self.nodes[kind, name] = node

    def type_named(self, name: str) -> ComplexType | SimpleType:
        if ("complexType", name) in self.nodes:
            if name not in self.complex:
                self.complex[name] = self.later(name, self.nodes["complexType", name])
            return self.complex[name]
        return self.simple_named(name)

    def later(self, name: str, node: etree._Element) -> ComplexType:
        """A complex type that is filled in later: types may contain each other."""
        kind = ComplexType(name)
        self.pending[kind] = node
        return kind

    def complete(self) -> None:
        """Fill in every type that was met."""
        while self.pending:
            self._ensure(next(iter(self.pending)))

    def _ensure(self, kind: ComplexType) -> None:
        node = self.pending.pop(kind, None)
        if node is not None:
            self._fill(kind, node)

    def simple_named(self, name: str) -> SimpleType:
        if name not in self.simple:
            if ("simpleType", name) in self.nodes:
                self.simple[name] = self.simple_type(self.nodes["simpleType", name], name)
            else:
                local = name.rpartition(":")[2]
                single = SimpleType("IDREF", primitive="IDREF")
                self.simple[name] = (
                    SimpleType(name, item=single, length=(1, _UNBOUNDED))
                    if local == "IDREFS"
                    else SimpleType(name, primitive=local)
                )
        return self.simple[name]

    def simple_type(self, node: etree._Element, name: str) -> SimpleType:
        child = next(node.iterchildren(tag=etree.Element))
        kind = child.tag.removeprefix(_XS)
        if kind == "list":
            return SimpleType(name, item=self.simple_named(child.get("itemType", "")))
        if kind == "union":
            names = child.get("memberTypes", "").split()
            return SimpleType(name, members=tuple(self.simple_named(part) for part in names))
        base = self.simple_named(child.get("base", ""))
        return self._restrict(name, base, child)

    def _restrict(self, name: str, base: SimpleType, node: etree._Element) -> SimpleType:
        facets: dict[str, list[str]] = {}
        for facet in node.iterchildren(tag=etree.Element):
            facets.setdefault(facet.tag.removeprefix(_XS), []).append(facet.get("value", ""))

        def number(*names: str) -> int | None:
            return next((int(float(facets[name][0])) for name in names if name in facets), None)

        low, high = number("length", "minLength"), number("length", "maxLength")
        least, most = base.bounds
        lower, upper, beyond = number("minInclusive"), number("maxInclusive"), None
        if (beyond := number("maxExclusive")) is not None:
            upper = beyond - 1
        return SimpleType(
            name,
            primitive=base.primitive,
            item=base.item,
            members=base.members,
            enumeration=tuple(facets.get("enumeration", base.enumeration)),
            pattern=facets["pattern"][0] if "pattern" in facets else base.pattern,
            length=base.length if low is None else (low, _UNBOUNDED if high is None else high),
            bounds=(least if lower is None else lower, most if upper is None else upper),
        )

    def _fill(self, target: ComplexType, node: etree._Element) -> None:
        for child in node.iterchildren(tag=etree.Element):
            kind = child.tag.removeprefix(_XS)
            if kind in ("sequence", "choice", "group"):
                particle = self.particle(child)
                if particle is None:
                    target.anything = True
                elif isinstance(particle, Group):
                    target.content = particle
            elif kind == "attribute":
                self._attribute(target, child)
            elif kind in ("simpleContent", "complexContent"):
                self._derive(target, next(child.iterchildren(tag=etree.Element)))
        target.finish()

    def _derive(self, target: ComplexType, node: etree._Element) -> None:
        base = self.type_named(node.get("base", ""))
        if isinstance(base, SimpleType):
            target.value = base
        else:
            self._ensure(base)
            target.base = base
            target.attributes.update(base.attributes)
            target.value = base.value
            if node.tag == _XS + "extension":
                target.content, target.anything = base.content, base.anything
        self._fill(target, node)

    def _attribute(self, target: ComplexType, node: etree._Element) -> None:
        name = node.get("name") or "{http://www.w3.org/XML/1998/namespace}base"
        inline = node.find(_XS + "simpleType")
        kind = (
            self.simple_named(node.get("type", "xs:anyURI"))
            if inline is None
            else self.simple_type(inline, name)
        )
        required = node.get("use") == "required"
        target.attributes[name] = Attribute(name, kind, required, node.get("default"))

    def particle(self, node: etree._Element) -> Declaration | Group | None:
        """The particle of a schema node; None where it is a wildcard."""
        low = int(node.get("minOccurs", "1"))
        limit = node.get("maxOccurs", "1")
        high = _UNBOUNDED if limit == "unbounded" else int(limit)
        kind = node.tag.removeprefix(_XS)
        if kind == "any":
            return None
        if kind == "element":
            return self.declaration(node, low, high)
        if kind == "group":
            name = node.get("ref", "")
            if name not in self.groups:
                body = next(self.nodes["group", name].iterchildren(tag=etree.Element))
                self.groups[name] = self.particle(body)
            shared = self.groups[name]
            return None if shared is None else Group("sequence", [shared], low, high)
        parts = [self.particle(child) for child in node.iterchildren(tag=etree.Element)]
        known = [part for part in parts if part is not None]
        return Group(kind, known, low, high) if known or not parts else None

    def declaration(self, node: etree._Element, low: int = 1, high: int = 1) -> Declaration:
        """The declaration that an xs:element makes."""
        name = node.get("name") or node.get("ref", "").rpartition(":")[2]
        complex_node, simple_node = node.find(_XS + "complexType"), node.find(_XS + "simpleType")
        kind: ComplexType | SimpleType
        if complex_node is not None:
            kind = self.later(f"{name} (local)", complex_node)
        elif simple_node is not None:
            kind = self.simple_type(simple_node, f"{name} (local)")
        elif node.get("ref") is not None:
            kind = ComplexType(name, anything=True)
        else:
            kind = self.type_named(node.get("type", "xs:string"))
        prefix, _, _ = node.get("ref", "").rpartition(":")
        namespace = node.nsmap[prefix] if prefix else NAMESPACE
        return Declaration(name, kind, node.get("default"), low, high, namespace)


@cache
def grammar() -> dict[str, ComplexType]:
    """The named complex types of COLLADA 1.5, by name."""
    reader = _Reader(schema_folder() / "collada-1.5" / "collada.xsd")
    for kind, name in list(reader.nodes):
        if kind == "complexType":
            reader.type_named(name)
    body = next(reader.nodes["element", "COLLADA"].iterchildren(tag=etree.Element))
    root = reader.later("COLLADA", body)
    reader.complete()
    return {**reader.complex, "COLLADA": root}


@cache
def all_types() -> tuple[ComplexType, ...]:
    """Every complex type of COLLADA 1.5, those without names too."""
    found = dict.fromkeys(grammar().values())
    waiting = list(found)
    while waiting:
        for child in waiting.pop().children.values():
            if isinstance(child.type, ComplexType) and child.type not in found:
                found[child.type] = None
                waiting.append(child.type)
    return tuple(found)


def stated_type(
    element: etree._Element, declared: ComplexType | SimpleType
) -> ComplexType | SimpleType | None:
    """The type of an element: the declared one, or one derived from it that its xsi:type names.

    None where xsi:type names something else.
    """
    name = element.get(XSI + "type")
    if name is None:
        return declared
    prefix, _, local_name = name.strip().rpartition(":")
    if element.nsmap.get(prefix or None) != NAMESPACE:
        return None
    if isinstance(declared, SimpleType):
        return declared if declared.name == local_name else None
    kind = grammar().get(local_name)
    return kind if kind is not None and kind.derives_from(declared) else None


@cache
def root_declaration() -> Declaration:
    """The declaration of the document element."""
    return Declaration("COLLADA", grammar()["COLLADA"], None, 1, 1)


def required(part: Declaration | Group) -> set[str]:
    """The names that a part cannot be without."""
    if not part.low:
        return set()
    if isinstance(part, Declaration):
        return {part.name}
    if part.kind == "choice":
        return required(part.parts[0]) if len(part.parts) == 1 else set()
    return {name for inner in part.parts for name in required(inner)}

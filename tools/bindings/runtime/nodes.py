"""Content that no schema describes: kept node by node, so that nothing of it is lost.

A wildcard's content is a list of `AnyElement`, `Comment`, `ProcessingInstruction`, str (text) and
of dataclasses for the global elements that the schemas do describe (the pe profile's).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from lxml.etree import _Comment, _Element, _ProcessingInstruction

from colladaphy_schema.errors import CodecError, reject
from colladaphy_schema.lexical import attribute_escaped, text_escaped

XML_NAMESPACE = "http://www.w3.org/XML/1998/namespace"
Scope = dict[str | None, str]


@dataclass(slots=True, kw_only=True)
class Comment:
    """A comment and the text after it."""

    text: str = ""
    tail: str | None = None


@dataclass(slots=True, kw_only=True)
class ProcessingInstruction:
    """A processing instruction and the text after it."""

    target: str
    text: str | None = None
    tail: str | None = None


@dataclass(slots=True, kw_only=True)
class AnyElement:
    """An element that no schema describes.

    `qname` and the keys of `attributes` are in Clark notation. `namespaces` holds the prefixes
    that this element has to declare beside its own: those declared on it and, for the outermost
    element, those in scope that it uses. Text, tail and children are kept as they were written.
    Prefixes take no part in comparison: they are spelling.
    """

    qname: str
    prefix: str | None = field(default=None, compare=False)
    attributes: dict[str, str] = field(default_factory=dict)
    namespaces: Scope = field(default_factory=dict, compare=False)
    text: str | None = None
    children: list[AnyElement | Comment | ProcessingInstruction] = field(default_factory=list)
    tail: str | None = None


Node = AnyElement | Comment | ProcessingInstruction


def read_node(element: _Element, outer: Scope | None = None, *, tail: bool = True) -> Node:
    """An lxml node as a generic node; `outer` is the scope of its parent, None at the top."""
    after = element.tail if tail else None
    if isinstance(element, _Comment):
        return Comment(text=element.text or "", tail=after)
    if isinstance(element, _ProcessingInstruction):
        target, text = element.target or "", element.text or None
        return ProcessingInstruction(target=target, text=text, tail=after)
    if not isinstance(element.tag, str):
        reject(element, "an entity reference cannot be kept")
    scope: Scope = dict(element.nsmap)
    if outer is None:
        namespaces = _used(element, scope)
    else:
        namespaces = {
            prefix: uri
            for prefix, uri in scope.items()
            if prefix is not None and prefix != element.prefix and outer.get(prefix) != uri
        }
    return AnyElement(
        qname=element.tag,
        prefix=element.prefix,
        attributes=dict(element.attrib),
        namespaces=namespaces,
        text=element.text,
        children=[read_node(child, scope) for child in element],
        tail=after,
    )


def _used(element: _Element, scope: Scope) -> Scope:
    """The prefixes in scope that names in the element use, or that its texts seem to use."""
    used: set[str | None] = set()
    texts: list[str] = []
    attributed: set[str] = set()
    for node in element.iter():
        if not isinstance(node.tag, str):
            continue
        used.add(node.prefix)
        texts.extend(value for value in (node.text, node.tail) if value)
        for name, value in node.items():
            texts.append(value)
            if name[0] == "{":
                attributed.add(name[1:].partition("}")[0])
    content = "\n".join(texts)
    return {
        prefix: uri
        for prefix, uri in scope.items()
        if prefix is not None
        and prefix != element.prefix
        and (prefix in used or uri in attributed or f"{prefix}:" in content)
    }


def write_node(node: Node, write: list[str], scope: Scope) -> None:
    """Append a generic node as XML text; `scope` is what is already declared around it."""
    if isinstance(node, Comment):
        if "--" in node.text or node.text.endswith("-"):
            raise CodecError("a comment cannot hold --, nor end in -")
        write.append(f"<!--{node.text}-->")
    elif isinstance(node, ProcessingInstruction):
        if "?>" in (node.text or ""):
            raise CodecError("a processing instruction cannot hold ?>")
        write.append(f"<?{node.target} {node.text}?>" if node.text else f"<?{node.target}?>")
    else:
        _write_element(node, write, scope)
    if node.tail:
        write.append(text_escaped(node.tail))


def _write_element(node: AnyElement, write: list[str], scope: Scope) -> None:
    declared = {p: uri for p, uri in node.namespaces.items() if scope.get(p, "") != uri}
    inner = {**scope, **declared}
    uri, local = _split(node.qname)
    prefix = node.prefix
    if inner.get(prefix, "") != uri:
        declared[prefix] = inner[prefix] = uri
    attributes = []
    for name, value in node.attributes.items():
        shown = attribute_name(name, inner, declared)
        attributes.append(f' {shown}="{attribute_escaped(value)}"')
    tag = f"{prefix}:{local}" if prefix else local
    write.append(f"<{tag}")
    for name, space in declared.items():
        write.append(f' {f"xmlns:{name}" if name else "xmlns"}="{attribute_escaped(space)}"')
    write.extend(attributes)
    if not node.children and not node.text:
        write.append("/>")
        return
    write.append(f">{text_escaped(node.text or '')}")
    for child in node.children:
        write_node(child, write, inner)
    write.append(f"</{tag}>")


def _split(qname: str) -> tuple[str, str]:
    if qname[:1] != "{":
        return "", qname
    uri, _, local = qname[1:].partition("}")
    return uri, local


def attribute_name(qname: str, inner: Scope, declared: Scope) -> str:
    """An attribute's name with its prefix; adds to `inner` and `declared` where it has none."""
    uri, local = _split(qname)
    return f"{_prefix(uri, inner, declared)}:{local}" if uri else local


def _prefix(uri: str, inner: Scope, declared: Scope) -> str:
    """A prefix for an attribute's namespace: one in scope, or a new declaration."""
    if uri == XML_NAMESPACE:
        return "xml"
    for prefix, bound in inner.items():
        if prefix and bound == uri:
            return prefix
    number = 0
    while f"ns{number}" in inner:
        number += 1
    inner[f"ns{number}"] = declared[f"ns{number}"] = uri
    return f"ns{number}"

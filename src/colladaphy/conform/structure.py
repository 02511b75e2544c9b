"""Repairs of the document's frame: libraries, wrappers, misspelt names, what stands elsewhere."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator
from functools import cache

from lxml import etree

from colladaphy.conform import structure_rules
from colladaphy.conform.context import NS, Context, append, insert, local, remove, rename
from colladaphy.conform.grammar import ComplexType, grammar, root_declaration, stated_type

__all__ = [
    "correct_names",
    "drop_empty_bindings",
    "drop_empty_libraries",
    "give_geometries_content",
    "homes_of_strays",
    "house_strays",
    "meant_name",
    "typed_elements",
    "wrap_children",
]

_WRAPPERS = ("technique_common", "contributor", "optics", "limits")
_DIGITS = re.compile(r"[\d_x]+")
_WHOLE_WORDS = {"translation": "translate", "rotation": "rotate", "colour": "color"}


def typed_elements(root: etree._Element) -> Iterator[tuple[etree._Element, ComplexType]]:
    """Every element that the schema knows where it stands, with its complex type, in order."""
    kind = root_declaration().type
    assert isinstance(kind, ComplexType)
    stack = [(root, kind)]
    while stack:
        element, kind = stack.pop()
        yield element, kind
        below = []
        for child in element.iterchildren(tag=etree.Element):
            known = kind.children.get(local(child))
            if known is None:
                continue
            kind_below = stated_type(child, known.type) or known.type
            if isinstance(kind_below, ComplexType):
                below.append((child, kind_below))
        stack.extend(reversed(below))


def correct_names(context: Context) -> None:
    """Elements whose name is nearly right get the right one, where that is free to take."""
    for element, kind in typed_elements(context.root):
        if kind.anything or kind.content is None:
            continue
        present: set[str] | None = None
        for child in element.iterchildren(tag=etree.Element):
            name = local(child)
            if name in kind.children or not child.tag.startswith(NS):
                continue
            if present is None:
                present = {local(other) for other in element}
            right = meant_name(name, kind, present)
            if right is not None and context.wants(structure_rules.MISSPELT):
                context.note(
                    structure_rules.MISSPELT, child, f"<{name}> is misspelt; is now <{right}>"
                )
                rename(child, right)


def meant_name(name: str, kind: ComplexType, present: set[str]) -> str | None:
    """The name of a child that a misspelt one stands for, where that is free to take."""
    right = _WHOLE_WORDS.get(name)
    if right in kind.children:
        return right
    single = {
        known
        for known, declaration in kind.children.items()
        if declaration.high == 1 and known in present
    }
    candidates = [known for known in kind.children if known not in single]
    for known in candidates:
        if known.lower() == name.lower() or known == name + "s":
            return known
    if len(name) < 4:
        return None
    close = [
        known
        for known in difflib.get_close_matches(name, candidates, n=3, cutoff=0.85)
        if known[0] == name[0] and _DIGITS.findall(known) == _DIGITS.findall(name)
    ]
    return close[0] if close else None


def wrap_children(context: Context) -> None:
    """Children move into the wrapper they belong to (technique_common, contributor), or out."""
    for element, kind in typed_elements(context.root):
        if kind.anything or kind.content is None:
            continue
        for name in _WRAPPERS:
            wrapper = kind.children.get(name)
            if wrapper is None or not isinstance(wrapper.type, ComplexType):
                continue
            inside = wrapper.type.children
            down = [
                child
                for child in element.iterchildren(tag=etree.Element)
                if local(child) in inside and local(child) not in kind.children
            ]
            if down and context.wants(structure_rules.WRAPPED):
                _move_down(context, element, name, down)
            _move_up(context, element, name, kind, wrapper.type)


def _move_down(
    context: Context, element: etree._Element, name: str, down: list[etree._Element]
) -> None:
    target = element.find(NS + name)
    if target is None:
        target = context.make(name)
        insert(element, 0 if name == "contributor" else element.index(down[0]), target)
    for child in down:
        message = f"<{local(child)}> stood in <{local(element)}>; moved into its <{name}>"
        context.note(structure_rules.WRAPPED, child, message)
        remove(child)
        append(target, child)


def _move_up(
    context: Context, element: etree._Element, name: str, outer: ComplexType, inner: ComplexType
) -> None:
    for wrapper in element.iterchildren(NS + name):
        for child in list(wrapper.iterchildren(tag=etree.Element)):
            kind = local(child)
            if kind in inner.children or kind not in outer.children or kind == name:
                continue
            if context.wants(structure_rules.WRAPPED):
                message = f"<{kind}> stood in <{name}>; moved out into <{local(element)}>"
                context.note(structure_rules.WRAPPED, child, message)
                remove(child)
                append(element, child)


@cache
def homes_of_strays() -> dict[str, str]:
    """The libraries that elements belong in, by the names of these elements."""
    return {
        declaration.name: name
        for name, library in grammar()["COLLADA"].children.items()
        if isinstance(library.type, ComplexType) and name.startswith("library_")
        for declaration in library.type.children.values()
        if declaration.name not in ("asset", "extra")
    }


def house_strays(context: Context) -> None:
    """What lies in the document itself but belongs in a library is put there."""
    libraries, homes = grammar()["COLLADA"].children, homes_of_strays()
    for child in list(context.root.iterchildren(tag=etree.Element)):
        name = local(child)
        if name in libraries or name not in homes or not context.wants(structure_rules.STRAY):
            continue
        library = context.library(homes[name].removeprefix("library_"))
        message = f"<{name}> stood outside of a library; moved into <{local(library)}>"
        context.note(structure_rules.STRAY, child, message)
        remove(child)
        append(library, child)


def drop_empty_libraries(context: Context) -> None:
    """Libraries without anything in them are not allowed; comments in them move up."""
    for library in list(context.root.iterchildren(tag=etree.Element)):
        name = local(library)
        if not name.startswith("library_") or name not in grammar()["COLLADA"].children:
            continue
        if next(library.iterchildren(tag=etree.Element), None) is not None:
            continue
        text = (library.text or "") + "".join(child.tail or "" for child in library)
        if text.strip() or not context.wants(structure_rules.EMPTY_LIBRARY):
            continue
        context.note(structure_rules.EMPTY_LIBRARY, library, f"<{name}> was empty; removed")
        for name_, value in library.attrib.items():
            context.keep(context.root, "attribute", of=name, name=str(name_), value=str(value))
        for comment in list(library):
            library.addprevious(comment)
        remove(library)


def drop_empty_bindings(context: Context) -> None:
    """A bind_material that binds nothing is not allowed, and says nothing."""
    for binding in context.all("bind_material"):
        bound = any(local(child) not in ("technique_common", "") for child in binding)
        common = binding.find(NS + "technique_common")
        if bound or (common is not None and len(common)) or binding.attrib:
            continue
        if context.wants(structure_rules.EMPTY_BINDING):
            context.note(
                structure_rules.EMPTY_BINDING, binding, "<bind_material> bound nothing; removed"
            )
            remove(binding)


def give_geometries_content(context: Context) -> None:
    """A geometry without any content gets an empty convex mesh: references to it stay whole."""
    known = grammar()["geometry_type"].children
    for geometry in context.all("geometry"):
        if any(
            local(child) in known and local(child) not in ("asset", "extra") for child in geometry
        ):
            continue
        if not context.wants(structure_rules.EMPTY_GEOMETRY):
            continue
        message = "<geometry> held no mesh; an empty <convex_mesh> was added"
        context.note(structure_rules.EMPTY_GEOMETRY, geometry, message)
        first = next((i for i, c in enumerate(geometry) if local(c) == "extra"), len(geometry))
        insert(geometry, first, context.make("convex_mesh"))

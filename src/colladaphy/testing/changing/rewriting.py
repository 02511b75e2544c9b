"""Changes that leave the meaning of a document as it is."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from random import Random

from hypothesis import strategies as st
from lxml import etree

from colladaphy.testing.changing.elements import NUMERIC, C, child, common, free_id, local, make
from colladaphy.testing.changing.spelling import respelled, spellings

__all__ = ["REWRITES", "Change", "Element", "of", "whole"]

PE = "{urn:colladaphy:pe:1}"
Element = etree._Element
Places = Callable[[Element], list[Element]]
Change = tuple[Places, Callable[[st.DrawFn, Element], None]]
"""Where a change can be made, and how it is made there."""

_WITH_EXTRA = (
    "box", "capsule", "cylinder", "geometry", "instance_physics_model", "instance_rigid_body",
    "node", "physics_material", "physics_model", "physics_scene", "rigid_body",
    "rigid_constraint", "shape", "sphere", "visual_scene", "COLLADA",
)  # fmt: skip
_WITH_TECHNIQUE = (
    "instance_rigid_body", "physics_material", "physics_scene", "rigid_body", "rigid_constraint",
)  # fmt: skip
_REFERRING = (
    "url", "target", "source", "parent", "convex_hull_of", "rigid_body", "constraint", "body",
    "joint", "axis", "link", "node",
)  # fmt: skip
_comments = st.sampled_from([" a note ", "", "<mass>7</mass>", " 1 2 3 "])
_foreign = st.sampled_from(
    [
        "<colour>red</colour>",
        '<node id="n0"><translate>9 9 9</translate></node>',
        '<x:contact xmlns:x="urn:example:x" mu="0.75"/>',
        "<note>some text &amp; more</note>",
    ]
)


def of(*names: str) -> Places:
    """Elements of some names."""
    return lambda root: common(root, *names)


def _technique(draw: st.DrawFn) -> Element:
    """A technique of a profile that nobody knows."""
    made = f'<technique xmlns="{C[1:-1]}" profile="other">{draw(_foreign)}</technique>'
    return etree.fromstring(made)


def _numeric(root: Element) -> list[Element]:
    """Elements that hold numbers and nothing else."""
    return [element for element in common(root, *NUMERIC) if element.text and not len(element)]


def _comment(draw: st.DrawFn, element: Element) -> None:
    element.addprevious(etree.Comment(draw(_comments)))


def _instruct(draw: st.DrawFn, element: Element) -> None:
    element.addprevious(etree.ProcessingInstruction("editor", "fold"))


def _comment_within(draw: st.DrawFn, element: Element) -> None:
    """A comment before a number, in the same element."""
    note = etree.Comment(draw(_comments))
    note.tail, element.text = element.text, None
    element.append(note)


def _extra(draw: st.DrawFn, element: Element) -> None:
    extra = make("extra", type="note")
    extra.append(_technique(draw))
    element.append(extra)


def _foreign_technique(draw: st.DrawFn, element: Element) -> None:
    common_technique = child(element, "technique_common")
    if common_technique is not None:
        common_technique.addnext(_technique(draw))


def _spell(draw: st.DrawFn, root: Element) -> None:
    style = draw(spellings)
    for element in common(root, *NUMERIC):
        if element.text and not len(element):
            element.text = respelled(element.text, style)


def _flags(draw: st.DrawFn, element: Element) -> None:
    truth = (element.text or "").strip() in ("true", "1")
    element.text = draw(st.sampled_from(["1", " true\n"] if truth else ["0", " false\n"]))


def _reorder(draw: st.DrawFn, root: Element) -> None:
    """Libraries in another order: a document has them in any."""
    libraries = [each for each in root if _is_library(each)]
    if len(libraries) > 1:
        place = root.index(libraries[0])
        for each in libraries:
            root.remove(each)
        for offset, each in enumerate(draw(st.permutations(libraries))):
            root.insert(place + offset, each)


def _is_library(element: Element) -> bool:
    return isinstance(element.tag, str) and local(element).startswith("library_")


def _libraries_of_several(root: Element) -> list[Element]:
    return [
        each
        for each in root
        if _is_library(each) and sum(isinstance(part.tag, str) for part in each) > 1
    ]


def _split(draw: st.DrawFn, library: Element) -> None:
    """Two libraries of a kind, of which the second has the last element of the first."""
    second = make(local(library))
    last = [part for part in library if isinstance(part.tag, str)][-1]
    if last.tag != f"{C}extra":
        library.addnext(second)
        second.append(last)


def _rename(draw: st.DrawFn, root: Element) -> None:
    """Other ids, in everything that refers to them; the pe profile does, too."""
    known = [each.get("id", "") for each in root.iter(f"{C}*") if each.get("id")]
    known = [id for id in known if not _NUMBER.fullmatch(id)]
    if len(known) != len(set(known)):
        return
    random = Random(draw(st.integers(0, 2**16)))
    fresh = [f"id-{number}" for number in range(len(known))]
    random.shuffle(fresh)
    renamed = dict(zip(known, fresh, strict=True))
    for element in root.iter(f"{C}*", f"{PE}*"):
        if element.tag.startswith(C) and not _is_own(element):
            continue
        names = _REFERRING if element.tag.startswith(C) else element.attrib
        if element.get("id") in renamed:
            element.set("id", renamed[element.get("id", "")])
        for name in map(str, names):
            if value := element.get(name):
                element.set(name, _readdressed(value, renamed, alone=name == "node"))
        if element.tag == f"{C}SIDREF" and element.text:
            element.text = _readdressed(element.text.strip(), renamed, alone=True)


def _readdressed(text: str, renamed: dict[str, str], *, alone: bool) -> str:
    """The same reference after ids were renamed: `#id`, `id/sid`, or an id `alone`."""
    first, slash, rest = text.removeprefix("#").partition("/")
    if not slash and text == first and not alone:
        return text  # a scoped id
    sign = "#" if text.startswith("#") else ""
    return f"{sign}{renamed.get(first, first)}{slash}{rest}"


_NUMBER = re.compile(r"Material\d+")
"""Ids that say the number of a material in its World."""


def _is_own(element: Element) -> bool:
    """Whether an element is one of COLLADA itself, not within what a profile holds."""
    return not any(above.tag == f"{C}technique" for above in element.iterancestors())


def _placed_nodes(root: Element) -> list[Element]:
    """Nodes that stand where they are; those of a library stand where they are instanced."""
    return [node for node in common(root, "node") if local(_parent(node)) != "library_nodes"]


def _parent(element: Element) -> Element:
    parent = element.getparent()
    assert parent is not None
    return parent


def _wrap(draw: st.DrawFn, node: Element) -> None:
    """A node within a node that moves nothing."""
    outer = make("node")
    node.addprevious(outer)
    outer.append(node)


def _still(draw: st.DrawFn, node: Element) -> None:
    """A transform that moves nothing, before the others."""
    form = draw(st.sampled_from([("translate", "0 0 0"), ("rotate", "0 0 1 0")]))
    place = 1 if len(node) and node[0].tag == f"{C}asset" else 0
    node.insert(place, make(form[0], form[1]))


def _name(draw: st.DrawFn, element: Element) -> None:
    """A name, which nothing refers to."""
    if element.get("name") is None:
        element.set("name", draw(st.sampled_from(["a name", "", "ü/#"])))


def _unused(draw: st.DrawFn, root: Element) -> None:
    """A model that nothing instances."""
    for library in common(root, "library_physics_models")[:1]:
        model = library.find(f"{C}physics_model")
        if model is not None:
            again = copy.deepcopy(model)
            for element in again.iter(f"{C}*"):
                if element.get("id") is not None:
                    element.set("id", free_id(root, element.get("id", "")))
            model.addnext(again)


def whole(root: Element) -> list[Element]:
    """The document as a whole."""
    return [root]


REWRITES: dict[str, Change] = {
    "comments": (of(*NUMERIC, "rigid_body", "shape", "node", "instance_rigid_body"), _comment),
    "extras": (of(*_WITH_EXTRA), _extra),
    "techniques": (of(*_WITH_TECHNIQUE), _foreign_technique),
    "instructions": (of("rigid_body", "shape", "node", "mass"), _instruct),
    "comments-within": (_numeric, _comment_within),
    "numbers": (whole, _spell),
    "flags": (of("dynamic", "enabled", "interpenetrate", "hollow"), _flags),
    "libraries-reordered": (whole, _reorder),
    "libraries-split": (_libraries_of_several, _split),
    "ids": (whole, _rename),
    "nodes-wrapped": (_placed_nodes, _wrap),
    "transforms-still": (of("node"), _still),
    "names": (of("node", "physics_model", "physics_scene", "geometry"), _name),
    "models-unused": (whole, _unused),
}
"""Changes by name; after each a document means what it meant before."""

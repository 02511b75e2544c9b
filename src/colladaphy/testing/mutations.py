"""Documents a few changes away from valid ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache

from hypothesis import strategies as st
from lxml import etree

from colladaphy.conform.grammar import NAMESPACE
from colladaphy.testing.building import XSI
from colladaphy.testing.coverage import components
from colladaphy.testing.documents import documents

__all__ = ["MUTATIONS", "mutants"]

Mutation = Callable[[st.DrawFn, etree._Element], None]

TEXTS = [
    *["", " ", "a", "-1", "0", "1", "1.5", "1 2", "1 2 3", "1 2 3 4", "true", "TRUE", "a b"],
    *["inf", "INF", "-INF", "nan", "NaN", "1e400", "0x1F", "1_0", "1,5", "-0", "9" * 20],
    *["#", "#a", "a/b", "a:b", "1.5.0", "1.4.1", "Z_UP", "2001-02-30T00:00:00"],
    *["2001-01-01T24:00:00Z", "\u0661", "\u00a01", "\u00e9"],
]
"""Values that are valid for some types, or look as if they were."""


def mutants(
    *, areas: Iterable[str] | None = None, size: int = 40, changes: int = 3
) -> st.SearchStrategy[bytes]:
    """Well-formed documents one to `changes` mutations away from valid ones; most are invalid.

    `areas` and `size` are those of `documents`. MUTATIONS lists the kinds of change.
    """
    valid = documents(areas=areas, size=size)
    kinds = st.lists(st.sampled_from(sorted(MUTATIONS)), min_size=1, max_size=changes)

    @st.composite
    def mutant(draw: st.DrawFn) -> bytes:
        root = etree.fromstring(draw(valid))
        for kind in draw(kinds):
            MUTATIONS[kind](draw, root)
        return etree.tostring(root, encoding="utf-8", xml_declaration=True)

    return mutant()


@cache
def _names() -> tuple[list[str], list[str]]:
    """The element and attribute names of the schema."""
    names = {component.name for component in components().values()}
    attributes = sorted(name.removeprefix("@") for name in names if name.startswith("@"))
    return sorted(names - {f"@{name}" for name in attributes}), attributes


def _any_element(draw: st.DrawFn, root: etree._Element) -> etree._Element:
    return draw(st.sampled_from(list(root.iter(etree.Element))))


def _any_child(draw: st.DrawFn, root: etree._Element) -> etree._Element | None:
    """An element other than the root, if there is one."""
    others = list(root.iterdescendants(etree.Element))
    return draw(st.sampled_from(others)) if others else None


def _any_holder(draw: st.DrawFn, root: etree._Element) -> etree._Element | None:
    """An element that has attributes, if there is one."""
    holders = [node for node in root.iter(etree.Element) if node.attrib]
    return draw(st.sampled_from(holders)) if holders else None


def _known_tag(draw: st.DrawFn) -> str:
    return f"{{{NAMESPACE}}}{draw(st.sampled_from(_names()[0]))}"


def _detach(element: etree._Element) -> etree._Element:
    parent = element.getparent()
    assert parent is not None
    element.tail = None
    parent.remove(element)
    return element


def drop_element(draw: st.DrawFn, root: etree._Element) -> None:
    if (element := _any_child(draw, root)) is not None:
        _detach(element)


def repeat_element(draw: st.DrawFn, root: etree._Element) -> None:
    if (element := _any_child(draw, root)) is not None:
        copy = etree.fromstring(etree.tostring(element, with_tail=False, encoding="UTF-8"))
        element.addnext(copy)


def move_element(draw: st.DrawFn, root: etree._Element) -> None:
    """To another place among its siblings."""
    if (element := _any_child(draw, root)) is not None:
        parent = element.getparent()
        assert parent is not None
        _detach(element)
        parent.insert(draw(st.integers(0, len(parent))), element)


def rename_element(draw: st.DrawFn, root: etree._Element) -> None:
    siblings = {child.tag for child in root.iterdescendants(etree.Element)}
    names = st.sampled_from(sorted(siblings)) if siblings else st.just(root.tag)
    _any_element(draw, root).tag = draw(names) if draw(st.booleans()) else _known_tag(draw)


def move_into_another_namespace(draw: st.DrawFn, root: etree._Element) -> None:
    element = _any_element(draw, root)
    namespace = draw(st.sampled_from(["", "urn:example:foreign", NAMESPACE + "/"]))
    local = etree.QName(element).localname
    element.tag = f"{{{namespace}}}{local}" if namespace else local


def insert_element(draw: st.DrawFn, root: etree._Element) -> None:
    parent = _any_element(draw, root)
    new = etree.Element(draw(st.sampled_from(["plain", "{urn:example:foreign}thing"])))
    if draw(st.booleans()):
        new.tag = _known_tag(draw)
    parent.insert(draw(st.integers(0, len(parent))), new)


def empty_element(draw: st.DrawFn, root: etree._Element) -> None:
    element = _any_element(draw, root)
    for child in list(element):
        element.remove(child)
    element.text = None


def change_text(draw: st.DrawFn, root: etree._Element) -> None:
    """Text in a place for text, or between elements."""
    _any_element(draw, root).text = draw(st.sampled_from(TEXTS))


def change_list_length(draw: st.DrawFn, root: etree._Element) -> None:
    lists = [node for node in root.iter(etree.Element) if len((node.text or "").split()) > 1]
    if lists:
        element = draw(st.sampled_from(lists))
        words = (element.text or "").split()
        element.text = " ".join(draw(st.sampled_from([words[1:], [*words, words[0]]])))


def drop_attribute(draw: st.DrawFn, root: etree._Element) -> None:
    if (element := _any_holder(draw, root)) is not None:
        del element.attrib[draw(st.sampled_from(sorted(element.attrib)))]


def change_attribute(draw: st.DrawFn, root: etree._Element) -> None:
    if (element := _any_holder(draw, root)) is not None:
        element.set(draw(st.sampled_from(sorted(element.attrib))), draw(st.sampled_from(TEXTS)))


def add_attribute(draw: st.DrawFn, root: etree._Element) -> None:
    others = ["nonsense", "{urn:example:foreign}a", f"{{{NAMESPACE}}}name", f"{{{XSI}}}nil"]
    name = draw(st.sampled_from(others) | st.sampled_from(_names()[1]))
    _any_element(draw, root).set(name, draw(st.sampled_from(TEXTS)))


def repeat_id(draw: st.DrawFn, root: etree._Element) -> None:
    holders = [node for node in root.iter(etree.Element) if "id" in node.attrib]
    if holders:
        copied = draw(st.sampled_from(holders)).attrib["id"]
        draw(st.sampled_from(holders)).set("id", copied)


def claim_a_type(draw: st.DrawFn, root: etree._Element) -> None:
    """An ``xsi:type``, seldom a derived one."""
    types = ["translate_type", "targetable_float3_type", "instance_image_type", "no_type", "xs:int"]
    _any_element(draw, root).set(f"{{{XSI}}}type", draw(st.sampled_from(types)))


MUTATIONS: dict[str, Mutation] = {
    mutation.__name__: mutation
    for mutation in (
        add_attribute,
        change_attribute,
        change_list_length,
        change_text,
        claim_a_type,
        drop_attribute,
        drop_element,
        empty_element,
        insert_element,
        move_element,
        move_into_another_namespace,
        rename_element,
        repeat_element,
        repeat_id,
    )
}
"""The kinds of change, by name: each takes hypothesis's draw and the root, and edits the tree."""

"""Every child that is wrong where it stands, and what would be right there, in plain words.

libxml2 stops at the first child of an element that its content model does not allow. What is
wrong with the others, and whether a child is misplaced, one too many or unknown, is told here from
the content models themselves.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterator
from functools import cache
from typing import NamedTuple

from lxml import etree

from colladaphy.conform.arrangement import arrange
from colladaphy.conform.context import NS, local
from colladaphy.conform.grammar import ComplexType, grammar, root_declaration, stated_type
from colladaphy.conform.structure import homes_of_strays, meant_name
from colladaphy.findings import Rule
from colladaphy.gate.rules import MISSING_ELEMENT, UNEXPECTED_ELEMENT

__all__ = ["Deviation", "deviations"]

_MOST = 8


class Deviation(NamedTuple):
    """One child too many, too few or in the wrong place."""

    rule: Rule
    element: etree._Element
    parent: etree._Element
    message: str
    related: etree._Element | None = None


def deviations(root: etree._Element, blamed: Collection[etree._Element]) -> Iterator[Deviation]:
    """What is wrong with the children of elements, parents first.

    `blamed` are the elements that libxml2 complains about: where several explanations are as
    good, the one that has a finding there is taken. Content of techniques is left out.
    """
    blamed = set(blamed)
    declaration = root_declaration()
    assert isinstance(declaration.type, ComplexType)
    stack = [(root, declaration.type)]
    while stack:
        element, kind = stack.pop()
        if kind.anything or kind.value is not None or kind.content is None:
            continue  # libxml2 says all that there is to say
        children = list(element.iterchildren(etree.Element))
        yield from _of_children(element, kind, children, blamed)
        below = []
        for child in children:
            known = kind.children.get(local(child))
            if known is None or child.tag != known.tag:
                continue
            stated = stated_type(child, known.type) or known.type
            if isinstance(stated, ComplexType):
                below.append((child, stated))
        stack.extend(reversed(below))


def _of_children(
    parent: etree._Element,
    kind: ComplexType,
    children: list[etree._Element],
    blamed: set[etree._Element],
) -> Iterator[Deviation]:
    names: dict[etree._Element, str] = {}
    strangers = 0
    present = {local(child) for child in children}
    for child in children:
        declared = kind.children.get(local(child))
        if declared is not None and child.tag == declared.tag:
            names[child] = local(child)
            continue
        right = meant_name(local(child), kind, present) if child.tag.startswith(NS) else None
        yield _unknown(parent, kind, child, right)
        if right is None:
            strangers += 1
        else:
            names[child] = right
    known = list(names)
    assert kind.content is not None
    if kind.matches(list(names.values())):
        return
    found = arrange(kind.content, names)
    if not found.missing and not kind.matches([names[child] for child in found.order]):
        return  # only libxml2 can tell what is wrong here
    surplus = set(found.surplus)
    for child in found.surplus:
        yield _surplus(parent, kind, child, known)
    ranks = {child: rank for rank, child in enumerate(found.order)}
    kept = [child for child in known if child not in surplus]
    accused = next((child for child in kept if child in blamed), None)
    told = False
    for child, message, other in _misplaced(kept, ranks, found.order, accused):
        told = told or child is accused
        yield Deviation(UNEXPECTED_ELEMENT, child, parent, message, other)
    # What stands in the place of something else is wrong once.
    for place, name in enumerate(found.missing[strangers:]):
        at = parent if told or place or accused is None else accused
        message = f"<{local(parent)}> lacks {name}"
        message += "." if at is parent else f", which belongs before <{local(at)}>."
        yield Deviation(MISSING_ELEMENT, at, parent, message)


def _unknown(
    parent: etree._Element, kind: ComplexType, child: etree._Element, right: str | None
) -> Deviation:
    name, above = local(child), local(parent)
    if not str(child.tag).startswith(NS):
        namespace = str(child.tag)[1:].rpartition("}")[0] if "}" in str(child.tag) else ""
        whose = f"is of the namespace {namespace!r}" if namespace else "is of no namespace"
        message = f"<{name}> {whose}, whose elements may stand in a <technique> only."
        return Deviation(UNEXPECTED_ELEMENT, child, parent, message)
    wrapper = next(
        (
            inner.name
            for inner in kind.children.values()
            if isinstance(inner.type, ComplexType)
            and inner.name in ("technique_common", "contributor", "optics", "limits")
            and name in inner.type.children
        ),
        None,
    )
    library = homes_of_strays().get(name) if above == "COLLADA" else None
    if right is not None:
        message = f"There is no <{name}> in <{above}>; did you mean <{right}>?"
    elif wrapper is not None:
        message = f"<{name}> may not stand in <{above}> itself; it belongs in its <{wrapper}>."
    elif library is not None:
        message = f"<{name}> may not stand in <{above}> itself; it belongs in <{library}>."
    else:
        where = _parents().get(name)
        homes = sorted(where) if where else []
        elsewhere = f"it belongs in {_list(homes, 'or')}" if homes else "COLLADA has none"
        allowed = _list(list(kind.children), "or") if kind.children else "no elements"
        message = f"<{name}> may not stand in <{above}>: {elsewhere}. Allowed here: {allowed}."
    return Deviation(UNEXPECTED_ELEMENT, child, parent, message)


def _surplus(
    parent: etree._Element,
    kind: ComplexType,
    child: etree._Element,
    known: list[etree._Element],
) -> Deviation:
    name = local(child)
    first = next((other for other in known if local(other) == name), child)
    if first is not child:
        most = kind.children[name].high
        number = "Only one" if most == 1 else f"At most {most}"
        message = f"{number} <{name}> may stand here in <{local(parent)}>."
        return Deviation(UNEXPECTED_ELEMENT, child, parent, message, first)
    other = next((other for other in known if other is not child), None)
    beside = f" beside <{local(other)}>" if other is not None else ""
    message = f"<{name}> may not stand in <{local(parent)}>{beside}: one rules out the other."
    return Deviation(UNEXPECTED_ELEMENT, child, parent, message, other)


def _misplaced(
    kept: list[etree._Element],
    ranks: dict[etree._Element, int],
    order: list[etree._Element],
    accused: etree._Element | None,
) -> Iterator[tuple[etree._Element, str, etree._Element | None]]:
    """The fewest children that have to move, with where to."""
    if kept == order:
        return
    staying = _ascending(kept, ranks)
    if accused in staying:
        others = _ascending([child for child in kept if child is not accused], ranks)
        if len(others) == len(staying):
            staying = others
    places = {child: place for place, child in enumerate(kept)}
    moving = [child for child in kept if child not in staying]
    for child in moving:
        after = next((o for o in order[ranks[child] + 1 :] if o in staying), None)
        before = next((o for o in reversed(order[: ranks[child]]) if o in staying), None)
        if (
            accused is not None
            and accused in staying
            and places[child] < places[accused]
            and ranks[child] > ranks[accused]
        ):
            # It is the same fault seen from the other side, where libxml2 sees it.
            message = f"<{local(accused)}> is out of order: it belongs before <{local(child)}>."
            yield accused, message, child
            accused = None
        elif after is not None and places[after] < places[child]:
            message = f"<{local(child)}> is out of order: it belongs before <{local(after)}>."
            yield child, message, after
        else:
            message = f"<{local(child)}> is out of order"
            message += "." if before is None else f": it belongs after <{local(before)}>."
            yield child, message, before


def _ascending(
    children: list[etree._Element], ranks: dict[etree._Element, int]
) -> set[etree._Element]:
    """As many of some children as can be that are in order."""
    tails: list[int] = []
    ends: list[int] = []
    before = [-1] * len(children)
    for place, child in enumerate(children):
        length = bisect_left(tails, ranks[child])
        before[place] = ends[length - 1] if length else -1
        if length == len(tails):
            tails.append(ranks[child])
            ends.append(place)
        else:
            tails[length], ends[length] = ranks[child], place
    found = set()
    place = ends[-1] if ends else -1
    while place >= 0:
        found.add(children[place])
        place = before[place]
    return found


@cache
def _parents() -> dict[str, set[str]]:
    """The elements that an element may stand in, by its name."""
    found: dict[str, set[str]] = {}
    seen: set[ComplexType] = set()
    stack = [("COLLADA", grammar()["COLLADA"])]
    while stack:
        name, kind = stack.pop()
        for child in kind.children.values():
            found.setdefault(child.name, set()).add(name)
            if isinstance(child.type, ComplexType) and child.type not in seen:
                seen.add(child.type)
                stack.append((child.name, child.type))
    return found


def _list(names: list[str], word: str) -> str:
    shown = [f"<{name}>" for name in names[:_MOST]]
    if len(names) > _MOST:
        return ", ".join(shown) + ", …"
    return f" {word} ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown)

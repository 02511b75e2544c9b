"""Small things that every part of the export does with elements."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from lxml import etree

from colladaphy.conform.downgrade.draft import Draft, detach, local, tag15
from colladaphy.conform.frames import Matrix, axis_angle, is_transform

__all__ = [
    "Names",
    "children",
    "copy_of",
    "first",
    "insert_all",
    "number_text",
    "numbers_text",
    "pose_steps",
    "put_steps",
    "steps_are_plain",
]


def children(element: etree._Element | None, *names: str) -> list[etree._Element]:
    """The children of these local names; none of no element."""
    return [] if element is None else [child for child in element if local(child) in names]


def first(element: etree._Element | None, *path: str) -> etree._Element | None:
    """The first descendant along a path of local names."""
    for name in path:
        if element is None:
            return None
        element = element.find(tag15(name))
    return element


def number_text(value: float) -> str:
    """A number that reads back to the same bits, as XML Schema spells it."""
    value = float(value)
    if np.isinf(value):
        return "INF" if value > 0 else "-INF"
    return "NaN" if np.isnan(value) else repr(value)


def numbers_text(values: Iterable[float]) -> str:
    """Numbers with spaces between."""
    return " ".join(number_text(value) for value in values)


def pose_steps(draft: Draft, pose: Matrix) -> Iterator[etree._Element]:
    """A pose as Bullet reads it: a translate, then a rotate where it turns."""
    yield draft.make("translate", numbers_text(pose[:3, 3]))
    turn = axis_angle(pose)
    if turn[3] != 0.0:
        yield draft.make("rotate", numbers_text(turn))


def steps_are_plain(parent: etree._Element) -> bool:
    """Whether the transforms are at most one translate and then rotates: nothing to rewrite.

    Bullet takes the rotates in their order and adds the translates, unrotated.
    """
    names = [local(child) for child in parent if is_transform(child)]
    return names[:1] in ([], ["translate"], ["rotate"]) and {*names[1:]} <= {"rotate"}


def put_steps(parent: etree._Element, steps: Iterable[etree._Element]) -> None:
    """Replace the transforms in `parent`; where there were none, put them where they belong."""
    old = [child for child in parent if is_transform(child)]
    position = parent.index(old[0]) if old else _place_for_steps(parent)
    for child in old:
        detach(child)
    insert_all(parent, position, list(steps))


_BEFORE_STEPS = frozenset(
    ("asset", "hollow", "mass", "density", "instance_physics_material", "physics_material",
     "instance_geometry", "plane", "box", "sphere", "cylinder", "capsule")
)  # fmt: skip


def _place_for_steps(parent: etree._Element) -> int:
    if local(parent) == "node":
        return len(children(parent, "asset"))
    before = [child for child in parent if local(child) in _BEFORE_STEPS]
    return parent.index(before[-1]) + 1 if before else 0


def copy_of(element: etree._Element) -> etree._Element:
    """A copy without the text that follows."""
    twin = copy.deepcopy(element)
    twin.tail = None
    return twin


def insert_all(parent: etree._Element, position: int, elements: Sequence[etree._Element]) -> None:
    """Insert elements in their order, in linear time, with the indentation of the others."""
    blank = parent.text if parent.text is not None and not parent.text.strip() else None
    for element in elements:
        element.tail = blank
    if elements and 0 < position == len(parent):
        elements[-1].tail, parent[-1].tail = parent[-1].tail, blank
    parent[position:position] = list(elements)


class Names:
    """Names that are taken, and new ones like those that are wished for."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)
        self._next: dict[str, int] = {}

    def take(self, names: Iterable[str]) -> None:
        """Count these as taken from now on."""
        self._taken.update(names)

    def new(self, wish: str) -> str:
        """`wish`, or it with the first number that makes it new; taken from now on."""
        name, number = wish, self._next.get(wish, 2)
        while name in self._taken:
            name, number = f"{wish}-{number}", number + 1
        self._next[wish] = number
        self._taken.add(name)
        return name

"""Transforms and nodes: trees of them, nodes of libraries that others instance."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from hypothesis import strategies as st

from colladaphy.testing.making.scalars import several
from colladaphy.testing.markup import library, numbers, tag

__all__ = ["Nodes", "coordinates", "draw_steps"]

coordinates = st.integers(-40, 40).map(lambda number: number / 8)
_vectors = st.tuples(coordinates, coordinates, coordinates)
_axes = st.sampled_from([(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, -2.0, 0.0), (0.6, 0.0, 0.8)])
_degrees = st.integers(-360, 360).map(float)


def draw_steps(
    draw: st.DrawFn, fewest: int = 0, forms: tuple[str, ...] = ("translate", "rotate")
) -> str:
    """Up to three transforms, as elements, that turn and move and do nothing else."""

    def step(draw: st.DrawFn) -> str:
        return _step(draw, draw(st.sampled_from(forms)))

    return "".join(several(draw, fewest, 3, step))


def _step(draw: st.DrawFn, form: str) -> str:
    match form:
        case "translate":
            return tag(form, numbers(draw(_vectors)))
        case "rotate":
            return tag(form, numbers((*draw(_axes), draw(_degrees))))
        case "matrix":
            angle = math.radians(draw(_degrees))
            c, s = math.cos(angle), math.sin(angle)
            x, y, z = draw(_vectors)
            return tag(form, numbers((c, -s, 0, x, s, c, 0, y, 0, 0, 1, z, 0, 0, 0, 1)))
        case _:  # from a place, towards another one, with an upward direction across
            x, y, z = draw(_vectors)
            return tag(form, numbers((x, y, z, x + 1, y, z - 2, 0, 1, 0)))


@dataclass
class _Node:
    id: str
    steps: str
    children: list[_Node] = field(default_factory=list)
    instanced: list[str] = field(default_factory=list)

    def text(self) -> str:
        instances = (tag("instance_node", url=f"#{id}") for id in self.instanced)
        inner = (child.text() for child in self.children)
        return tag("node", self.steps, *instances, *inner, id=self.id)


class Nodes:
    """The nodes of a document, which come as they are asked for."""

    FORMS = ("translate", "rotate", "matrix", "lookat")

    def __init__(self, mark: str) -> None:
        self._mark = mark
        self._top: list[_Node] = []
        self._lent: list[_Node] = []
        self._all: list[_Node] = []

    def new(self, draw: st.DrawFn) -> str:
        """The id of a node of its own: in the scene, within another node, or in a library."""
        node = _Node(f"{self._mark}n{len(self._all)}", draw_steps(draw, forms=self.FORMS))
        where = draw(st.sampled_from(["scene", "within", "library"]))
        if where == "scene" or not self._all:
            self._top.append(node)
        elif where == "within":
            draw(st.sampled_from(self._all)).children.append(node)
        else:  # instanced once, or nobody could say where it stands
            draw(st.sampled_from(self._all)).instanced.append(node.id)
            self._lent.append(node)
        self._all.append(node)
        return node.id

    def some(self, draw: st.DrawFn) -> str:
        """The id of a node that is new, or now and then of any."""
        if self._all and not draw(st.integers(0, 4)):
            return draw(st.sampled_from(self._all)).id
        return self.new(draw)

    @property
    def features(self) -> set[str]:
        """What occurs."""
        found = {"instance_node"} if self._lent else set()
        if any(node.children for node in self._all):
            found.add("nested-nodes")
        return found

    def texts(self) -> tuple[str, str]:
        """The library of nodes and that of visual scenes."""
        lent = library("nodes", *(node.text() for node in self._lent))
        scene = tag("visual_scene", *(node.text() for node in self._top), id=f"{self._mark}visual")
        return lent, library("visual_scenes", scene) if self._top else ""

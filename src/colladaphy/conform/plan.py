"""Filling a content model from the children there are."""

from __future__ import annotations

from lxml import etree

from colladaphy.conform.assumptions import assumed_element
from colladaphy.conform.context import Context, local
from colladaphy.conform.grammar import Declaration, Group, required

__all__ = ["Plan", "Pool", "set_children"]

Pool = dict[str, list[etree._Element]]
"""Children that have no place yet, by local name, in document order."""


class Plan:
    """Fills a content model from the children there are."""

    def __init__(self, context: Context, element: etree._Element) -> None:
        self.context = context
        self.element = element
        self.order: list[etree._Element] = []
        self.made: dict[etree._Element, str] = {}
        self.missing: str | None = None

    def take(self, part: Declaration | Group, pool: Pool) -> None:
        """Move from `pool` to `order` what `part` may hold."""
        if isinstance(part, Declaration):
            self._element(part, pool)
        elif part.high > 1:
            self._repeated(part, pool)
        elif part.low or _present(part, pool):
            if part.kind == "sequence":
                for inner in part.parts:
                    self.take(inner, pool)
            else:
                self.take(self._branch(part, pool), pool)

    def _element(self, part: Declaration, pool: Pool) -> None:
        found = pool.get(part.name, [])
        taken, pool[part.name] = found[: part.high], found[part.high :]
        self.order.extend(taken)
        for _ in range(part.low - len(taken)):
            new = assumed_element(self.context, self.element, part)
            if new is None:
                self.missing = self.missing or part.name
                return
            self.order.append(new[0])
            self.made[new[0]] = f": {new[1]}" if new[1] else ""

    def _repeated(self, part: Group, pool: Pool) -> None:
        names = {declaration.name for declaration in part.declarations()}
        if part.kind == "choice" and all(isinstance(inner, Declaration) for inner in part.parts):
            for child in self.element.iterchildren(tag=etree.Element):
                rest = pool.get(local(child))
                if local(child) in names and rest and rest[0] is child:
                    self.order.append(rest.pop(0))
            if part.low and not self.order:
                self.missing = self.missing or " or ".join(sorted(names))
            return
        once = Group(part.kind, part.parts, 1, 1)
        count = 0
        while _present(part, pool) and self.missing is None:
            before = len(self.order)
            self.take(once, pool)
            count += 1
            if len(self.order) == before:
                break
        while count < part.low and self.missing is None:
            self.take(once, pool)
            count += 1

    def _branch(self, part: Group, pool: Pool) -> Declaration | Group:
        """The branch of a choice that needs least and holds most of what is there."""

        def cost(branch: Declaration | Group) -> tuple[int, int]:
            needed = required(branch)
            lacking = sum(1 for name in needed if not pool.get(name))
            inner = [branch] if isinstance(branch, Declaration) else branch.declarations()
            return lacking, -len({item.name for item in inner if pool.get(item.name)})

        present = [branch for branch in part.parts if _present(branch, pool)]
        return min(present or part.parts, key=cost)


def _present(part: Declaration | Group, pool: Pool) -> bool:
    names = [part] if isinstance(part, Declaration) else part.declarations()
    return any(pool.get(declaration.name) for declaration in names)


def set_children(parent: etree._Element, order: list[etree._Element]) -> None:
    """Put elements into this order; comments stay before the element they stand before."""
    tails = [child.tail for child in parent]
    units: dict[etree._Element, list[etree._Element]] = {}
    waiting: list[etree._Element] = []
    for child in parent:
        waiting.append(child)
        if local(child):
            units[child] = waiting
            waiting = []
    nodes = [node for element in order for node in units.get(element, [element])] + waiting
    blank = parent.text if parent.text and not parent.text.strip() else None
    for node in list(parent):
        parent.remove(node)
    last = tails[-1] if tails else None
    for node in nodes:
        node.tail = blank
        parent.append(node)
    if nodes:
        nodes[-1].tail = last

"""How the children that there are would fit a content model best, without a change to them."""

from __future__ import annotations

from dataclasses import dataclass, field

from lxml import etree

from colladaphy.conform.grammar import Declaration, Group, required

__all__ = ["Arrangement", "arrange"]

_Element = etree._Element


@dataclass(slots=True)
class Arrangement:
    """Children in the order of a content model, and what is too many or too few."""

    order: list[_Element] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    """What is needed, in words."""
    surplus: list[_Element] = field(default_factory=list)


def arrange(content: Group, names: dict[_Element, str]) -> Arrangement:
    """Put children, which have names that a content model knows, in its order."""
    work = _Work(names)
    work.take(content)
    found = work.found
    placed = set(found.order)
    found.surplus = [child for child in names if child not in placed]
    return found


class _Work:
    """Children that have no place yet, by name: a queue each, with how many of it are taken."""

    def __init__(self, names: dict[_Element, str]) -> None:
        self.found = Arrangement()
        self._places = {child: place for place, child in enumerate(names)}
        self._queues: dict[str, list[_Element]] = {}
        self._taken: dict[str, int] = {}
        for child, name in names.items():
            self._queues.setdefault(name, []).append(child)

    def _left(self, name: str) -> int:
        return len(self._queues.get(name, ())) - self._taken.get(name, 0)

    def _next(self, name: str) -> int:
        """The place of the next child of a name."""
        queue = self._queues[name]
        return self._places[queue[self._taken.get(name, 0)]]

    def _move(self, name: str, count: int) -> None:
        start = self._taken.get(name, 0)
        self.found.order += self._queues[name][start : start + count]
        self._taken[name] = start + count

    def take(self, part: Declaration | Group) -> None:
        """Find places for what a part of the content model may hold."""
        if isinstance(part, Declaration):
            count = min(self._left(part.name), part.high)
            if count:
                self._move(part.name, count)
            if count < part.low:
                self._lack(f"<{part.name}>")
        elif part.high > 1:
            self._repeated(part)
        elif part.low or self._present(part):
            self._once(part)

    def _once(self, part: Group) -> None:
        if part.kind == "sequence":
            for inner in part.parts:
                self.take(inner)
            return
        present = [branch for branch in part.parts if self._present(branch)]
        if not present and _may_be_empty(part):
            return
        if not present:
            names = [f"<{declared.name}>" for declared in part.declarations()]
            shown = ", ".join(names[:6]) + (", …" if len(names) > 6 else "")
            self._lack(f"one of {shown}" if len(names) > 1 else shown)
            return
        self.take(min(present, key=self._cost))

    def _repeated(self, part: Group) -> None:
        if part.kind == "choice" and all(isinstance(inner, Declaration) for inner in part.parts):
            names = {inner.name for inner in part.declarations()}
            some = [
                child
                for name in names
                for child in self._queues.get(name, [])[self._taken.get(name, 0) :]
            ]
            for name in names:
                self._taken[name] = len(self._queues.get(name, ()))
            self.found.order += sorted(some, key=self._places.__getitem__)
            if part.low and not some:
                self._once(Group(part.kind, part.parts, 1, 1))
            return
        once = Group(part.kind, part.parts, 1, 1)
        count = 0
        while self._present(part) and not self.found.missing:
            before = len(self.found.order)
            self._once(once)
            count += 1
            if len(self.found.order) == before:
                break
        while count < part.low and not self.found.missing:
            self._once(once)
            count += 1

    def _cost(self, branch: Declaration | Group) -> tuple[int, int, int]:
        """Branches that lack least, then that hold most, then whose first child comes first."""
        lacking = sum(1 for name in required(branch) if not self._left(name))
        held = {inner.name for inner in _declarations(branch) if self._left(inner.name)}
        return lacking, -len(held), min(map(self._next, held), default=0)

    def _present(self, part: Declaration | Group) -> bool:
        return any(self._left(inner.name) for inner in _declarations(part))

    def _lack(self, what: str) -> None:
        self.found.missing.append(what)


def _declarations(part: Declaration | Group) -> list[Declaration]:
    return [part] if isinstance(part, Declaration) else part.declarations()


def _may_be_empty(part: Declaration | Group) -> bool:
    if not part.low:
        return True
    if isinstance(part, Declaration):
        return False
    each = [_may_be_empty(inner) for inner in part.parts]
    return any(each) if part.kind == "choice" else all(each)

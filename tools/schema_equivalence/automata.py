"""Content models as automata, so that only the language counts, not how groups are nested."""

from collections import deque
from collections.abc import Iterator
from typing import Any

from xmlschema.validators import XsdAnyElement, XsdGroup

from tools.schema_equivalence.loading import SchemaError

Label = tuple[str, ...]
State = frozenset[int]
"""A set of positions; START alone before the first child."""
START: State = frozenset([-1])
Part = tuple[bool, set[int], set[int]]
"""Of a piece of the expression: may be empty, positions that may come first, and last."""
EMPTY: Part = (True, set(), set())


def label(particle: Any) -> Label:
    """What a particle matches: an element by its expanded name, or a wildcard."""
    if isinstance(particle, XsdAnyElement):
        return ("any", *sorted(particle.namespace), particle.process_contents)
    return ("element", particle.name)


class Automaton:
    """The Glushkov automaton of a model group: one position a particle (and a repetition)."""

    def __init__(self, group: Any) -> None:
        self.particles: list[Any] = []
        self._follow: list[set[int]] = []
        self._nullable, self._first, self._last = self._part(group)

    def is_final(self, state: State) -> bool:
        if state is START:
            return self._nullable
        return not self._last.isdisjoint(state)

    def step(self, state: State) -> dict[Label, State]:
        """The labels that may come next, and where each leads."""
        successors: dict[Label, set[int]] = {}
        for position in state:
            following = self._first if position == -1 else self._follow[position]
            for successor in following:
                successors.setdefault(label(self.particles[successor]), set()).add(successor)
        return {found: frozenset(positions) for found, positions in successors.items()}

    def _part(self, particle: Any) -> Part:
        least, most = particle.min_occurs, particle.max_occurs
        if most == 0:
            return EMPTY
        whole = EMPTY
        for _ in range(least):
            whole = self._sequence(whole, self._once(particle))
        if most is None:
            _, first, last = once = self._once(particle)
            for position in last:
                self._follow[position] |= first
            return self._sequence(whole, (True, once[1], once[2]))
        optional = EMPTY
        for _ in range(most - least):  # (x (x (x)?)?)?
            _, first, last = self._sequence(self._once(particle), optional)
            optional = (True, first, last)
        return self._sequence(whole, optional)

    def _once(self, particle: Any) -> Part:
        if not isinstance(particle, XsdGroup):
            self.particles.append(particle)
            self._follow.append(set())
            position = len(self.particles) - 1
            return (False, {position}, {position})
        if particle.model == "all" and len(particle) > 1:
            raise SchemaError(f"xs:all is not compared: {particle.name or particle}")
        parts = [self._part(child) for child in particle]
        if particle.model == "choice":
            return (
                any(part[0] for part in parts),
                set().union(*(part[1] for part in parts)),
                set().union(*(part[2] for part in parts)),
            )
        whole = EMPTY
        for part in parts:
            whole = self._sequence(whole, part)
        return whole

    def _sequence(self, left: Part, right: Part) -> Part:
        for position in left[2]:
            self._follow[position] |= right[1]
        return (
            left[0] and right[0],
            left[1] | right[1] if left[0] else left[1],
            right[2] | left[2] if right[0] else right[2],
        )


def walk_together(
    ours: Automaton, official: Automaton
) -> Iterator[tuple[str, State, State, dict[Label, State], dict[Label, State]]]:
    """Every reachable pair of states, with a shortest word that leads there and what follows."""
    seen = {(START, START)}
    queue = deque([(START, START, "")])
    while queue:
        mine, theirs, word = queue.popleft()
        my_steps, their_steps = ours.step(mine), official.step(theirs)
        yield word, mine, theirs, my_steps, their_steps
        for found in sorted(my_steps.keys() & their_steps.keys()):
            pair = (my_steps[found], their_steps[found])
            if pair not in seen:
                seen.add(pair)
                queue.append((*pair, f"{word} {short(found)}".strip()))


def short(found: Label) -> str:
    return found[1].rpartition("}")[2] if found[0] == "element" else "any"

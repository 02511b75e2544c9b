"""Which elements have a content in which a name alone does not say what may follow it.

A content model is local where its smallest automaton is in the same state behind every child of
one name: what may stand in it is then told by first and last children and pairs of neighbours.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from xmlschema.validators import XsdElement

from tools.schema_equivalence.automata import START, Automaton, Label, State
from tools.schema_equivalence.loading import load

__all__ = ["is_local", "with_other_content"]

XS = "{http://www.w3.org/2001/XMLSchema}"


def is_local(group: Any) -> bool:
    """Whether a content model is local; wildcards count as one name."""
    automaton = Automaton(group)
    steps: dict[State, dict[Label, State]] = {}
    todo = [START]
    while todo:
        state = todo.pop()
        if state not in steps:
            steps[state] = automaton.step(state)
            todo += steps[state].values()
    classes = _classes(automaton, steps)
    reached: dict[Label, set[int]] = {}
    for step in steps.values():
        for label, target in step.items():
            reached.setdefault(label, set()).add(classes[target])
    return all(len(states) == 1 for states in reached.values())


def _classes(automaton: Automaton, steps: dict[State, dict[Label, State]]) -> dict[State, int]:
    """Equal numbers for states behind which the same may follow (Moore's refinement)."""
    classes = {state: int(automaton.is_final(state)) for state in steps}
    while True:
        keys = {
            state: (classes[state], *sorted((label, classes[to]) for label, to in step.items()))
            for state, step in steps.items()
        }
        numbers = {key: number for number, key in enumerate(dict.fromkeys(keys.values()))}
        refined = {state: numbers[key] for state, key in keys.items()}
        if len(numbers) == len(set(classes.values())):
            return refined
        classes = refined


def with_other_content(schema: Path) -> list[str]:
    """The qualified names of elements that are declared with a content that is not local."""
    maps = load(schema).maps
    seen: set[int] = set()
    found: set[str] = set()
    todo = [each for each in maps.elements.values() if not each.name.startswith(XS)]
    while todo:
        element = todo.pop()
        kind = element.type
        if id(element) in seen:
            continue
        seen.add(id(element))
        if kind is None or not kind.has_complex_content():
            continue
        if kind.mixed or not is_local(kind.content):
            found.add(str(element.name))
        todo += [each for each in kind.content.iter_elements() if isinstance(each, XsdElement)]
    return sorted(found)

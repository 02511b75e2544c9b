"""Elements that are instanced within themselves, and scoped ids that are there twice."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from colladaphy.columns.distinct import are_among
from colladaphy.findings import Severity
from colladaphy.links.names import MOST_INSTANCES
from colladaphy.links.rules import BUDGET, CYCLE
from colladaphy.meaning import link_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit

__all__ = ["CHECKS"]


_EDGES: tuple[tuple[tuple[str, ...], str, tuple[str, ...]], ...] = (
    (("instance_node",), "url", ("node",)),
    (("instance_physics_model",), "url", ("physics_model",)),
    (("instance_articulated_system",), "url", ("articulated_system",)),
    (("instance_kinematics_model",), "url", ("kinematics_model",)),
    (("convex_mesh",), "convex_hull_of", ("geometry",)),
    (("skin", "morph"), "source", ("controller",)),
    (("instance_animation",), "url", ("animation",)),
    (("instance_formula",), "url", ("formula",)),
)
"""References that put one element into another: where, which, and the names of both."""
_BODIES = ("rigid_body", "rigid_constraint")


def circles(context: Context) -> Iterator[Hit]:
    """Elements that are instanced within themselves."""
    for names, attribute, kinds in _EDGES:
        elements = np.concatenate([context.ordinals(name) for name in names])
        around = context.ancestor(elements, *kinds)
        targets = np.concatenate([context.led(name, attribute) for name in names])
        there = context.is_named(targets, *kinds)
        good = np.flatnonzero((around >= 0) & there)
        if kinds != ("node",):  # what holds nothing closes no circle
            good = good[are_among(targets[good], around[good])]
        if not len(good):
            continue
        below: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
        for element, outer, target in zip(
            *(column[good].tolist() for column in (elements, around, targets)), strict=True
        ):
            below[outer].append((target, element))
        used = targets[(around < 0) & there].tolist()
        if kinds == ("node",):
            _nest(context, below)
        told: set[int] = set()
        for element, target in _closing(below, used):
            if target in told:
                continue
            told.add(target)
            message = f"{context.label(target)} is instanced within itself."
            if attribute == "convex_hull_of":
                message = f"{context.label(target)} is a convex hull of itself."
            yield Hit(CYCLE, element, message, (target,), attribute)


def _nest(context: Context, below: dict[int, list[tuple[int, int]]]) -> None:
    """Let nodes hold the nodes in them, too, as far as those hold instances."""
    waiting = list(below)
    known = set(waiting)
    while waiting:
        inner = waiting.pop()
        outer = int(context.ancestor(np.array([inner]), "node")[0])
        if outer < 0:
            continue
        below.setdefault(outer, []).append((inner, inner))
        if outer not in known:
            known.add(outer)
            waiting.append(outer)


def _closing(
    below: dict[int, list[tuple[int, int]]], used: Sequence[int] = ()
) -> Iterable[tuple[int, int]]:
    """The references that close circles, and what they lead to: one of each circle.

    It is the one that closes it as seen from what is `used` from outside, which loading goes by.
    """
    state: dict[int, int] = {}
    found = []
    for start in (*used, *sorted(below)):
        if start in state or start not in below:
            continue
        state[start] = 1
        stack = [(start, iter(sorted(below[start], key=lambda edge: edge[1])))]
        while stack:
            element, edges = stack[-1]
            for target, reference in edges:
                if state.get(target) == 1:
                    found.append((reference, target))
                elif target not in state:
                    state[target] = 1
                    inner = sorted(below.get(target, ()), key=lambda edge: edge[1])
                    stack.append((target, iter(inner)))
                    break
            else:
                state[element] = 2
                stack.pop()
    return found


def expansions(context: Context) -> Iterator[Hit]:
    """Models in models that make more instances than a file of that size should."""
    elements = context.ordinals("instance_physics_model")
    around = context.ancestor(elements, "physics_model")
    if len(elements) <= MOST_INSTANCES and not bool(np.any(around >= 0)):
        return
    targets = context.led("instance_physics_model", "url")
    within: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
    for element, outer, target in zip(
        *(column.tolist() for column in (elements, around, targets)), strict=True
    ):
        within[outer].append((target, element))
    if next(iter(_closing(within)), None) is not None:
        return  # told as a circle
    sizes = _sizes(within)
    whole = sum(1 + sizes.get(target, 0) for target, _ in within[-1])
    if whole > MOST_INSTANCES:
        _, element = max(within[-1], key=lambda edge: sizes.get(edge[0], 0))
        yield Hit(BUDGET, element, f"The scenes expand to {whole:,} instances of models.")


def _sizes(within: dict[int, list[tuple[int, int]]]) -> dict[int, int]:
    """How many instances there are in a model, those in the models in it included."""
    sizes: dict[int, int] = {}
    stack = list(within)
    while stack:
        model = stack[-1]
        inner = [target for target, _ in within.get(model, ()) if target in within]
        waiting = [target for target in inner if target not in sizes]
        if waiting:
            stack += waiting
            continue
        sizes[model] = sum(1 + sizes.get(target, 0) for target, _ in within[model])
        stack.pop()
    return sizes


def duplicate_sids(context: Context) -> Iterator[Hit]:
    """Siblings of one scoped id."""
    if context.columns.scoped_identifiers.all_differ():
        return
    elements, texts = context.columns.with_attribute("sid")
    parents = context.parent[elements].tolist()
    if len(set(zip(parents, texts, strict=True))) == len(texts):
        return
    first: dict[tuple[int, str], int] = {}
    for element, parent, text in zip(elements.tolist(), parents, texts, strict=True):
        known = first.setdefault((parent, text), element)
        if known == element:
            continue
        name = context.name(element)
        needed = name in _BODIES and context.name(known) in _BODIES
        yield Hit(
            link_rules.DUPLICATE_SID,
            element,
            f"<{name}> has the sid {text!r} of a <{context.name(known)}> beside it.",
            (known,),
            "sid",
            Severity.ERROR if needed else None,
        )


CHECKS = (circles, duplicate_sids, expansions)

"""The pe profile: kinds of joints, tensors, materials and pairs that say two things, or nothing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.findings import Severity
from colladaphy.meaning import profile_rules
from colladaphy.meaning.comparing import matched
from colladaphy.meaning.constraint_table import constraints_of, limits_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.profile import are_broken
from colladaphy.meaning.profile_table import profile_of
from colladaphy.meaning.staleness import old_limits
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]

_KINDS = {"fixed": (0, 0), "hinge": (0, 1), "slider": (1, 0), "ball": (0, 3)}
"""How many axes shift and turn in joints of a kind."""
_POSITIVE = ("density", "young_modulus", "stiffness")


def kinds(context: Context) -> Iterator[Hit]:
    """Joints of another kind than their limits make them; general may be any."""
    elements = profile_of(context).elements("joint")
    if not len(elements):
        return
    table = constraints_of(context)
    mine, rows = matched(table.elements, profile_of(context).holders(elements))
    free = []
    for name in ("linear", "swing_cone_and_twist"):
        low, high = limits_of(context, name)
        free.append((low != high).sum(axis=1)[rows])
    numbers, texts = context.columns.factorized(context.at(Rows, elements[mine]), "kind")
    meant = np.array([_KINDS.get(text, (-1, -1)) for text in (*texts, "")])[numbers]
    wrong = (meant[:, 0] >= 0) & (meant != np.column_stack(free)).any(axis=1)
    told = old_limits(context) if wrong.any() else {}
    for row in np.flatnonzero(wrong).tolist():
        holder = int(table.elements[rows[row]])
        if holder in told:
            continue  # the limits are others than they were
        shifts, turns = free[0][row], free[1][row]
        message = (
            f"The kind is {texts[numbers[row]]}, but by the limits {shifts} axes shift and "
            f"{turns} turn."
        )
        yield Hit(profile_rules.OLD_VALUE, int(elements[mine[row]]), message, (holder,), "kind")


def tensors(context: Context) -> Iterator[Hit]:
    """Tensors of inertia that are not symmetric, but for those that no body has."""
    elements, _, values = profile_of(context).values("inertia", 9, "body", "shape", "union")
    if not len(elements):
        return
    matrices = np.where(np.isfinite(values), values, 0.0).reshape(-1, 3, 3)
    sizes = np.abs(matrices).max(axis=(1, 2))
    with np.errstate(over="ignore"):
        apart = np.abs(matrices - matrices.transpose(0, 2, 1)).max(axis=(1, 2))
    wrong = np.flatnonzero(apart > 1e-6 * sizes)
    if len(wrong):
        scaled = matrices[wrong] / sizes[wrong, None, None]
        moments = np.linalg.eigvalsh((scaled + scaled.transpose(0, 2, 1)) / 2.0)
        wrong = wrong[~are_broken(moments)]
    for row in wrong.tolist():
        message = "The inertia is not symmetric; loading takes the mean of both halves."
        yield Hit(profile_rules.VALUE, int(elements[row]), message, severity=Severity.WARNING)


def materials(context: Context) -> Iterator[Hit]:
    """Values of materials that have to be positive, and are zero."""
    for name in _POSITIVE:
        elements, _, values = profile_of(context).values(name, 1, "material")
        for element in elements[values[:, 0] == 0.0].tolist():
            message = f"<pe:{name}> is 0; loading takes another value."
            yield Hit(profile_rules.VALUE, element, message, severity=Severity.WARNING)


def pairs(context: Context) -> Iterator[Hit]:
    """Pairs of the same materials, in whichever order."""
    elements = profile_of(context).elements("pair")
    seen: dict[tuple[int, frozenset[str]], int] = {}
    around = context.parent[elements].tolist()
    named = [context.texts(context.at(Rows, elements), key) for key in ("first", "second")]
    for element, outer, *names in zip(elements.tolist(), around, *named, strict=True):
        first = seen.setdefault((outer, frozenset(name or "" for name in names)), element)
        if first != element:
            message = "There is a pair of the same materials already."
            yield Hit(profile_rules.TWICE, element, message, (first,))


CHECKS = (kinds, tensors, materials, pairs)

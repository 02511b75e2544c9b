"""Limits that count from where the bodies are (thesis 5.6), as the thesis's own files have them.

The standard compares the frames of a constraint: bodies whose frames are apart are drawn together
where the limits are zero. To count from the current distance, the frame of the reference body is
put where the other one is now; it keeps its axes, so that all limits mean the same along them.
"""

from __future__ import annotations

import numpy as np
from lxml import etree

from colladaphy.conform import convention_rules
from colladaphy.conform.context import NS, Context
from colladaphy.conform.conventions.clues import place_of
from colladaphy.conform.conventions.places import Places
from colladaphy.conform.frames import Matrix, nearest_rotation
from colladaphy.conform.placing import put_place

__all__ = ["count_from_here"]

_NEAR = 1e-12


def count_from_here(context: Context) -> None:
    """Put the frames of every constraint together, at the pose of the document."""
    nodes: dict[tuple[str, str], list[etree._Element]] = {}
    for instance in context.all("instance_rigid_body"):
        model, node = instance.getparent(), context.by_url(instance.get("target"))
        if model is not None and node is not None:
            name = (instance.get("body") or "").rpartition("/")[2]
            nodes.setdefault((model.get("url", "").lstrip("#"), name), []).append(node)
    places = Places(context)
    for constraint in context.all("rigid_constraint"):
        model, ends = constraint.getparent(), []
        for name in ("ref_attachment", "attachment"):
            end = constraint.find(NS + name)
            if model is not None and end is not None:
                ends.append((end, _frame(end, model, nodes, places)))
        frames = [frame for _, frame in ends]
        if len(ends) < 2 or frames[0] is None or frames[1] is None:
            continue
        (holder, _), outer, inner = ends[0], frames[0], frames[1]
        shift = np.linalg.solve(outer, inner)[:3, 3]
        size = max(1.0, float(np.abs(inner[:3, 3]).max()))
        own = place_of(holder)
        if own is None or float(np.abs(shift).max()) <= _NEAR * size:
            continue
        if not context.wants(convention_rules.CURRENT_DISTANCE):
            return
        moved = own.copy()
        moved[:3, 3] += own[:3, :3] @ shift
        put_place(context, holder, nearest_rotation(moved)[0])
        told = " ".join(f"{value:g}" for value in shift)
        message = f"the frames of {constraint.get('sid')!r} were {told} apart, and are together now"
        context.note(convention_rules.CURRENT_DISTANCE, constraint, message)


def _frame(
    end: etree._Element,
    model: etree._Element,
    nodes: dict[tuple[str, str], list[etree._Element]],
    places: Places,
) -> Matrix | None:
    """Where an attachment is in the scene; None where that cannot be told, or differs."""
    own, name = place_of(end), (end.get("rigid_body") or "").rpartition("/")[2]
    if own is None or not name:
        return own
    found = nodes.get((model.get("id", ""), name), [])
    if len(found) != 1:
        return None
    place = places.of(found[0])
    return None if place is None else place.shown @ own

"""What the attachments of constraints hold (COLLADA 1.5 §rigid_constraint, §attachment)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import link_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.comparing import matched
from colladaphy.meaning.constraint_table import SIDES, constraints_of, reference_at
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.links import reference_hits
from colladaphy.meaning.models import instanced_bodies, instanced_constraints, parts_of

__all__ = ["CHECKS", "ends"]

Array = NDArray[Any]


def attachments(context: Context) -> Iterator[Hit]:
    """What the attachments of constraints refer to; the empty reference is the world."""
    table, parts = constraints_of(context), context.shared(parts_of)
    for side in range(len(SIDES)):
        for row in np.flatnonzero(~table.are_world[:, side] & (table.bodies[:, side] < 0)).tolist():
            element = int(table.attachments[row, side])
            text = reference_at(context, element)
            model = int(context.parent[table.elements[row]])
            if parts.attached(context.resource, model, text) is None:
                yield from reference_hits(
                    context, element, "rigid_body", text, ("rigid_body", "node"), addressed=True
                )


def ends(context: Context) -> Iterator[Hit]:
    """Constraints in effect whose bodies are there twice, or not at all."""
    there, used = instanced_bodies(context), instanced_constraints(context)
    table, bodies = constraints_of(context), bodies_of(context)
    mine, rows = matched(table.elements, used.parts)
    if not len(mine):
        return
    width = len(context.parent)
    order = np.flatnonzero(there.parts >= 0)
    keys = (there.around * width + there.parts)[order]
    order = order[np.argsort(keys, kind="stable")]
    keys.sort()
    told: set[int] = set()
    broken = set(there.around[there.lost].tolist())
    ends = table.bodies[rows]
    held = np.where(ends >= 0, bodies.elements[ends], -1)
    # What is in a model within the model has its instance there.
    own = (ends >= 0) & (context.parent[held] == context.parent[table.elements[rows]][:, None])
    wanted = used.around[mine][:, None] * width + held
    first, last = (np.searchsorted(keys, wanted, side=side) for side in ("left", "right"))
    lacking: dict[tuple[int, int], list[Hit]] = {}
    for place, side in np.argwhere(own & (last - first != 1)).tolist():
        element, instance = int(used.elements[mine[place]]), int(used.around[mine[place]])
        body, text = int(held[place, side]), used.texts[mine[place]]
        sid = context.columns.attribute_of(body, "sid") or ""
        end = int(table.attachments[rows[place], side])
        found = there.elements[order[first[place, side] : last[place, side]]].tolist()
        if found and found[1] not in told:
            told.add(found[1])
            message = (
                f"The body {sid!r} is instanced {len(found)} times in one instance of its model, "
                f"so the constraint {text!r} cannot tell which one is meant."
            )
            yield Hit(link_rules.BODY_TWICE, found[1], message, (found[0], end), "body")
        elif not found and instance not in broken and element not in told:
            told.add(element)
            message = (
                f"The constraint {text!r} attaches to the body {sid!r} ({SIDES[side]}), which this "
                "instance of the model does not instance."
            )
            hit = Hit(link_rules.BODY_NOT_INSTANCED, element, message, (end, body), "constraint")
            lacking.setdefault((instance, body), []).append(hit)
    for hits in lacking.values():  # one instance is lacking, however many attach to it
        more = f" {len(hits) - 1} more constraints attach to it."
        yield replace(hits[0], message=hits[0].message + (more if len(hits) > 1 else ""))


CHECKS = (attachments, ends)

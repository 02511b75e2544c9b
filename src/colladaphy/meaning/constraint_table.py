"""Rigid constraints with the bodies that they bind (COLLADA 1.5 §rigid_constraint)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.texts import Ranges
from colladaphy.links.poses import Poses
from colladaphy.links.steps import Steps, poses_of_steps
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.comparing import matched
from colladaphy.meaning.context import Context
from colladaphy.meaning.models import parts_of
from colladaphy_schema.core_columns import RotateTypeRows, TranslateTypeRows
from colladaphy_schema.rows import Child, Rows

__all__ = ["SIDES", "AttachmentRows", "Constraints", "constraints_of", "frames_of", "limits_of",
           "reference_at"]  # fmt: skip

Array = NDArray[Any]
SIDES = ("ref_attachment", "attachment")


class AttachmentRows(Rows):
    """Attachments, with their frames."""

    __slots__ = ()
    translate: Child[TranslateTypeRows] = Child(
        "{http://www.collada.org/2008/03/COLLADASchema}translate", "core_columns:TranslateTypeRows"
    )
    rotate: Child[RotateTypeRows] = Child(
        "{http://www.collada.org/2008/03/COLLADASchema}rotate", "core_columns:RotateTypeRows"
    )


class Constraints:
    """All rigid constraints of a document, one a row."""

    def __init__(self, context: Context) -> None:
        rows = context.rows(Rows, "rigid_constraint")
        assert rows.ordinals is not None
        self.elements: Array = rows.ordinals.astype(np.int64)
        count = len(rows)
        self.are_world: Array = np.ones((count, 2), np.bool_)
        """(n, 2) which refer to nothing."""
        self.attachments: Array = np.full((count, 2), -1, np.int64)
        self.bodies: Array = np.full((count, 2), -1, np.int64)
        """(n, 2) the rows of the bodies, -1 for the world and for what is not found."""
        self.frames = [Poses.none(count), Poses.none(count)]
        """Of both attachments, in their bodies."""
        parts, bodies = context.shared(parts_of), bodies_of(context)
        models = context.parent[self.elements]
        for side, name in enumerate(SIDES):
            ends = context.children(rows, name, AttachmentRows)
            assert ends.ordinals is not None
            self.attachments[ends.owner, side] = ends.ordinals
            world = np.zeros(len(ends), np.bool_)
            self.frames[side].put(ends.owner, frames_of(context, ends))
            mine = models[ends.owner]
            held = _plainly_held(context, ends, mine)
            left = np.flatnonzero(held < 0)
            texts = context.texts(ends, "rigid_body") if len(left) else []
            for row in left.tolist():
                if text := (texts[row] or "").strip():
                    meant = parts.attached(context.resource, int(mine[row]), text)
                    if meant is not None and meant[0] is context.resource:
                        held[row] = meant[1]
                else:
                    world[row] = True
            found, rows_of = matched(bodies.elements, held)
            self.bodies[ends.owner[found], side] = rows_of
            self.are_world[ends.owner, side] = world


def reference_at(context: Context, attachment: int) -> str:
    """What an attachment refers to; empty for the world."""
    return (context.columns.attribute_of(attachment, "rigid_body") or "").strip()


def _plainly_held(context: Context, ends: Rows, models: Array) -> Array:
    """The bodies (n,) of the models that attachments name as nearly all do; -1 for others.

    That is by a sid, behind a slash and the id of the model or a dot.
    """
    columns = context.columns
    there, ranges = columns.ranges(ends, "rigid_body")
    found = np.full(len(ends), -1, np.int64)
    made = ranges.words()
    if made is None or not made[0].size:  # also where all of them are empty
        return found
    letters = made[0].view(np.uint8).reshape(len(ranges), -1)
    slashes = letters == ord("/")
    at = slashes.argmax(axis=1)
    good = (slashes.sum(axis=1) == 1) & ~((letters == ord("#")) | (letters == ord("%"))).any(axis=1)
    behind = np.arange(letters.shape[1]) > at[:, None]
    good &= ~((letters == ord(".")) & behind).any(axis=1)
    heads = Ranges(ranges.all_words, ranges.starts, ranges.starts + at)
    sids = Ranges(ranges.all_words, ranges.starts + at + 1, ranges.stops)
    mine = models if there is None else models[there]
    good &= (columns.identifiers.matched(heads) == mine) | ((at == 1) & (letters[:, 0] == ord(".")))
    bodies = np.where(good, columns.scoped_identifiers.matched(sids, mine), -1)
    bodies[~context.is_named(bodies, "rigid_body")] = -1
    found[slice(None) if there is None else there] = bodies
    return found


def frames_of(context: Context, rows: AttachmentRows) -> Poses:
    """Where what has translates and rotates stands in what is around it, a row each."""
    context.fill(rows)
    return poses_of_steps(Steps.of(rows), exact=False)


def constraints_of(context: Context) -> Constraints:
    """The constraints of a document."""
    return context.shared(Constraints)


def limits_of(context: Context, name: str) -> tuple[Array, Array]:
    """Lower and upper limits (n, 3) of all constraints; locked where nothing is said."""
    rows = context.rows(Rows, "rigid_constraint")
    common = context.children(rows, "technique_common", Rows)
    limits = context.children(common, "limits", Rows)
    groups = context.children(limits, name, Rows)
    owner = common.owner[limits.owner[groups.owner]]
    made = []
    for part in ("min", "max"):
        values = np.zeros((len(rows), 3))
        found, elements = context.vectors(groups, part, 3, 0.0)
        there = elements >= 0
        values[owner[there]] = found[there]
        made.append(values)
    return made[0], made[1]

"""Shapes of the pe profile: those of the body that they stand for, and where they stand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import p
from colladaphy.links.poses import Poses, quaternion_product, reach, unit_quaternions
from colladaphy.meaning.comparing import are_numbers, matched
from colladaphy.meaning.constraint_table import AttachmentRows, frames_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.profile_table import profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["Kept", "Pairs", "Places", "pairs_of", "shape_poses", "turn_rods"]

Array = NDArray[Any]

_ROD = np.array([[math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]])
"""Turns the profile's axis x of capsules and cylinders onto COLLADA's y."""


class Pairs:
    """The shapes of profiles that stand for those of their bodies, in order, if as many."""

    def __init__(self, context: Context) -> None:
        profile = profile_of(context)
        bodies = context.ancestor(context.ordinals("shape"), "rigid_body")
        mine = np.flatnonzero(bodies >= 0)
        bodies = bodies[mine]
        elements = profile.elements("shape")
        holders = profile.holders(elements)
        order = np.argsort(holders, kind="stable")
        holders = holders[order]
        begin, end = (np.searchsorted(bodies, holders, side=side) for side in ("left", "right"))
        first, last = (np.searchsorted(holders, holders, side=side) for side in ("left", "right"))
        good = (end > begin) & (end - begin == last - first)
        rows = mine[(begin + np.arange(len(holders)) - first)[good]]
        elements = elements[order][good]
        order = np.argsort(elements)
        self.elements: Array = elements[order]
        """(n,) shapes of the profile, ascending."""
        self.rows: Array = rows[order]
        """(n,) the rows of the shapes that they stand for."""

    def matched(self, wanted: Array, among: Array | None = None) -> tuple[Array, Array]:
        """The places in `wanted` of shapes of the profile that have others, and the others' rows.

        With `among`, rows of shapes, the places there instead; others are left out.
        """
        mine, at = matched(self.elements, wanted)
        rows = self.rows[at]
        if among is None:
            return mine, rows
        some, at = matched(among, rows)
        return mine[some], at


def pairs_of(context: Context) -> Pairs:
    """Which shapes of the profile stand for which of their bodies."""
    return context.shared(Pairs)


class Kept:
    """A value of elements of the profile, by the element that it is of."""

    def __init__(self, context: Context, name: str, width: int, *outer: str) -> None:
        self.elements, around, self.values = profile_of(context).values(name, width, *outer)
        self._rows = np.full(len(context.parent), -1, np.int32)
        self._rows[around] = np.arange(len(around), dtype=np.int32)
        self.are_numbers: Array = are_numbers(self.values)
        """(n,) which values are numbers."""

    def rows(self, wanted: Array) -> Array:
        """The rows (n,) of what elements state; -1 for nothing."""
        found: Array = self._rows[wanted]
        return found

    def faulty(self, rows: Array) -> Array:
        """Which of some rows (n,), or -1, are of values that are no numbers."""
        found: Array = (rows >= 0) & ~np.append(self.are_numbers, True)[rows]
        return found


class Places:
    """Where shapes and unions of the profile say that they stand."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.positions = Kept(context, "position", 3, "shape", "union")
        self.orientations = Kept(context, "orientation", 4, "shape", "union")

    def are_told(self, elements: Array) -> Array:
        """Which elements (n,) say themselves where they stand."""
        return (self.positions.rows(elements) >= 0) | (self.orientations.rows(elements) >= 0)

    def whole(self, shapes: Array) -> tuple[Poses, Array, Array, Array]:
        """Where shapes stand in their bodies.

        Also the largest numbers (n,) that say so, whether any do (n,), and whether all are
        numbers (n,).
        """
        columns = self.context.columns
        made, told, good = self._own(shapes)
        sizes = reach(made.positions)
        inner, above = np.arange(len(shapes)), self.context.parent[shapes]
        while True:
            inside = np.flatnonzero(columns.have_code(above, columns.codes_of(p("union"))))
            if not len(inside):
                return made, sizes, told, good
            inner, above = inner[inside], above[inside]
            step, is_told, is_good = self._own(above)
            sizes[inner] = np.maximum(sizes[inner], reach(step.positions))
            told[inner] |= is_told
            good[inner] &= is_good
            made.put(inner, step.then(made.take(inner)))
            above = self.context.parent[above]

    def _own(self, elements: Array) -> tuple[Poses, Array, Array]:
        """Where elements stand in the next ones around them, if told (n,), by numbers (n,)."""
        made = Poses.none(len(elements))
        places, turns = self.positions.rows(elements), self.orientations.rows(elements)
        mine = np.flatnonzero(places >= 0)
        made.positions[mine], made.moved[mine] = self.positions.values[places[mine]], True
        mine = np.flatnonzero(turns >= 0)
        given = self.orientations.values[turns[mine]]
        some = given.any(axis=1)  # what is all zero is no turn
        made.orientations[mine[some]] = unit_quaternions(given[some])
        made.turned[mine[some]] = True
        good = ~(self.positions.faulty(places) | self.orientations.faulty(turns))
        return made, (places >= 0) | (turns >= 0), good


def shape_poses(context: Context) -> Poses:
    """Where shapes stand in their bodies, a row each."""
    return context.shared(_shape_poses)


def _shape_poses(context: Context) -> Poses:
    return frames_of(context, context.at(AttachmentRows, shapes_of(context).elements))


def turn_rods(context: Context, rows: Array, poses: Poses) -> Poses:
    """Poses of some shapes, turned to the profile's axes where they are long."""
    turning = np.flatnonzero(context.shared(_long)[rows])
    if len(turning):
        pose = poses.take(turning)
        turn = quaternion_product(pose.orientations, np.broadcast_to(_ROD, (len(turning), 4)))
        poses.put(turning, Poses.of(len(turning), pose.positions, turn, moved=pose.moved))
    return poses


def _long(context: Context) -> Array:
    """Which shapes (n,) are capsules or cylinders along an axis."""
    shapes = shapes_of(context)
    made = np.zeros(len(shapes.elements), np.bool_)
    for name in ("capsule", "cylinder"):
        found = context.children(shapes.rows, name, Rows)
        height, _ = context.scalars(found, "height")
        made[found.owner] = height != 0.0
    return made

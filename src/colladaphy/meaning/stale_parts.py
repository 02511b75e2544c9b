"""Values of the pe profile about planes, members of unions and joints that were left behind.

As in `staleness`: what the common profile says now is compared with what the profile keeps.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among
from colladaphy.links.poses import DEGREE, reach, rotate_vectors, unit_quaternions
from colladaphy.meaning import profile_rules
from colladaphy.meaning.comparing import DIGITS, TURN, are_numbers, differing, matched, old, same
from colladaphy.meaning.constraint_table import constraints_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import unclear_nodes
from colladaphy.meaning.profile_shapes import Kept, Places, pairs_of, shape_poses, turn_rods
from colladaphy.meaning.profile_table import profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


def planes(context: Context) -> Iterator[Hit]:
    """Normals, displacements and anchors of planes that stand where their shapes do."""
    elements = profile_of(context).elements("plane")
    if not len(elements):
        return
    rows = context.children(shapes_of(context).rows, "plane", Rows)
    equations, places = context.vectors(rows, "equation", 4)
    around = context.parent[elements]
    mine, at = pairs_of(context).matched(around, rows.owner)
    _, _, placed, _ = context.shared(Places).whole(around[mine])
    lengths = np.linalg.norm(equations[at, :3], axis=1)
    good = are_numbers(equations[at]) & (lengths > 0.0) & ~placed
    kept = {name: Kept(context, name, width, "plane")
            for name, width in (("normal", 3), ("displacement", 1), ("anchor", 3))}  # fmt: skip
    for each in kept.values():
        good &= ~each.faulty(each.rows(elements[mine]))
    mine, at, lengths = mine[good], at[good], lengths[good]
    poses = shape_poses(context).take(rows.owner[at])
    normals = rotate_vectors(poses.orientations, equations[at, :3] / lengths[:, None])
    away, offsets = (normals * poses.positions).sum(axis=1), equations[at, 3] / lengths
    stated, sizes = (away - offsets)[:, None], np.maximum(np.abs(away), np.abs(offsets))
    told = np.zeros(len(mine), np.bool_)
    found = kept["normal"].rows(elements[mine])
    there = np.flatnonzero(found >= 0)
    values = kept["normal"].values[found[there]]
    sizes_there = np.linalg.norm(values, axis=1)
    apart = reach(values / sizes_there[:, None] - normals[there]) > 10.0 * DIGITS
    told[there] = apart | ~(sizes_there > 0.0)  # one of no length is told elsewhere
    for row in np.flatnonzero(apart & (sizes_there > 0.0)).tolist():
        place = there[row]
        yield old("normal", int(kept["normal"].elements[found[place]]), normals[place],
                  values[row], int(places[at[place]]))  # fmt: skip
    for name in ("displacement", "anchor"):
        found = kept[name].rows(elements[mine])
        there = np.flatnonzero((found >= 0) & ~told)
        values = kept[name].values[found[there]]
        own = values if name == "displacement" else (normals[there] * values).sum(axis=1)[:, None]
        room = np.maximum(sizes[there], reach(values))
        apart = np.abs(own - stated[there])[:, 0] > 10.0 * DIGITS * room
        told[there] = apart
        for row in np.flatnonzero(apart).tolist():
            place = there[row]
            yield old("displacement", int(kept[name].elements[found[place]]), stated[place],
                      own[row], int(places[at[place]]))  # fmt: skip


def masses(context: Context) -> Iterator[Hit]:
    """Masses of shapes."""
    elements, around, values = profile_of(context).values("mass", 1, "shape")
    if not len(elements):
        return
    stated, places = context.vectors(shapes_of(context).rows, "mass", 1)
    mine, at = pairs_of(context).matched(around)
    stated, values, places = stated[at], values[mine], places[at]
    among = (places >= 0) & (np.minimum(stated, values)[:, 0] >= 0.0)
    yield from differing("mass", elements[mine], stated, values, places, among)


def members(context: Context) -> Iterator[Hit]:
    """Where shapes stand in their unions and bodies."""
    places = context.shared(Places)
    elements = profile_of(context).elements("shape")
    elements = elements[places.are_told(elements)]
    if not len(elements):
        return
    shapes = shapes_of(context)
    mine, rows = pairs_of(context).matched(elements)
    odd = np.zeros(len(shapes.elements), np.bool_)
    odd[shapes.mesh_rows] = True
    odd[context.children(shapes.rows, "plane", Rows).owner] = True
    if unclear := unclear_nodes(context):
        odd |= are_among(shapes.elements, unclear)
    mine, rows = mine[~odd[rows]], rows[~odd[rows]]
    elements = elements[mine]
    kept, sizes, _, good = places.whole(elements)
    stated = shape_poses(context).take(rows)
    apart = reach(kept.positions - stated.positions)
    sizes = np.maximum(sizes, reach(stated.positions))
    at = places.positions.rows(elements)
    moved = good & (at >= 0) & (apart > 10.0 * DIGITS * sizes)
    above = context.parent[elements]
    together: dict[int, list[int]] = {}
    for row in np.flatnonzero(moved).tolist():
        together.setdefault(int(above[row]), []).append(row)
    members = Counter(above.tolist()) if together else {}
    for union, found in together.items():
        own = int(places.positions.rows(np.array([union]))[0])
        if own >= 0 and 1 < len(found) == members[union]:  # it is the union that stands elsewhere
            message = f"All {len(found)} members stand elsewhere in the common profile."
            yield Hit(profile_rules.OLD_VALUE, int(places.positions.elements[own]), message,
                      tuple(shapes.elements[rows[found[:3]]].tolist()))  # fmt: skip
            continue
        for row in found:
            yield old("position", int(places.positions.elements[at[row]]), stated.positions[row],
                      kept.positions[row], int(shapes.elements[rows[row]]))  # fmt: skip
    at = places.orientations.rows(elements)
    turned = good & ~moved & (at >= 0)
    turned[turned] = places.orientations.values[at[turned]].any(axis=1)
    one, other = turn_rods(context, rows, stated).orientations, kept.orientations
    turned &= np.minimum(reach(one - other), reach(one + other)) > TURN
    for row in np.flatnonzero(turned).tolist():
        yield old("orientation", int(places.orientations.elements[at[row]]), one[row], other[row],
                  int(shapes.elements[rows[row]]))  # fmt: skip


def springs(context: Context) -> Iterator[Hit]:
    """Springs of joints."""
    profile = profile_of(context)
    rows = context.rows(Rows, "rigid_constraint")
    assert rows.ordinals is not None
    common = context.children(rows, "technique_common", Rows)
    outer = context.children(common, "spring", Rows)
    for kind, angular in (("linear_spring", False), ("angular_spring", True)):
        elements = profile.elements(kind)
        if not len(elements):
            continue
        what = kind.replace("_", " ")
        found = context.children(outer, kind.partition("_")[0], Rows)
        own = common.owner[outer.owner[found.owner]]
        mine, at = matched(rows.ordinals, profile.holders(elements))
        alone = ~are_among(at, own)
        for element, row in zip(elements[mine[alone]].tolist(), at[alone].tolist(), strict=True):
            message = f"The {what} of the pe profile is not in the common profile."
            holder = int(rows.ordinals[row])
            yield Hit(profile_rules.OLD_VALUE, element, message, (holder,))
        told = elements[mine[alone]]
        for name, default, factor in (
            ("stiffness", 1.0, 1.0 / DEGREE), ("damping", 0.0, 1.0 / DEGREE),
            ("target_value", 0.0, DEGREE),
        ):  # fmt: skip
            stated, places = context.vectors(found, name, 1, default)
            stated[places < 0] = default
            stated *= factor if angular else 1.0
            kept, around, values = profile.values(name, 1, kind)
            holders = profile.holders(kept)
            mine, at = matched(rows.ordinals[own], holders)
            others = np.where(places[at] >= 0, places[at], holders[mine])
            among = ~are_among(around[mine], told) & (np.abs(values[mine])[:, 0] <= 1e300)
            name_of = f"{name.replace('_', ' ')} of the {what}"
            hits = list(differing(name_of, kept[mine], stated[at], values[mine], others, among))
            elements = np.array([hit.element for hit in hits], np.int64)
            told = np.concatenate([told, context.parent[elements]])
            yield from hits


def frames(context: Context) -> Iterator[Hit]:
    """Frames of joints in their bodies."""
    profile = profile_of(context)
    if not len(profile.elements("joint")):
        return
    table, shapes, unclear = constraints_of(context), shapes_of(context), unclear_nodes(context)
    flat = shapes.holders[context.children(shapes.rows, "plane", Rows).owner]
    for side, name in enumerate(("frame1", "frame2")):
        elements = profile.elements(name)
        mine, rows = matched(table.elements, profile.holders(elements))
        attachments = table.attachments[rows, side]
        # Of a plane, the frame is in the pose of its normal.
        good = (attachments >= 0) & ~are_among(table.bodies[rows, side], flat)
        good &= ~are_among(attachments, unclear)
        places = Kept(context, "position", 3, name)
        turns = Kept(context, "orientation", 4, name)
        for each in (places, turns):
            good &= ~each.faulty(each.rows(elements[mine]))
        own, attachments = elements[mine[good]], attachments[good]
        stated = table.frames[side].take(rows[good])
        at = places.rows(own)
        some = np.flatnonzero(at >= 0)
        moved = np.zeros(len(own), np.bool_)
        moved[some] = ~same(stated.positions[some], places.values[at[some]])
        for row in np.flatnonzero(moved).tolist():
            yield old("position of the frame", int(places.elements[at[row]]),
                      stated.positions[row], places.values[at[row]],
                      int(attachments[row]))  # fmt: skip
        at = turns.rows(own)
        some = np.flatnonzero((at >= 0) & ~moved)
        given, one = turns.values[at[some]], stated.orientations[some]
        units = unit_quaternions(given)
        apart = np.minimum(reach(units - one), reach(units + one)) > TURN
        for row in np.flatnonzero(apart & given.any(axis=1)).tolist():
            yield old("orientation of the frame", int(turns.elements[at[some[row]]]), one[row],
                      given[row], int(attachments[some[row]]))  # fmt: skip


CHECKS = (planes, masses, members, springs, frames)

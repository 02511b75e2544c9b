"""Values of the pe profile about planes, members of unions and joints that were left behind.

As in `staleness`: what the common profile says now is compared with what the profile keeps.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import DEGREE, Poses, reach, rotate_vectors, unit_quaternions
from colladaphy.links.steps import Steps, poses_of_steps
from colladaphy.meaning.constraint_table import AttachmentRows, constraints_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import unclear_nodes
from colladaphy.meaning.profile_table import Profile, profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy.meaning.staleness import DIGITS, TURN, is_told, old, paired, rods, same
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


def planes(context: Context) -> Iterator[Hit]:
    """Normals, displacements and anchors of planes that stand where their shapes do."""
    profile = profile_of(context)
    elements = profile.elements("plane")
    if not len(elements):
        return
    shapes, pairs = shapes_of(context), paired(context, profile)
    rows = context.children(shapes.rows, "plane", Rows)
    equations, places = context.vectors(rows, "equation", 4)
    at = dict(zip(shapes.elements[rows.owner].tolist(), range(len(rows)), strict=True))
    poses = _shape_poses(context)
    values = {name: _by_parent(profile, name, width, "plane")
              for name, width in (("normal", 3), ("displacement", 1), ("anchor", 3))}  # fmt: skip
    for plane, shape in zip(elements.tolist(), context.parent[elements].tolist(), strict=True):
        row = at.get(pairs.get(shape, -1), -1)
        if row < 0 or _is_placed(profile, shape):
            continue
        equation, length = equations[row], float(np.linalg.norm(equations[row, :3]))
        kept = {name: found[plane] for name, found in values.items() if plane in found}
        if is_told(equation, *(value for _, value in kept.values())) or not length > 0.0:
            continue
        pose = poses.take(np.array([rows.owner[row]]))
        normal = rotate_vectors(pose.orientations, equation[None, :3] / length)[0]
        away = float(normal @ pose.positions[0])
        stated = np.array([away - equation[3] / length])
        place = int(places[row])
        if "normal" in kept:
            element, value = kept["normal"]
            size = float(np.linalg.norm(value))
            if not size > 0.0:
                continue
            if float(np.abs(value / size - normal).max()) > 10.0 * DIGITS:
                yield old("normal", element, normal, value, place)
                continue
        size = max(abs(away), abs(equation[3] / length))
        for name in ("displacement", "anchor"):
            if name not in kept:
                continue
            element, value = kept[name]
            mine = value if name == "displacement" else np.array([normal @ value])
            room = max(size, float(np.abs(value).max()))
            if float(np.abs(mine - stated).max()) > 10.0 * DIGITS * room:
                yield old("displacement", element, stated, mine, place)
                break


def members(context: Context) -> Iterator[Hit]:
    """Masses of shapes, and where members of unions stand."""
    profile = profile_of(context)
    kept, around, values = profile.values("mass", 1, "shape")
    if len(kept):
        shapes, pairs = shapes_of(context), paired(context, profile)
        stated, places = context.vectors(shapes.rows, "mass", 1)
        at = {element: row for row, element in enumerate(shapes.elements.tolist())}
        for element, shape, value in zip(kept.tolist(), around.tolist(), values, strict=True):
            row = at.get(pairs.get(shape, -1), -1)
            if row < 0 or places[row] < 0 or is_told(stated[row], value):
                continue
            if min(value[0], stated[row, 0]) >= 0.0 and not same(stated[row], value):
                yield old("mass", element, stated[row], value, int(places[row]))
    yield from _poses(context, profile)


def _poses(context: Context, profile: Profile) -> Iterator[Hit]:
    places = _by_parent(profile, "position", 3, "shape", "union")
    turns = _by_parent(profile, "orientation", 4, "shape", "union")
    if not places and not turns:
        return
    shapes, pairs = shapes_of(context), paired(context, profile)
    at = {element: row for row, element in enumerate(shapes.elements.tolist())}
    odd = {row for row, _ in shapes.meshes()}
    odd.update(context.children(shapes.rows, "plane", Rows).owner.tolist())
    unclear = unclear_nodes(context)
    stated, turned = _shape_poses(context), rods(context)
    faulty = _faulty(places) | _faulty(turns)
    chosen, rows, chains = [], [], []
    for shape in profile.elements("shape").tolist():
        row = at.get(pairs.get(shape, -1), -1)
        if row < 0 or row in odd or pairs[shape] in unclear:
            continue
        chain = _chain(context, shape)
        if (shape in places or shape in turns) and faulty.isdisjoint(chain):
            chosen.append(shape)
            rows.append(row)
            chains.append(chain)
    if not chosen:
        return
    kept, sizes = _composed(chains, places, turns)
    mine = stated.take(np.array(rows))
    apart = reach(kept.positions - mine.positions)
    sizes = np.maximum(sizes, reach(mine.positions))
    moved = np.array([shape in places for shape in chosen]) & (apart > 10.0 * DIGITS * sizes)
    one, other = turned(np.array(rows), mine).orientations, kept.orientations
    far = np.minimum(reach(one - other), reach(one + other)) > TURN
    for place in np.flatnonzero(moved | far).tolist():
        shape, element = chosen[place], int(shapes.elements[rows[place]])
        if moved[place]:
            yield old("position", places[shape][0], mine.positions[place], kept.positions[place],
                      element)  # fmt: skip
        elif shape in turns and turns[shape][1].any():
            yield old("orientation", turns[shape][0], one[place], other[place], element)


def _composed(
    chains: list[list[int]], places: dict[int, tuple[int, Any]], turns: dict[int, tuple[int, Any]]
) -> tuple[Poses, Any]:
    """Where the innermost of chains stand, and the largest numbers (n,) that say so."""
    made, sizes = Poses.none(len(chains)), np.zeros(len(chains))
    for depth in range(max(map(len, chains)) - 1, -1, -1):
        rows = np.flatnonzero([len(chain) > depth for chain in chains])
        step = _poses_in([chains[row][depth] for row in rows.tolist()], places, turns)
        made.put(rows, made.take(rows).then(step))
        sizes[rows] = np.maximum(sizes[rows], reach(step.positions))
    return made, sizes


def springs(context: Context) -> Iterator[Hit]:
    """Springs of joints."""
    profile = profile_of(context)
    rows = context.rows(Rows, "rigid_constraint")
    assert rows.ordinals is not None
    at = {element: row for row, element in enumerate(rows.ordinals.tolist())}
    common = context.children(rows, "technique_common", Rows)
    outer = context.children(common, "spring", Rows)
    for kind, angular in (("linear_spring", False), ("angular_spring", True)):
        elements = profile.elements(kind)
        if not len(elements):
            continue
        found = context.children(outer, kind.partition("_")[0], Rows)
        own = dict(
            zip(common.owner[outer.owner[found.owner]].tolist(), range(len(found)), strict=True)
        )
        told: set[int] = set()
        what = kind.replace("_", " ")
        for element, holder in zip(
            elements.tolist(), profile.holders(elements).tolist(), strict=True
        ):
            if at.get(holder, -1) >= 0 and at[holder] not in own:
                told.add(element)
                message = f"The {what} of the pe profile is not in the common profile."
                hit = old(what, element, np.zeros(0), np.zeros(0), holder)
                yield Hit(hit.rule, element, message, (holder,))
        for name, default, factor in (
            ("stiffness", 1.0, 1.0 / DEGREE), ("damping", 0.0, 1.0 / DEGREE),
            ("target_value", 0.0, DEGREE),
        ):  # fmt: skip
            stated, places = context.vectors(found, name, 1)
            stated[places < 0] = default
            stated *= factor if angular else 1.0
            kept, around, values = profile.values(name, 1, kind)
            holders = profile.holders(kept).tolist()
            for element, group, value, holder in zip(
                kept.tolist(), around.tolist(), values, holders, strict=True
            ):
                row = own.get(at.get(holder, -1), -1)
                if row < 0 or group in told or is_told(stated[row], value):
                    continue
                if np.abs(value).max() > 1e300 or same(stated[row], value):
                    continue
                told.add(group)
                other = int(places[row]) if places[row] >= 0 else holder
                name_of = f"{name.replace('_', ' ')} of the {what}"
                yield old(name_of, element, stated[row], value, other)


def frames(context: Context) -> Iterator[Hit]:
    """Frames of joints in their bodies."""
    profile = profile_of(context)
    if not len(profile.elements("joint")):
        return
    table, unclear = constraints_of(context), unclear_nodes(context)
    at = {element: row for row, element in enumerate(table.elements.tolist())}
    shapes = shapes_of(context)
    flat = set(shapes.holders[context.children(shapes.rows, "plane", Rows).owner].tolist())
    for side, name in enumerate(("frame1", "frame2")):
        places = _by_parent(profile, "position", 3, name)
        turns = _by_parent(profile, "orientation", 4, name)
        elements = profile.elements(name)
        for frame, holder in zip(
            elements.tolist(), profile.holders(elements).tolist(), strict=True
        ):
            row = at.get(holder, -1)
            attachment = -1 if row < 0 else int(table.attachments[row, side])
            told = [each[frame][1] for each in (places, turns) if frame in each]
            if row >= 0 and int(table.bodies[row, side]) in flat:
                continue  # of a plane, the frame is in the pose of its normal
            if row < 0 or attachment < 0 or attachment in unclear or is_told(*told):
                continue
            stated = table.frames[side].take(np.array([row]))
            if frame in places and not same(stated.positions[0], places[frame][1]):
                yield old("position of the frame", places[frame][0], stated.positions[0],
                          places[frame][1], attachment)  # fmt: skip
            elif frame in turns and turns[frame][1].any():
                one = stated.orientations[0]
                other = unit_quaternions(turns[frame][1][None])[0]
                if min(np.abs(one - other).max(), np.abs(one + other).max()) > TURN:
                    yield old("orientation of the frame", turns[frame][0], one, turns[frame][1],
                              attachment)  # fmt: skip


def _shape_poses(context: Context) -> Poses:
    """Where shapes stand in their bodies (n,)."""
    shapes = shapes_of(context)
    return poses_of_steps(Steps.of(context.at(AttachmentRows, shapes.elements)))


def _by_parent(profile: Profile, name: str, width: int, *outer: str) -> dict[int, tuple[int, Any]]:
    """Elements with the numbers in them, by what they stand in."""
    kept, around, values = profile.values(name, width, *outer)
    return {
        parent: (element, value)
        for parent, element, value in zip(around.tolist(), kept.tolist(), values, strict=True)
    }


def _faulty(told: dict[int, tuple[int, Any]]) -> set[int]:
    """What holds numbers that are none, which is told elsewhere."""
    if not told:
        return set()
    fine = np.isfinite(np.array([value for _, value in told.values()])).all(axis=1)
    return {one for one, good in zip(told, fine.tolist(), strict=True) if not good}


def _unions(context: Context) -> set[int]:
    return set(profile_of(context).elements("union").tolist())


def _chain(context: Context, shape: int) -> list[int]:
    """A shape of the profile and the unions around it, outwards."""
    unions, found = context.shared(_unions), [shape]
    while (above := int(context.parent[found[-1]])) in unions:
        found.append(above)
    return found


def _is_placed(profile: Profile, shape: int) -> bool:
    """Whether the profile says of a shape, or of unions around it, where they stand."""
    return any(
        profile.child(one, name) >= 0
        for one in _chain(profile.context, shape)
        for name in ("position", "orientation")
    )


def _poses_in(
    elements: list[int], places: dict[int, tuple[int, Any]], turns: dict[int, tuple[int, Any]]
) -> Poses:
    """Where elements stand in the next one around them (n,)."""
    made = Poses.none(len(elements))
    moved = [row for row, element in enumerate(elements) if element in places]
    if moved:
        made.positions[moved] = [places[elements[row]][1] for row in moved]
        made.moved[moved] = True
    turned = [row for row, element in enumerate(elements) if element in turns]
    if turned:
        given = np.array([turns[elements[row]][1] for row in turned])
        some = given.any(axis=1)  # what is all zero is no turn
        rows = np.array(turned)[some]
        made.orientations[rows], made.turned[rows] = unit_quaternions(given[some]), True
    return made


CHECKS = (planes, members, springs, frames)

"""Values of the pe profile that the common profile has left behind (thesis 6.2.1).

Software that does not know the profile keeps it and edits the common values. Loading takes the
newer ones; here the difference is told. Values that agree to six digits are the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import DEGREE, Poses, quaternion_product, unit_quaternions
from colladaphy.links.steps import Steps, poses_of_steps
from colladaphy.meaning import profile_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.constraint_table import AttachmentRows, limits_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import nodes_of, unclear_nodes
from colladaphy.meaning.profile_table import Profile, profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


_DIGITS = 6e-6
_TURN = 1e-4
_ROD = np.array([[math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]])
"""Turns the profile's axis x of capsules and cylinders onto COLLADA's y."""
_SIZES = (
    ("sphere", "radius", "sphere", "radius", 1, 1.0),
    ("box", "lengths", "box", "half_extents", 3, 2.0),
    ("capsule", "length", "capsule", "height", 1, 1.0),
    ("cylinder", "length", "cylinder", "height", 1, 1.0),
)


def _same(one: Array, other: Array) -> bool:
    if np.isnan(one).any() or np.isnan(other).any():
        return True  # told elsewhere
    # Of the largest numbers the common profile says only that they are large.
    large = (np.minimum(np.abs(one), np.abs(other)) > 1e300) & (np.sign(one) == np.sign(other))
    one, other = np.where(large, 0.0, one), np.where(large, 0.0, other)
    scale = np.maximum(np.abs(one), np.abs(other)).max(initial=0.0)
    close = (np.abs(one - other) <= _DIGITS * scale) & np.isfinite(one) & np.isfinite(other)
    return bool(np.all(close | (one == other)))


def _is_told(*values: Array) -> bool:
    """Whether a value is no number that there can be, which is told elsewhere."""
    return not all(bool(np.isfinite(each).all()) for each in values)


def _hit(what: str, element: int, stated: Array, kept: Array, other: int) -> Hit:
    one, two = (" ".join(f"{value:g}" for value in values.tolist()) for values in (stated, kept))
    message = f"The {what} is {one} in the common profile, {two} in the pe profile."
    return Hit(profile_rules.OLD_VALUE, element, message, (other,))


def masses(context: Context) -> Iterator[Hit]:
    """Masses of bodies."""
    profile, bodies = profile_of(context), bodies_of(context)
    kept, _, values = profile.values("mass", 1, "body")
    for element, holder, value in zip(
        kept.tolist(), profile.holders(kept).tolist(), values, strict=True
    ):
        row = bodies.row(holder)
        if row < 0 or bodies.mass_elements[row] < 0:
            continue
        stated = bodies.masses[row : row + 1]
        if value[0] < 0.0 or not stated[0] >= 0.0 or _is_told(stated, value):
            continue
        if not _same(stated, value):
            yield _hit("mass", element, stated, value, int(bodies.mass_elements[row]))


def sizes(context: Context) -> Iterator[Hit]:
    """Sizes of shapes; the shapes of the profile stand for those of the body, in their order."""
    profile = profile_of(context)
    pairs: dict[int, int] | None = None
    for kind, name, outer, size, width, factor in _SIZES:
        kept, around, values = profile.values(name, width, kind)
        if not len(kept):
            continue
        if pairs is None:
            pairs = _paired(context, profile)
        shapes = shapes_of(context)
        rows = context.children(shapes.rows, outer, Rows)
        stated, elements = context.vectors(rows, size, width)
        at = dict(zip(shapes.elements[rows.owner].tolist(), range(len(rows)), strict=True))
        for place, shape in enumerate(context.parent[around].tolist()):
            row = at.get(pairs.get(shape, -1), -1)
            if row < 0 or not (values[place] > 0.0).all() or not (stated[row] > 0.0).all():
                continue
            if _is_told(stated[row], values[place]):
                continue
            if not _same(stated[row] * factor, values[place]):
                yield _hit(f"{name} of the {kind}", int(kept[place]), stated[row] * factor,
                           values[place], int(elements[row]))  # fmt: skip


def radii(context: Context) -> Iterator[Hit]:
    """Radii of capsules and cylinders, whichever axes they are along."""
    profile = profile_of(context)
    for kind, width in (("capsule", 3), ("cylinder", 2)):
        kept, around, values = profile.values("radii", 3, kind)
        if not len(kept):
            continue
        shapes, pairs = shapes_of(context), _paired(context, profile)
        rows = context.children(shapes.rows, kind, Rows)
        stated, elements = context.vectors(rows, "radius", width)
        at = dict(zip(shapes.elements[rows.owner].tolist(), range(len(rows)), strict=True))
        for place, shape in enumerate(context.parent[around].tolist()):
            row = at.get(pairs.get(shape, -1), -1)
            mine = values[place, 3 - width :]
            if row < 0 or _is_told(stated[row], mine):
                continue
            if not (stated[row] > 0.0).all() or not (mine > 0.0).all():
                continue
            if not _same(np.sort(stated[row]), np.sort(mine)):
                yield _hit(f"radius of the {kind}", int(kept[place]), stated[row], mine,
                           int(elements[row]))  # fmt: skip


def materials(context: Context) -> Iterator[Hit]:
    """Restitution and friction of physics materials."""
    profile = profile_of(context)
    rows = context.rows(Rows, "physics_material")
    assert rows.ordinals is not None
    common = context.children(rows, "technique_common", Rows)
    at = {int(rows.ordinals[owner]): row for row, owner in enumerate(common.owner.tolist())}
    for name, most in (("restitution", 1.0), ("static_friction", np.inf),
                       ("dynamic_friction", np.inf)):  # fmt: skip
        kept, _, values = profile.values(name, 1, "material")
        if not len(kept):
            continue
        stated, places = context.vectors(common, name, 1)
        holders = profile.holders(kept)
        holders = np.where(context.is_named(holders, "extra"), context.parent[holders], holders)
        for element, holder, value in zip(kept.tolist(), holders.tolist(), values, strict=True):
            row = at.get(holder, -1)
            if row < 0 or places[row] < 0 or _is_told(stated[row], value):
                continue
            if 0.0 <= stated[row, 0] <= most and not _same(stated[row], value):
                yield _hit(name.replace("_", " "), element, stated[row], value, int(places[row]))


def _paired(context: Context, profile: Profile) -> dict[int, int]:
    """The shapes of bodies by those of their profiles, where there are as many."""
    own: dict[int, list[int]] = {}
    elements = context.ordinals("shape")
    for element, body in zip(
        elements.tolist(), context.ancestor(elements, "rigid_body").tolist(), strict=True
    ):
        own.setdefault(body, []).append(element)
    kept: dict[int, list[int]] = {}
    inner = profile.elements("shape")
    for element, body in zip(inner.tolist(), profile.holders(inner).tolist(), strict=True):
        kept.setdefault(body, []).append(element)
    return {
        one: other
        for body, mine in own.items()
        if len(mine) == len(kept.get(body, ()))
        for one, other in zip(kept[body], mine, strict=True)
    }


def motions(context: Context) -> Iterator[Hit]:
    """Orientations, positions and velocities of instances."""
    profile = profile_of(context)
    yield from _velocities(context, profile)
    turns, turned, orientations = profile.values("orientation", 4, "motion")
    places, placed, positions = profile.values("position", 3, "motion")
    if not len(turns) and not len(places):
        return
    nodes, unclear = nodes_of(context), unclear_nodes(context)
    elements = np.unique(np.concatenate([turned, placed]))
    holders = profile.holders(elements)
    targets = np.array([nodes.targets.get(holder, -1) for holder in holders.tolist()], np.int64)
    parents = [
        reference.element
        for reference in context.references("parent", "instance_physics_model")
        if reference.text.strip()
    ]
    models = context.ordinals("instance_physics_model")
    nested = models[context.is_within(models, "physics_model")]
    around = context.parent[holders]
    good = (targets >= 0) & ~np.isin(around, parents) & ~np.isin(around, nested)
    if unclear:
        good[good] = [not unclear & set(nodes.chain(node)) for node in targets[good].tolist()]
    elements, holders, targets = elements[good], holders[good], targets[good]
    if not len(elements):
        return
    table = context.placement.nodes
    poses, _ = context.placement.poses(table.rows_of(0, targets))
    inner, single, plane, clear = _inner_poses(context, holders)
    whole = poses.then(inner)
    mine, at = _matched(elements, turned)
    mine, at = (each[np.isfinite(orientations[mine]).all(axis=1)] for each in (mine, at))
    units = unit_quaternions(orientations[mine])
    stated = whole.orientations[at]
    apart = np.minimum(np.abs(units - stated).max(axis=1, initial=0.0),
                       np.abs(units + stated).max(axis=1, initial=0.0))  # fmt: skip
    for row in np.flatnonzero(
        (apart > _TURN) & orientations[mine].any(axis=1) & ~plane[at] & clear[at]
    ).tolist():
        yield _hit("orientation", int(turns[mine[row]]), stated[row], orientations[mine[row]],
                   int(targets[at[row]]))  # fmt: skip
    mine, at = _matched(elements, placed)
    stated = whole.positions[at]
    columns = (positions[mine], stated, inner.positions[at])
    scale = np.max([np.abs(column).max(axis=1, initial=0.0) for column in columns], axis=0)
    apart = np.abs(positions[mine] - stated).max(axis=1, initial=0.0)
    told = ~np.isfinite(positions[mine]).all(axis=1) | ~clear[at]
    for row in np.flatnonzero((apart > 10.0 * _DIGITS * scale) & single[at] & ~told).tolist():
        yield _hit("position", int(places[mine[row]]), stated[row], positions[mine[row]],
                   int(targets[at[row]]))  # fmt: skip


def _matched(elements: Array, wanted: Array) -> tuple[Array, Array]:
    """Places in `wanted` whose element is one of `elements`, ascending, and its place there."""
    if not len(elements):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    at = np.minimum(np.searchsorted(elements, wanted), len(elements) - 1)
    mine = np.flatnonzero(elements[at] == wanted)
    return mine, at[mine]


def _inner_poses(context: Context, instances: Array) -> tuple[Poses, Array, Array, Array]:
    """The frames of Worlds' bodies in their rigid_bodies, whether the place is known, planes.

    The last is of which frames nothing is faulty.

    A body of one shape has the frame of that shape, one of several has its own.
    """
    bodies, shapes = bodies_of(context), shapes_of(context)
    rows = np.searchsorted(bodies.elements, instances)
    body = bodies.body[rows]
    order = np.argsort(shapes.holders, kind="stable")
    holders = shapes.holders[order]
    own = np.searchsorted(holders, rows) < np.searchsorted(holders, rows, side="right")
    inherited = ~own & (body >= 0)
    source = np.where(inherited, body, rows)
    frames = context.ancestor(context.ordinals("mass_frame"), "rigid_body", "instance_rigid_body")
    framed = np.isin(instances, frames)
    framed |= inherited & np.isin(bodies.elements[source], frames)
    begin = np.searchsorted(holders, source)
    single = np.searchsorted(holders, source, side="right") - begin == 1
    made = Poses.none(len(instances))
    known, flat = np.zeros(len(instances), np.bool_), np.zeros(len(instances), np.bool_)
    clear = np.ones(len(instances), np.bool_)
    mine = np.flatnonzero(single)
    shape = order[begin[mine]]
    clear[mine] = ~np.isin(shapes.elements[shape], list(unclear_nodes(context)))
    plane = np.isin(shape, context.children(shapes.rows, "plane", Rows).owner)
    flat[mine[plane]] = True  # turned as its normal says
    mine, shape = mine[~plane], shape[~plane]
    # The body of a mesh stands at its centre of mass.
    meshes = np.array([row for row, _ in shapes.meshes()], np.int64)
    known[mine] = ~framed[mine] & ~np.isin(shape, meshes)
    mine, shape = mine[~framed[mine]], shape[~framed[mine]]
    made.put(
        mine, poses_of_steps(Steps.of(context.at(AttachmentRows, shapes.elements))).take(shape)
    )
    rods = np.zeros(len(shapes.elements), np.bool_)
    for name in ("capsule", "cylinder"):
        found = context.children(shapes.rows, name, Rows)
        height, _ = context.scalars(found, "height")
        rods[found.owner] = height != 0.0
    turning = mine[rods[shape]]
    if len(turning):
        pose = made.take(turning)
        turn = quaternion_product(pose.orientations, np.broadcast_to(_ROD, (len(turning), 4)))
        made.put(turning, Poses.of(len(turning), pose.positions, turn, moved=pose.moved))
    return made, known, flat, clear


def _velocities(context: Context, profile: Profile) -> Iterator[Hit]:
    instances = context.rows(Rows, "instance_rigid_body")
    common = context.children(instances, "technique_common", Rows)
    assert instances.ordinals is not None
    for name, other, factor in (
        ("linear_velocity", "velocity", 1.0), ("angular_velocity", "angular_velocity", DEGREE),
    ):  # fmt: skip
        kept, _, values = profile.values(name, 3, "motion")
        if not len(kept):
            continue
        stated, places = context.vectors(common, other, 3)
        mine, at = _matched(instances.ordinals[common.owner], profile.holders(kept))
        one, two = stated[at] * factor, values[mine]
        scale = np.maximum(np.abs(one), np.abs(two)).max(axis=1, initial=0.0)
        apart = np.abs(one - two).max(axis=1, initial=0.0) > _DIGITS * scale
        apart &= scale < 1e300  # of the largest, the common profile says only that they are large
        for row in np.flatnonzero(apart & (places[at] >= 0)).tolist():
            yield _hit(name.replace("_", " "), int(kept[mine[row]]), one[row], two[row],
                       int(places[at[row]]))  # fmt: skip


def limits(context: Context) -> Iterator[Hit]:
    """Limits of joints."""
    profile = profile_of(context)
    constraints = context.rows(Rows, "rigid_constraint")
    assert constraints.ordinals is not None
    at = {element: row for row, element in enumerate(constraints.ordinals.tolist())}
    for name, other, factor in (
        ("linear_limits", "linear", 1.0), ("angular_limits", "swing_cone_and_twist", DEGREE),
    ):  # fmt: skip
        for part, stated in zip(("min", "max"), limits_of(context, other), strict=True):
            kept, _, values = profile.values(part, 3, name)
            others = profile.values("max" if part == "min" else "min", 3, name)[2]
            beyond = values > others if part == "min" else values < others
            wrong = np.asarray(beyond.any(axis=1))
            for element, holder, value, told in zip(
                kept.tolist(), profile.holders(kept).tolist(), values, wrong.tolist(), strict=True
            ):
                row = at.get(holder, -1)
                if row >= 0 and not told and not _same(stated[row] * factor, value):
                    what = f"{part} of the {name.replace('_', ' ')}"
                    yield _hit(what, element, stated[row] * factor, value, holder)


def worlds(context: Context) -> Iterator[Hit]:
    """Gravity and time step of scenes."""
    profile = profile_of(context)
    elements = profile.elements("world")
    if not len(elements):
        return
    rows = context.rows(Rows, "physics_scene")
    common = context.children(rows, "technique_common", Rows)
    assert rows.ordinals is not None
    at = {int(rows.ordinals[owner]): row for row, owner in enumerate(common.owner.tolist())}
    for name, width in (("gravity", 3), ("time_step", 1)):
        stated, places = context.vectors(common, name, width)
        kept, _, values = profile.values(name, width, "world")
        for element, holder, value in zip(
            kept.tolist(), profile.holders(kept).tolist(), values, strict=True
        ):
            row = at.get(holder, -1)
            if row < 0 or places[row] < 0 or _is_told(stated[row], value):
                continue
            if name == "time_step" and not stated[row, 0] > 0.0:
                continue
            if not _same(stated[row], value):
                yield _hit(name.replace("_", " "), element, stated[row], value, int(places[row]))


CHECKS = (masses, sizes, radii, materials, motions, limits, worlds)

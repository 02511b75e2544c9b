"""Values of the pe profile that the common profile has left behind (thesis 6.2.1).

Software that does not know the profile keeps it and edits the common values. Loading takes the
newer ones; here the difference is told. Values that agree to six digits are the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import p
from colladaphy.links.poses import DEGREE, Poses, quaternion_product, reach
from colladaphy.meaning import profile_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.constraint_table import limits_of
from colladaphy.meaning.context import Context, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.profile_table import Profile, profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "DIGITS", "TURN", "is_told", "old", "paired", "rods", "same"]

Array = NDArray[Any]


DIGITS = 6e-6
TURN = 1e-4
_ROD = np.array([[math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]])
"""Turns the profile's axis x of capsules and cylinders onto COLLADA's y."""
_KINDS = ("sphere", "box", "capsule", "cylinder", "plane")
_SIZES = (
    ("sphere", "radius", "sphere", "radius", 1, 1.0),
    ("box", "lengths", "box", "half_extents", 3, 2.0),
    ("capsule", "length", "capsule", "height", 1, 1.0),
    ("cylinder", "length", "cylinder", "height", 1, 1.0),
)


def same(one: Array, other: Array) -> bool:
    """Whether two values agree to six digits."""
    if np.isnan(one).any() or np.isnan(other).any():
        return True  # told elsewhere
    # Of the largest numbers the common profile says only that they are large.
    large = (np.minimum(np.abs(one), np.abs(other)) > 1e300) & (np.sign(one) == np.sign(other))
    one, other = np.where(large, 0.0, one), np.where(large, 0.0, other)
    scale = np.maximum(np.abs(one), np.abs(other)).max(initial=0.0)
    if scale < 1e-300:
        return True  # the tiniest doubles have few bits
    close = (np.abs(one - other) <= DIGITS * scale) & np.isfinite(one) & np.isfinite(other)
    return bool(np.all(close | (one == other)))


def is_told(*values: Array) -> bool:
    """Whether a value is no number that there can be, which is told elsewhere."""
    return not all(bool(np.isfinite(each).all()) for each in values)


def old(what: str, element: int, stated: Array, kept: Array, other: int) -> Hit:
    """What to say of a value that was left behind."""
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
        if row < 0:
            continue
        stated, other = bodies.masses[row : row + 1], int(bodies.mass_elements[row])
        if other < 0:
            stated, other = context.shared(_masses_of_shapes)[row : row + 1], holder
        if value[0] < 0.0 or not stated[0] >= 0.0 or is_told(stated, value):
            continue
        if not same(stated, value):
            yield old("mass", element, stated, value, other)


def _masses_of_shapes(context: Context) -> Array:
    """The masses of bodies (n,) by their shapes; NaN where one is silent, or there is none."""
    shapes, count = shapes_of(context), len(bodies_of(context).elements)
    masses, _ = context.vectors(shapes.rows, "mass", 1)
    held = shapes.holders >= 0
    sums = np.bincount(shapes.holders[held], masses[held, 0], minlength=count)
    sums[np.bincount(shapes.holders[held], minlength=count) == 0] = np.nan
    return sums


def inertias(context: Context) -> Iterator[Hit]:
    """Principal moments of inertia of bodies, whichever axes they are about."""
    profile, bodies = profile_of(context), bodies_of(context)
    kept, _, values = profile.values("inertia", 9, "body")
    if not len(kept) or not len(bodies.elements):
        return
    holders = profile.holders(kept)
    rows = np.minimum(np.searchsorted(bodies.elements, holders), len(bodies.elements) - 1)
    stated, sizes = np.sort(bodies.inertias[rows], axis=1), reach(values)
    good = (bodies.elements[rows] == holders) & (bodies.inertia_elements[rows] >= 0)
    good &= np.isfinite(stated).all(axis=1) & (stated > 0.0).all(axis=1)
    good &= np.isfinite(sizes) & (sizes > 0.0)
    mine = np.flatnonzero(good)
    # So that the largest do not overflow.
    tensors = (values[mine] / sizes[mine, None]).reshape(-1, 3, 3)
    moments = np.linalg.eigvalsh((tensors + tensors.transpose(0, 2, 1)) / 2.0)
    stated = stated[mine] / sizes[mine, None]
    told = ~(moments > 0.0).all(axis=1)  # elsewhere
    told |= moments[:, 0] + moments[:, 1] < moments[:, 2] * (1.0 - 1e-3)
    apart = reach(moments - stated) > 10.0 * DIGITS * moments[:, 2]
    for place in np.flatnonzero(apart & ~told).tolist():
        at = mine[place]
        yield old("inertia", int(kept[at]), stated[place] * sizes[at], moments[place] * sizes[at],
                  int(bodies.inertia_elements[rows[at]]))  # fmt: skip


def fixed(context: Context) -> Iterator[Hit]:
    """Whether bodies can move."""
    profile, bodies = profile_of(context), bodies_of(context)
    kept = profile.elements("fixed")
    bodies_kept = context.columns.codes_of(p("body"))
    kept = kept[np.isin(context.columns.index.codes[context.parent[kept]], bodies_kept)]
    words = context.at(TextRows, kept).value if len(kept) else []
    for element, holder, word in zip(
        kept.tolist(), profile.holders(kept).tolist(), words, strict=True
    ):
        row = bodies.row(holder)
        if row < 0 or bodies.moves[row] != (word.strip() in ("true", "1")):
            continue
        message = "The body moves in the common profile, and is fixed in the pe profile."
        if not bodies.moves[row]:
            message = "The body is not dynamic in the common profile, and moves in the pe profile."
        yield Hit(profile_rules.OLD_VALUE, element, message, (holder,))


def kinds(context: Context) -> Iterator[Hit]:
    """Shapes that are others now."""
    profile, pairs = profile_of(context), None
    known: dict[int, str] = {}
    for kind in _KINDS:
        elements = profile.elements(kind)
        if not len(elements):
            continue
        if pairs is None:
            pairs, shapes = paired(context, profile), shapes_of(context)
            for name in _KINDS:
                found = context.children(shapes.rows, name, Rows)
                known.update(dict.fromkeys(shapes.elements[found.owner].tolist(), name))
        for element, shape in zip(
            elements.tolist(), context.parent[elements].tolist(), strict=True
        ):
            now = known.get(pairs.get(shape, -1), kind)
            # A sphere may be written as a capsule without a length.
            if now != kind and {now, kind} != {"sphere", "capsule"}:
                message = f"The shape is a {now} in the common profile, a {kind} in the pe profile."
                yield Hit(profile_rules.OLD_VALUE, element, message, (pairs[shape],))


def sizes(context: Context) -> Iterator[Hit]:
    """Sizes of shapes; the shapes of the profile stand for those of the body, in their order."""
    profile = profile_of(context)
    pairs: dict[int, int] | None = None
    for kind, name, outer, size, width, factor in _SIZES:
        kept, around, values = profile.values(name, width, kind)
        if not len(kept):
            continue
        if pairs is None:
            pairs = paired(context, profile)
        shapes = shapes_of(context)
        rows = context.children(shapes.rows, outer, Rows)
        stated, elements = context.vectors(rows, size, width)
        at = dict(zip(shapes.elements[rows.owner].tolist(), range(len(rows)), strict=True))
        for place, shape in enumerate(context.parent[around].tolist()):
            row = at.get(pairs.get(shape, -1), -1)
            if row < 0 or not (values[place] > 0.0).all() or not (stated[row] > 0.0).all():
                continue
            if is_told(stated[row], values[place]):
                continue
            if not same(stated[row] * factor, values[place]):
                yield old(f"{name} of the {kind}", int(kept[place]), stated[row] * factor,
                           values[place], int(elements[row]))  # fmt: skip


def radii(context: Context) -> Iterator[Hit]:
    """Radii of capsules and cylinders, whichever axes they are along."""
    profile = profile_of(context)
    for kind, width, name in (("capsule", 3, "radii"), ("cylinder", 2, "radii"),
                              ("capsule", 3, "radius"), ("cylinder", 2, "radius")):  # fmt: skip
        kept, around, values = profile.values(name, 1 if name == "radius" else 3, kind)
        if not len(kept):
            continue
        values = np.broadcast_to(values, (len(kept), 3))
        shapes, pairs = shapes_of(context), paired(context, profile)
        rows = context.children(shapes.rows, kind, Rows)
        stated, elements = context.vectors(rows, "radius", width)
        at = dict(zip(shapes.elements[rows.owner].tolist(), range(len(rows)), strict=True))
        for place, shape in enumerate(context.parent[around].tolist()):
            row = at.get(pairs.get(shape, -1), -1)
            mine = values[place, 3 - width :]
            if row < 0 or is_told(stated[row], mine):
                continue
            if not (stated[row] > 0.0).all() or not (mine > 0.0).all():
                continue
            if not same(np.sort(stated[row]), np.sort(mine)):
                yield old(f"radius of the {kind}", int(kept[place]), stated[row], mine,
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
            if row < 0 or places[row] < 0 or is_told(stated[row], value):
                continue
            if 0.0 <= stated[row, 0] <= most and not same(stated[row], value):
                yield old(name.replace("_", " "), element, stated[row], value, int(places[row]))


def paired(context: Context, profile: Profile) -> dict[int, int]:
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


def rods(context: Context) -> Callable[[Array, Poses], Poses]:
    """What turns the poses of some shapes to the profile's axes, where they are long."""
    shapes = shapes_of(context)
    long = np.zeros(len(shapes.elements), np.bool_)
    for name in ("capsule", "cylinder"):
        found = context.children(shapes.rows, name, Rows)
        height, _ = context.scalars(found, "height")
        long[found.owner] = height != 0.0

    def turned(rows: Array, poses: Poses) -> Poses:
        turning = np.flatnonzero(long[rows])
        if len(turning):
            pose = poses.take(turning)
            turn = quaternion_product(pose.orientations, np.broadcast_to(_ROD, (len(turning), 4)))
            poses.put(turning, Poses.of(len(turning), pose.positions, turn, moved=pose.moved))
        return poses

    return turned


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
                if row >= 0 and not told and not same(stated[row] * factor, value):
                    what = f"{part} of the {name.replace('_', ' ')}"
                    yield old(what, element, stated[row] * factor, value, holder)


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
            if row < 0 or places[row] < 0 or is_told(stated[row], value):
                continue
            if name == "time_step" and not min(stated[row, 0], value[0]) > 0.0:
                continue
            if not same(stated[row], value):
                yield old(name.replace("_", " "), element, stated[row], value, int(places[row]))


CHECKS = (masses, inertias, fixed, kinds, sizes, radii, materials, limits, worlds)

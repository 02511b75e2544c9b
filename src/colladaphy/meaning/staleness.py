"""Values of the pe profile that the common profile has left behind (thesis 6.2.1).

Software that does not know the profile keeps it and edits the common values. Loading takes the
newer ones; here the difference is told.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.names import p
from colladaphy.links.poses import DEGREE, reach
from colladaphy.meaning import profile_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.comparing import DIGITS, differing, matched, old, same
from colladaphy.meaning.constraint_table import limits_of
from colladaphy.meaning.context import Context, TextRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.profile_shapes import pairs_of
from colladaphy.meaning.profile_table import profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS", "old_limits"]

Array = NDArray[Any]

_KINDS = ("sphere", "box", "capsule", "cylinder", "plane")
_SIZES = (
    ("sphere", "radius", "sphere", "radius", 1, 1.0),
    ("box", "lengths", "box", "half_extents", 3, 2.0),
    ("capsule", "length", "capsule", "height", 1, 1.0),
    ("cylinder", "length", "cylinder", "height", 1, 1.0),
)


def masses(context: Context) -> Iterator[Hit]:
    """Masses of bodies."""
    profile, bodies = profile_of(context), bodies_of(context)
    kept, _, values = profile.values("mass", 1, "body")
    holders = profile.holders(kept)
    mine, rows = matched(bodies.elements, holders)
    stated, others = bodies.masses[rows], bodies.mass_elements[rows]
    if (others < 0).any():
        # A mass that is the sum of what the profile has for the shapes is compared there.
        parts, _, masses_of_parts = profile.values("mass", 1, "shape")
        held, at = matched(bodies.elements, profile.holders(parts))
        sums = np.bincount(at, masses_of_parts[held, 0], minlength=len(bodies.elements))[rows]
        silent = (others < 0) & ~((sums > 0.0) & same(sums[:, None], values[mine]))
        stated = np.where(silent, context.shared(_masses_of_shapes)[rows], stated)
        others = np.where(others < 0, holders[mine], others)
    among = (values[mine, 0] >= 0.0) & (stated >= 0.0)
    yield from differing("mass", kept[mine], stated[:, None], values[mine], others, among)


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
    kept = kept[context.columns.have_code(context.parent[kept], bodies_kept)]
    mine, rows = matched(bodies.elements, profile.holders(kept))
    if not len(mine):
        return
    kept = kept[mine]
    words = [word.strip() for word in context.at(TextRows, kept).value]
    wrong = np.isin(words, ("true", "1")) == bodies.moves[rows]
    for element, row in zip(kept[wrong].tolist(), rows[wrong].tolist(), strict=True):
        message = "The body moves in the common profile, and is fixed in the pe profile."
        if not bodies.moves[row]:
            message = "The body is not dynamic in the common profile, and moves in the pe profile."
        yield Hit(profile_rules.OLD_VALUE, element, message, (int(bodies.elements[row]),))


def kinds(context: Context) -> Iterator[Hit]:
    """Shapes that are others now."""
    profile, shapes = profile_of(context), shapes_of(context)
    now = np.full(len(shapes.elements), -1)
    for index, name in enumerate(_KINDS):
        now[context.children(shapes.rows, name, Rows).owner] = index
    # A sphere may be written as a capsule without a length.
    round_ = np.isin(now, (_KINDS.index("sphere"), _KINDS.index("capsule")))
    for index, kind in enumerate(_KINDS):
        elements = profile.elements(kind)
        if not len(elements):
            continue
        mine, rows = pairs_of(context).matched(context.parent[elements])
        wrong = (now[rows] != index) & (now[rows] >= 0)
        if kind in ("sphere", "capsule"):
            wrong &= ~round_[rows]
        for element, row in zip(elements[mine[wrong]].tolist(), rows[wrong].tolist(), strict=True):
            message = (
                f"The shape is a {_KINDS[now[row]]} in the common profile, "
                f"a {kind} in the pe profile."
            )
            yield Hit(profile_rules.OLD_VALUE, element, message, (int(shapes.elements[row]),))


def sizes(context: Context) -> Iterator[Hit]:
    """Sizes of shapes; the shapes of the profile stand for those of the body, in their order."""
    profile = profile_of(context)
    for kind, name, outer, size, width, factor in _SIZES:
        kept, around, values = profile.values(name, width, kind)
        if not len(kept):
            continue
        rows = context.children(shapes_of(context).rows, outer, Rows)
        stated, elements = context.vectors(rows, size, width)
        mine, at = pairs_of(context).matched(context.parent[around], rows.owner)
        stated, values = stated[at], values[mine]
        among = np.logical_and((values > 0.0).all(axis=1), (stated > 0.0).all(axis=1))
        yield from differing(f"{name} of the {kind}", kept[mine], stated * factor, values,
                             elements[at], among)  # fmt: skip


def radii(context: Context) -> Iterator[Hit]:
    """Radii of capsules and cylinders, whichever axes they are along."""
    profile = profile_of(context)
    for kind, width, name in (("capsule", 3, "radii"), ("cylinder", 2, "radii"),
                              ("capsule", 3, "radius"), ("cylinder", 2, "radius")):  # fmt: skip
        kept, around, values = profile.values(name, 1 if name == "radius" else 3, kind)
        if not len(kept):
            continue
        rows = context.children(shapes_of(context).rows, kind, Rows)
        stated, elements = context.vectors(rows, "radius", width)
        mine, at = pairs_of(context).matched(context.parent[around], rows.owner)
        values = np.broadcast_to(values, (len(kept), 3))[mine, 3 - width :]
        stated = stated[at]
        good = (stated > 0.0).all(axis=1) & (values > 0.0).all(axis=1)
        good &= ~same(np.sort(stated, axis=1), np.sort(values, axis=1))
        yield from differing(f"radius of the {kind}", kept[mine], stated, values, elements[at],
                             good)  # fmt: skip


def materials(context: Context) -> Iterator[Hit]:
    """Restitution and friction of physics materials."""
    profile = profile_of(context)
    rows = context.rows(Rows, "physics_material")
    assert rows.ordinals is not None
    common = context.children(rows, "technique_common", Rows)
    for name, most in (("restitution", 1.0), ("static_friction", np.inf),
                       ("dynamic_friction", np.inf)):  # fmt: skip
        kept, _, values = profile.values(name, 1, "material")
        if not len(kept):
            continue
        stated, places = context.vectors(common, name, 1)
        holders = profile.holders(kept)
        holders = np.where(context.is_named(holders, "extra"), context.parent[holders], holders)
        mine, at = matched(rows.ordinals[common.owner], holders)
        stated = stated[at]
        among = (places[at] >= 0) & (stated[:, 0] >= 0.0) & (stated[:, 0] <= most)
        yield from differing(name.replace("_", " "), kept[mine], stated, values[mine], places[at],
                             among)  # fmt: skip


def limits(context: Context) -> Iterator[Hit]:
    """Limits of joints, of each joint once: where one is left behind, all may be."""
    yield from old_limits(context).values()


def old_limits(context: Context) -> dict[int, Hit]:
    """What is told of the limits of joints, by the joint."""
    return context.shared(_old_limits)


def _old_limits(context: Context) -> dict[int, Hit]:
    profile = profile_of(context)
    constraints = context.rows(Rows, "rigid_constraint").ordinals
    assert constraints is not None
    found: dict[int, Hit] = {}
    for name, other, factor in (
        ("linear_limits", "linear", 1.0), ("angular_limits", "swing_cone_and_twist", DEGREE),
    ):  # fmt: skip
        if not len(profile.elements(name)):
            continue
        for part, stated in zip(("min", "max"), limits_of(context, other), strict=True):
            kept, _, values = profile.values(part, 3, name)
            others = profile.values("max" if part == "min" else "min", 3, name)[2]
            crossed = (values > others) if part == "min" else (values < others)
            mine, at = matched(constraints, profile.holders(kept))
            wrong = ~crossed[mine].any(axis=1) & ~same(stated[at] * factor, values[mine])
            for place in np.flatnonzero(wrong).tolist():
                what = f"{part} of the {name.replace('_', ' ')}"
                row = int(at[place])
                joint = int(constraints[row])
                hit = old(what, int(kept[mine[place]]), stated[row] * factor, values[mine[place]],
                          joint)  # fmt: skip
                found.setdefault(joint, hit)
    return found


def worlds(context: Context) -> Iterator[Hit]:
    """Gravity and time step of scenes."""
    profile = profile_of(context)
    if not len(profile.elements("world")):
        return
    rows = context.rows(Rows, "physics_scene")
    assert rows.ordinals is not None
    common = context.children(rows, "technique_common", Rows)
    for name, width in (("gravity", 3), ("time_step", 1)):
        stated, places = context.vectors(common, name, width)
        kept, _, values = profile.values(name, width, "world")
        mine, at = matched(rows.ordinals[common.owner], profile.holders(kept))
        stated, values, places_at = stated[at], values[mine], places[at]
        among = places_at >= 0
        if name == "time_step":
            among &= (stated > 0.0).all(axis=1) & (values > 0.0).all(axis=1)
        yield from differing(name.replace("_", " "), kept[mine], stated, values, places_at, among)


CHECKS = (masses, inertias, fixed, kinds, sizes, radii, materials, limits, worlds)

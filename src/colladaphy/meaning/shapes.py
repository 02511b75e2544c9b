"""Shapes of bodies: sizes, masses and densities (COLLADA 1.5 §shape, §box … §sphere, §hollow)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among, distinct, numbered
from colladaphy.findings import Severity
from colladaphy.meaning import physics_rules
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


_FAR = 10.0
_SAME = 0.02
"""How far a mass may be from density times volume."""


def sizes(context: Context) -> Iterator[Hit]:
    """Primitives without a size, planes without a normal, planes that move."""
    shapes, bodies = shapes_of(context), bodies_of(context)
    for element, message, flat in shapes.faults:
        severity = Severity.WARNING if flat else None
        yield Hit(physics_rules.SHAPE_SIZE, element, message, severity=severity)
    planes = context.children(shapes.rows, "plane", Rows)
    equations, elements = context.vectors(planes, "equation", 4)
    with np.errstate(all="ignore"):
        length = np.linalg.norm(equations[:, :3], axis=1)
    good = (length > 0.0) & np.isfinite(equations).all(axis=1)
    for place, row in enumerate(planes.owner.tolist()):
        if not good[place]:
            shown = " ".join(f"{value:g}" for value in equations[place].tolist())
            yield Hit(
                physics_rules.PLANE_NORMAL,
                int(elements[place]),
                f"The equation of the plane is {shown}.",
            )
        elif bodies.moves[shapes.holders[row]]:
            body = int(bodies.elements[shapes.holders[row]])
            message = f"{context.label(body)} moves, and is a plane."
            yield Hit(physics_rules.PLANE_MOVES, int(elements[place]), message, (body,))


def masses(context: Context) -> Iterator[Hit]:
    """Masses and densities of shapes that are none, or that contradict each other."""
    shapes, bodies = shapes_of(context), bodies_of(context)
    moves = bodies.moves[shapes.holders] if len(shapes.holders) else np.zeros(0, np.bool_)
    has_mass, has_density = shapes.mass_elements >= 0, shapes.density_elements >= 0
    good_mass = has_mass & (shapes.masses >= 0.0) & (shapes.masses < np.inf)
    good_density = has_density & (shapes.densities >= 0.0) & (shapes.densities < np.inf)
    for row in np.flatnonzero(has_mass & ~good_mass).tolist():
        yield Hit(physics_rules.MASS_VALUE, int(shapes.mass_elements[row]),
                  f"The mass of a shape is {shapes.masses[row]:g}.")  # fmt: skip
    for row in np.flatnonzero(has_density & ~good_density).tolist():
        yield Hit(physics_rules.DENSITY_VALUE, int(shapes.density_elements[row]),
                  f"The density of a shape is {shapes.densities[row]:g}.")  # fmt: skip
    zero = good_density & (shapes.densities == 0.0) & moves & ~(shapes.masses > 0.0)
    for row in np.flatnonzero(zero).tolist():
        yield Hit(physics_rules.DENSITY_ZERO, int(shapes.density_elements[row]),
                  "The density is 0, and the body moves.")  # fmt: skip
    yield from _weightless(context, good_mass & (shapes.masses == 0.0) & moves & ~good_density)
    both = good_mass & good_density & ~shapes.hollow
    expected = shapes.densities * shapes.volumes
    wrong = both & (np.abs(expected - shapes.masses) > _SAME * np.maximum(expected, shapes.masses))
    for row in np.flatnonzero(wrong).tolist():
        message = (
            f"The mass is {shapes.masses[row]:g}, but the density {shapes.densities[row]:g} times "
            f"the volume is {expected[row]:g}."
        )
        yield Hit(physics_rules.MASS_DENSITY, int(shapes.density_elements[row]), message,
                  (int(shapes.mass_elements[row]),))  # fmt: skip


def _weightless(context: Context, empty: Array) -> Iterator[Hit]:
    """Shapes of mass zero in bodies that have no other mass."""
    shapes, bodies = shapes_of(context), bodies_of(context)
    count = len(bodies.elements)
    light = np.bincount(shapes.holders, empty, minlength=count)
    heavy = light < np.bincount(shapes.holders, minlength=count)
    for row in np.flatnonzero(empty & ~heavy[shapes.holders]).tolist():
        holder = int(shapes.holders[row])
        mine = bodies.instances(holder)
        given = bool(len(mine)) and bool(np.all(bodies.masses[mine] > 0.0))
        if bodies.mass_elements[holder] < 0 and not given:
            message = f"{context.label(int(bodies.elements[holder]))} moves, but its mass is 0."
            yield Hit(physics_rules.MASS_ZERO, int(shapes.mass_elements[row]), message)


def centres(context: Context) -> Iterator[Hit]:
    """Centres of mass that are far away from the shapes."""
    bodies, shapes = bodies_of(context), shapes_of(context)
    frames = shapes.frames()
    if not frames.any():
        return
    reach = shapes.reaches()
    body = np.maximum(bodies.body, 0)
    reach = np.where(reach > 0.0, reach, reach[body])
    far = bodies.moves & (frames > _FAR * reach) & (reach > 0.0) & np.isfinite(frames)
    at = context.first_children("technique_common")
    inner = context.first_children("mass_frame")
    for row in np.flatnonzero(far).tolist():
        element = int(bodies.elements[row])
        message = (
            f"The mass frame is moved by {frames[row]:g}, but the shapes reach to {reach[row]:g}."
        )
        yield Hit(physics_rules.MASS_FRAME, inner.get(at.get(element, -1), element), message)


def totals(context: Context) -> Iterator[Hit]:
    """Bodies whose mass is not that of their shapes, and those without any."""
    shapes, bodies = shapes_of(context), bodies_of(context)
    count = len(bodies.elements)
    if not len(shapes.elements):
        return
    number = np.bincount(shapes.holders, minlength=count)
    good = (shapes.masses >= 0.0) & (shapes.masses < np.inf)
    stated = np.bincount(shapes.holders, good, minlength=count)
    sums = np.bincount(shapes.holders, np.nan_to_num(shapes.masses), minlength=count)
    whole = (number > 0) & (stated == number) & (sums > 0.0)
    whole &= (bodies.masses > 0.0) & (bodies.masses < np.inf)
    wrong = whole & (np.abs(sums - bodies.masses) > 2e-3 * np.maximum(sums, bodies.masses))
    for row in np.flatnonzero(wrong).tolist():
        message = (
            f"The mass is {bodies.masses[row]:g}, but those of the shapes add up to {sums[row]:g}."
        )
        yield Hit(physics_rules.MASS_SUM, int(bodies.mass_elements[row]), message)
    yield from _unweighed(context)


def _unweighed(context: Context) -> Iterator[Hit]:
    shapes, bodies = shapes_of(context), bodies_of(context)
    count = len(bodies.elements)
    weighed = np.bincount(
        shapes.holders, (shapes.mass_elements >= 0) | (shapes.density_elements >= 0),
        minlength=count,
    ) > 0  # fmt: skip
    plane = np.zeros(count, np.bool_)
    plane[shapes.holders[context.children(shapes.rows, "plane", Rows).owner]] = True
    thin = np.full(count, -1, np.int64)
    rows = np.flatnonzero(shapes.hollow & (shapes.mass_elements < 0))[::-1]
    thin[shapes.holders[rows]] = rows
    hollow = thin >= 0
    heavy = weighed | (bodies.mass_elements >= 0)
    profiled, partly = _profiled(context), _partly(context)
    for row in [
        row
        for row in partly
        if bool(np.all(bodies.masses[bodies.instances(row)] > 0.0)) and len(bodies.instances(row))
    ]:
        del partly[row]  # the instances say the whole mass
    doubtful = ~heavy | hollow
    doubtful[list(partly)] = True
    doubtful &= ~bodies.is_instance & bodies.moves & ~plane & ~profiled
    for row in np.flatnonzero(doubtful).tolist():
        if heavy[row] and not hollow[row]:
            yield _light(context, row, partly[row])
            continue
        moving = bodies.instances(row)
        moving = moving[bodies.moves[moving]]
        given = bool(len(moving)) and bool(heavy[moving].all())
        if hollow[row] and bodies.mass_elements[row] < 0 and not given:
            element = int(shapes.hollow_elements[thin[row]])
            message = f"A shape of {context.label(int(bodies.elements[row]))} is hollow."
            yield Hit(physics_rules.HOLLOW, element, message, (int(bodies.elements[row]),))
        elif not heavy[row] and not given:
            message = f"{context.label(int(bodies.elements[row]))} moves, but nobody says its mass."
            yield Hit(physics_rules.MASS_MISSING, int(bodies.elements[row]), message)


def _partly(context: Context) -> dict[int, int]:
    """The first shape without mass or density of bodies of which other shapes have some."""
    shapes, bodies = shapes_of(context), bodies_of(context)
    stated = (shapes.mass_elements >= 0) | (shapes.density_elements >= 0)
    weighed = np.zeros(len(bodies.elements), np.bool_)
    weighed[shapes.holders[stated]] = True
    silent = ~stated & (weighed & (bodies.mass_elements < 0))[shapes.holders]
    rows = np.flatnonzero(silent)
    rows = rows[numbered(shapes.holders[rows])[0]]
    return dict(zip(shapes.holders[rows].tolist(), rows.tolist(), strict=True))


def _light(context: Context, row: int, shape: int) -> Hit:
    shapes, bodies = shapes_of(context), bodies_of(context)
    name = context.label(int(bodies.elements[row]))
    message = f"Other shapes of {name} have a mass or density, but nobody says that of this one."
    return Hit(physics_rules.MASS_MISSING, int(shapes.elements[shape]), message,
               (int(bodies.elements[row]),))  # fmt: skip


def _profiled(context: Context) -> Array:
    """(n,) which bodies have a profile, or a material with one, which may say the mass."""
    bodies = bodies_of(context)
    made = np.zeros(len(bodies.elements), np.bool_)
    techniques = context.ordinals("technique")
    above = context.parent[techniques]
    made[are_among(bodies.elements, above)] = True
    extra = context.parent[np.maximum(above, 0)]
    materials = distinct(extra[context.is_named(extra, "physics_material")])
    if len(materials):
        users = context.rows(Rows, "instance_physics_material")
        assert users.ordinals is not None
        targets = context.led("instance_physics_material", "url")
        mine = users.ordinals[are_among(targets, materials)]
        inline = materials[context.is_within(materials, "shape", "technique_common")]
        holders = context.ancestor(
            np.concatenate([mine, inline]), "rigid_body", "instance_rigid_body"
        )
        found = are_among(bodies.elements, holders)
        made |= found
        made[bodies.body[found & (bodies.body >= 0)]] = True
    return made


CHECKS = (sizes, masses, centres, totals)

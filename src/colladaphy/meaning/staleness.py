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
from colladaphy.meaning.constraint_table import AttachmentRows
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import nodes_of, odd_transforms
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
    scale = np.maximum(np.abs(one), np.abs(other)).max(initial=0.0)
    close = np.abs(one - other) <= _DIGITS * scale
    return bool(np.all(close | (one == other)))


def _hit(what: str, element: int, stated: Array, kept: Array, other: int) -> Hit:
    one, two = (" ".join(f"{value:g}" for value in values.tolist()) for values in (stated, kept))
    message = f"The {what} is {one} in the common profile, {two} in the pe profile."
    return Hit(profile_rules.OLD_VALUE, element, message, (other,))


def masses(context: Context) -> Iterator[Hit]:
    """Masses of bodies."""
    profile = profile_of(context)
    bodies = bodies_of(context)
    for element in profile.elements("body").tolist():
        kept = profile.child(element, "mass")
        row = bodies.row(profile.holder(element))
        if kept < 0 or row < 0 or bodies.mass_elements[row] < 0:
            continue
        stated, value = bodies.masses[row : row + 1], profile.numbers(kept)
        if not _same(stated, value):
            yield _hit("mass", kept, stated, value, int(bodies.mass_elements[row]))


def sizes(context: Context) -> Iterator[Hit]:
    """Sizes of shapes; the shapes of the profile stand for those of the body, in their order."""
    profile = profile_of(context)
    bodies = profile.elements("body")
    if not len(bodies):
        return
    shapes = shapes_of(context)
    kinds = [
        (context.vectors(context.children(shapes.rows, outer, Rows), size, width), factor,
         context.children(shapes.rows, outer, Rows).owner, kind, name)
        for kind, name, outer, size, width, factor in _SIZES
    ]  # fmt: skip
    own = {element: row for row, element in enumerate(shapes.elements.tolist())}
    pairs = _paired(context, profile)
    for (values, elements), factor, owner, kind, name in kinds:
        rows = dict(zip(owner.tolist(), range(len(owner)), strict=True))
        for shape, kept_shape in pairs:
            inner = profile.child(kept_shape, kind)
            kept = -1 if inner < 0 else profile.child(inner, name)
            row = rows.get(own[shape], -1)
            if kept < 0 or row < 0:
                continue
            stated, value = values[row] * factor, profile.numbers(kept)
            if not _same(stated, value):
                yield _hit(f"{name} of the {kind}", kept, stated, value, int(elements[row]))


def _paired(context: Context, profile: Profile) -> list[tuple[int, int]]:
    """Shapes of bodies with those of their profiles, where there are as many."""
    own: dict[int, list[int]] = {}
    elements = context.ordinals("shape")
    for element, body in zip(
        elements.tolist(), context.ancestor(elements, "rigid_body").tolist(), strict=True
    ):
        own.setdefault(body, []).append(element)
    kept: dict[int, list[int]] = {}
    for element in profile.elements("shape").tolist():
        kept.setdefault(profile.holder(element), []).append(element)
    return [
        pair
        for body, mine in own.items()
        if len(mine) == len(kept.get(body, ()))
        for pair in zip(mine, kept[body], strict=True)
    ]


def motions(context: Context) -> Iterator[Hit]:
    """Orientations, positions and velocities of instances."""
    profile = profile_of(context)
    elements = profile.elements("motion")
    if not len(elements):
        return
    holders = [profile.holder(element) for element in elements.tolist()]
    yield from _velocities(context, profile, elements.tolist(), holders)
    nodes, odd = nodes_of(context), odd_transforms(context)
    targets = [nodes.targets.get(holder, -1) for holder in holders]
    parents = {
        reference.element
        for reference in context.references("parent", "instance_physics_model")
        if reference.text.strip()
    }
    models = context.ordinals("instance_physics_model")
    nested = set(models[context.is_within(models, "physics_model")].tolist())
    good = [
        place for place, (target, holder) in enumerate(zip(targets, holders, strict=True))
        if target >= 0 and int(context.parent[holder]) not in parents
        and int(context.parent[holder]) not in nested
        and not (odd and any(node in odd for node in nodes.chain(target)))
    ]  # fmt: skip
    if not good:
        return
    table = context.placement.nodes
    rows = np.array([table.row_of(0, targets[place]) for place in good], np.int64)
    poses, _ = context.placement.poses(rows)
    inner, single = _inner_poses(context, [holders[place] for place in good])
    whole = poses.then(inner)
    for at, place in enumerate(good):
        kept = profile.child(int(elements[place]), "orientation")
        if kept >= 0 and (value := profile.numbers(kept)).any():
            mine = unit_quaternions(value[None])[0]
            stated = whole.orientations[at]
            if min(np.abs(mine - stated).max(), np.abs(mine + stated).max()) > _TURN:
                yield _hit("orientation", kept, stated, value, targets[place])
        kept = profile.child(int(elements[place]), "position")
        if kept >= 0 and single[at]:
            value, stated = profile.numbers(kept), whole.positions[at]
            scale = max(np.abs(value).max(), np.abs(stated).max(),
                        np.abs(inner.positions[at]).max())  # fmt: skip
            if np.abs(value - stated).max() > 10.0 * _DIGITS * scale:
                yield _hit("position", kept, stated, value, targets[place])


def _inner_poses(context: Context, instances: list[int]) -> tuple[Poses, list[bool]]:
    """The frames of Worlds' bodies in their rigid_bodies, and whether the place is known too.

    A body of one shape has the frame of that shape, one of several has its own.
    """
    bodies, shapes = bodies_of(context), shapes_of(context)
    shape_rows = context.at(AttachmentRows, shapes.elements)
    local = poses_of_steps(Steps.of(shape_rows))
    rods = np.zeros(len(shapes.elements), np.bool_)
    for name in ("capsule", "cylinder"):
        found = context.children(shapes.rows, name, Rows)
        height, _ = context.scalars(found, "height")
        rods[found.owner] = height != 0.0
    planes = np.zeros(len(shapes.elements), np.bool_)
    planes[context.children(shapes.rows, "plane", Rows).owner] = True
    order = np.argsort(shapes.holders, kind="stable")
    holders = shapes.holders[order]
    frames = set(context.ancestor(context.ordinals("mass_frame"), "rigid_body",
                                  "instance_rigid_body").tolist())  # fmt: skip
    made = Poses.none(len(instances))
    known = [False] * len(instances)
    for at, instance in enumerate(instances):
        row = bodies.row(instance)
        begin, end = np.searchsorted(holders, (row, row + 1))
        if begin == end and row >= 0 and bodies.body[row] >= 0:
            body = int(bodies.body[row])
            begin, end = np.searchsorted(holders, (body, body + 1))
            framed = instance in frames or int(bodies.elements[body]) in frames
        else:
            framed = instance in frames
        if end - begin != 1:
            continue
        shape = int(order[begin])
        if planes[shape]:
            continue
        pose = local.take(np.array([shape]))
        if rods[shape]:
            turn = quaternion_product(pose.orientations, _ROD)
            pose = Poses.of(1, pose.positions, turn, moved=pose.moved)
        made.put(np.array([at]), pose if not framed else Poses.none(1))
        known[at] = not framed
    return made, known


def _velocities(
    context: Context, profile: Profile, elements: list[int], holders: list[int]
) -> Iterator[Hit]:
    instances = context.rows(Rows, "instance_rigid_body")
    common = context.children(instances, "technique_common", Rows)
    assert instances.ordinals is not None
    at = {int(instances.ordinals[owner]): row for row, owner in enumerate(common.owner.tolist())}
    for name, other, factor in (
        ("linear_velocity", "velocity", 1.0), ("angular_velocity", "angular_velocity", DEGREE),
    ):  # fmt: skip
        values, places = context.vectors(common, other, 3)
        for element, holder in zip(elements, holders, strict=True):
            kept, row = profile.child(element, name), at.get(holder, -1)
            if kept < 0 or row < 0 or places[row] < 0:
                continue
            stated, value = values[row] * factor, profile.numbers(kept)
            if not _same(stated, value):
                yield _hit(name.replace("_", " "), kept, stated, value, int(places[row]))


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
        values, places = context.vectors(common, name, width)
        for element in elements.tolist():
            kept, row = profile.child(element, name), at.get(profile.holder(element), -1)
            if kept < 0 or row < 0 or places[row] < 0:
                continue
            value = profile.numbers(kept)
            if not _same(values[row], value):
                yield _hit(name.replace("_", " "), kept, values[row], value, int(places[row]))


CHECKS = (masses, sizes, motions, worlds)

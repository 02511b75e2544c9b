"""Poses and velocities of the pe profile that the common profile has left behind (thesis 6.2.1)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import are_among, distinct
from colladaphy.links.poses import DEGREE, Poses, unit_quaternions
from colladaphy.meaning.body_table import bodies_of
from colladaphy.meaning.comparing import DIGITS, TURN, matched, old
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.node_table import nodes_of, unclear_nodes
from colladaphy.meaning.profile_shapes import shape_poses, turn_rods
from colladaphy.meaning.profile_table import Profile, profile_of
from colladaphy.meaning.shape_table import shapes_of
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


def motions(context: Context) -> Iterator[Hit]:
    """Orientations, positions and velocities of instances."""
    profile = profile_of(context)
    yield from _velocities(context, profile)
    turns, turned, orientations = profile.values("orientation", 4, "motion")
    places, placed, positions = profile.values("position", 3, "motion")
    if not len(turns) and not len(places):
        return
    nodes, unclear = nodes_of(context), unclear_nodes(context)
    elements = distinct(np.concatenate([turned, placed]))
    holders = profile.holders(elements)
    targets = nodes.moved_by(holders)
    parents = [
        reference.element
        for reference in context.references("parent", "instance_physics_model")
        if reference.text.strip()
    ]
    models = context.ordinals("instance_physics_model")
    nested = models[context.is_within(models, "physics_model")]
    around = context.parent[holders]
    good = (targets >= 0) & ~are_among(around, parents) & ~are_among(around, nested)
    if unclear:
        good[good] = [not unclear & set(nodes.chain(node)) for node in targets[good].tolist()]
    elements, holders, targets = elements[good], holders[good], targets[good]
    if not len(elements):
        return
    table = context.placement.nodes
    poses, _ = context.placement.poses(table.rows_of(0, targets))
    inner, single, plane, clear = _inner_poses(context, holders)
    whole = poses.then(inner)
    strays, away, kept = _displaced(elements, placed, positions, whole, inner)
    astray = np.zeros(len(elements), np.bool_)
    astray[away] = single[away] & clear[away]
    mine, at = matched(elements, turned)
    mine, at = (each[np.isfinite(orientations[mine]).all(axis=1)] for each in (mine, at))
    units = unit_quaternions(orientations[mine])
    stated = whole.orientations[at]
    apart = np.minimum(np.abs(units - stated).max(axis=1, initial=0.0),
                       np.abs(units + stated).max(axis=1, initial=0.0))  # fmt: skip
    for row in np.flatnonzero(
        (apart > TURN) & orientations[mine].any(axis=1) & ~plane[at] & clear[at]
    ).tolist():
        hit = old("orientation", int(turns[mine[row]]), stated[row], orientations[mine[row]],
                  int(targets[at[row]]))  # fmt: skip
        if astray[at[row]]:  # who moves a body turns it as well
            astray[at[row]] = False
            hit = replace(hit, message=f"{hit.message} The position is another one, too.")
        yield hit
    for row in np.flatnonzero(astray[away]).tolist():
        yield old("position", int(places[strays[row]]), whole.positions[away[row]], kept[row],
                  int(targets[away[row]]))  # fmt: skip


def _displaced(
    elements: Array, placed: Array, positions: Array, whole: Poses, inner: Poses
) -> tuple[Array, Array, Array]:
    """Positions that are others than those of bodies: their rows, those of the bodies, they."""
    mine, at = matched(elements, placed)
    stated = whole.positions[at]
    columns = (positions[mine], stated, inner.positions[at])
    scale = np.max([np.abs(column).max(axis=1, initial=0.0) for column in columns], axis=0)
    apart = np.abs(positions[mine] - stated).max(axis=1, initial=0.0)
    wrong = (apart > 10.0 * DIGITS * scale) & np.isfinite(positions[mine]).all(axis=1)
    return mine[wrong], at[wrong], positions[mine[wrong]]


def _inner_poses(context: Context, instances: Array) -> tuple[Poses, Array, Array, Array]:
    """The frames of Worlds' bodies in their rigid_bodies, whether the place is known, planes.

    The last is of which frames nothing is lacking or faulty.

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
    framed = are_among(instances, frames)
    framed |= inherited & are_among(bodies.elements[source], frames)
    begin = np.searchsorted(holders, source)
    single = np.searchsorted(holders, source, side="right") - begin == 1
    made = Poses.none(len(instances))
    known, flat = np.zeros(len(instances), np.bool_), np.zeros(len(instances), np.bool_)
    clear = own | inherited  # a body that is not there is told
    mine = np.flatnonzero(single)
    shape = order[begin[mine]]
    unclear = list(unclear_nodes(context))
    if shapes.faults:  # how a rod is turned cannot be told of one that is none
        sized = np.array([element for element, _, _ in shapes.faults], np.int64)
        unclear += context.ancestor(sized, "shape").tolist()
    clear[mine] = ~are_among(shapes.elements[shape], unclear)
    planes = context.children(shapes.rows, "plane", Rows).owner
    flat |= are_among(source, shapes.holders[planes])  # turned as its normal says
    plane = are_among(shape, planes)
    mine, shape = mine[~plane], shape[~plane]
    # The body of a mesh stands at its centre of mass.
    is_mesh = np.zeros(len(shapes.elements), np.bool_)
    is_mesh[shapes.mesh_rows] = True
    known[mine] = ~framed[mine] & ~is_mesh[shape]
    mine, shape = mine[~framed[mine]], shape[~framed[mine]]
    made.put(mine, turn_rods(context, shape, shape_poses(context).take(shape)))
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
        mine, at = matched(instances.ordinals[common.owner], profile.holders(kept))
        one, two = stated[at] * factor, values[mine]
        scale = np.maximum(np.abs(one), np.abs(two)).max(axis=1, initial=0.0)
        apart = np.abs(one - two).max(axis=1, initial=0.0) > DIGITS * scale
        apart &= scale < 1e300  # of the largest, the common profile says only that they are large
        for row in np.flatnonzero(apart & (places[at] >= 0)).tolist():
            yield old(name.replace("_", " "), int(kept[mine[row]]), one[row], two[row],
                       int(places[at[row]]))  # fmt: skip


CHECKS = (motions,)

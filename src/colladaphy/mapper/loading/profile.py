"""The pe profile by column: what it says of bodies, of how they move, and of what unions hold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.pool import concatenated, taken
from colladaphy.links.poses import Poses
from colladaphy.world.kinds import Kind
from colladaphy_schema.pe_columns import ShapeTypeRows

__all__ = [
    "Motions",
    "Parts",
    "ProfileBodies",
    "countable",
    "first_of",
    "read_motions",
    "read_profiles",
]

Array = NDArray[Any]

_PROFILE = "pe"


@dataclass(slots=True)
class Parts:
    """Bodies, shapes and unions of the profile, one a row; what they do not say is masked out."""

    uid: Array
    has_uid: Array
    sid: Array
    has_sid: Array
    names: list[str | None]
    fixed: Array
    has_fixed: Array
    hollow: Array
    has_hollow: Array
    mass: Array
    has_mass: Array
    inertia: Array
    """(n, 9)."""
    has_inertia: Array
    poses: Poses
    kinds: Array
    """(n,) numbers of `Kind`, -1 where no geometry is given."""
    dimensions: Array
    """(n, 4) as the World lays them out."""
    anchors: Array
    """(n, 3) NaN where there is none."""
    large: Array
    """(n,) whether an id has more than 64 bits."""

    def __len__(self) -> int:
        return len(self.uid)

    def take(self, rows: Array) -> Parts:
        """Some of them."""
        return taken(self, rows)


@dataclass(slots=True)
class ProfileBodies:
    """What the profile says of rigid_bodies."""

    bodies: Parts
    union: Array
    """(m,) whether the body is a union."""
    shaped: Array
    """(m,) whether a single shape is described."""
    owner: Array
    """(m,) the rigid_body of each."""
    leaves: Parts
    """The shapes of bodies, in their order."""
    leaf_owner: Array
    """(k,) the rigid_body of each."""
    leaf_keys: Array
    """(k,) what tells the element from all others, ascending with the order of the document."""
    leaf_union: Array
    """(k,) the key of the union that holds it; -1 for the outermost, or for none."""
    unions: Parts
    """The unions within others."""
    union_owner: Array
    """(u,) the rigid_body of each."""
    union_keys: Array
    union_union: Array
    """(u,) the key of the union that holds it; -1 for the outermost."""
    union_depth: Array


@dataclass(slots=True)
class Motions:
    """What the profile says of instances."""

    there: Array
    """(n,) whether anything is said."""
    position: Array
    has_position: Array
    orientation: Array
    has_orientation: Array
    linear_velocity: Array
    has_linear_velocity: Array
    angular_velocity: Array
    has_angular_velocity: Array
    force: Array
    torque: Array
    sleeping: Array


def first_of(owners: Any, techniques: Any, name: str) -> tuple[Any, Array]:
    """The first element of a name in the pe techniques of each owner, and the owner of each.

    `owners` are the rows that the techniques belong to.
    """
    ours = techniques
    if len(techniques):
        ours = techniques.select(techniques.origin.chosen(techniques, "profile", _PROFILE))
    found = getattr(ours, name)
    owner = ours.owner[found.owner]
    if len(owner) > 1:
        first = np.append(True, owner[1:] != owner[:-1])
        if not first.all():
            found, owner = found.select(first), owner[first]
    return found, owner


def read_motions(instances: Any, home: int, start: int) -> Motions:
    """The motions of the instances of a document."""
    count = len(instances)
    found, owner = first_of(instances, instances.technique, "motion")
    there = np.zeros(count, np.bool_)
    there[owner] = True
    values: dict[str, Array] = {"there": there}
    for name, width in (("position", 3), ("orientation", 4), ("linear_velocity", 3),
                        ("angular_velocity", 3), ("force", 3), ("torque", 3)):  # fmt: skip
        column = getattr(found, name)
        spread = np.zeros((count, width))
        has = np.zeros(count, np.bool_)
        if column.present.any():
            spread[owner] = np.where(column.present[:, None], column.values, 0.0)
            has[owner] = column.present
        values[name] = spread
        if name not in ("force", "torque"):
            values[f"has_{name}"] = has
    sleeping = np.zeros(count, np.bool_)
    sleeping[owner] = found.sleeping.values & found.sleeping.present
    return Motions(**values, sleeping=sleeping)


def read_profiles(bodies: Any, home: int, start: int) -> ProfileBodies:
    """What the profile says of the rigid_bodies of a document."""
    found, owner = first_of(bodies, bodies.technique, "body")
    union, shape = found.union, found.shape
    outermost = np.full(len(shape), -1)
    leaves: list[tuple[Any, Array, Array]] = [(shape, owner[shape.owner], outermost)]
    unions: list[tuple[Any, Array, Array]] = []
    level, level_owner = union, owner[union.owner]
    keys = np.full(len(union), -1)
    while len(level):
        shapes, inner = level.shape, level.union
        leaves.append((shapes, level_owner[shapes.owner], keys[shapes.owner]))
        unions.append((inner, level_owner[inner.owner], keys[inner.owner]))
        level, level_owner = inner, level_owner[inner.owner]
        keys = _keys(inner, home)
    is_union = np.zeros(len(found), np.bool_)
    is_union[union.owner] = True
    is_shape = np.zeros(len(found), np.bool_)
    is_shape[shape.owner] = True
    leaf_parts, leaf_owner, leaf_keys, leaf_union = _together(leaves, home)
    union_parts, union_owner, union_keys, union_union = _together(unions, home)
    # In the order of the document, as the shapes of the common profile are.
    order = np.argsort(leaf_keys, kind="stable")
    if not bool(np.all(order[:-1] < order[1:])):
        leaf_parts, leaf_owner, leaf_keys, leaf_union = (
            leaf_parts.take(order), leaf_owner[order], leaf_keys[order], leaf_union[order]
        )  # fmt: skip
    depth = np.repeat(np.arange(len(unions)), [len(rows) for rows, _, _ in unions])
    return ProfileBodies(
        _parts(found, shaped=False),
        is_union,
        is_shape,
        owner + start,
        leaf_parts,
        leaf_owner + start,
        leaf_keys,
        leaf_union,
        union_parts,
        union_owner + start,
        union_keys,
        union_union,
        depth.astype(np.int64),
    )


def _keys(rows: Any, home: int) -> Array:
    return np.asarray(rows.ordinals.astype(np.int64) + (home << 40))


def _together(
    levels: list[tuple[Any, Array, Array]], home: int
) -> tuple[Parts, Array, Array, Array]:
    """Parts of several levels, their owners, keys, and the keys of the unions around them."""
    if not levels:
        nothing = np.zeros(0, np.int64)
        return _parts(ShapeTypeRows(0), shaped=True), nothing, nothing, nothing
    parts = concatenated([_parts(rows, shaped=isinstance(rows, ShapeTypeRows))
                          for rows, _, _ in levels])  # fmt: skip
    return (
        parts,
        np.concatenate([owner for _, owner, _ in levels]).astype(np.int64),
        np.concatenate([_keys(rows, home) for rows, _, _ in levels]),
        np.concatenate([around for _, _, around in levels]).astype(np.int64),
    )


def _masked(column: Any, count: int, shape: tuple[int, ...], default: Any) -> tuple[Array, Array]:
    if column is None:
        return np.full((count, *shape), default), np.zeros(count, np.bool_)
    return column.values, column.present


def countable(column: Any, count: int) -> tuple[Array, Array, Array]:
    """The ids (n,) of a column, where they are, and where they are too large.

    The schema's integers may be any, ours not: an id of more than 64 bits is as if not there, and
    the World gives another one.
    """
    values, present = _masked(column, count, (), 0)
    large = np.zeros(count, np.bool_)
    if values.dtype == object:
        fits = np.array([-(2**63) <= value < 2**63 for value in values.tolist()], np.bool_)
        large = present & ~fits
        values, present = np.where(fits, values, 0).astype(np.int64), present & fits
    return values, present, large


def _parts(rows: Any, *, shaped: bool) -> Parts:
    count = len(rows)
    uid, has_uid, large_uid = countable(rows.uid, count)
    sid, has_sid, large_sid = countable(rows.sid, count)
    fixed, has_fixed = _masked(rows.fixed, count, (), False)
    hollow, has_hollow = _masked(rows.hollow, count, (), False)
    mass, has_mass = _masked(rows.mass, count, (), np.nan)
    inertia, has_inertia = _masked(rows.inertia, count, (9,), np.nan)
    poses = Poses.none(count)
    if hasattr(type(rows), "position"):
        position, moved = _masked(rows.position, count, (3,), np.nan)
        orientation, turned = _masked(rows.orientation, count, (4,), np.nan)
        poses = Poses.of(count, position, orientation, moved=moved, turned=turned)
    kinds = np.full(count, -1, np.int8)
    dimensions = np.zeros((count, 4))
    anchors = np.full((count, 3), np.nan)
    if shaped and count:
        _geometry(rows, kinds, dimensions, anchors)
    return Parts(uid, has_uid, sid, has_sid, list(rows.name or [None] * count), fixed, has_fixed,
                 hollow, has_hollow, mass, has_mass, inertia, has_inertia, poses, kinds, dimensions,
                 anchors, large_uid | large_sid)  # fmt: skip


def _geometry(rows: Any, kinds: Array, dimensions: Array, anchors: Array) -> None:
    spheres, boxes, ellipsoids, planes = rows.sphere, rows.box, rows.ellipsoid, rows.plane
    if len(spheres):
        kinds[spheres.owner] = Kind.SPHERE
        dimensions[spheres.owner, 0] = spheres.radius
    if len(boxes):
        kinds[boxes.owner] = Kind.BOX
        dimensions[boxes.owner, :3] = boxes.lengths
    if len(ellipsoids):
        kinds[ellipsoids.owner] = Kind.ELLIPSOID
        dimensions[ellipsoids.owner, :3] = ellipsoids.radii
    for rods, kind in ((rows.capsule, Kind.CAPSULE), (rows.cylinder, Kind.CYLINDER)):
        if not len(rods):
            continue
        kinds[rods.owner] = kind
        for child in (rods.radius, rods.radii):
            if not len(child):
                continue
            radii = np.broadcast_to(child.value.reshape(len(child), -1), (len(child), 3)).copy()
            if kind is Kind.CYLINDER and child is rods.radius:
                radii[:, 0] = 0.0
            dimensions[rods.owner[child.owner], :3] = radii
        dimensions[rods.owner, 3] = rods.length
    if len(planes):
        kinds[planes.owner] = Kind.PLANE
        normal, anchor, shift = planes.normal, planes.anchor, planes.displacement
        x, y, z = (normal.values * anchor.values).T
        distance = np.where(shift.present, shift.values, x + y + z)
        dimensions[planes.owner, :3] = normal.values
        dimensions[planes.owner, 3] = distance
        anchors[planes.owner] = anchor.values
        # A plane without a normal, or without a place, says nothing.
        said = normal.present & (shift.present | anchor.present)
        kinds[planes.owner[~said]] = -1

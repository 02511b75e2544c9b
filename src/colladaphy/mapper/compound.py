"""Shapes as parts: primitives, unions, and how the pe profile refines them (thesis 4.3, 6.2.1)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from colladaphy.document.poses import IDENTITY, Pose
from colladaphy.mapper import rules
from colladaphy.mapper.deciding import Mapping, thesis_shape
from colladaphy.mapper.planes import plane_pose
from colladaphy.mapper.plans import Part
from colladaphy.mapper.shapes import Shape
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.mapper.bodies import BodyInstance, BodyReader, BodyValues
    from colladaphy.mapper.profile import ProfileBody, ProfilePart
    from colladaphy.mapper.staleness import Precision

__all__ = ["compound_part", "single_part"]


def single_part(
    reader: BodyReader,
    shape: Shape,
    material: int,
    values: BodyValues,
    profile: ProfileBody | None,
    precision: Precision,
    instance: BodyInstance,
) -> tuple[Part, Pose]:
    """A body of one shape, and its pose in the rigid_body."""
    mapping = Mapping(reader, instance, values, profile, precision)
    kept = None if profile is None or reader.prefer == "common" else profile
    shape_part = None if kept is None else kept.part
    if shape_part is not None and shape_part.thesis is not None:
        pose = shape.pose
        shape = thesis_shape(mapping, shape_part, shape)
        shape.pose = pose
        shape_part = None
    part = Part(shape.kind, shape.dimensions, IDENTITY, -1, material, shape.hollow)
    if shape_part is not None:
        part.kind, part.dimensions = mapping.dimensions(shape, shape_part)
    if part.kind is Kind.MESH and shape.mesh is not None:
        part.mesh_id = shape.mesh.id
    stated = values.mass if values.mass is not None else shape.mass
    part.mass = mapping.mass(stated, None if kept is None else kept.mass)
    part.inertia = mapping.inertia(
        mapping.stated_inertia(shape.pose), None if kept is None else kept.inertia
    )
    return part, shape.pose


def compound_part(
    reader: BodyReader,
    shapes: Sequence[Shape],
    materials: Sequence[int],
    values: BodyValues,
    profile: ProfileBody | None,
    precision: Precision,
    instance: BodyInstance,
) -> tuple[Part, Pose]:
    """A body of several shapes as a union, and its pose in the rigid_body."""
    mapping = Mapping(reader, instance, values, profile, precision)
    mapping.extent = extent_of(shapes)
    center = None if values.mass_frame is None else values.mass_frame.position
    members = [_flat_member(shape, id) for shape, id in zip(shapes, materials, strict=True)]
    tree = profile.part if profile is not None and reader.prefer != "common" else None
    if tree is not None and tree.members is not None:
        leaves = list(tree.leaves())
        if len(leaves) == len(shapes):
            return _profiled_union(mapping, tree, members, shapes)
        reader.document.note(
            rules.BAD_PROFILE,
            instance.body,
            f"The pe profile of {instance.body.get('sid')!r} has {len(leaves)} shapes, "
            f"the common one {len(shapes)}; the pe union is not used.",
            file=instance.body_document.file,
        )
    part = Part(Kind.UNION, members=members)
    part.mass = values.mass
    if values.mass_frame is None:
        center = center_of(members)
    place = Pose(center)
    part.inertia = mapping.stated_inertia(place)
    back = place.inverse()
    for member in members:
        member.pose = back.then(member.pose)
    return part, place


def extent_of(shapes: Sequence[Shape]) -> float:
    """How far the shapes reach, roughly."""
    sizes = [0.0]
    for shape in shapes:
        sizes += [abs(value) for value in (*shape.dimensions, *shape.pose.translation)]
        if shape.mesh is not None:
            sizes.append(float(np.max(np.abs(shape.mesh.vertices))))
    return max(size for size in sizes if math.isfinite(size))


def _flat_member(shape: Shape, material: int) -> Part:
    mesh_id = -1 if shape.mesh is None else shape.mesh.id
    part = Part(shape.kind, shape.dimensions, shape.pose, mesh_id, material, shape.hollow)
    part.mass = shape.mass
    if shape.kind is Kind.PLANE:
        part.pose = plane_pose(shape.dimensions)
    return part


def center_of(members: Sequence[Part]) -> tuple[float, float, float] | None:
    """The centre of mass of members; None for the origin (a plane makes it infinite)."""
    if any(member.kind is Kind.PLANE for member in members):
        return None
    weights = [1.0 if member.mass is None else member.mass for member in members]
    total = sum(weights)
    if total <= 0.0:
        weights = [1.0] * len(weights)
        total = float(len(weights))
    x, y, z = (
        sum(w * member.pose.translation[i] for w, member in zip(weights, members, strict=True))
        / total
        for i in range(3)
    )
    return (x, y, z) if x or y or z else None


# --- unions of the pe profile


def _profiled_union(
    mapping: Mapping, tree: ProfilePart, members: list[Part], shapes: Sequence[Shape]
) -> tuple[Part, Pose]:
    """The union of the pe profile, its leaves refined by the shapes of the common profile."""
    profile = mapping.profile
    assert profile is not None
    leaves = iter(list(zip(members, shapes, strict=True)))
    whole_center = center_of(members)
    part = Part(Kind.UNION)
    part.members = [_refined(mapping, child, leaves, Pose()) for child in tree.members or ()]
    masses = [leaf.mass or 0.0 for leaf in members]
    stated = mapping.values.mass
    if stated is None:
        stated = 0.0
        for mass in masses:
            stated += mass
    part.mass = mapping.mass(stated, profile.mass)
    part.inertia = mapping.inertia(mapping.stated_inertia(IDENTITY), profile.inertia)
    frame = mapping.values.mass_frame
    center = None if frame is None else frame.position
    if mapping.edited:
        for child in part.members:
            _forget_sums(child)
        if mapping.values.inertia is None:
            part.inertia = None
    if frame is None and (mapping.edited or profile.inertia is None):
        center = whole_center
    place = Pose(center if center is None or any(center) else None)
    for child in part.members:
        child.pose = place.inverse().then(child.pose)
    return part, place


def _forget_sums(part: Part) -> None:
    if part.kind is Kind.UNION:
        part.mass = part.inertia = None
        for member in part.members:
            _forget_sums(member)


def _refined(
    mapping: Mapping,
    kept: ProfilePart,
    leaves: Iterator[tuple[Part, Shape]],
    outer: Pose,
) -> Part:
    """A member of a pe union; `outer` is the pose of the union in the rigid_body."""
    if kept.members is not None:
        inner = Part(Kind.UNION, uid=kept.uid, sid=kept.sid, name=kept.name)
        inner.pose = Pose(kept.position, kept.orientation)
        inner.mass, inner.inertia = kept.mass, kept.inertia
        where = outer.then(kept.pose)
        inner.members = [_refined(mapping, child, leaves, where) for child in kept.members]
        if kept.inertia is None:
            _settle(inner)
        return inner
    part, shape = next(leaves)
    if kept.thesis is not None:
        fresh = thesis_shape(mapping, kept, shape)
        part.kind, part.dimensions, part.mass = fresh.kind, fresh.dimensions, fresh.mass
        part.pose = outer.inverse().then(shape.pose)
        whole = outer.then(fresh.pose)
        same = mapping.precision.same_as_whole(
            whole.translation, shape.pose.translation, mapping.extent
        ) and mapping.precision.same_turn(whole.rotation, shape.pose.rotation)
        if fresh is not shape and same:
            part.pose = fresh.pose
    else:
        where = outer.then(kept.pose)
        part.kind, part.dimensions = mapping.dimensions(shape, kept, where)
        if part.kind is not Kind.PLANE:
            part.pose = shape.pose
        if part.kind is not Kind.MESH:
            part.mesh_id = -1
        part.mass = mapping.mass(part.mass, kept.mass)
        part.inertia = kept.inertia
        part.pose = _member_pose(mapping, kept, part, outer)
    part.uid, part.sid, part.name = kept.uid, kept.sid, kept.name
    return part


def _settle(union: Part) -> None:
    """Put the origin of a union that has none at its centre of mass."""
    center = center_of([leaf for leaf in union.members if leaf.kind is not Kind.UNION])
    if center is None or any(member.kind is Kind.UNION for member in union.members):
        return
    place = Pose(center)
    union.pose = union.pose.then(place)
    for member in union.members:
        member.pose = place.inverse().then(member.pose)


def _member_pose(mapping: Mapping, kept: ProfilePart, part: Part, outer: Pose) -> Pose:
    """The pose in the union: the profile's, unless the common one is newer."""
    stated = part.pose
    direct = outer == IDENTITY
    position = kept.position
    if position is None:
        position = stated.position if direct else outer.inverse().then(stated).position
    orientation = kept.orientation
    exact = Pose(position, orientation)
    whole = outer.then(Pose(position, kept.pose.orientation))
    if part.kind is Kind.PLANE:
        same = kept.dimensions == part.dimensions
    else:
        same = mapping.precision.same_as_whole(
            whole.translation, stated.translation, mapping.extent
        ) and mapping.precision.same_turn(whole.rotation, stated.rotation)
    if mapping.decide("pose of a shape", stated, whole, same):
        return exact
    mapping.edited = True
    return outer.inverse().then(stated)

"""Deciding between the common profile and the pe profile, value by value (thesis 6.2.1)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from colladaphy.document.poses import Pose
from colladaphy.mapper import rules
from colladaphy.mapper.planes import plane_at
from colladaphy.mapper.plans import Dimensions
from colladaphy.mapper.shapes import Shape, ShapeError, read_shape, unit_plane
from colladaphy.mapper.tensors import Tensor, diagonal, symmetric_part, turned
from colladaphy.mapper.tessellation import extent
from colladaphy.world.kinds import Kind

if TYPE_CHECKING:
    from colladaphy.mapper.bodies import BodyInstance, BodyReader, BodyValues
    from colladaphy.mapper.profile import ProfileBody, ProfilePart
    from colladaphy.mapper.staleness import Precision

__all__ = ["Mapping", "thesis_shape"]


class Mapping:
    """One body on its way: what its elements say, and how its values are decided."""

    def __init__(
        self,
        reader: BodyReader,
        instance: BodyInstance,
        values: BodyValues,
        profile: ProfileBody | None,
        precision: Precision,
    ) -> None:
        self.reader = reader
        self.instance = instance
        self.values = values
        self.profile = profile
        self.precision = precision
        self.edited = False
        """Whether a shape was edited in the common profile after the profile was written."""
        self.extent = 0.0
        """The size of the body: what is small against it can be due to rounding."""

    def decide(self, what: str, stated: object, kept: object, same: bool) -> bool:
        """Whether the profile's value is taken; notes where it is an older one."""
        prefer = self.reader.prefer
        if prefer == "profile" or (prefer == "newer" and same):
            return True
        if prefer == "newer":
            body = self.instance.body
            self.reader.stale(what, body, self.instance.body_document, stated, kept)
        return False

    # --- values

    def mass(self, stated: float | None, kept: float | None) -> float | None:
        """The mass: the profile's, unless the common one is newer."""
        if kept is None or stated is None:
            return kept if stated is None else stated
        same = self.precision.same(stated, kept)
        return kept if self.decide("mass", stated, kept, same) else stated

    def stated_inertia(self, pose: Pose) -> Tensor | None:
        """What the common profile says, in the frame of a part at `pose` in the rigid_body."""
        if self.values.inertia is None:
            return None
        frame = self.values.mass_frame
        tensor = turned(diagonal(self.values.inertia), None if frame is None else frame.orientation)
        return turned(tensor, pose.inverse().orientation)

    def inertia(self, stated: Tensor | None, kept: Tensor | None) -> Tensor | None:
        """The inertia: the profile's, unless the common one is newer."""
        if kept is None or stated is None:
            return stated if kept is None else kept
        # COLLADA says the symmetric part, and of the largest numbers only that they are large.
        symmetric = symmetric_part(kept)
        same = not all(map(math.isfinite, stated)) or self.precision.same_as_whole(
            stated, symmetric
        )
        return kept if self.decide("inertia", stated, kept, same) else stated

    def dimensions(
        self, shape: Shape, kept: ProfilePart, where: Pose | None = None
    ) -> tuple[Kind, Dimensions]:
        """Kind and dimensions: the profile's, unless the common ones are newer.

        A plane in a union is where its pose `where` in the rigid_body puts it.
        """
        if kept.dimensions is None or kept.geometry is None:
            return shape.kind, shape.dimensions
        kind = Kind[kept.geometry.upper()]
        x, y, z, length = kept.dimensions
        exact = (x, y, z, length)
        same = kind is shape.kind and (
            self._same_plane(shape.dimensions, exact if where is None else plane_at(where))
            if kind is Kind.PLANE
            else self.precision.same_each(shape.dimensions, exact)
        )
        if shape.kind is Kind.MESH and self._is_tessellated(kind, exact, shape):
            shape.pose = shape.placed
            same = True
        if self.decide("shape", shape.dimensions, exact, same):
            return kind, exact
        self.edited = True
        return shape.kind, shape.dimensions

    def _same_plane(self, stated: Dimensions, kept: Dimensions) -> bool:
        stated = unit_plane(stated)
        return self.precision.same_as_whole(stated[:3], kept[:3]) and self.precision.same(
            stated[3], kept[3], self.extent
        )

    def _is_tessellated(self, kind: Kind, exact: Dimensions, shape: Shape) -> bool:
        """Whether a mesh stands for the primitive of the profile, written for other readers."""
        mesh = shape.mesh
        if mesh is None or not mesh.convex:
            return False
        size = extent(kind, exact)
        if size is None:
            return False
        reach = np.max(np.abs(mesh.vertices), axis=0)
        return bool(np.all(np.abs(reach - size) <= 2e-6 * np.max(size)))


def thesis_shape(mapping: Mapping, part: ProfilePart, shape: Shape) -> Shape:
    """The shape that the thesis's spelling of the profile gives, unless it is outdated."""
    assert part.thesis is not None
    reader = mapping.reader
    try:
        other = read_shape(part.thesis, mapping.instance.body_document, reader.geometries)
    except (ShapeError, KeyError, ValueError):
        reader.document.note(
            rules.BAD_PROFILE, mapping.instance.body, file=mapping.instance.body_document.file
        )
        return shape
    if other.mass is None:
        other.mass, other.hollow = shape.mass, shape.hollow
    same = other.kind is shape.kind
    if same and other.kind is Kind.PLANE:
        # The equation leaves open which side is solid, so the profile may turn it round.
        same = any(
            mapping.precision.same_as_whole(
                tuple(sign * value for value in shape.dimensions), other.dimensions
            )
            for sign in (1.0, -1.0)
        )
    elif same:
        same = mapping.precision.same_each(shape.dimensions, other.dimensions)
    if not mapping.decide("shape", shape.dimensions, other.dimensions, same):
        return shape
    return other

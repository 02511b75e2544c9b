"""Rigid bodies and their instances as plans: the path for everything (thesis 3.3, 4.3, 5.3).

Instance data beats rigid_body data beats shape data; what nobody says has a default. One shape is
a primitive, several are a union. Uniform bodies take the quicker path of `columns`, which gives
the same World.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from colladaphy.document.names import c, local_name
from colladaphy.document.nodes import pose_of_steps
from colladaphy.document.poses import IDENTITY, Pose, Vector
from colladaphy.mapper import rules
from colladaphy.mapper.compound import compound_part, single_part
from colladaphy.mapper.markup import token
from colladaphy.mapper.materials import STANDARD_DENSITY
from colladaphy.mapper.motion import read_motion
from colladaphy.mapper.plans import Part, Plan
from colladaphy.mapper.profile import ProfileBody, boolean, numbers, read_profile_body
from colladaphy.mapper.shapes import Shape, ShapeError, read_shape
from colladaphy.mapper.staleness import Precision
from colladaphy.world.kinds import Kind
from colladaphy.world.shapes import solid_volume

if TYPE_CHECKING:
    from colladaphy.document import Document, Prefer
    from colladaphy.mapper.geometries import Geometries
    from colladaphy.mapper.materials import MaterialTable
    from colladaphy.world import World

__all__ = ["BodyInstance", "BodyReader", "BodyValues"]

Source = tuple[etree._Element, "Document"]


@dataclass(slots=True)
class BodyInstance:
    """An instance_rigid_body, the rigid_body that it instances, and the pose of its node."""

    element: etree._Element
    document: Document
    body: etree._Element
    body_document: Document
    pose: Pose = IDENTITY
    model: object = None
    """The instance of the physics model that it belongs to."""


@dataclass(slots=True)
class BodyValues:
    """What instance and rigid_body say together, the instance first."""

    dynamic: bool | None = None
    mass: float | None = None
    mass_frame: Pose | None = None
    inertia: Vector | None = None
    material: Source | None = None
    shapes: list[Source] = field(default_factory=list)


class BodyReader:
    """Reads bodies, one after the other."""

    def __init__(
        self,
        document: Document,
        world: World,
        geometries: Geometries,
        materials: MaterialTable,
        prefer: Prefer,
    ) -> None:
        self.document = document
        self.world = world
        self.geometries = geometries
        self.materials = materials
        self.prefer = prefer
        self._assumed_density: set[etree._Element] = set()

    def read(self, instance: BodyInstance) -> Plan | None:
        """The plan of a body; None, with a finding, where the World cannot hold it."""
        values = self._values(instance)
        shapes = []
        for element, document in values.shapes:
            try:
                shapes.append(read_shape(element, document, self.geometries))
            except ShapeError as error:
                self._skip(error, element, document, instance)
        if not shapes:
            return None
        profile = read_profile_body(instance.body)
        precision = Precision((instance.body, instance.element))
        self._complete(shapes, values, instance, profile)
        part, origin = self._part(shapes, values, profile, precision, instance)
        plan = Plan(part, instance.element, instance.document.file)
        plan.node = instance.pose
        plan.fixed = self._fixed(values, profile, instance)
        plan.part.pose = instance.pose.then(origin)
        if profile is not None:
            part.uid = profile.uid
            part.sid = profile.sid or system_id(instance.body.get("sid", ""), "Body")
        stated = instance.body.get("name")
        part.name = instance.element.get("name") if stated is None else stated
        if profile is not None and profile.name is not None and same_token(profile.name, stated):
            part.name = profile.name
        plan.origin = origin.inverse()
        read_motion(self, plan, instance, profile, precision)
        return plan

    # --- what the common profile says

    def _values(self, instance: BodyInstance) -> BodyValues:
        values = BodyValues()
        sources = ((instance.body, instance.body_document), (instance.element, instance.document))
        for element, document in sources:
            common = element.find(c("technique_common"))
            shapes = []
            for child in () if common is None else common:
                match local_name(child.tag):
                    case "dynamic":
                        values.dynamic = boolean(child)
                    case "mass":
                        values.mass = numbers(child)[0]
                    case "mass_frame":
                        values.mass_frame = pose_of_steps(child)
                    case "inertia":
                        x, y, z = numbers(child)
                        values.inertia = (x, y, z)
                    case "instance_physics_material" | "physics_material":
                        values.material = (child, document)
                    case "shape":
                        shapes.append((child, document))
            if shapes:
                values.shapes = shapes
        return values

    def _complete(
        self,
        shapes: list[Shape],
        values: BodyValues,
        instance: BodyInstance,
        profile: ProfileBody | None,
    ) -> None:
        """Give every shape a mass and a material (thesis 5.3: redistribution)."""
        volumes = [own_volume(shape) for shape in shapes]
        for shape, volume in zip(shapes, volumes, strict=True):
            if shape.mass is None and shape.kind is not Kind.PLANE:
                shape.mass = self._mass_by_density(shape, volume, values, instance)
        if values.mass is None or len(shapes) == 1 or is_union(profile):
            return
        # The whole has a mass of its own, which the shapes share in proportion to theirs.
        total = math.fsum(shape.mass or 0.0 for shape in shapes)
        weights = [shape.mass or 0.0 for shape in shapes] if total > 0.0 else volumes
        whole = total if total > 0.0 else math.fsum(volumes)
        if whole > 0.0 and total != values.mass:
            for shape, weight in zip(shapes, weights, strict=True):
                if shape.kind is not Kind.PLANE:
                    shape.mass = values.mass * (weight / whole)

    def _mass_by_density(
        self, shape: Shape, volume: float, values: BodyValues, instance: BodyInstance
    ) -> float:
        density = shape.density
        if density is None:
            source = self.material_source(shape, values, instance)
            record = None if source is None else self.materials.record(*source)
            if record is not None and record.has_density:
                density = record.values["density"]
        if density is None:
            density = STANDARD_DENSITY
            if values.mass is None and instance.body not in self._assumed_density:
                self._assumed_density.add(instance.body)
                self.document.note(
                    rules.DENSITY_ASSUMED, instance.body, file=instance.body_document.file
                )
        return volume * density

    def material_source(
        self, shape: Shape, values: BodyValues, instance: BodyInstance
    ) -> Source | None:
        """Which material counts: that of the instance, of the body, or of the shape."""
        if values.material is not None:
            return values.material
        if shape.material is None:
            return None
        home = instance.body_document
        if any(element is shape.element for element, _ in values.shapes):
            home = next(home for element, home in values.shapes if element is shape.element)
        return shape.material, home

    def material_id(
        self,
        shape: Shape,
        values: BodyValues,
        instance: BodyInstance,
        profile: ProfileBody | None,
    ) -> int:
        """The World's material of a shape; its own density makes a variant (thesis 4.4)."""
        source = self.material_source(shape, values, instance)
        record = None if source is None else self.materials.record(*source)
        if record is None:
            record = self.materials.unspecified(shape.element, instance.body_document)
        # Our own files state the material's density in the material itself.
        density = None if profile is not None and record.has_density else shape.density
        return self.materials.id_of(record, density)

    def _fixed(
        self, values: BodyValues, profile: ProfileBody | None, instance: BodyInstance
    ) -> bool:
        stated = values.dynamic is False
        kept = None if profile is None else profile.fixed
        if kept is None or kept == stated or self.prefer == "common":
            return stated
        if self.prefer == "profile":
            return kept
        self.stale("dynamic", instance.body, instance.body_document, not stated, not kept)
        return stated

    # --- what both profiles say

    def _part(
        self,
        shapes: list[Shape],
        values: BodyValues,
        profile: ProfileBody | None,
        precision: Precision,
        instance: BodyInstance,
    ) -> tuple[Part, Pose]:
        """The part that the body is, and its pose in the rigid_body."""
        materials = [self.material_id(shape, values, instance, profile) for shape in shapes]
        if is_union(profile) or len(shapes) > 1 or _off_center(shapes[0], values):
            return compound_part(self, shapes, materials, values, profile, precision, instance)
        return single_part(self, shapes[0], materials[0], values, profile, precision, instance)

    def stale(
        self,
        what: str,
        element: etree._Element,
        document: Document,
        stated: object,
        kept: object,
    ) -> None:
        """Note that the common profile's value is newer than the pe profile's."""
        name = element.get("sid") or element.get("body") or element.get("id") or "?"
        message = (
            f"The {what} of {name!r} is {stated} in the common profile, {kept} in the pe profile; "
            "the common one was edited and is taken."
        )
        self.document.note(rules.STALE, element, message, file=document.file)

    def _skip(
        self,
        error: ShapeError,
        element: etree._Element,
        document: Document,
        instance: BodyInstance,
    ) -> None:
        rule = rules.EMPTY_SHAPE if error.empty else rules.NO_GEOMETRY
        name = instance.body.get("name") or instance.body.get("sid") or "?"
        message = f"{error} The shape of body {name!r} is skipped."
        self.document.note(rule, element, message, file=document.file)


def system_id(sid: str, prefix: str) -> int | None:
    """The system id that one of our own sids is made of (thesis 5.4)."""
    digits = sid.removeprefix(prefix)
    if digits == sid or not digits.isascii() or not digits.isdigit() or len(digits) > 18:
        return None
    return int(digits)


def same_token(one: str, other: str | None) -> bool:
    """Whether two names are the same as xs:token, which keeps no runs of blanks."""
    return other is not None and token(one) == token(other)


def is_union(profile: ProfileBody | None) -> bool:
    """Whether the pe profile says that the body is a union."""
    return profile is not None and profile.part is not None and profile.part.members is not None


def own_volume(shape: Shape) -> float:
    """The volume of a shape; 0 for a plane."""
    if shape.mesh is not None:
        return shape.mesh.volume
    with np.errstate(all="ignore"):
        return float(solid_volume(shape.kind, np.array([shape.dimensions]))[0])


def _off_center(shape: Shape, values: BodyValues) -> bool:
    """Whether a single shape's centre is not the centre of mass that the body states."""
    frame = values.mass_frame
    if frame is None or frame.position is None or shape.kind is Kind.PLANE:
        return False
    size = max((*map(abs, shape.dimensions), *map(abs, shape.pose.translation)))
    if shape.mesh is not None:
        size = max(size, float(np.max(np.abs(shape.mesh.body_vertices))))
    return math.dist(frame.translation, shape.pose.translation) > 1e-6 * size

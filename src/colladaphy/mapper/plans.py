"""What a body will be, between the document and the World (thesis 5.3: ColladaBody).

A plan can still be changed, and knows what the World will not: the frame of the rigid_body, which
constraints refer to.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from lxml import etree

from colladaphy.document.poses import IDENTITY, Pose, Vector
from colladaphy.world.kinds import Kind

__all__ = ["Part", "Plan"]

Dimensions = tuple[float, float, float, float]
_NONE: Dimensions = (0.0, 0.0, 0.0, 0.0)


@dataclass(slots=True)
class Part:
    """A primitive, a mesh or a union; None for what the World works out by itself."""

    kind: Kind
    dimensions: Dimensions = _NONE
    pose: Pose = IDENTITY
    """In the enclosing union, or in the world."""
    mesh_id: int = -1
    material_id: int = -1
    hollow: bool = False
    mass: float | None = None
    inertia: tuple[float, ...] | None = None
    """Row by row, about the centre of mass in the part's frame."""
    uid: int | None = None
    sid: int | None = None
    """The system id that is wanted, later the one that it gets."""
    name: str | None = None
    members: list[Part] = field(default_factory=list)
    local: bool = True
    """Whether the poses of members are relative to the union, so that they are stored as such."""


@dataclass(slots=True)
class Plan:
    """A body to be: what it is made of, and how it moves."""

    part: Part
    element: etree._Element
    """The instance_rigid_body."""
    file: str | None = None
    fixed: bool = False
    sleeping: bool = False
    linear_velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    force: Vector = (0.0, 0.0, 0.0)
    torque: Vector = (0.0, 0.0, 0.0)
    origin: Pose = IDENTITY
    """The frame of the rigid_body in that of the World's body."""
    node: Pose = IDENTITY
    """The frame of the rigid_body in the world."""

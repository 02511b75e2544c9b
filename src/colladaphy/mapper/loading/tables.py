"""The elements that a World is loaded from, in all documents that belong together."""

from __future__ import annotations

from colladaphy.links.names import c
from colladaphy.links.nodes import Placement
from colladaphy.links.pool import Pool
from colladaphy.links.resource import Resource
from colladaphy_schema.geometry_library_columns import GeometryTypeRows
from colladaphy_schema.physics_columns import (
    InstancePhysicsModelTypeRows,
    InstanceRigidBodyTypeRows,
    InstanceRigidConstraintTypeRows,
    PhysicsMaterialTypeRows,
    PhysicsModelTypeRows,
    RigidBodyTypeRows,
    RigidConstraintTypeRows,
)

__all__ = ["Tables"]


class Tables:
    """Tables of physics, by the names of the elements."""

    def __init__(self, resource: Resource) -> None:
        self.resource = resource
        """The document that is loaded, whose report takes what is noticed."""
        self.pool = pool = Pool(resource)
        self.models = pool.table(PhysicsModelTypeRows, c("physics_model"))
        self.model_instances = pool.table(InstancePhysicsModelTypeRows, c("instance_physics_model"))
        self.bodies = pool.table(RigidBodyTypeRows, c("rigid_body"))
        self.body_instances = pool.table(InstanceRigidBodyTypeRows, c("instance_rigid_body"))
        self.constraints = pool.table(RigidConstraintTypeRows, c("rigid_constraint"))
        self.constraint_instances = pool.table(
            InstanceRigidConstraintTypeRows, c("instance_rigid_constraint")
        )
        self.materials = pool.table(PhysicsMaterialTypeRows, c("physics_material"))
        self.geometries = pool.table(GeometryTypeRows, c("geometry"))
        self.placement = Placement(pool, resource)

"""What becomes of documents that are loaded, and where everything in it comes from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.loading.bodies import LoadedBodies
from colladaphy.mapper.loading.instances import Expansion
from colladaphy.mapper.loading.joints import LoadedJoints
from colladaphy.mapper.loading.materials import MaterialTable
from colladaphy.mapper.loading.meshes import Geometries
from colladaphy.mapper.loading.tables import Tables
from colladaphy.world import World

__all__ = ["Loaded"]


@dataclass(frozen=True, slots=True)
class Loaded:
    """A World, and where in the documents everything in it comes from."""

    world: World
    tables: Tables
    expansion: Expansion
    bodies: LoadedBodies
    created: NDArray[np.bool_]
    """(n,) which of the bodies the World took."""
    joints: LoadedJoints
    driven: NDArray[np.int64]
    """System ids of the joints that the kinematics have, and no rigid_constraint."""
    materials: MaterialTable
    geometries: Geometries
    roots: NDArray[np.int64]
    """Rows of the instance_physics_model elements that were asked for; -1 for none."""

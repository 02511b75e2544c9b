"""Everything that has a shape: bodies that are primitives, and the primitives in unions.

The common profile knows no union of unions, so all primitives of a union stand in one rigid_body,
each at its pose in the outermost union (thesis 4.3).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.poses import Poses, rotate_vectors
from colladaphy.mapper.numbers import differs
from colladaphy.mapper.storing.geometries import BOX, PLANE, halves_are_exact
from colladaphy.mapper.storing.tree import Tree
from colladaphy.world.kinds import Kind
from colladaphy.world.masses import mass_and_inertia, volumes

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["Leaves"]

Array = NDArray[Any]

_UNION = int(Kind.UNION)
_MESH = int(Kind.MESH)
_EMPTY = int(Kind.EMPTY)
_SHARED = ("sids", "uids", "kinds", "positions", "masses", "inertias", "material_ids",
           "dimensions", "hollow", "mesh_ids")  # fmt: skip


class Leaves:
    """Primitives, k rows in the order of the file, and what has to be said of each."""

    def __init__(
        self, world: World, bodies: dict[str, Array], tree: Tree, options: WriteOptions
    ) -> None:
        single = np.flatnonzero(bodies["kinds"] != _UNION)
        inner = tree.order[~tree.is_union[tree.order]]
        self.owner: Array = single
        """(k,) the row of the body that each belongs to."""
        self.row: Array = single
        """(k,) the row among the bodies, or among the members."""
        self.is_member: Array = np.zeros(len(single), np.bool_)
        """(k,)"""
        self.poses: Poses | None = None
        """Where they stand in their bodies; None for no members."""
        if not len(inner):
            whole = len(single) == len(bodies["kinds"])
            self.values = {key: bodies[key] if whole else bodies[key][single] for key in _SHARED}
        else:
            owner = np.concatenate([single, tree.top[inner]])
            sorting = np.argsort(owner, kind="stable")
            self.owner, self.row = owner[sorting], np.append(single, inner)[sorting]
            self.is_member = sorting >= len(single)
            self.values = {
                key: np.concatenate([bodies[key][single], tree.values[key][inner]])[sorting]
                for key in _SHARED
            }
            resting = Poses.none(len(single))
            self.poses = Poses.joined([resting, tree.poses.take(inner)]).take(sorting)
        self.equations = self._equations()
        """(k, 4) Ax + By + Cz + D = 0 of planes in the frames of their bodies."""
        self._weigh(world, options)
        self._compare(world, options)

    def __len__(self) -> int:
        return len(self.owner)

    def _equations(self) -> Array:
        """Where the World has n·x = d."""
        kinds, dimensions = self.values["kinds"], self.values["dimensions"]
        equations = np.zeros((len(self), 4))
        planes = np.flatnonzero(kinds == PLANE)
        if not len(planes):
            return equations
        equations[planes] = dimensions[planes]
        inner = planes[self.is_member[planes]]
        if self.poses is not None and len(inner):
            poses = self.poses.take(inner)
            up = np.broadcast_to(np.array([0.0, 0.0, 1.0]), (len(inner), 3))
            with np.errstate(all="ignore"):
                normals = rotate_vectors(poses.orientations, up)
                (a, b, c), (x, y, z) = normals.T, poses.positions.T
                equations[inner, :3] = normals
                equations[inner, 3] = a * x + b * y + c * z
        equations[planes, 3] = -equations[planes, 3]
        return equations

    def _weigh(self, world: World, options: WriteOptions) -> None:
        kinds, masses = self.values["kinds"], self.values["masses"]
        self.has_density: Array = np.zeros(len(self), np.bool_)
        """(k,) which state their density, and not their mass."""
        self.densities: Array = masses
        """(k,)"""
        planes = kinds == PLANE
        self.has_mass: Array = ~planes
        """(k,) which state their mass."""
        self._weight_is_exact = np.ones(len(self), np.bool_)
        if planes.any():
            self.has_mass[planes] = differs(masses[planes][:, None], np.zeros(1))
        if options.shape_weight == "density":
            self._weigh_by_density(world)

    def _weigh_by_density(self, world: World) -> None:
        kinds, masses = self.values["kinds"], self.values["masses"]
        with np.errstate(all="ignore"):
            sizes = volumes(self.values, world.meshes)
            densities = masses / sizes
            again = densities * sizes
            # Not where the volume is too small or too large to say the mass by it.
            usable = np.abs(again - masses) <= 1e-12 * masses
        usable &= np.isfinite(densities) & (sizes > 0)
        usable &= (kinds != BOX) | halves_are_exact(self.values["dimensions"])
        self.has_density, self.densities = usable, densities
        self.has_mass &= ~usable
        self._weight_is_exact = ~differs(again[:, None], masses[:, None]) | ~usable

    def _compare(self, world: World, options: WriteOptions) -> None:
        """What the common profile does not say exactly, or all with a full profile."""
        values, full = self.values, options.profile == "full"
        kinds, dimensions = values["kinds"], values["dimensions"]
        _, derived = mass_and_inertia(values, values["masses"], world.materials, world.meshes)
        self.says_inertia: Array = differs(derived, values["inertias"]) | full
        """(k,) whose inertia is not the one that shape and mass have, to the last bit."""
        self.says_mass: Array = ~self._weight_is_exact | full
        """(k,) whose mass is for the pe profile to say."""
        boxes = kinds == BOX
        says_shape = kinds == PLANE
        if full or options.tessellate:
            says_shape = np.ones(len(self), np.bool_)
        elif boxes.any():
            says_shape[boxes] = ~halves_are_exact(dimensions[boxes])
        self.exact_kinds: Array = np.where(
            says_shape & (kinds != _MESH) & (kinds != _EMPTY), kinds, -1
        )
        """(k,) the kind of the geometry that is for the pe profile to say, -1 for none."""

    def per_body(self, values: Array, count: int) -> Array:
        """Flags (k,) of primitives for the bodies (n,) that they are; False for unions."""
        if not self.is_member.any() and len(self) == count:
            return values
        spread = np.zeros(count, np.bool_)
        spread[self.owner[~self.is_member]] = values[~self.is_member]
        return spread

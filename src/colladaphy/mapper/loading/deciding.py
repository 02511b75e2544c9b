"""Deciding between the common profile and the pe profile, value by value (thesis 6.2.1)."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.members import Members
from colladaphy.mapper.loading.profile import Parts as ProfileParts
from colladaphy.mapper.loading.sameness import Sameness, tolerance_of
from colladaphy.mapper.loading.shapes import unit_planes
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.loading.tensors import symmetric_parts
from colladaphy.mapper.tessellation import extent
from colladaphy.meaning.profile_rules import OLD_VALUE
from colladaphy.world import World
from colladaphy.world.kinds import Kind

__all__ = ["Deciding", "Prefer"]

Array = NDArray[Any]
_STEPS = ("lookat", "matrix", "rotate", "scale", "skew", "translate")
Prefer = Literal["newer", "profile", "common"]


class Deciding:
    """Takes the newer of two values of bodies, and notes where that is the common profile's."""

    def __init__(self, tables: Tables, bodies: FoundBodies, prefer: Prefer) -> None:
        self._tables = tables
        self._bodies = bodies
        self.prefer = prefer
        self.sameness = Sameness(len(bodies), self._tolerance)
        self.pose_sameness = Sameness(len(bodies), self._pose_tolerance)
        """The same for where bodies are, which their nodes say."""
        self.edited = np.zeros(len(bodies), np.bool_)
        """Bodies of which a shape was edited in the common profile."""

    def _tolerance(self, body: int) -> float:
        tables, bodies = self._tables, self._bodies
        homes = tables.pool.resources
        row, instance = int(bodies.bodies[body]), int(bodies.rows[body])
        return min(
            tolerance_of(homes[int(bodies.body_homes[body])], int(tables.bodies.ordinals[row])),
            tolerance_of(
                homes[int(bodies.homes[body])], int(tables.body_instances.ordinals[instance])
            ),
        )

    def _pose_tolerance(self, body: int) -> float:
        """What the transforms of the node tell beside the record of the body."""
        nodes = self._tables.placement.nodes
        row = self._bodies.nodes[body : body + 1]
        if row[0] < 0:
            return self._tolerance(body)
        home = self._tables.pool.resources[int(nodes.homes(row)[0])]
        node = int(nodes.ordinals[row[0]])
        steps, element, end = [], node + 1, home.columns.end_of(node)
        while element < end:
            if home.columns.local_name(element) in _STEPS:
                steps.append(element)
            element = home.columns.end_of(element)
        return min(self._tolerance(body), tolerance_of(home, *steps))

    def take(
        self,
        what: str,
        bodies: Array,
        stated: Any,
        kept: Any,
        same: Array,
        *,
        instance: bool = False,
    ) -> Array:
        """Where the profile's values are taken (n,); notes where they are older ones.

        `stated` and `kept` are columns, or functions of a row, for messages.
        """
        if self.prefer == "profile":
            return np.ones(len(bodies), np.bool_)
        if self.prefer == "common":
            return np.zeros(len(bodies), np.bool_)
        for row in np.flatnonzero(~same).tolist():
            self._note(what, int(bodies[row]), _shown(stated, row), _shown(kept, row), instance)
        return same

    def _note(self, what: str, body: int, stated: object, kept: object, instance: bool) -> None:
        tables, found = self._tables, self._bodies
        if instance:
            row, home = int(found.rows[body]), int(found.homes[body])
            name = (
                tables.body_instances.texts("sid")[row] or tables.body_instances.texts("body")[row]
            )
            ordinal = int(tables.body_instances.ordinals[row])
        else:
            row, home = int(found.bodies[body]), int(found.body_homes[body])
            name = tables.bodies.texts("sid")[row] or tables.bodies.texts("id")[row] or "?"
            ordinal = int(tables.bodies.ordinals[row])
        message = (
            f"The {what} of {name!r} is {stated} in the common profile, {kept} in the pe profile; "
            "the common one was edited and is taken."
        )
        tables.resource.note(OLD_VALUE, ordinal, message, home=tables.pool.resources[home])

    # --- values

    def masses(self, bodies: Array, stated: Array, kept: Array, has_kept: Array) -> Array:
        """Masses (n,): the profile's, unless the common ones are newer."""
        result = stated.copy()
        only = has_kept & np.isnan(stated)
        result[only] = kept[only]
        both = np.flatnonzero(has_kept & ~np.isnan(stated))
        if len(both):
            mine = bodies[both]
            same = self.sameness.each(mine, stated[both], kept[both])
            taken = self.take("mass", mine, stated[both], kept[both], same)
            result[both[taken]] = kept[both[taken]]
        return result

    def inertias(self, bodies: Array, stated: Array, kept: Array, has_kept: Array) -> Array:
        """Inertias (n, 9), NaN where nobody says one: the profile's unless the common are newer."""
        result = stated.copy()
        has_stated = ~np.isnan(stated).all(axis=1)
        only = has_kept & ~has_stated
        result[only] = kept[only]
        both = np.flatnonzero(has_kept & has_stated)
        if len(both):
            mine = bodies[both]
            # COLLADA says the symmetric part, and of the largest numbers only that they are large.
            same = np.asarray(~np.isfinite(stated[both]).all(axis=1))
            left = np.flatnonzero(~same)
            symmetric = symmetric_parts(kept[both[left]])
            same[left] = self.sameness.whole(mine[left], stated[both[left]], symmetric)
            taken = self.take("inertia", mine, stated[both], kept[both], same)
            result[both[taken]] = kept[both[taken]]
        return result

    def dimensions(
        self,
        rows: Array,
        members: Members,
        kept: ProfileParts,
        extents: Array,
        planes: Array | None,
        world: World,
    ) -> tuple[Array, Array, Array]:
        """Kinds and dimensions of some members, and which are taken from meshes in their place.

        `kept` has one row for each of `rows`, `extents` is the size of the body, `planes` where
        planes in unions are by their poses.
        """
        bodies = members.owner[rows]
        kinds, dimensions = members.kinds[rows].copy(), members.dimensions[rows].copy()
        replaced = np.zeros(len(rows), np.bool_)
        said = np.flatnonzero(kept.kinds >= 0)
        if not len(said):
            return kinds, dimensions, replaced
        mine = bodies[said]
        same = kept.kinds[said] == kinds[said]
        flat = kept.kinds[said] == Kind.PLANE
        solid = np.flatnonzero(same & ~flat)
        same[solid] = self.sameness.each(
            mine[solid], dimensions[said[solid]], kept.dimensions[said[solid]]
        )
        level = np.flatnonzero(same & flat)
        if len(level):
            exact = kept.dimensions if planes is None else planes
            same[level] = self._same_planes(
                mine[level], dimensions[said[level]], exact[said[level]], extents[said[level]]
            )
        for place in np.flatnonzero(kinds[said] == Kind.MESH).tolist():
            row = int(said[place])
            if _is_tessellated(members, int(rows[row]), kept, row, world):
                same[place] = replaced[row] = True
        taken = self.take("shape", mine, _tuples(dimensions[said]), _tuples(kept.dimensions[said]),
                          same)  # fmt: skip
        kinds[said[taken]] = kept.kinds[said[taken]]
        dimensions[said[taken]] = kept.dimensions[said[taken]]
        if self.prefer != "common":
            self.edited[mine[~taken]] = True
        return kinds, dimensions, replaced

    def _same_planes(self, bodies: Array, stated: Array, kept: Array, extents: Array) -> Array:
        stated, _ = unit_planes(stated)
        # The equation leaves open which side is solid, so the profile may turn it round.
        across = np.sum(stated[:, :3] * kept[:, :3], axis=1) < 0.0
        stated = np.where(across[:, None], -stated, stated)
        return np.asarray(
            self.sameness.whole(bodies, stated[:, :3], kept[:, :3])
            & self.sameness.scaled(bodies, stated[:, 3], kept[:, 3], extents)
        )


def _shown(values: Any, row: int) -> object:
    if callable(values):
        return values(row)
    value = values[row]
    if isinstance(value, np.ndarray):
        return tuple(value.tolist())
    return value.item() if isinstance(value, np.generic) else value


def _tuples(rows: Array) -> Any:
    return lambda row: tuple(rows[row].tolist())


def _is_tessellated(
    members: Members, row: int, kept: ProfileParts, place: int, world: World
) -> bool:
    """Whether a mesh stands for the primitive of the profile, written for other readers."""
    mesh = world.meshes.get(int(members.mesh_ids[row]))
    if mesh is None or not mesh.convex:
        return False
    size = extent(Kind(int(kept.kinds[place])), tuple(kept.dimensions[place].tolist()))
    if size is None:
        return False
    reach = np.max(np.abs(mesh.vertices), axis=0)
    return bool(np.all(np.abs(reach - size) <= 2e-6 * np.max(size)))

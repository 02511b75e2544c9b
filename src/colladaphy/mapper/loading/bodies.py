"""Rigid bodies as parts (thesis 3.3, 4.3, 5.3).

Instance data beats rigid_body data beats shape data; what nobody says has a default. One shape is
a primitive, several are a union; the pe profile tells unions in unions and exact values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import orjson
from numpy.typing import NDArray

from colladaphy.links.nodes import Sums
from colladaphy.links.pool import concatenated, taken
from colladaphy.links.poses import Poses, reach, rotate_vectors, unit_quaternions
from colladaphy.mapper import rules
from colladaphy.mapper.loading.deciding import Deciding, Prefer
from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.impossible import note_impossible
from colladaphy.mapper.loading.materials import MaterialTable
from colladaphy.mapper.loading.members import Members, complete, read_members
from colladaphy.mapper.loading.meshes import Geometries
from colladaphy.mapper.loading.parts import Parts, new_parts
from colladaphy.mapper.loading.planes import plane_poses
from colladaphy.mapper.loading.profile import Motions, ProfileBodies, read_motions, read_profiles
from colladaphy.mapper.loading.shapes import move_planes
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.loading.tensors import diagonals, turned_tensors
from colladaphy.mapper.loading.unions import Compounds, Unions
from colladaphy.mapper.loading.values import BodyValues, overridden, read_bodies, read_instances
from colladaphy.mapper.tokens import same_token, system_id
from colladaphy.world import World
from colladaphy.world.kinds import Kind

__all__ = ["LoadedBodies", "load_bodies"]

Array = NDArray[Any]


@dataclass(slots=True)
class LoadedBodies:
    """Bodies to be, and what constraints have to know of them."""

    found: FoundBodies
    parts: Parts
    tops: Array
    """(n,) the part that each body is."""
    fixed: Array
    sleeping: Array
    linear: Array
    angular: Array
    force: Array
    torque: Array
    origins: Poses
    """The frames of the rigid_bodies in those of the World's bodies."""


def load_bodies(
    tables: Tables,
    found: FoundBodies,
    world: World,
    materials: MaterialTable,
    geometries: Geometries,
    prefer: Prefer,
) -> LoadedBodies:
    """Everything that the documents say of the bodies that are found."""
    own = tables.bodies.gather(read_bodies)
    theirs = tables.body_instances.gather(read_instances)
    body_values, instance_values = (
        _taken(own.values, found.bodies),
        _taken(theirs.values, found.rows),
    )
    values = overridden(body_values, instance_values)
    members = read_members(tables, found, values, (own.shapes, theirs.shapes), geometries)
    has_shape = np.zeros(len(found), np.bool_)
    has_shape[members.owner] = True
    if not has_shape.all():
        # Nothing is left of bodies whose shapes a World cannot hold.
        kept = np.flatnonzero(has_shape)
        places = np.cumsum(has_shape) - 1
        members.owner = places[members.owner]
        found = found.take(tables, kept)
        values, instance_values = _taken(values, kept), _taken(instance_values, kept)
    loading = _Loading(
        tables, found, members, values, instance_values, world, materials, prefer
    )  # fmt: skip
    return loading.loaded(theirs.linear[found.rows], theirs.angular[found.rows])


def _taken(values: BodyValues, rows: Array) -> BodyValues:
    return values if _are_all(rows, len(values.mass)) else taken(values, rows)


def _are_all(rows: Array, count: int) -> bool:
    return len(rows) == count and bool(np.all(rows == np.arange(count)))


class _Loading:
    """One load, step by step."""

    def __init__(
        self,
        tables: Tables,
        found: FoundBodies,
        members: Members,
        values: BodyValues,
        instance_values: BodyValues,
        world: World,
        materials: MaterialTable,
        prefer: Prefer,
    ) -> None:
        self._tables = tables
        self._found = found
        self._members = members
        self._values = values
        self._world = world
        self._prefer = prefer
        self._deciding = Deciding(tables, found, prefer)
        self._profile: ProfileBodies = tables.bodies.gather(read_profiles)
        there = np.full(len(tables.bodies), -1, np.int64)
        there[self._profile.owner] = np.arange(len(self._profile.owner))
        self._kept = _of(there, found.bodies, -1)
        """(n,) the rows of the profile, -1 for none."""
        kept = self._kept
        note_impossible(tables, found, values, instance_values, self._profile.bodies, kept)
        self._is_union = (kept >= 0) & _of(self._profile.union, kept)
        counts = np.bincount(members.owner, minlength=len(found))
        self._first = np.cumsum(counts) - counts
        lone = counts == 1
        off = lone & ~self._is_union
        off[off] = _off_center(members, self._first[off], values, np.flatnonzero(off), world)
        self._compound = self._is_union | ~lone | off
        shares = values.has_mass & ~self._is_union & (~lone | off)
        complete(tables, found, members, values, instance_values, materials, shares)
        # Our own files state the material's density in the material itself.
        given = members.densities.copy()
        stated = ~np.isnan(given) & (kept[members.owner] >= 0)
        if stated.any():
            rows = np.flatnonzero(stated)
            known = ~np.isnan(materials.densities(members.material_rows[rows]))
            given[rows[known]] = np.nan
        shaped = np.flatnonzero(members.kinds != Kind.EMPTY)
        self._material_ids = np.full(len(members), -1, np.int64)
        if len(shaped):
            self._material_ids[shaped] = materials.ids(
                members.material_rows[shaped], given[shaped], members.homes[shaped],
                members.ordinals[shaped],
            )  # fmt: skip

    def loaded(self, linear: Array, angular: Array) -> LoadedBodies:
        found = self._found
        count = len(found)
        single = np.flatnonzero(~self._compound)
        parts = new_parts(0)
        tops = np.full(count, -1, np.int64)
        origin = Poses.none(count)
        if len(single):
            parts, placed = self._singles(single)
            tops[single] = np.arange(len(single))
            origin.put(single, placed)
        several = np.flatnonzero(self._compound)
        if len(several):
            compounds = self._compounds(several)
            start = len(parts)
            more = compounds.parts
            more.parents = np.where(more.parents >= 0, more.parents + start, -1)
            tops[several] = compounds.tops + start
            origin.put(several, compounds.places)
            parts = _stacked(parts, more) if start else more
        motions: Motions = self._tables.body_instances.gather(read_motions)
        mine = motions if _are_all(found.rows, len(motions.there)) else taken(motions, found.rows)
        self._identify(parts, tops)
        loaded = LoadedBodies(
            found, parts, tops, self._fixed(), mine.sleeping, linear.copy(), angular.copy(),
            mine.force, mine.torque, Poses.none(count),
        )  # fmt: skip
        if self._prefer == "common":
            loaded.sleeping = np.zeros(count, np.bool_)
            loaded.force, loaded.torque = np.zeros((count, 3)), np.zeros((count, 3))
        self._place(loaded, origin, mine)
        return loaded

    # --- bodies of one shape

    def _singles(self, bodies: Array) -> tuple[Parts, Poses]:
        """Bodies of one shape as parts, and their poses in the rigid_bodies."""
        members, deciding = self._members, self._deciding
        rows = self._first[bodies]
        count = len(bodies)
        parts = new_parts(count)
        parts.body = bodies
        parts.kinds, parts.dimensions = members.kinds[rows], members.dimensions[rows]
        placed = members.poses.take(rows)
        parts.mesh_ids, parts.hollow = members.mesh_ids[rows], members.hollow[rows]
        parts.material_ids = self._material_ids[rows]
        bare = np.flatnonzero(parts.kinds == Kind.EMPTY)
        if len(bare):
            placed = self._bare(bodies, bare, placed)
            parts.hollow[bare] = False
        kept = self._kept[bodies] if self._prefer != "common" else np.full(count, -1)
        profile = self._profile
        shaped = np.flatnonzero((kept >= 0) & _of(profile.shaped, kept))
        if len(shaped):
            leaf = np.searchsorted(profile.leaf_owner, self._found.bodies[bodies[shaped]])
            described = profile.leaves.take(leaf)
            kinds, dimensions, replaced = deciding.dimensions(
                rows[shaped], members, described, np.zeros(len(shaped)), None, self._world
            )
            parts.kinds[shaped], parts.dimensions[shaped] = kinds, dimensions
            parts.mesh_ids[shaped[kinds != Kind.MESH]] = -1
            meshes = shaped[replaced]
            placed.put(meshes, members.placed.take(rows[meshes]))
        values = self._values
        stated = np.where(values.has_mass[bodies], values.mass[bodies], members.masses[rows])
        described_rows = np.maximum(kept, 0)
        whole = profile.bodies
        has = (kept >= 0) & _of(whole.has_mass, kept)
        parts.masses = deciding.masses(bodies, stated, _of(whole.mass, described_rows, np.nan), has)
        has = (kept >= 0) & _of(whole.has_inertia, kept)
        if has.any() or values.has_inertia[bodies].any():
            parts.inertias = deciding.inertias(
                bodies, self.stated_inertias(bodies, placed),
                _of(whole.inertia, described_rows, np.nan, (9,)), has,
            )  # fmt: skip
        return parts, placed

    def _bare(self, bodies: Array, bare: Array, placed: Poses) -> Poses:
        """The poses with those of bodies without a shape, whose centre their mass frame says."""
        made = placed.take(np.arange(len(placed)))
        frames = self._values.frames.take(bodies[bare]).places_only()
        frames.moved &= np.any(frames.positions != 0.0, axis=1)
        made.put(bare, frames)
        return made

    def stated_inertias(self, bodies: Array, poses: Poses) -> Array:
        """What the common profile says (n, 9), in the frames of parts at poses in rigid_bodies."""
        values = self._values
        made = np.full((len(bodies), 9), np.nan)
        rows = np.flatnonzero(values.has_inertia[bodies])
        if not len(rows):
            return made
        frames, inner = values.frames.take(bodies[rows]), poses.take(rows).inverse()
        tensors = turned_tensors(
            diagonals(values.inertia[bodies[rows]]), frames.orientations, frames.turned
        )
        made[rows] = turned_tensors(tensors, inner.orientations, inner.turned)
        return made

    # --- bodies of several shapes

    def _compounds(self, bodies: Array) -> Compounds:
        unions = Unions(
            bodies, self._found, self._members, self._material_ids, self._values, self._profile,
            self._kept if self._prefer != "common" else np.full(len(self._kept), -1),
            self._deciding, self._tables, self._world, self.stated_inertias,
        )  # fmt: skip
        return unions.made()

    # --- who it is, and how it moves

    def _identify(self, parts: Parts, tops: Array) -> None:
        """User ids, wanted system ids and names of bodies."""
        found, profile, tables = self._found, self._profile, self._tables
        kept = self._kept
        there = np.flatnonzero(kept >= 0)
        mine = kept[there]
        parts.uids[tops[there]] = np.where(
            profile.bodies.has_uid[mine], profile.bodies.uid[mine], 0
        )
        self._note_large(there, mine)
        sids = tables.bodies.texts("sid")
        wanted = _system_ids([sids[row] for row in found.bodies[there].tolist()])
        explicit = profile.bodies.has_sid[mine] & (profile.bodies.sid[mine] != 0)
        parts.sids[tops[there]] = np.where(explicit, profile.bodies.sid[mine], wanted)
        names, others = tables.bodies.texts("name"), tables.body_instances.texts("name")
        kept_names = profile.bodies.names
        if not (_any_named(names) or _any_named(others) or _any_named(kept_names)):
            return
        for body, (row, instance, top, said) in enumerate(
            zip(
                found.bodies.tolist(),
                found.rows.tolist(),
                tops.tolist(),
                kept.tolist(),
                strict=True,
            )
        ):
            del body
            stated = names[row]
            name = others[instance] if stated is None else stated
            exact = kept_names[said] if said >= 0 else None
            if exact is not None and same_token(exact, stated):
                name = exact
            parts.names[top] = name

    def _note_large(self, bodies: Array, kept: Array) -> None:
        """Note the bodies of which an id, or one of what they hold, is too large."""
        profile, tables = self._profile, self._tables
        if not (profile.bodies.large.any() or profile.leaves.large.any()
                or profile.unions.large.any()):  # fmt: skip
            return
        rows = self._found.bodies[bodies]
        large = profile.bodies.large[kept].copy()
        for parts, owner in ((profile.leaves, profile.leaf_owner),
                             (profile.unions, profile.union_owner)):  # fmt: skip
            large |= np.isin(rows, owner[parts.large])
        for row in np.unique(rows[large]).tolist():
            home = tables.pool.resources[int(tables.bodies.homes(np.array([row]))[0])]
            sid = tables.bodies.texts("sid")[row]
            message = f"An id of the body {sid!r} has more than 64 bits."
            tables.resource.note(rules.ID_LARGE, int(tables.bodies.ordinals[row]), message,
                                 home=home)  # fmt: skip

    def _fixed(self) -> Array:
        values, kept, profile = self._values, self._kept, self._profile
        stated = values.has_dynamic & ~values.dynamic
        said = (kept >= 0) & _of(profile.bodies.has_fixed, kept)
        other = np.flatnonzero(said & (_of(profile.bodies.fixed, kept) != stated))
        if not len(other) or self._prefer == "common":
            return stated
        exact = profile.bodies.fixed[kept[other]]
        taken = self._deciding.take("dynamic", other, ~stated[other], ~exact,
                                    np.zeros(len(other), np.bool_))  # fmt: skip
        stated = stated.copy()
        stated[other[taken]] = exact[taken]
        return stated

    def _place(self, loaded: LoadedBodies, origin: Poses, motions: Motions) -> None:
        """Where bodies are in the world, and how they move."""
        found, parts, tops = self._found, loaded.parts, loaded.tops
        poses = found.poses.then(origin)
        loaded.origins = origin.inverse()
        flat = np.flatnonzero(parts.kinds[tops] == Kind.PLANE)
        use = motions.there if self._prefer != "common" else np.zeros(len(found), np.bool_)
        solid = use.copy()
        solid[flat] = False
        self._poses(poses, origin, motions, np.flatnonzero(solid))
        if len(flat):
            self._planes(loaded, poses, motions, flat)
        if len(tops) == len(parts) and bool(np.all(tops == np.arange(len(tops)))):
            parts.poses = poses
        else:
            parts.poses.put(tops, poses)
        for name, column, exact, has in (
            ("linear velocity", loaded.linear, motions.linear_velocity,
             motions.has_linear_velocity),
            ("angular velocity", loaded.angular, motions.angular_velocity,
             motions.has_angular_velocity),
        ):  # fmt: skip
            rows = np.flatnonzero(use & has)
            if not len(rows):
                continue
            stated = column[rows]
            same = self._deciding.sameness.each(rows, stated, exact[rows])
            taken = self._deciding.take(name, rows, stated, exact[rows], same, instance=True)
            column[rows[taken]] = exact[rows[taken]]

    def _poses(self, poses: Poses, origin: Poses, motions: Motions, rows: Array) -> None:
        """Exact positions and orientations of the profile, unless the nodes were moved.

        A position that is a sum is compared as a whole, to the size of what was added up, and a
        product of turns with a tolerance for each.
        """
        deciding = self._deciding
        mine = rows[motions.has_position[rows]]
        if len(mine):
            stated, exact = poses.positions[mine], motions.position[mine]
            same = deciding.pose_sameness.each(mine, stated, exact)
            left = np.flatnonzero(~same)
            if len(left):
                sums = self._sums(origin)
                left = left[sums.steps[mine[left]] > 0]
                same[left] = deciding.pose_sameness.whole(
                    mine[left], stated[left], exact[left], sums.sizes[mine[left]]
                )
            taken = mine[deciding.take("position", mine, stated, exact, same, instance=True)]
            poses.positions[taken] = motions.position[taken]
            poses.moved[taken] = True
        mine = rows[motions.has_orientation[rows]]
        if len(mine):
            stated, exact = poses.orientations[mine], motions.orientation[mine]
            same = deciding.pose_sameness.turn(mine, stated, exact)
            left = np.flatnonzero(~same)
            if len(left):
                steps = self._sums(origin).steps[mine[left]]
                same[left] = deciding.pose_sameness.turn(
                    mine[left], stated[left], exact[left], steps
                )
            taken = mine[deciding.take("orientation", mine, stated, exact, same, instance=True)]
            poses.orientations[taken] = motions.orientation[taken]
            poses.turned[taken] = True

    def _sums(self, origin: Poses) -> Sums:
        """What the poses of bodies at `origin` in their rigid_bodies are made of."""
        sums = self._found.reach(self._tables)
        sums.sizes += reach(origin.positions)
        sums.steps += ~origin.is_identity()
        return sums

    def _planes(self, loaded: LoadedBodies, poses: Poses, motions: Motions, rows: Array) -> None:
        """A plane is where its equation says; anchor and orientation are the pe profile's."""
        parts, found = loaded.parts, self._found
        tops = loaded.tops[rows]
        local = parts.dimensions[tops].copy()
        nodes = found.poses.take(rows)
        moved, _ = move_planes(nodes, local)
        parts.dimensions[tops] = moved
        stands = plane_poses(moved)
        kept = self._kept[rows] if self._prefer != "common" else np.full(len(rows), -1)
        shaped = np.flatnonzero((kept >= 0) & _of(self._profile.shaped, kept))
        if len(shaped):
            leaf = np.searchsorted(self._profile.leaf_owner, found.bodies[rows[shaped]])
            described = self._profile.leaves.take(leaf)
            same = np.all(described.dimensions == local[shaped], axis=1)
            same &= ~np.isnan(described.anchors).any(axis=1)
            at = shaped[same]
            anchors = described.anchors[same]
            turned = ~nodes.is_identity()[at]
            anchors[turned] = nodes.take(at[turned]).points(anchors[turned])
            stands.positions[at] = anchors
            turns = np.flatnonzero(motions.there[rows] & motions.has_orientation[rows])
            turns = turns[np.isin(turns, shaped)]
            exact = motions.orientation[rows[turns]]
            normals = rotate_vectors(
                unit_quaternions(exact), np.tile([0.0, 0.0, 1.0], (len(turns), 1))
            )
            close = np.all(np.abs(normals - moved[turns, :3]) <= 1e-6, axis=1)
            stands.orientations[turns[close]] = exact[close]
        poses.put(rows, stands)
        loaded.origins.put(rows, stands.inverse().then(nodes))


def _of(column: Array, rows: Array, default: Any = False, shape: tuple[int, ...] = ()) -> Array:
    """A column by rows of which some are -1."""
    if not len(column):
        return np.full((len(rows), *shape), default)
    return np.asarray(column[rows])


def _any_named(names: list[Any]) -> bool:
    return names.count(None) != len(names)


def _system_ids(sids: list[str]) -> Array:
    """The system ids that our own sids of bodies are made of; -1 for others."""
    joined = "\n".join(["", *sids])
    count = len(sids)
    if count and joined.count("\nBody") == count == joined.count("B") and len(joined) < 22 * count:
        try:
            numbers = orjson.loads(f"[{joined.replace(chr(10) + 'Body', ',')[1:]}]")
            return np.array(numbers, np.int64)
        except (ValueError, OverflowError):
            pass  # not all of them are made of numbers
    return np.array(
        [-1 if id is None else id for id in (system_id(sid, "Body") for sid in sids)], np.int64
    )


def _off_center(
    members: Members, rows: Array, values: BodyValues, bodies: Array, world: World
) -> Array:
    """Whether a single shape's centre is not the centre of mass that the body states."""
    frames = values.has_frame[bodies] & (members.kinds[rows] != Kind.PLANE)
    frames &= members.kinds[rows] != Kind.EMPTY
    off = np.zeros(len(rows), np.bool_)
    mine = np.flatnonzero(frames)
    if len(mine):
        member = rows[mine]
        centers = members.poses.positions[member]
        size = np.maximum(reach(members.dimensions[member]), reach(centers))
        size = np.maximum(size, members.reach(member, world, centered=True))
        apart = values.frames.positions[bodies[mine]] - centers
        off[mine] = np.sqrt(np.sum(apart * apart, axis=1)) > 1e-6 * size
    return off


def _stacked(first: Parts, second: Parts) -> Parts:
    return concatenated([first, second])

"""Bodies of several shapes as unions, and how the pe profile refines them (thesis 4.3, 6.2.1)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.pool import concatenated, expanded
from colladaphy.links.poses import Poses, reach, unit_quaternions
from colladaphy.mapper import rules
from colladaphy.mapper.loading.deciding import Deciding
from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.members import Members
from colladaphy.mapper.loading.parts import Parts, new_parts
from colladaphy.mapper.loading.planes import plane_poses, planes_at
from colladaphy.mapper.loading.profile import ProfileBodies
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.loading.values import BodyValues
from colladaphy.world import World
from colladaphy.world.kinds import Kind

__all__ = ["Compounds", "Unions"]

Array = NDArray[Any]


@dataclass(slots=True)
class Compounds:
    """Unions as parts."""

    parts: Parts
    tops: Array
    """(n,) the part of each body."""
    places: Poses
    """Where they stand in the rigid_bodies."""


class Unions:
    """Some of the bodies as unions of their shapes, or of those that the profile tells."""

    def __init__(
        self,
        bodies: Array,
        found: FoundBodies,
        members: Members,
        material_ids: Array,
        values: BodyValues,
        profile: ProfileBodies,
        kept: Array,
        deciding: Deciding,
        tables: Tables,
        world: World,
        stated_inertias: Callable[[Array, Poses], Array],
    ) -> None:
        self._bodies = bodies
        self._found = found
        self._members = members
        self._values = values
        self._profile = profile
        self._deciding = deciding
        self._tables = tables
        self._world = world
        self._stated_inertias = stated_inertias
        begin = np.searchsorted(members.owner, bodies, side="left")
        end = np.searchsorted(members.owner, bodies, side="right")
        self._rows, self._owner = expanded(begin, end)
        """The members of the bodies, and which of the bodies each is of."""
        self._counts = end - begin
        self._material_ids = material_ids[self._rows]
        self._kept = kept[bodies]
        self._leaf = self._leaves()

    def _leaves(self) -> Array:
        """For each member the leaf of the profile's tree that stands for it; -1 where none does."""
        profile, kept = self._profile, self._kept
        leaf = np.full(len(self._rows), -1, np.int64)
        if not len(profile.owner):
            return leaf
        told = np.flatnonzero((kept >= 0) & profile.union[kept])
        if not len(told):
            return leaf
        rows = self._found.bodies[self._bodies[told]]
        begin = np.searchsorted(profile.leaf_owner, rows, side="left")
        end = np.searchsorted(profile.leaf_owner, rows, side="right")
        same = (end - begin) == self._counts[told]
        for place in told[~same].tolist():
            self._note_misfit(place, int((end - begin)[told == place][0]))
        first = np.full(len(self._bodies), -1, np.int64)
        first[told[same]] = begin[same]
        starts = np.cumsum(self._counts) - self._counts
        rank = np.arange(len(self._rows)) - starts[self._owner]
        mine = first[self._owner] >= 0
        leaf[mine] = first[self._owner[mine]] + rank[mine]
        return leaf

    def _note_misfit(self, place: int, count: int) -> None:
        body = int(self._bodies[place])
        row, home = int(self._found.bodies[body]), int(self._found.body_homes[body])
        sid = self._tables.bodies.texts("sid")[row]
        message = (
            f"The pe profile of {sid!r} has {count} shapes, the common one "
            f"{int(self._counts[place])}; the pe union is not used."
        )
        self._tables.resource.note(
            rules.BAD_PROFILE, int(self._tables.bodies.ordinals[row]), message,
            home=self._tables.pool.resources[home],
        )  # fmt: skip

    def made(self) -> Compounds:
        """The unions with all that is in them."""
        members, rows = self._members, self._rows
        count = len(rows)
        parts = new_parts(count)
        parts.body = members.owner[rows]
        parts.kinds, parts.dimensions = members.kinds[rows].copy(), members.dimensions[rows].copy()
        parts.poses = members.poses.take(rows)
        planes = np.flatnonzero(parts.kinds == Kind.PLANE)
        if len(planes):
            parts.poses.put(planes, plane_poses(parts.dimensions[planes]))
        parts.mesh_ids, parts.hollow = members.mesh_ids[rows], members.hollow[rows]
        parts.material_ids = self._material_ids
        parts.masses = members.masses[rows].copy()
        centers = self._centers(parts, self._owner, len(self._bodies))
        told = self._leaf >= 0
        inner: _Inner | None = None
        if told.any():
            inner = self._refine(parts, np.flatnonzero(told))
        return self._together(parts, centers, inner)

    # --- centres

    def _centers(self, parts: Parts, owner: Array, count: int) -> Poses:
        """Centres of mass of parts, by owner; not moved where it is the origin, or infinite."""
        flat = np.zeros(count, np.bool_)
        flat[owner[parts.kinds == Kind.PLANE]] = True
        weights = np.where(np.isnan(parts.masses), 1.0, parts.masses)
        with np.errstate(all="ignore"):
            total = np.bincount(owner, weights, minlength=count)
            light = ~(total > 0.0)
            weights = np.where(light[owner], 1.0, weights)
            total = np.where(light, np.bincount(owner, minlength=count), total)
            positions = parts.poses.positions
            made = np.column_stack([
                np.bincount(owner, weights * positions[:, axis], minlength=count) / total
                for axis in range(3)
            ])  # fmt: skip
        made[flat] = 0.0
        return Poses.of(count, made, moved=np.any(made != 0.0, axis=1))

    # --- unions of the pe profile

    def _refine(self, parts: Parts, rows: Array) -> _Inner:
        """Refine members by the leaves that stand for them; gives the unions they stand in."""
        profile, deciding = self._profile, self._deciding
        bodies = parts.body[rows]
        leaf = self._leaf[rows]
        described = profile.leaves.take(leaf)
        inner = _Inner.of(self, np.unique(self._owner[rows]))
        around = inner.places(profile.leaf_union[leaf], self._owner[rows])
        outer = inner.outer(around)
        extents = self._extents()[self._owner[rows]]
        own = described.poses
        unit = Poses.of(len(rows), own.positions, unit_quaternions(own.orientations),
                        moved=own.moved, turned=own.turned)  # fmt: skip
        where = outer.then(unit)
        # A plane through the origin tells nothing of how far away it was made.
        away = reach(where.positions)
        extents = np.maximum(extents, np.where(np.isfinite(away), away, 0.0))
        kinds, dimensions, _ = deciding.dimensions(
            self._rows[rows], self._members, described, extents, planes_at(where), self._world
        )
        parts.kinds[rows], parts.dimensions[rows] = kinds, dimensions
        parts.mesh_ids[rows[kinds != Kind.MESH]] = -1
        solid = np.flatnonzero(kinds != Kind.PLANE)
        stated = parts.poses.take(rows)
        stated.put(solid, self._members.poses.take(self._rows[rows[solid]]))
        parts.masses[rows] = deciding.masses(
            bodies, parts.masses[rows], described.mass, described.has_mass
        )
        parts.inertias[rows] = np.where(described.has_inertia[:, None], described.inertia, np.nan)
        parts.poses.put(rows, self._member_poses(bodies, described.poses, unit, stated, outer,
                                                 kinds, dimensions, described.dimensions,
                                                 extents))  # fmt: skip
        parts.uids[rows] = np.where(described.has_uid, described.uid, 0)
        parts.sids[rows] = np.where(described.has_sid, described.sid, -1)
        for row, name in zip(rows.tolist(), described.names, strict=True):
            parts.names[row] = name
        inner.leaf_rows, inner.leaf_around = rows, around
        return inner

    def _member_poses(
        self, bodies: Array, exact: Poses, unit: Poses, stated: Poses, outer: Poses, kinds: Array,
        dimensions: Array, kept_dimensions: Array, extents: Array,
    ) -> Poses:  # fmt: skip
        """Poses in the unions: the profile's, unless the common ones are newer."""
        deciding = self._deciding
        back = outer.inverse().then(stated)
        positions = exact.places_only()
        missing = np.flatnonzero(~exact.moved)
        if len(missing):
            direct = outer.is_identity()[missing, None]
            at = Poses.of(
                len(missing),
                np.where(direct, stated.positions[missing], back.positions[missing]),
                moved=np.where(direct[:, 0], stated.moved[missing], back.moved[missing]),
            )
            positions.put(missing, at)
        whole = outer.then(positions.then(unit.turns_only()))
        flat = kinds == Kind.PLANE
        same = np.all(kept_dimensions == dimensions, axis=1)
        solid = np.flatnonzero(~flat)
        mine = bodies[solid]
        same[solid] = deciding.sameness.whole(
            mine, whole.positions[solid], stated.positions[solid], extents[solid]
        ) & deciding.sameness.turn(mine, whole.orientations[solid], stated.orientations[solid])
        taken = deciding.take(
            "pose of a shape", bodies, _pose_texts(stated), _pose_texts(whole), same
        )
        deciding.edited[bodies[~taken]] = True
        made = positions
        made.orientations, made.turned = exact.orientations.copy(), exact.turned.copy()
        made.orientations[~made.turned] = (1.0, 0.0, 0.0, 0.0)
        made.put(~taken, back.take(~taken))
        return made

    def _extents(self) -> Array:
        """How far the shapes of each body reach, roughly (n,)."""
        members, rows = self._members, self._rows
        sizes = np.abs(np.column_stack([
            members.dimensions[rows], members.poses.positions[rows],
            members.reach(rows, self._world, centered=False)
        ]))  # fmt: skip
        sizes[~np.isfinite(sizes)] = 0.0
        extents = np.zeros(len(self._bodies))
        np.maximum.at(extents, self._owner, reach(sizes))
        return extents

    # --- everything together

    def _together(self, parts: Parts, centers: Poses, inner: _Inner | None) -> Compounds:
        bodies, values, deciding = self._bodies, self._values, self._deciding
        count = len(bodies)
        told = np.zeros(count, np.bool_)
        if inner is not None:
            told[inner.bodies] = True
        edited = deciding.edited[bodies]
        has_frame = values.has_frame[bodies]
        frames = values.frames.take(bodies).places_only()
        profile = self._profile
        has_kept = np.zeros(count, np.bool_)
        if len(profile.owner):
            has_kept = told & profile.bodies.has_inertia[self._kept]
        # Without a frame the shapes say where the centre is; the profile's unions begin there.
        places = frames.take(np.arange(count))
        free = ~has_frame & (~told | edited | ~has_kept)
        places.put(free, centers.take(free))
        places.moved &= np.any(places.positions != 0.0, axis=1) | (has_frame & ~told)
        tops = new_parts(count)
        tops.body = bodies
        tops.kinds[...] = Kind.UNION
        tops.masses = np.where(values.has_mass[bodies], values.mass[bodies], np.nan)
        unmoved = Poses.none(count)
        frame_of = places.take(np.arange(count))
        frame_of.put(told, unmoved.take(told))
        tops.inertias = self._stated_inertias(bodies, frame_of)
        if inner is not None:
            mine = np.flatnonzero(told)
            kept = profile.bodies.take(self._kept[mine])
            sums = np.bincount(self._owner, np.nan_to_num(parts.masses), minlength=count)
            stated = np.where(np.isnan(tops.masses[mine]), sums[mine], tops.masses[mine])
            tops.masses[mine] = deciding.masses(bodies[mine], stated, kept.mass, kept.has_mass)
            tops.inertias[mine] = deciding.inertias(
                bodies[mine], tops.inertias[mine], kept.inertia, kept.has_inertia
            )
            forget = told & edited & ~values.has_inertia[bodies]
            tops.inertias[forget] = np.nan
        around = np.full(len(parts), -1, np.int64)
        unions = new_parts(0)
        if inner is not None:
            around[inner.leaf_rows] = inner.leaf_around
            unions = inner.parts(edited)
            inner.settle(parts, unions)
        # What stands in the outermost union is told from its place.
        back = places.inverse()
        outermost = np.flatnonzero(around < 0)
        whole = back.take(self._owner[outermost])
        parts.poses.put(outermost, whole.then(parts.poses.take(outermost)))
        if inner is not None and len(unions):
            rows = np.flatnonzero(inner.around < 0)
            unions.poses.put(rows, back.take(inner.owner[rows]).then(unions.poses.take(rows)))
        return self._ordered(parts, around, unions, inner, tops, places)

    def _ordered(
        self, parts: Parts, around: Array, unions: Parts, inner: _Inner | None, tops: Parts,
        places: Poses,
    ) -> Compounds:  # fmt: skip
        """All parts in one table, members before the unions that hold them."""
        leaves, count = len(parts), len(self._bodies)
        rank = np.arange(leaves)
        top_rows = np.arange(count) + leaves + len(unions)
        parts.parents = np.where(around >= 0, around + leaves, top_rows[self._owner])
        ends = np.cumsum(self._counts) - 1
        last = [rank, ends]
        depth = [np.zeros(leaves, np.int64), np.full(count, -1)]
        owners = [self._owner, np.arange(count)]
        if inner is not None and len(unions):
            unions.parents = np.where(inner.around >= 0, inner.around + leaves,
                                      top_rows[inner.owner])  # fmt: skip
            last.insert(1, inner.last_leaves())
            depth.insert(1, inner.depth)
            owners.insert(1, inner.owner)
            depth[0] = np.full(leaves, int(inner.depth.max()) + 1)
        joined = concatenated([parts, unions, tops] if len(unions) else [parts, tops])
        order = np.lexsort((-np.concatenate(depth), np.concatenate(last), np.concatenate(owners)))
        back = np.empty(len(order), np.int64)
        back[order] = np.arange(len(order))
        return Compounds(joined.take(order), back[top_rows], places)


@dataclass(slots=True)
class _Inner:
    """Unions within unions of the profile, each after the one that holds it."""

    unions: Unions
    bodies: Array
    """The bodies whose trees are told, by their place among the compounds."""
    rows: Array
    """(u,) rows of the profile's unions; one that stands for several bodies is there for each."""
    owner: Array
    """(u,) the body of each, by its place among the compounds."""
    around: Array
    """(u,) the union that holds it; -1 for the outermost."""
    depth: Array
    where: Poses
    """Of the unions in the rigid_bodies."""
    leaf_rows: Array
    leaf_around: Array
    """The refined members, and the inner unions that hold them."""

    @classmethod
    def of(cls, unions: Unions, bodies: Array) -> _Inner:
        profile = unions._profile
        order = np.lexsort((profile.union_depth, profile.union_owner))
        owners = profile.union_owner[order]
        wanted = unions._found.bodies[unions._bodies[bodies]]
        begin = np.searchsorted(owners, wanted, side="left")
        end = np.searchsorted(owners, wanted, side="right")
        places, mine = expanded(begin, end)
        rows, owner = order[places], bodies[mine]
        made = cls(unions, bodies, rows, owner, np.zeros(0, np.int64), profile.union_depth[rows],
                   Poses.none(len(rows)), np.zeros(0, np.int64), np.zeros(0, np.int64))  # fmt: skip
        made.around = made.places(profile.union_union[rows], owner)
        own = profile.unions.poses.take(rows)
        unit = Poses.of(len(rows), own.positions, unit_quaternions(own.orientations),
                        moved=own.moved, turned=own.turned)  # fmt: skip
        made.where = unit
        for level in range(1, int(made.depth.max(initial=-1)) + 1):
            here = np.flatnonzero(made.depth == level)
            made.where.put(here, made.where.take(made.around[here]).then(unit.take(here)))
        return made

    def places(self, keys: Array, owners: Array) -> Array:
        """The unions of some keys in some bodies, -1 for none."""
        found = np.full(len(keys), -1, np.int64)
        asked = np.flatnonzero(keys >= 0)
        if not len(asked) or not len(self.rows):
            return found
        known = self.unions._profile.union_keys[self.rows]
        order = np.lexsort((known, self.owner))
        codes, inverse = np.unique(np.concatenate([known, keys[asked]]), return_inverse=True)
        inverse = inverse.reshape(-1)
        mine = self.owner[order] * len(codes) + inverse[: len(known)][order]
        query = owners[asked] * len(codes) + inverse[len(known) :]
        found[asked] = order[np.searchsorted(mine, query)]
        return found

    def outer(self, around: Array) -> Poses:
        """The poses in the rigid_bodies of the unions that hold something."""
        made = Poses.none(len(around))
        inside = np.flatnonzero(around >= 0)
        made.put(inside, self.where.take(around[inside]))
        return made

    def parts(self, edited: Array) -> Parts:
        """The unions as parts, with the sums that the profile keeps, where no shape was edited."""
        kept = self.unions._profile.unions.take(self.rows)
        parts = new_parts(len(self.rows))
        parts.body = self.unions._bodies[self.owner]
        parts.kinds[...] = Kind.UNION
        parts.poses = kept.poses
        old = edited[self.owner]
        parts.masses = np.where(kept.has_mass & ~old, kept.mass, np.nan)
        parts.inertias = np.where((kept.has_inertia & ~old)[:, None], kept.inertia, np.nan)
        parts.uids = np.where(kept.has_uid, kept.uid, 0)
        parts.sids = np.where(kept.has_sid, kept.sid, -1)
        parts.names = list(kept.names)
        return parts

    def settle(self, leaves: Parts, unions: Parts) -> None:
        """Put the origins of innermost unions that have none at their centres of mass."""
        kept = self.unions._profile.unions.take(self.rows)
        full = np.zeros(len(self.rows), np.bool_)
        full[self.around[self.around >= 0]] = True
        rows = np.flatnonzero(~kept.has_inertia & ~full)
        if not len(rows):
            return
        place = np.full(len(self.rows) + 1, -1, np.int64)
        place[rows] = np.arange(len(rows))
        held = place[self.leaf_around]
        mine = np.flatnonzero(held >= 0)
        some = leaves.take(self.leaf_rows[mine])
        centers = self.unions._centers(some, held[mine], len(rows))
        unions.poses.put(rows, unions.poses.take(rows).then(centers))
        at = self.leaf_rows[mine]
        leaves.poses.put(at, centers.inverse().take(held[mine]).then(leaves.poses.take(at)))

    def last_leaves(self) -> Array:
        """The last member in each union (u,), at any depth, by its row."""
        last = np.full(len(self.rows), -1, np.int64)
        inside = self.leaf_around >= 0
        np.maximum.at(last, self.leaf_around[inside], self.leaf_rows[inside])
        for level in range(int(self.depth.max(initial=0)), 0, -1):
            here = np.flatnonzero(self.depth == level)
            np.maximum.at(last, self.around[here], last[here])
        return last


def _pose_texts(poses: Poses) -> Callable[[int], str]:
    return lambda row: (
        f"{tuple(poses.positions[row].tolist())} {tuple(poses.orientations[row].tolist())}"
    )

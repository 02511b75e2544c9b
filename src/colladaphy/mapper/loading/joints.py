"""Rigid constraints as joints (thesis 4.5, 5.3; COLLADA 1.5 §rigid_constraint).

A constraint binds the two bodies of the same instance of its physics model. Attachments are frames
in the rigid_body; in the World they are frames in the body, whose origin is the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.links import rules as link_rules
from colladaphy.links.poses import Poses, reach
from colladaphy.mapper import rules
from colladaphy.mapper.loading.bodies import LoadedBodies
from colladaphy.mapper.loading.constraints import Constraints, read_constraints
from colladaphy.mapper.loading.creation import free_ids
from colladaphy.mapper.loading.deciding import Prefer
from colladaphy.mapper.loading.ends import Ends
from colladaphy.mapper.loading.found import named_below
from colladaphy.mapper.loading.instances import Expansion
from colladaphy.mapper.loading.sameness import Sameness, tolerance_of
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.tokens import same_token, system_id
from colladaphy.meaning.profile_rules import OLD_VALUE
from colladaphy.world import JointColumns, World

__all__ = ["LoadedJoints", "load_joints"]

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class LoadedJoints:
    """Joints, one a row, and the elements that they were made of."""

    sids: Array
    """(n,) system ids; a World that did not take the joint has none of that id."""
    instances: Array
    """(n,) rows of the instance_rigid_constraint elements."""
    constraints: Array
    """(n,) rows of the rigid_constraint elements."""
    models: Array
    """(n,) the instances of models that they stand in."""


def load_joints(
    tables: Tables, expansion: Expansion, loaded: LoadedBodies, created: Array, world: World,
    prefer: Prefer,
) -> LoadedJoints:  # fmt: skip
    """Create the joints of all constraints that are instanced; what cannot be one is noted."""
    instances = tables.constraint_instances
    rows, models = instances.below(tables.model_instances.keys(expansion.rows))
    if not len(rows):
        return LoadedJoints(rows, rows, rows, models)
    texts = instances.texts("constraint")
    names = [texts[row] for row in rows.tolist()]
    found = named_below(tables.constraints, tables.models.keys(expansion.models)[models], names)
    for place in np.flatnonzero(found < 0).tolist():
        model = tables.models.texts("id")[int(expansion.models[models[place]])]
        home = tables.pool.resources[int(instances.homes(rows[place : place + 1])[0])]
        message = f"The model {model!r} has no rigid constraint {names[place]!r}."
        tables.resource.note(link_rules.MISSING, int(instances.ordinals[rows[place]]), message,
                             home=home)  # fmt: skip
    good = np.flatnonzero(found >= 0)
    read = tables.constraints.gather(read_constraints)
    ends = Ends(tables, expansion, loaded, created, read)
    attached, bodies, places = ends.attached(found[good], models[good])
    kept = good[attached]
    sids = kept
    if len(kept):
        sids = _Joints(tables, loaded, world, prefer, read, found[kept], bodies, places).create()
    return LoadedJoints(sids, rows[kept], found[kept], models[kept])


class _Joints:
    """Joints to be, one a row."""

    def __init__(
        self, tables: Tables, loaded: LoadedBodies, world: World, prefer: Prefer,
        read: Constraints, rows: Array, bodies: Array, places: Poses,
    ) -> None:  # fmt: skip
        self._tables = tables
        self._world = world
        self._prefer = prefer
        self._read = read
        self._rows = rows
        self._bodies = bodies
        self._sameness = Sameness(len(rows), self._tolerance)
        sides = (2 * rows[:, None] + np.arange(2)).reshape(-1)
        flat = bodies.reshape(-1)
        self._origins = Poses.none(len(flat))
        there = np.flatnonzero(flat >= 0)
        self._origins.put(there, loaded.origins.take(flat[there]))
        outer = places
        outer.put(there, self._origins.take(there))
        self.frames = outer.then(read.frames.take(sides))
        self._sides = sides
        sids = loaded.parts.sids[loaded.tops]
        self.ends = np.where(bodies >= 0, sids[bodies] if len(sids) else 0, 0)

    def _place(self, row: int) -> tuple[Any, int]:
        table = self._tables.constraints
        home = self._tables.pool.resources[int(table.homes(self._rows[row : row + 1])[0])]
        return home, int(table.ordinals[self._rows[row]])

    def _tolerance(self, row: int) -> float:
        home, element = self._place(row)
        return tolerance_of(home, element)

    def create(self) -> Array:
        """Create them, in the order of their system ids; returns these (n,)."""
        read, rows = self._read, self._rows
        linear, angular = read.linear[rows].copy(), read.angular[rows].copy()
        springs, has = read.springs[rows].copy(), read.has_spring[rows].copy()
        motors = np.zeros((len(rows), 2))
        if self._prefer != "common":
            self._refine(linear, angular, springs, has)
            motors = read.motors[rows]
        springs[~has] = 0.0
        sids, uids, names = self._identities()
        order = np.argsort(sids, kind="stable")
        columns = JointColumns(
            bodies=self.ends[order],
            sids=sids[order],
            uids=uids[order],
            positions=self.frames.positions.reshape(-1, 2, 3)[order],
            orientations=self.frames.orientations.reshape(-1, 2, 4)[order],
            linear_limits=linear[order],
            angular_limits=angular[order],
            linear_springs=springs[order, 0],
            angular_springs=springs[order, 1],
            motors=motors[order],
            enabled=read.enabled[rows][order],
            interpenetrate=read.interpenetrate[rows][order],
            names=[names[row] for row in order.tolist()],
        )
        self._extend(columns, order, 0, len(order))
        return sids

    def _extend(self, columns: JointColumns, order: Array, begin: int, end: int) -> None:
        """Create a range of the joints, by halves where the World does not take all of it."""
        if begin == end:
            return
        span = slice(begin, end)
        part = JointColumns(**{name: getattr(columns, name)[span]
                               for name in JointColumns.__dataclass_fields__})  # fmt: skip
        try:
            self._world.extend_joints(part)
        except WorldError as error:
            if end - begin == 1:
                home, element = self._place(int(order[begin]))
                message = f"{error.findings[0].message} The constraint is skipped."
                self._tables.resource.note(rules.CONSTRAINT_FAULTY, element, message, home=home)
                return
            middle = (begin + end) // 2
            self._extend(columns, order, begin, middle)
            self._extend(columns, order, middle, end)

    def _note_large(self, row: int) -> None:
        table = self._tables.constraints
        home = self._tables.pool.resources[int(table.homes(np.array([row]))[0])]
        message = f"An id of the joint {table.texts('sid')[row]!r} has more than 64 bits."
        self._tables.resource.note(rules.ID_LARGE, int(table.ordinals[row]), message, home=home)

    def _identities(self) -> tuple[Array, Array, list[str | None]]:
        read, rows = self._read, self._rows
        sids, names = self._tables.constraints.texts("sid"), self._tables.constraints.texts("name")
        for row in rows[read.large[rows]].tolist():
            self._note_large(row)
        wanted: list[int | None] = []
        kept_names: list[str | None] = []
        columns = (column[rows].tolist() for column in (read.kept, read.kept_sids))
        for row, kept, explicit in zip(rows.tolist(), *columns, strict=True):
            name = names[row]
            sid: int | None = None
            if kept:
                sid = system_id(sids[row] or "", "Joint") if explicit == -1 else explicit
                exact = read.kept_names[row]
                if exact is not None and same_token(exact, name):
                    name = exact
            wanted.append(sid)
            kept_names.append(name)
        uids = np.where(read.kept[rows], read.uids[rows], 0)
        return np.array(free_ids(wanted, ()), np.int64), uids, kept_names

    def _refine(self, linear: Array, angular: Array, springs: Array, has: Array) -> None:
        """Take the profile's values where they are the newer ones."""
        read, rows = self._read, self._rows
        self._refine_frames()
        for name, column, exact, told in (
            ("linear limits", linear, read.exact_linear, read.has_linear),
            ("angular limits", angular, read.exact_angular, read.has_angular),
        ):
            mine = np.flatnonzero(told[rows])
            if len(mine):
                kept = exact[rows[mine]]
                same = self._sameness.each(mine, column[mine], kept)
                taken = self._taken(name, mine, column[mine], kept, same)
                column[mine[taken]] = kept[taken]
        for side, name in enumerate(("linear spring", "angular spring")):
            mine = np.flatnonzero(read.has_exact_spring[rows, side])
            if len(mine):
                kept = read.exact_springs[rows[mine], side]
                stated = springs[mine, side]
                same = has[mine, side] & self._sameness.each(mine, stated, kept)
                same |= np.any(np.abs(kept) > 1e300, axis=1)
                taken = self._taken(name, mine, stated, kept, same)
                springs[mine[taken], side] = kept[taken]
                has[mine[taken], side] = True

    def _refine_frames(self) -> None:
        """The frames of the profile, unless what they are in the common profile was edited."""
        exact = self._read.exact_frames.take(self._sides)
        mine = np.flatnonzero(~exact.is_identity())
        if not len(mine):
            return
        stated, told = self.frames.take(mine), exact.take(mine)
        made = stated.take(np.arange(len(mine)))
        made.positions[told.moved], made.moved[told.moved] = told.positions[told.moved], True
        made.orientations[told.turned] = told.orientations[told.turned]
        made.turned[told.turned] = True
        outer = self._origins.take(mine).inverse()
        one, other = outer.then(stated), outer.then(made)
        joints = mine // 2
        same = self._sameness.turn(joints, one.orientations, other.orientations)
        finite = np.isfinite(np.column_stack([one.positions, other.positions])).all(axis=1)
        level = np.flatnonzero(finite & same)
        extent = reach(outer.positions)
        same[level] = self._sameness.whole(
            joints[level], one.positions[level], other.positions[level], extent[level]
        )
        taken = self._taken("frame", joints, one.positions, other.positions, same)
        self.frames.put(mine[taken], made.take(taken))

    def _taken(self, what: str, joints: Array, stated: Array, kept: Array, same: Array) -> Array:
        if self._prefer == "profile":
            return np.ones(len(joints), np.bool_)
        for row in np.flatnonzero(~same).tolist():
            home, element = self._place(int(joints[row]))
            sid = self._tables.constraints.texts("sid")[int(self._rows[joints[row]])]
            message = (
                f"The {what} of {sid!r} is {tuple(stated[row].reshape(-1).tolist())} in the common "
                f"profile, {tuple(kept[row].reshape(-1).tolist())} in the pe profile; the common "
                "one was edited and is taken."
            )
            self._tables.resource.note(OLD_VALUE, element, message, home=home)
        return same

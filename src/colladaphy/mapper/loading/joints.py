"""Rigid constraints as joints (thesis 4.5, 5.3; COLLADA 1.5 §rigid_constraint).

A constraint binds the two bodies of the same instance of its physics model. Attachments are frames
in the rigid_body; in the World they are frames in the body, whose origin is the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import DocumentError, WorldError
from colladaphy.links import rules as link_rules
from colladaphy.links.addresses import split_reference
from colladaphy.links.poses import DEGREE, Poses
from colladaphy.links.steps import poses_of
from colladaphy.mapper import rules
from colladaphy.mapper.loading.bodies import LoadedBodies
from colladaphy.mapper.loading.creation import free_ids
from colladaphy.mapper.loading.deciding import Prefer
from colladaphy.mapper.loading.found import named_below
from colladaphy.mapper.loading.instances import Expansion
from colladaphy.mapper.loading.profile import first_of
from colladaphy.mapper.loading.sameness import Sameness, tolerance_of
from colladaphy.mapper.loading.tables import Tables
from colladaphy.mapper.tokens import same_token, system_id
from colladaphy.world import JointColumns, World

__all__ = ["LoadedJoints", "load_joints"]

Array = NDArray[Any]

_SIDES = ("ref_attachment", "attachment")
_LARGEST = 1.7e308


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


@dataclass(slots=True)
class _Constraints:
    """The rigid_constraints of a document; what the profile does not say is masked out."""

    references: list[str]
    """(2 n,) what the two attachments of each refer to, empty for the world."""
    origins: Array
    """(n, 2) the elements of the attachments; -1 for none."""
    frames: Poses
    """(2 n,) in the rigid_bodies."""
    enabled: Array
    interpenetrate: Array
    linear: Array
    """(n, 2, 3) limits."""
    angular: Array
    """(n, 2, 3) in radians."""
    springs: Array
    """(n, 2, 3) stiffness, damping, target: linear, angular per radian."""
    has_spring: Array
    kept: Array
    """(n,) whether the profile has a joint."""
    uids: Array
    kept_sids: Array
    kept_names: list[str | None]
    exact_frames: Poses
    """(2 n,)."""
    exact_linear: Array
    has_linear: Array
    exact_angular: Array
    has_angular: Array
    exact_springs: Array
    has_exact_spring: Array


def _read(constraints: Any, home: int, start: int) -> _Constraints:
    count = len(constraints)
    references = [""] * (2 * count)
    origins = np.full((count, 2), -1, np.int64)
    frames = Poses.none(2 * count)
    for side, name in enumerate(_SIDES):
        attachment = getattr(constraints, name)
        rows = attachment.owner
        origins[rows, side] = attachment.ordinals
        for row, reference in zip(rows.tolist(), attachment.rigid_body, strict=True):
            references[2 * row + side] = reference or ""
        frames.put(2 * rows + side, poses_of(attachment))
    common = constraints.technique_common
    enabled = _flag(common, common.enabled, count, True)
    interpenetrate = _flag(common, common.interpenetrate, count, False)
    limits = common.limits
    linear = _limits(common, limits, limits.linear, count)
    angular = _limits(common, limits, limits.swing_cone_and_twist, count) * DEGREE
    springs = np.zeros((count, 2, 3))
    has_spring = np.zeros((count, 2), np.bool_)
    outer = common.spring
    for side, name in enumerate(("linear", "angular")):
        inner = getattr(outer, name)
        if not len(inner):
            continue
        rows = common.owner[outer.owner[inner.owner]]
        springs[rows, side] = np.column_stack([
            _spring_value(inner, part, default)
            for part, default in (("stiffness", 1.0), ("damping", 0.0), ("target_value", 0.0))
        ])  # fmt: skip
        has_spring[rows, side] = True
    with np.errstate(all="ignore"):
        per_radian = springs[:, 1, :2] / DEGREE
        springs[:, 1, :2] = np.where(np.isinf(per_radian), np.copysign(_LARGEST, per_radian),
                                     per_radian)  # fmt: skip
        springs[:, 1, 2] *= DEGREE
    return _Constraints(references, origins, frames, enabled, interpenetrate, linear, angular,
                        springs, has_spring, **_profile(constraints, count))  # fmt: skip


def _flag(common: Any, child: Any, count: int, default: bool) -> Array:
    made = np.full(count, default)
    if len(child):
        made[common.owner[child.owner]] = child.value
    return made


def _limits(common: Any, limits: Any, group: Any, count: int) -> Array:
    made = np.zeros((count, 2, 3))
    for place, name in enumerate(("min", "max")):
        child = getattr(group, name)
        if len(child):
            rows = common.owner[limits.owner[group.owner[child.owner]]]
            made[rows, place] = child.value
    return made


def _spring_value(group: Any, name: str, default: float) -> Array:
    child = getattr(group, name)
    made = np.full(len(group), default)
    made[child.owner] = child.value
    return made


def _profile(constraints: Any, count: int) -> dict[str, Any]:
    """What the pe profile says of constraints."""
    joints, owner = first_of(constraints, constraints.technique, "joint")
    kept = np.zeros(count, np.bool_)
    kept[owner] = True
    uids, sids = np.zeros(count, np.int64), np.full(count, -1, np.int64)
    uids[owner] = np.where(joints.uid.present, joints.uid.values, 0)
    sids[owner] = np.where(joints.sid.present, joints.sid.values, -1)
    names: list[str | None] = [None] * count
    for row, name in zip(owner.tolist(), joints.name, strict=True):
        names[row] = name
    frames = Poses.none(2 * count)
    for side, attribute in enumerate(("frame1", "frame2")):
        frame = getattr(joints, attribute)
        if len(frame):
            at, turn = frame.position, frame.orientation
            poses = Poses.of(
                len(frame), at.values, turn.values, moved=at.present, turned=turn.present
            )
            frames.put(2 * owner[frame.owner] + side, poses)
    made: dict[str, Any] = {
        "kept": kept, "uids": uids, "kept_sids": sids, "kept_names": names, "exact_frames": frames,
        "exact_springs": np.zeros((count, 2, 3)),
        "has_exact_spring": np.zeros((count, 2), np.bool_),
    }  # fmt: skip
    for name in ("linear", "angular"):
        exact, has = np.zeros((count, 2, 3)), np.zeros(count, np.bool_)
        limits = getattr(joints, f"{name}_limits")
        if len(limits):
            rows = owner[limits.owner]
            exact[rows, 0], exact[rows, 1] = limits.min, limits.max
            has[rows] = True
        made[f"exact_{name}"], made[f"has_{name}"] = exact, has
        spring = getattr(joints, f"{name}_spring")
        if len(spring):
            rows, side = owner[spring.owner], int(name == "angular")
            values = np.column_stack([spring.stiffness, spring.damping, spring.target_value])
            made["exact_springs"][rows, side] = values
            made["has_exact_spring"][rows, side] = True
    return made


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
    read = tables.constraints.gather(_read)
    ends = _Ends(tables, expansion, loaded, created, read)
    attached, bodies, places = ends.attached(found[good], models[good])
    kept = good[attached]
    sids = kept
    if len(kept):
        sids = _Joints(tables, loaded, world, prefer, read, found[kept], bodies, places).create()
    return LoadedJoints(sids, rows[kept], found[kept], models[kept])


class _Ends:
    """Finds the bodies that attachments mean."""

    def __init__(
        self, tables: Tables, expansion: Expansion, loaded: LoadedBodies, created: Array,
        read: _Constraints,
    ) -> None:  # fmt: skip
        self._tables = tables
        self._expansion = expansion
        self._created = created
        self._read = read
        found = loaded.found
        self._by_model: dict[tuple[int, int], list[int]] = {}
        self._by_body: dict[int, list[int]] = {}
        for body, (model, row) in enumerate(
            zip(found.models.tolist(), found.bodies.tolist(), strict=True)
        ):
            self._by_model.setdefault((model, row), []).append(body)
            self._by_body.setdefault(row, []).append(body)
        bodies = tables.bodies
        self._sids: dict[tuple[int, str], int] = {}
        for row, (key, sid) in enumerate(
            zip(bodies.parent_keys.tolist(), bodies.texts("sid"), strict=True)
        ):
            self._sids.setdefault((key, sid), row)
        self._model_keys = tables.models.keys(expansion.models).tolist()
        self._model_ids = [tables.models.texts("id")[row] for row in expansion.models.tolist()]
        self._children: dict[int, list[int]] = {}
        for inner, around in enumerate(expansion.around.tolist()):
            self._children.setdefault(around, []).append(inner)
        self._instance_sids = tables.model_instances.texts("sid")

    def attached(self, constraints: Array, models: Array) -> tuple[Array, Array, Poses]:
        """The numbers of those whose ends are all there, and their bodies (n, 2), -1 for the world.

        Of ends at nodes of the world the poses (2 n) of these are given.
        """
        kept: list[int] = []
        bodies: list[tuple[int, int]] = []
        nodes: list[tuple[int, int]] = []
        references = self._read.references
        pairs = zip(constraints.tolist(), models.tolist(), strict=True)
        for number, (row, model) in enumerate(pairs):
            ends: list[int] = []
            stands: list[int] = []
            try:
                for side in (0, 1):
                    reference = references[2 * row + side]
                    body, node = -1, -1
                    if reference:
                        body, node = self._end(row, side, model, reference)
                    ends.append(body)
                    stands.append(node)
            except DocumentError as error:
                self._tables.resource.report.extend(error.findings)
                continue
            if -2 in ends:
                reference = references[2 * row + ends.index(-2)]
                home, element = self._place(row)
                message = f"The body {reference!r} was not loaded; the constraint is skipped."
                self._tables.resource.note(rules.CONSTRAINT_SKIPPED, element, message, home=home)
                continue
            kept.append(number)
            bodies.append((ends[0], ends[1]))
            nodes.append((stands[0], stands[1]))
        flat = np.array(nodes, np.int64).reshape(-1)
        places = Poses.none(len(flat))
        there = np.flatnonzero(flat >= 0)
        if len(there):
            places.put(there, self._tables.placement.poses(flat[there])[0])
        return np.array(kept, np.int64), np.array(bodies, np.int64).reshape(-1, 2), places

    def _place(self, row: int) -> tuple[Any, int]:
        table = self._tables.constraints
        home = self._tables.pool.resources[int(table.homes(np.array([row]))[0])]
        return home, int(table.ordinals[row])

    def _end(self, row: int, side: int, model: int, reference: str) -> tuple[int, int]:
        """The body that an attachment means, -2 if it was not loaded; or -1 and a node."""
        # As nearly all are written: the model, or nothing, and the sid of the body.
        outer, slash, sid = reference.rpartition("/")
        if outer == self._model_ids[model] or not slash:
            quick = self._sids.get((self._model_keys[model], sid))
            if quick is not None:
                return self._only(self._by_model.get((model, quick), ()), row, side), -1
        file, head, sids = split_reference(reference)
        if not file:
            path = sids if head in (".", self._model_ids[model]) else [head, *sids]
            where: int | None = model
            for step in path[:-1]:
                where = None if where is None else self._child(where, step)
            if where is not None and path:
                body = self._sids.get((self._model_keys[where], path[-1]))
                if body is not None:
                    return self._only(self._by_model.get((where, body), ()), row, side), -1
        home, _ = self._place(row)
        origin = int(self._read.origins[row, side])
        target, element = home.follow(reference, origin, ("rigid_body", "node"))
        number = self._tables.pool.number(target)
        if target.columns.local_name(element) == "node":
            node = self._tables.placement.nodes.row_of(number, element)
            _, circles = self._tables.placement.poses(np.array([node]))
            if circles:
                raise circles[node]
            return -1, node
        body = self._tables.bodies.row_of(number, element)
        inside = self._walk(model)
        within = [found for inner in inside for found in self._by_model.get((inner, body), ())]
        return self._only(within or self._by_body.get(body, ()), row, side), -1

    def _child(self, model: int, name: str) -> int | None:
        """The instance within one of a sid, or else of a model's id."""
        children = self._children.get(model, ())
        rows = self._expansion.rows
        for child in children:
            if self._instance_sids[int(rows[child])] == name:
                return child
        for child in children:
            if self._model_ids[child] == name:
                return child
        return None

    def _walk(self, model: int) -> list[int]:
        found = [model]
        for inner in found:
            found += self._children.get(inner, ())
        return found

    def _only(self, bodies: Any, row: int, side: int) -> int:
        if len(bodies) > 1:
            home, _ = self._place(row)
            element = home.element(int(self._read.origins[row, side]))
            reference = self._read.references[2 * row + side]
            message = (
                f"The body {reference!r} is instanced {len(bodies)} times in one instance of its "
                "model, so a constraint cannot tell which one is meant."
            )
            raise DocumentError(
                rules.BODY_TWICE.at(element, message, file=self._tables.resource.file)
            )
        return bodies[0] if bodies and self._created[bodies[0]] else -2


class _Joints:
    """Joints to be, one a row."""

    def __init__(
        self, tables: Tables, loaded: LoadedBodies, world: World, prefer: Prefer,
        read: _Constraints, rows: Array, bodies: Array, places: Poses,
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
        if self._prefer != "common":
            self._refine(linear, angular, springs, has)
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

    def _identities(self) -> tuple[Array, Array, list[str | None]]:
        read, rows = self._read, self._rows
        sids, names = self._tables.constraints.texts("sid"), self._tables.constraints.texts("name")
        wanted: list[int | None] = []
        kept_names: list[str | None] = []
        for row in rows.tolist():
            name = names[row]
            sid: int | None = None
            if read.kept[row]:
                explicit = int(read.kept_sids[row])
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
        extent = np.abs(outer.positions).max(axis=1)
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
            self._tables.resource.note(rules.STALE, element, message, home=home)
        return same

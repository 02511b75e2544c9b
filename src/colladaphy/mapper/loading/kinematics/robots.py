"""Instances of kinematics models in the scene: where they stand, and what is said of their axes."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from colladaphy.errors import ColladaError
from colladaphy.links.names import c
from colladaphy.mapper import rules
from colladaphy.mapper.loading.kinematics.models import Model, Place, numbers_of, read_model
from colladaphy.mapper.loading.kinematics.references import References, Value
from colladaphy.mapper.loading.tables import Tables
from colladaphy_schema.kinematics_columns import (
    ArticulatedSystemTypeRows,
    InstanceKinematicsSceneTypeRows,
    KinematicsSceneTypeRows,
)
from colladaphy_schema.kinematics_model_columns import KinematicsModelTypeRows

__all__ = ["AxisInfo", "Bound", "Robot", "find_robots"]

_MOST_ROBOTS = 10_000
_MEMBER = re.compile(r"(\.[A-Za-z_]\w*|(\(\d+\)){1,2})\s*$")


@dataclass(slots=True)
class Bound:
    """What an axis moves in the visual scene."""

    node: int
    """The row of the node."""
    step: int
    """The number of the transform in it that the joint's value is; -1 for the node as a whole."""
    value: float | None
    """Degrees or a length."""


@dataclass(slots=True)
class AxisInfo:
    """What an articulated system says of an axis."""

    low: float | None = None
    high: float | None = None
    """As they are written: degrees or a length."""
    locked: bool = False
    formulas: list[Place] = field(default_factory=list)
    """What makes it follow others."""


@dataclass(slots=True)
class Robot:
    """One instance of a kinematics model."""

    model: Model
    through: frozenset[Place]
    """The instances that lead to it."""
    systems: frozenset[Place]
    """The articulated systems that it stands in."""
    node: int = -1
    """The row of the node that its outermost link is."""
    bound: dict[Place, Bound] = field(default_factory=dict)
    """By axis."""
    infos: dict[Place, AxisInfo] = field(default_factory=dict)
    """By axis."""
    values: dict[Place, float] = field(default_factory=dict)
    """Degrees or lengths at the pose of the file, by axis; those that are missing are zero."""


def find_robots(tables: Tables, references: References) -> list[Robot]:
    """The kinematics models that the scene instances; what leads nowhere is noted."""
    resource = tables.resource
    rows = resource.columns.rows(InstanceKinematicsSceneTypeRows, c("instance_kinematics_scene"))
    finder = _Finder(tables, references)
    for row, ordinal in enumerate(numbers_of(rows)):
        finder.add_scene((0, ordinal), rows.select(np.array([row])))
    return finder.robots


class _Finder:
    def __init__(self, tables: Tables, references: References) -> None:
        self._tables = tables
        self._pool = tables.pool
        self._references = references
        self._models = self._pool.table(KinematicsModelTypeRows, c("kinematics_model"))
        self._read: dict[Place, Model] = {}
        self.robots: list[Robot] = []

    def add_scene(self, place: Place, rows: Any) -> None:
        """The robots of one instance of a kinematics scene."""
        target = self._references.instance_of(place)
        if target is None:
            self._note(rules.KINEMATICS_LOST, place, "The kinematics scene cannot be found.")
            return
        begin = len(self.robots)
        self._collect(target, frozenset(), frozenset(), 0)
        mine = self.robots[begin:]
        for robot in mine:
            self._add_infos(robot)
        home = place[0]
        binds = rows.bind_kinematics_model
        params = _texts(binds, binds.param)
        for ordinal, node, address, param in zip(
            numbers_of(binds), binds.node, binds.SIDREF, params, strict=True
        ):
            meant = self._meant(address or param, (home, ordinal), mine)
            if meant is None:
                message = f"The kinematics model {address or param!r} cannot be found."
                self._note(rules.KINEMATICS_LOST, (home, ordinal), message)
            elif node:
                found = self._target(node, (home, ordinal))
                if found is not None:
                    meant.node = found[0]
        self._bind_axes(home, rows.bind_joint_axis, mine)

    # --- the models that are instanced

    def _collect(
        self, place: Place, through: frozenset[Place], systems: frozenset[Place], depth: int
    ) -> None:
        """The models that a scene or an articulated system instances, at any depth."""
        home, element = place
        kind = self._pool.resources[home].columns.local_name(element)
        if kind == "kinematics_model":
            model = self._model(place)
            if model is not None and len(self.robots) < _MOST_ROBOTS:
                self.robots.append(Robot(model, through, systems))
            return
        if depth > 64 or place in systems:
            return
        if kind == "articulated_system":
            rows: Any = self._rows(ArticulatedSystemTypeRows, "articulated_system", place)
            systems |= {place}
            instances = [
                *numbers_of(rows.kinematics.instance_kinematics_model),
                *numbers_of(rows.motion.instance_articulated_system),
            ]
        elif kind == "kinematics_scene":
            rows = self._rows(KinematicsSceneTypeRows, "kinematics_scene", place)
            instances = [
                *numbers_of(rows.instance_kinematics_model),
                *numbers_of(rows.instance_articulated_system),
            ]
        else:
            return
        for ordinal in sorted(instances):
            inner = self._references.instance_of((home, ordinal))
            if inner is None:
                self._note(rules.KINEMATICS_LOST, (home, ordinal),
                           "What is instanced here cannot be found.")  # fmt: skip
            else:
                self._collect(inner, through | {(home, ordinal)}, systems, depth + 1)

    def _rows(self, kind: Any, name: str, place: Place) -> Any:
        rows = self._pool.resources[place[0]].columns.rows(kind, c(name))
        return rows.select(rows.ordinals == place[1])

    def _model(self, place: Place) -> Model | None:
        if place not in self._read:
            row = self._models.row_of(*place)
            if row < 0:
                return None
            self._read[place] = read_model(self._pool, row)
        return self._read[place]

    def _meant(self, reference: str | None, origin: Place, among: list[Robot]) -> Robot | None:
        """The robot that a binding means."""
        value = self._references.resolve(reference, origin) if reference else None
        if value is None or value.place is None:
            return among[0] if len(among) == 1 else None
        return self._best(value.place, value.through, among)

    @staticmethod
    def _best(place: Place, through: frozenset[Place], among: list[Robot]) -> Robot | None:
        """The robot that stands behind the most of the instances that a path went through."""
        scored = [
            (len(robot.through & (through | {place})) - 1e-6 * number, robot)
            for number, robot in enumerate(among)
        ]
        fits = [
            (score, robot) for score, robot in scored
            if score > 0.5 or robot.model.place == place or len(among) == 1
        ]  # fmt: skip
        return max(fits, key=lambda one: one[0])[1] if fits else None

    # --- axes

    def _axis(self, found: Value | None) -> Place | None:
        if found is None or found.place is None:
            return None
        return self._references.axis_of(found.place)

    def _bind_axes(self, home: int, binds: Any, among: list[Robot]) -> None:
        axes = binds.axis
        addresses: list[str | None] = [None] * len(binds)
        params = _texts(axes, axes.param)
        for owner, address, param in zip(axes.owner.tolist(), axes.SIDREF, params, strict=True):
            addresses[owner] = address or param
        values = self._numbers(home, binds, binds.value)
        for ordinal, target, address, value in zip(
            numbers_of(binds), binds.target, addresses, values, strict=True
        ):
            origin = home, ordinal
            found = self._references.resolve(address, origin) if address else None
            axis = self._axis(found)
            if found is None or axis is None:
                self._note(rules.KINEMATICS_LOST, origin, f"The axis {address!r} cannot be found.")
                continue
            robot = self._best(axis, found.through, among)
            if robot is None:
                continue
            where = self._target(target, origin) if target else None
            if where is None:
                where = -1, -1
            robot.bound[axis] = Bound(*where, value)

    def _numbers(self, home: int, rows: Any, child: Any) -> list[float | None]:
        """Numbers that are given, or by a parameter."""
        made: list[float | None] = [None] * len(rows)
        params = _texts(child, child.param)
        for at, (owner, param, ordinal) in enumerate(
            zip(child.owner.tolist(), params, numbers_of(child), strict=True)
        ):
            if child.float.present[at]:
                made[owner] = float(child.float.values[at])
            elif param:
                value = self._references.resolve(param, (home, ordinal))
                made[owner] = None if value is None else value.number
        return made

    def _flags(self, home: int, rows: Any, child: Any) -> list[bool]:
        made = [False] * len(rows)
        params = _texts(child, child.param)
        for at, (owner, param, ordinal) in enumerate(
            zip(child.owner.tolist(), params, numbers_of(child), strict=True)
        ):
            if child.bool.present[at]:
                made[owner] = bool(child.bool.values[at])
            elif param:
                value = self._references.resolve(param, (home, ordinal))
                made[owner] = bool(value is not None and value.flag)
        return made

    def _add_infos(self, robot: Robot) -> None:
        """What the articulated systems around a robot say of its axes."""
        for home, element in sorted(robot.systems):
            rows = self._rows(ArticulatedSystemTypeRows, "articulated_system", (home, element))
            infos = rows.kinematics.technique_common.axis_info
            limits = infos.limits
            lows, highs = (self._numbers(home, limits, child) for child in (limits.min, limits.max))
            there = dict(zip(limits.owner.tolist(), zip(lows, highs, strict=True), strict=True))
            locked = self._flags(home, infos, infos.locked)
            formulas: list[list[Place]] = [[] for _ in range(len(infos))]
            for child in (infos.formula, infos.instance_formula):
                for owner, ordinal in zip(child.owner.tolist(), numbers_of(child), strict=True):
                    formulas[owner].append((home, ordinal))
            for row, (ordinal, address) in enumerate(
                zip(numbers_of(infos), infos.axis, strict=True)
            ):
                found = self._references.resolve(address, (home, ordinal))
                axis = self._axis(found)
                if axis is None:
                    self._note(rules.KINEMATICS_LOST, (home, ordinal),
                               f"The axis {address!r} cannot be found.")  # fmt: skip
                    continue
                low, high = there.get(row, (None, None))
                robot.infos[axis] = AxisInfo(low, high, locked[row], formulas[row])

    # --- nodes

    def _target(self, reference: str, origin: Place) -> tuple[int, int] | None:
        """The row of the node that a reference leads to, and the transform in it."""
        whole = self._followed(reference, origin)
        # A path may end in what is meant of a transform: its ANGLE, or a number of it.
        home, found = whole or self._followed(_MEMBER.sub("", reference), origin) or (0, None)
        if found is None:
            self._note(rules.KINEMATICS_LOST, origin, f"The node {reference!r} cannot be found.")
            return None
        columns = self._pool.resources[home].columns
        step = -1
        if columns.local_name(found) != "node":
            step, found = found, columns.parent_of(found)
        row = self._tables.placement.nodes.row_of(home, found)
        return None if row < 0 else (row, step)

    def _followed(self, reference: str, origin: Place) -> Place | None:
        home, element = origin
        resource = self._pool.resources[home]
        try:
            target, found = resource.follow(reference, element)
            return self._pool.number(target), found
        except ColladaError:
            # The first step may be a sid, of a node anywhere.
            head, *rest = reference.strip().lstrip("#").split("/")
            at: int | None = resource.sids.within(0, head)
            for sid in rest:
                at = None if at is None else resource.sids.within(at, sid)
            return None if at is None else (home, at)

    def _note(self, rule: Any, place: Place, message: str) -> None:
        home = self._pool.resources[place[0]]
        self._tables.resource.note(rule, place[1], message, home=home)


def _texts(rows: Any, child: Any) -> list[str | None]:
    made: list[str | None] = [None] * len(rows)
    for owner, text in zip(child.owner.tolist(), child.value, strict=True):
        made[owner] = text
    return made

"""Kinematic joints as joints of the World (COLLADA 1.5 §joint, §attachment_full, §axis_info).

A joint binds the bodies of two links, with the limits of its axes, at the pose of the file.
Neighbouring links touch and overlap by design, so that they do not collide with each other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.findings import Rule
from colladaphy.links.names import c
from colladaphy.links.poses import DEGREE, Poses
from colladaphy.mapper import rules
from colladaphy.mapper.loading.bodies import LoadedBodies
from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.kinematics.formulas import Following, following_of, values_of
from colladaphy.mapper.loading.kinematics.frames import Stand, stands_of
from colladaphy.mapper.loading.kinematics.freedoms import Freedom, freedom_of
from colladaphy.mapper.loading.kinematics.links import WORLD, Carriers
from colladaphy.mapper.loading.kinematics.models import (
    Attachment,
    Axis,
    JointModel,
    Place,
    numbers_of,
    read_joints,
)
from colladaphy.mapper.loading.kinematics.pairs import free_joints, pairs_to_pass, stated_pairs
from colladaphy.mapper.loading.kinematics.references import References
from colladaphy.mapper.loading.kinematics.robots import Robot, find_robots
from colladaphy.mapper.loading.tables import Tables
from colladaphy.world import JointColumns, World
from colladaphy.world.coordinates import angles_of
from colladaphy_schema.kinematics_columns import InstanceKinematicsSceneTypeRows
from colladaphy_schema.kinematics_model_columns import KinematicsModelTypeRows

__all__ = ["load_kinematics"]

Array = NDArray[Any]

_NEAR = 1e-9
"""How far beyond its limits a joint may stand by rounding."""


def load_kinematics(
    tables: Tables, found: FoundBodies, loaded: LoadedBodies, created: Array, world: World
) -> Array:
    """Create the joints of the robots in the scene; returns their system ids (n,).

    `found` are all bodies that are instanced, `loaded` those that have a shape or a mass. What
    cannot be mapped is noted.
    """
    columns = tables.resource.columns
    tag = c("instance_kinematics_scene")
    if not len(columns.rows(InstanceKinematicsSceneTypeRows, tag)):
        models = columns.rows(KinematicsModelTypeRows, c("kinematics_model"))
        if len(models):
            tables.resource.note(rules.KINEMATICS_UNUSED, numbers_of(models)[0])
        return np.zeros(0, np.int64)
    return _Loading(tables, found, loaded, created, world).joints()


class _Loading:
    def __init__(
        self, tables: Tables, found: FoundBodies, loaded: LoadedBodies, created: Array, world: World
    ) -> None:
        self._tables = tables
        self._world = world
        self._references = References(tables.pool)
        self._robots = find_robots(tables, self._references)
        self._library = read_joints(tables.pool)
        there = {
            key: number if created[number] else -1
            for number, key in enumerate(
                zip(loaded.found.models.tolist(), loaded.found.rows.tolist(), strict=True)
            )
        }
        self._carriers = Carriers(tables, found, there)
        self._poses = loaded.parts.poses.take(loaded.tops)
        self._sids = loaded.parts.sids[loaded.tops].tolist()
        self._bound: set[tuple[int, ...]] = {
            tuple(sorted(pair)) for pair in world.joint_table.column("bodies").tolist()
        }
        self._made: list[int] = []

    def joints(self) -> Array:
        """Create the joints of all robots."""
        carried = [self._add(robot) for robot in self._robots]
        if self._robots:
            self._let_pass(carried)
        return np.array(self._made, np.int64)

    def _let_pass(self, carried: Sequence[Mapping[Place, int]]) -> None:
        """Let links pass through each other where the file says so, by joints that hold nothing."""
        links = [link for robot in self._robots for link in robot.model.links]
        for stated in stated_pairs(self._tables.pool, self._references, links):
            if stated.lost:
                message = f"The links of {len(stated.lost)} pairs cannot be found."
                self._note(rules.PAIRS, stated.lost[0], message)
            pairs = [
                (int(self._sids[one]), int(self._sids[two]))
                for one, two in pairs_to_pass(stated.pairs, carried)
                if one >= 0
            ]
            made = free_joints(self._world, pairs)
            if made is not None and stated.first is not None:
                self._made += self._world.extend_joints(made).tolist()
                message = f"{len(made.bodies)} pairs of links pass through each other."
                self._note(rules.PAIRS_PASS, stated.first, message)

    def _add(self, robot: Robot) -> dict[Place, int]:
        """Create the joints of a robot; returns the bodies of its links."""
        model = robot.model
        following = self._follow(robot)
        joints = [self._joint(robot, attachment, following) for attachment in model.attachments]
        for attachment in model.unended:
            self._note(rules.JOINT_UNMAPPED, attachment.place,
                       f"The joint {attachment.joint!r} is attached at one end only.")  # fmt: skip
        bodies, shown = self._carriers.of(robot, joints)
        if not any(body >= 0 for body in bodies):
            message = f"None of the {len(bodies)} links of {model.name!r} is a body that is loaded."
            self._note(rules.ROBOT_EMPTY, model.place, message)
            return {}
        done = self._carry(robot, joints, bodies)
        stands = stands_of(robot, joints, shown, self._tables.placement,
                           self._tables.pool.resources)  # fmt: skip
        for at, (attachment, joint, stand) in enumerate(
            zip(model.attachments, joints, stands, strict=True)
        ):
            if joint is not None and stand is not None and at not in done:
                self._bind(robot, attachment, joint, stand, bodies)
        return {link.place: body for link, body in zip(model.links, bodies, strict=True)}

    # --- joints as the robot has them

    def _follow(self, robot: Robot) -> dict[Place, Following]:
        """What formulas say of the axes of a robot, and the values that these have by it."""
        model = robot.model
        places = [(model.place[0], number) for number in model.formulas]
        places += [place for info in robot.infos.values() for place in info.formulas]
        read = [following_of(self._tables.pool, self._references, place) for place in places]
        following = {found.target: found for found in read if found is not None}
        stated = {axis: bound.value for axis, bound in robot.bound.items()}
        robot.values = values_of(
            {axis: value for axis, value in stated.items() if value is not None}, following
        )
        bad = sum(found is None for found in read)
        free = len(read) - sum(found is not None and not found.slopes for found in read)
        if free:
            message = (
                f"{free} formulas of {model.name!r} make axes follow others: a World has no such "
                "joints. They begin where the formulas put them, and move freely within their "
                "limits"
            )
            message += f"; {bad} formulas are not linear, and not read." if bad else "."
            self._note(rules.JOINT_FOLLOWS, model.place, message)
        return following

    def _joint(
        self, robot: Robot, attachment: Attachment, following: Mapping[Place, Following]
    ) -> JointModel | None:
        """The joint of an attachment, its axes as the articulated system has them."""
        value = self._references.resolve(attachment.joint, attachment.place)
        place = None if value is None else value.place
        if place is not None and place not in self._library:
            inner = self._references.instance_of(place)  # of an instance_joint
            self._library = read_joints(self._tables.pool) if inner is not None else self._library
            name = self._tables.pool.resources[place[0]].columns.attribute_of(place[1], "name")
            sid = self._tables.pool.resources[place[0]].columns.attribute_of(place[1], "sid")
            known = None if inner is None else self._library.get(inner)
            if known is not None:
                place, known = known.place, replace(known, name=name or known.name or sid)
                return _as_told(robot, known, following)
        joint = None if place is None else self._library.get(place)
        if joint is None:
            self._note(rules.KINEMATICS_LOST, attachment.place,
                       f"The joint {attachment.joint!r} cannot be found.")  # fmt: skip
            return None
        return _as_told(robot, joint, following)

    # --- bodies

    def _carry(
        self, robot: Robot, joints: Sequence[JointModel | None], bodies: list[int]
    ) -> set[int]:
        """Let links without a body ride on what they are fixed to; gives the joints that did it."""
        done: set[int] = set()
        changed = True
        while changed:
            changed = False
            for at, (attachment, joint) in enumerate(
                zip(robot.model.attachments, joints, strict=True)
            ):
                ends = attachment.outer, attachment.inner
                if at in done or joint is None or joint.moving:
                    continue
                empty = [end for end in ends if bodies[end] == -1]
                if len(empty) != 1:
                    continue
                bodies[empty[0]] = bodies[ends[0] + ends[1] - empty[0]]
                done.add(at)
                changed = True
                link = robot.model.links[empty[0]]
                message = f"The joint {joint.name!r} fixes {link.label!r}, which has no body."
                self._note(rules.JOINT_EMPTY, attachment.place, message)
        return done

    def _bind(
        self, robot: Robot, attachment: Attachment, joint: JointModel, stand: Stand,
        bodies: list[int],
    ) -> None:  # fmt: skip
        one, two = bodies[attachment.outer], bodies[attachment.inner]
        links = robot.model.links
        if -1 in (one, two):
            missing = links[attachment.outer if one == -1 else attachment.inner]
            message = (
                f"The joint {joint.name!r} is skipped: the link {missing.label!r} has no body."
            )
            self._note(rules.JOINT_UNMAPPED, attachment.place, message)
            return
        if one == two:
            return
        freedom = freedom_of(joint.moving)
        if isinstance(freedom, str):
            message = f"The joint {joint.name!r} is skipped: {freedom}."
            self._note(rules.JOINT_UNMAPPED, attachment.place, message)
            return
        sids = [0 if body == WORLD else self._sids[body] for body in (one, two)]
        pair = tuple(sorted(sids))
        if pair in self._bound:
            message = f"The joint {joint.name!r} binds what a rigid_constraint binds already."
            self._note(rules.JOINT_DOUBLED, attachment.place, message)
            return
        if not stand.agrees:
            message = (
                f"The joint {joint.name!r} stands elsewhere in the nodes than in the kinematics "
                "model; that of the nodes counts."
            )
            self._note(rules.JOINT_FRAMES, attachment.place, message)
        turn = Poses.of(1, None, freedom.turn[None])
        ends = [stand.outer.then(turn), stand.inner.then(turn)]
        linear, angular = self._with_room(joint, attachment, freedom, ends)
        frames = [self._back(body).then(end) for body, end in zip((one, two), ends, strict=True)]
        made = JointColumns(
            bodies=np.array([sids]),
            positions=np.array([[frame.positions[0] for frame in frames]]),
            orientations=np.array([[frame.orientations[0] for frame in frames]]),
            linear_limits=linear[None],
            angular_limits=angular[None],
            interpenetrate=np.ones(1, np.bool_),
            names=[joint.name],
        )
        try:
            self._made += self._world.extend_joints(made).tolist()
        except WorldError as error:
            message = f"{error.findings[0].message} The joint {joint.name!r} is skipped."
            self._note(rules.CONSTRAINT_FAULTY, attachment.place, message)

    def _with_room(
        self, joint: JointModel, attachment: Attachment, freedom: Freedom, ends: Sequence[Poses]
    ) -> tuple[Array, Array]:
        """Limits (2, 3), linear and angular, that the pose of the file is within.

        What begins beyond its limits would be thrown back: a robot that is loaded stands.
        """
        apart = ends[0].inverse().then(ends[1])
        turns = angles_of(freedom.angular, apart.orientations[0])
        made, beyond = [], []
        for limits, values, unit in (
            (freedom.linear, apart.positions[0], 1.0),
            (freedom.angular, turns, DEGREE),
        ):
            low, high = limits
            near = _NEAR * np.maximum(1.0, np.abs(values))
            out = (low != high) & ((values < low - near) | (values > high + near))
            beyond += (values[out] / unit).tolist()
            made.append(np.where(out, [np.minimum(low, values), np.maximum(high, values)], limits))
        if beyond:
            told = ", ".join(f"{value:.6g}" for value in beyond)
            message = (
                f"The joint {joint.name!r} stands at {told}, beyond its limits; they give way."
            )
            self._note(rules.JOINT_BEYOND, attachment.place, message)
        return made[0], made[1]

    def _back(self, body: int) -> Poses:
        """From the world into the frame of a body."""
        return Poses.none(1) if body == WORLD else self._poses.take(np.array([body])).inverse()

    def _note(self, rule: Rule, place: Place, message: str) -> None:
        home = self._tables.pool.resources[place[0]]
        self._tables.resource.note(rule, place[1], message, home=home)


def _as_told(robot: Robot, joint: JointModel, following: Mapping[Place, Following]) -> JointModel:
    """A joint with what the articulated system and the formulas say of its axes."""
    axes = []
    for axis in joint.axes:
        found = following.get(axis.place)
        told = _told(robot, axis)
        axes.append(told if found is None or found.slopes else replace(told, locked=True))
    return replace(joint, axes=tuple(axes))


def _told(robot: Robot, axis: Axis) -> Axis:
    """An axis with the limits that the articulated system gives it."""
    info = robot.infos.get(axis.place)
    if info is None:
        return axis
    scale = 1.0 if axis.slides else DEGREE
    low = axis.low if info.low is None or math.isnan(info.low) else info.low * scale
    high = axis.high if info.high is None or math.isnan(info.high) else info.high * scale
    return replace(axis, low=low, high=high, locked=info.locked)

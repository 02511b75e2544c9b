"""Where the joints of a robot stand in the world, at the pose of the file.

The transform that an axis is bound to says it best: what comes before it in its node, and in all
those around, is the joint's frame on the outer link, and behind it the frame on the inner one.
Where nothing is bound, the model's own chain says it, with the values that its axes have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.links.nodes import Placement
from colladaphy.links.poses import DEGREE, Poses
from colladaphy.links.resource import Resource
from colladaphy.links.steps import rigid_parts, step_matrix
from colladaphy.mapper.loading.kinematics.models import Attachment, Axis, JointModel
from colladaphy.mapper.loading.kinematics.robots import Robot

__all__ = ["Stand", "stands_of"]

Array = NDArray[Any]

_STEPS = ("translate", "rotate", "matrix", "scale", "skew", "lookat")
_APART = 1e-4
"""Angles, and lengths against those of the robot, by which two frames may differ."""


@dataclass(frozen=True, slots=True)
class Stand:
    """Where one joint stands, as frames in the world; one row each."""

    outer: Poses
    """On the outer link, before the first axis that moves."""
    inner: Poses
    """On the inner link, behind the last one."""
    agrees: bool
    """Whether nodes and model say the same."""


@dataclass(frozen=True, slots=True)
class _Ends:
    """Frames around the axes of a joint: all of them, and those that move."""

    first: Poses
    outer: Poses
    inner: Poses
    last: Poses


def stands_of(
    robot: Robot, joints: Sequence[JointModel | None], shown: Sequence[int],
    placement: Placement, resources: Sequence[Resource],
) -> list[Stand | None]:  # fmt: skip
    """The frames of the joints of all attachments (those of `joints` that there are).

    `shown` has the row of the node of each link, -1 for none.
    """
    return _Frames(robot, joints, shown, placement, resources).stands()


class _Frames:
    def __init__(
        self, robot: Robot, joints: Sequence[JointModel | None], shown: Sequence[int],
        placement: Placement, resources: Sequence[Resource],
    ) -> None:  # fmt: skip
        self._robot = robot
        self._joints = joints
        self._shown = shown
        self._placement = placement
        self._resources = resources
        self._links: dict[int, Poses] = {}

    def stands(self) -> list[Stand | None]:
        """Outer links come before inner ones, and what closes loops last."""
        model = self._robot.model
        bound = [
            self._bound(joint) if attachment.after is None else None
            for attachment, joint in zip(model.attachments, self._joints, strict=True)
        ]
        for root in model.roots:
            self._links[root] = self._root(root, bound)
        made: list[Stand | None] = []
        for attachment, joint, ends in zip(model.attachments, self._joints, bound, strict=True):
            made.append(None if joint is None else self._stand(attachment, joint, ends))
            if joint is None and attachment.after is None:
                # A joint that is not there moves nothing.
                own = model.links[attachment.inner].pose
                outer = self._links[attachment.outer]
                self._links[attachment.inner] = outer.then(attachment.before).then(own)
        return made

    def _root(self, root: int, bound: list[_Ends | None]) -> Poses:
        """An outermost link: told by the joints on it, or else by its node."""
        for attachment, ends in zip(self._robot.model.attachments, bound, strict=True):
            if attachment.outer == root and ends is not None:
                return ends.first.then(attachment.before.inverse())
        around = Poses.none(1)
        node = self._robot.node if self._robot.node >= 0 else self._shown[root]
        if node >= 0:
            around = self._placement.poses(np.array([node]))[0]
        return around.then(self._robot.model.links[root].pose)

    def _stand(self, attachment: Attachment, joint: JointModel, ends: _Ends | None) -> Stand:
        before = self._links[attachment.outer].then(attachment.before)
        if attachment.after is not None:
            after = self._links[attachment.inner].then(attachment.after)
            return Stand(before if joint.moving else after, after, True)
        agrees = True
        ends = ends or self._by_node(attachment, joint, before)
        if ends is None:
            chain = [before]
            for axis in joint.axes:
                chain.append(chain[-1].then(_moved(axis, self._robot.values.get(axis.place, 0.0))))
            moving = [at for at, axis in enumerate(joint.axes) if not axis.is_still]
            outer, inner = (moving[0], moving[-1] + 1) if moving else (-1, -1)
            ends = _Ends(before, chain[outer], chain[inner], chain[-1])
        else:
            agrees = self._agree(before, ends.first)
        own = self._robot.model.links[attachment.inner].pose
        self._links[attachment.inner] = ends.last.then(own)
        return Stand(ends.outer, ends.inner, agrees)

    def _agree(self, one: Poses, other: Poses) -> bool:
        apart = one.inverse().then(other)
        angle = 2.0 * float(np.abs(apart.orientations[0, 1:]).max())
        return angle <= _APART and float(np.abs(apart.positions[0]).max()) <= _APART * self._size()

    def _size(self, more: Sequence[Poses] = ()) -> float:
        """How far the links that are known, and some other frames, are apart."""
        places = [poses.positions[0] for poses in (*self._links.values(), *more)]
        return max(float(np.ptp(np.array(places), axis=0).max()), 1e-3) if places else 1e-3

    # --- nodes

    def _by_node(self, attachment: Attachment, joint: JointModel, before: Poses) -> _Ends | None:
        """The inner link as its node shows it, if a joint of one axis can have moved it there."""
        node = self._shown[attachment.inner]
        if node < 0 or len(joint.axes) != 1:
            return None
        here = self._placement.poses(np.array([node]))[0]
        last = here.then(self._robot.model.links[attachment.inner].pose.inverse())
        apart = before.inverse().then(last)
        shift, turn = apart.positions[0], apart.orientations[0, 1:]
        direction = np.array(joint.axes[0].direction)
        if joint.axes[0].slides:
            shift = shift - direction * (shift @ direction)
        else:
            turn = turn - direction * (turn @ direction)
        near = _APART * self._size([before, last])
        if 2.0 * float(np.abs(turn).max()) > _APART or float(np.abs(shift).max()) > near:
            return None
        outer = before if joint.moving else last  # what is fixed is so as it stands
        return _Ends(before, outer, last, last)

    def _bound(self, joint: JointModel | None) -> _Ends | None:
        """The frames before and behind the transforms that the axes of a joint are bound to."""
        found = [] if joint is None else [self._robot.bound.get(axis.place) for axis in joint.axes]
        if not found or any(one is None or one.node < 0 or one.step < 0 for one in found):
            return None
        nodes = {one.node for one in found if one is not None}
        steps = sorted(one.step for one in found if one is not None)
        if len(nodes) != 1 or not all(self._is_plain(nodes, step) for step in steps):
            return None
        node = nodes.pop()
        first = self._prefix(node, steps[0], inclusive=False)
        last = self._prefix(node, steps[-1], inclusive=True)
        assert joint is not None
        moving = [self._robot.bound[axis.place].step for axis in joint.moving]
        if not moving:
            return _Ends(first, last, last, last)
        return _Ends(first, self._prefix(node, min(moving), inclusive=False),
                     self._prefix(node, max(moving), inclusive=True), last)  # fmt: skip

    def _is_plain(self, nodes: set[int], step: int) -> bool:
        """Whether a transform is a rotation or a translation alone, not all there is in one."""
        home = int(self._placement.nodes.homes(np.array(list(nodes)))[0])
        columns = self._resources[home].columns
        return columns.local_name(step) in ("rotate", "translate")

    def _prefix(self, row: int, last: int, *, inclusive: bool) -> Poses:
        """The frame in the world of the first transforms of a node."""
        nodes = self._placement.nodes
        home = int(nodes.homes(np.array([row]))[0])
        rows = nodes.parts[home].select(np.array([row - nodes.start(home)]))
        steps: list[tuple[int, str, Array]] = []
        for name in _STEPS:
            child = getattr(rows, name)
            steps += [
                (ordinal, name, value)
                for ordinal, value in zip(child.ordinals.tolist(), child.value, strict=True)
                if ordinal < last or (inclusive and ordinal == last)
            ]
        above = int(self._placement.above()[row])
        pose = Poses.none(1)
        if above >= 0:
            pose = self._placement.poses(np.array([above]))[0]
        for _, name, value in sorted(steps, key=lambda step: step[0]):
            if name == "scale":
                continue
            matrix = step_matrix(name, value)
            inner = rigid_parts(matrix[None])[0]
            if name == "rotate":
                inner.moved[:] = False
            pose = pose.then(inner)
        return pose


def _moved(axis: Axis, value: float) -> Poses:
    direction = np.array(axis.direction)
    if axis.slides:
        return Poses.of(1, (direction * value)[None])
    half = 0.5 * value * DEGREE
    turn = np.array([[np.cos(half), *(np.sin(half) * direction)]])
    return Poses.of(1, None, turn, turned=np.array([bool(direction.any())]))

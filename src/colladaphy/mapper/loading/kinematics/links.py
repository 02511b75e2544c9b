"""Which bodies the links of a robot are (COLLADA 1.5 §bind_kinematics_model, §bind_joint_axis).

A link and a rigid body are the same thing where both are bound to one node; where they are not,
they have the same name, as OpenRAVE, OpenHRP3 and ROS write them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from colladaphy.findings import Rule
from colladaphy.mapper import rules
from colladaphy.mapper.loading.found import FoundBodies
from colladaphy.mapper.loading.kinematics.models import JointModel, Link
from colladaphy.mapper.loading.kinematics.robots import Robot
from colladaphy.mapper.loading.tables import Tables

__all__ = ["WORLD", "Carriers"]

WORLD = -2
"""Stands for the world, which holds what hangs on it."""
_NOBODY = -1


class Carriers:
    """The bodies of links, by the numbers of the bodies that are found."""

    def __init__(
        self, tables: Tables, found: FoundBodies, there: dict[tuple[int, int], int]
    ) -> None:
        """`there` has the number in the World-to-be of each found body that it takes.

        Its keys are the instance of the model and the row of the instance_rigid_body.
        """
        self._tables = tables
        self._found = found
        self._number = [there.get(key, -1) for key in zip(
            found.models.tolist(), found.rows.tolist(), strict=True)]  # fmt: skip
        self._by_node: dict[int, list[int]] = {}
        self._by_name: dict[str, list[int]] = {}
        bodies, nodes = tables.bodies, tables.placement.nodes
        texts = [bodies.texts("name"), bodies.texts("sid"), bodies.texts("id")]
        node_names = nodes.texts("name")
        for at, (body, node) in enumerate(
            zip(found.bodies.tolist(), found.nodes.tolist(), strict=True)
        ):
            names = {column[body] for column in texts}
            if node >= 0:
                self._by_node.setdefault(node, []).append(at)
                names.add(node_names[node])
            for name in names - {None}:
                self._by_name.setdefault(name, []).append(at)
        self._declared = {text for column in texts for text in column if text}

    def of(self, robot: Robot, joints: Sequence[JointModel | None]) -> tuple[list[int], list[int]]:
        """The body of each link, and the row of the node that shows it; -1 for none.

        A body is its number, -1 for none, or `WORLD` for what nothing carries.
        """
        model = robot.model
        nodes = [-1] * len(model.links)
        for root in model.roots[:1]:
            nodes[root] = robot.node
        for attachment, joint in zip(model.attachments, joints, strict=True):
            if joint is not None and attachment.after is None:
                for axis in joint.axes:
                    bound = robot.bound.get(axis.place)
                    if bound is not None and bound.node >= 0:
                        nodes[attachment.inner] = bound.node
        places = [self._place(robot, link, node)
                  for link, node in zip(model.links, nodes, strict=True)]  # fmt: skip
        shown = [
            int(self._found.nodes[place]) if node < 0 <= place else node
            for place, node in zip(places, nodes, strict=True)
        ]
        made = [-1 if place < 0 else self._number[place] for place in places]
        for root in model.roots:
            if made[root] == _NOBODY and self._is_frame(model.links[root], places[root]):
                made[root] = WORLD
                message = (
                    f"The link {model.links[root].label!r} of {model.name!r} has neither a shape "
                    "nor a mass: the world holds what hangs on it."
                )
                self._note(rules.LINK_IN_WORLD, model.links[root], message)
        return made, shown

    def _is_frame(self, link: Link, place: int) -> bool:
        """Whether no body is made of a link, or whether it is only not among those loaded."""
        return place >= 0 or not {link.name, link.sid} & self._declared

    def _place(self, robot: Robot, link: Link, node: int) -> int:
        """The place of a link's body among those found, -1 for none."""
        here = self._by_node.get(node, []) if node >= 0 else []
        named = set(self._by_name.get(link.name or "", [])) | set(
            self._by_name.get(link.sid or "", [])
        )
        if len(here) > 1:
            here = [at for at in here if at in named] or here
        if here:
            return here[0]
        some = sorted(named)
        if len(some) > 1 and robot.node >= 0:
            below = self._found.nodes[some]
            inside = self._tables.placement.is_within(below, np.full(len(some), robot.node))
            some = [at for at, is_in in zip(some, inside.tolist(), strict=True) if is_in] or some
        if len(some) > 1:
            message = f"The link {link.label!r} may be any of {len(some)} bodies of its name."
            self._note(rules.LINK_UNCLEAR, link, message)
        return some[0] if len(some) == 1 else -1

    def _note(self, rule: Rule, link: Link, message: str) -> None:
        home = self._tables.pool.resources[link.place[0]]
        self._tables.resource.note(rule, link.place[1], message, home=home)

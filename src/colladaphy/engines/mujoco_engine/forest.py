"""Joints as trees: which body hangs on which, and which joints close loops."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from colladaphy.world import Joint, World

__all__ = ["Forest", "Link", "holds_nothing", "plan"]


@dataclass(frozen=True, slots=True)
class Link:
    """A joint by which `child` hangs on `parent` (system ids; 0 is the world)."""

    joint: int
    parent: int
    child: int
    reverse: bool
    """The child is the joint's body 1."""


@dataclass(slots=True)
class Forest:
    """All bodies that can move, each a root (free) or a child of exactly one link."""

    order: list[int] = field(default_factory=list)
    """System ids, parents before children."""
    links: dict[int, Link] = field(default_factory=dict)
    """By system id of the child."""
    loops: list[int] = field(default_factory=list)
    """System ids of the joints that close loops."""
    inert: list[int] = field(default_factory=list)
    """System ids of the joints that hold nothing: both their bodies are fixed."""


def plan(world: World) -> Forest:
    """The trees of `world`, breadth first from what is fixed, then from the smallest system id."""
    sids = world.sids.tolist()
    moving = dict(zip(sids, (~world.fixed).tolist(), strict=True))
    forest = Forest()
    edges: dict[int, list[tuple[int, int, int, bool]]] = {}
    for joint in world.joints:
        if not joint.enabled or holds_nothing(joint):
            continue
        one, two = (body.sid if body else 0 for body in (joint.body1, joint.body2))
        if not (moving.get(one, False) or moving.get(two, False)):
            forest.inert.append(joint.sid)
            continue
        edges.setdefault(one, []).append((joint.sid, one, two, False))
        edges.setdefault(two, []).append((joint.sid, two, one, True))
    still = [0, *(sid for sid in sids if not moving[sid])]
    reached = set(still)
    used: set[int] = set()
    queue = deque(sid for sid in still if sid in edges)
    roots = iter(sid for sid in sids if moving[sid])
    while True:
        while queue:
            sid = queue.popleft()
            for joint_sid, parent, child, reverse in edges.get(sid, ()):
                if joint_sid in used:
                    continue
                used.add(joint_sid)
                if child in reached:
                    forest.loops.append(joint_sid)
                    continue
                reached.add(child)
                forest.links[child] = Link(joint_sid, parent, child, reverse)
                forest.order.append(child)
                queue.append(child)
        root = next((sid for sid in roots if sid not in reached), None)
        if root is None:
            return forest
        reached.add(root)
        forest.order.append(root)
        queue.append(root)


def holds_nothing(joint: Joint) -> bool:
    """True if all axes are free and no spring pulls."""
    free = all(
        np.all(np.isneginf(low)) and np.all(np.isposinf(high))
        for low, high in (
            (joint.linear_min, joint.linear_max),
            (joint.angular_min, joint.angular_max),
        )
    )
    return free and not any(joint.linear_spring[:2]) and not any(joint.angular_spring[:2])

"""Where nodes are: as the file shows them, and with all joints at zero.

A robot's file may show it in any pose. The transforms that a joint moves are those that a
`bind_joint_axis` of the scene names (COLLADA 1.5 §bind_joint_axis); at zero they do nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from lxml import etree

from colladaphy.conform.context import Context, local
from colladaphy.conform.frames import TRANSFORMS, Matrix, transform_of
from colladaphy.conform.solids import are_usable

__all__ = ["Place", "Places"]


@dataclass(frozen=True, slots=True)
class Place:
    """A node as it is shown and at rest, in what it hangs in: a visual scene or a library."""

    scene: etree._Element | None
    shown: Matrix
    rest: Matrix


class Places:
    """The places of a document's nodes, through parents and instances; each is found once."""

    def __init__(self, context: Context) -> None:
        self._joints = _joint_transforms(context)
        self._known: dict[etree._Element, Place | None] = {}
        self._holders: dict[etree._Element, etree._Element] = {}
        for instance in context.all("instance_node"):
            node, holder = context.by_url(instance.get("url")), instance.getparent()
            if node is not None and holder is not None and local(holder) == "node":
                self._holders.setdefault(node, holder)

    def of(self, node: etree._Element) -> Place | None:
        """Where a node is; None where a transform above it cannot be read."""
        chain: list[etree._Element] = []
        current = node
        while current not in self._known:
            chain.append(current)
            above = self._above(current)
            if above is None or above in chain:
                top = Place(current.getparent(), np.eye(4), np.eye(4))
                self._known[current] = self._within(top, current)
                chain.pop()
                break
            current = above
        place = self._known[current]
        for step in reversed(chain):
            place = self._known[step] = self._within(place, step)
        return place

    def _above(self, node: etree._Element) -> etree._Element | None:
        parent = node.getparent()
        if parent is not None and local(parent) == "node":
            return parent
        return self._holders.get(node)

    def _within(self, outer: Place | None, node: etree._Element) -> Place | None:
        if outer is None:
            return None
        steps = [child for child in node if local(child) in TRANSFORMS]
        try:
            shown = outer.shown @ transform_of(steps)
            rest = outer.rest @ transform_of(s for s in steps if s not in self._joints)
        except ValueError:
            return None
        if not are_usable([*shown.ravel().tolist(), *rest.ravel().tolist()]):
            return None
        return Place(outer.scene, shown, rest)


def _joint_transforms(context: Context) -> set[etree._Element]:
    """The transforms that joints move."""
    wanted: dict[str, set[str]] = {}
    for bind in context.all("bind_joint_axis"):
        *path, sid = (bind.get("target") or "").split("/")
        if path and sid:
            wanted.setdefault(sid, set()).add(path[-1])
    found: dict[str, list[etree._Element]] = {}
    if wanted:
        for transform in context.all("rotate", "translate", "matrix"):
            if transform.get("sid") in wanted:
                found.setdefault(transform.get("sid", ""), []).append(transform)
    joints: set[etree._Element] = set()
    for sid, transforms in found.items():
        if len(transforms) == 1:  # the nodes in the path may be wrong, and often are
            joints.update(transforms)
            continue
        for transform in transforms:
            node = transform.getparent()
            if node is not None and wanted[sid] & {node.get("id"), node.get("sid")}:
                joints.add(transform)
    return joints

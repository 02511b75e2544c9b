"""Nodes: Bullet reads the transform of a body's own node only, and loses the order of its steps.

So each body's node stands at the top of the visual scene, with a translate and then a rotate. What
the node shows keeps its place in the world (COLLADA 1.5 §node, §instance_rigid_body).
"""

from __future__ import annotations

import numpy as np
from lxml import etree

from colladaphy.conform.bullet import rules
from colladaphy.conform.bullet.flatten import Body
from colladaphy.conform.bullet.markup import (
    Names,
    children,
    first,
    numbers_text,
    pose_steps,
    put_steps,
    steps_are_plain,
)
from colladaphy.conform.downgrade.draft import Draft, detach, local
from colladaphy.conform.frames import Matrix, inverse, nearest_rotation, transform_of

__all__ = ["Nodes"]

_CONTENT = (
    "instance_camera", "instance_controller", "instance_geometry", "instance_light",
    "instance_node", "node",
)  # fmt: skip


class Nodes:
    """The nodes of a document: where they stand, and how bodies come to have one each."""

    def __init__(self, draft: Draft) -> None:
        self._draft = draft
        self._by_id: dict[str, etree._Element] = {}
        for node in draft.all("node"):
            self._by_id.setdefault(node.get("id", ""), node)
        self._by_id.pop("", None)
        self._holders: dict[str, list[etree._Element]] = {}
        for instance in draft.all("instance_node"):
            holder = instance.getparent()
            if holder is not None:
                url = instance.get("url", "").strip().removeprefix("#")
                self._holders.setdefault(url, []).append(holder)
        self._ids = Names(element.get("id", "") for element in draft.everything())
        self._known: dict[etree._Element, Matrix] = {}
        self._used: set[etree._Element] = set()
        self._scene: etree._Element | None = None
        self._last: etree._Element | None = None
        self._animated = {
            channel.get("target", "").strip().partition("/")[0] for channel in draft.all("channel")
        }

    def find(self, url: str) -> etree._Element | None:
        """The node of this document that a url names."""
        return self._by_id.get(url.strip().removeprefix("#"))

    def world(self, node: etree._Element) -> Matrix:
        """The transform of a node in the world, through its parents and the first instance."""
        path: list[etree._Element] = []
        current: etree._Element | None = node
        while current is not None and current not in self._known and current not in path:
            path.append(current)
            current = self._above(current)
        result = self._known.get(current, np.eye(4)) if current is not None else np.eye(4)
        for step in reversed(path):
            result = self._known[step] = result @ transform_of(step)
        return result

    def _above(self, node: etree._Element) -> etree._Element | None:
        parent = node.getparent()
        if parent is None or local(parent) == "node":
            return parent
        if local(parent) == "visual_scene":
            return None
        holders = self._holders.get(node.get("id", ""), ())
        return holders[0] if holders else None

    def _is_within(self, node: etree._Element, ancestor: etree._Element) -> bool:
        seen: set[etree._Element] = set()
        current: etree._Element | None = node
        while current is not None and current not in seen:
            if current is ancestor:
                return True
            seen.add(current)
            current = self._above(current)
        return False

    def place(self, body: Body) -> Matrix:
        """The transform of a body's target, below the parents of its model if it is not there."""
        target = self.find(body.instance.get("target", ""))
        result = np.eye(4) if target is None else self.world(target)
        for url in reversed(body.level.parents):
            parent = self.find(url)
            if parent is None:
                continue
            if target is not None and self._is_within(target, parent):
                break
            result = self.world(parent) @ result
        return result

    # -- writing ------------------------------------------------------------------------------

    def give(self, body: Body, whole: Matrix) -> None:
        """Let the body's target be a node at the top that stands where Bullet's body is.

        `whole` is the transform that the target had, with its scale.
        """
        pose = body.pose @ body.inner
        target = self.find(body.instance.get("target", ""))
        if target is None:
            message = f"The target {body.instance.get('target')!r} is not a node of this file."
            self._draft.note(rules.NO_NODE, body.instance, message)
            self._add(body, pose)
        elif target in self._used or not self._may_move(target):
            message = f"The node {target.get('id')!r} cannot be the body's own, so it got another."
            self._draft.note(rules.NODE_ADDED, body.instance, message)
            self._add(body, pose)
        else:
            self._used.add(target)
            self._rewrite(target, pose, whole)

    def _may_move(self, node: etree._Element) -> bool:
        """Whether it stands in a visual scene, in one place, and is no joint of a skeleton."""
        current: etree._Element | None = node
        while current is not None and local(current) == "node":
            if self._holders.get(current.get("id") or " "):
                return False
            current = current.getparent()
        if current is None or local(current) != "visual_scene":
            return False
        return node.getparent() is current or node.get("type") != "JOINT"

    def _add(self, body: Body, pose: Matrix) -> None:
        name = self._ids.new(f"{body.instance.get('body')}-node")
        node = self._draft.make("node", attributes={"id": name})
        put_steps(node, pose_steps(self._draft, pose))
        if self._last is None:
            scene = self._visual_scene()
            others = children(scene, "node")
            scene.insert(scene.index(others[-1]) + 1 if others else 0, node)
        else:
            self._last.addnext(node)
        self._last = node
        body.instance.set("target", "#" + name)

    def _rewrite(self, node: etree._Element, pose: Matrix, whole: Matrix) -> None:
        parent = node.getparent()
        at_top = parent is not None and local(parent) == "visual_scene"
        if at_top and steps_are_plain(node) and np.array_equal(pose, transform_of(node)):
            return
        if node.get("id") in self._animated:
            message = f"The node {node.get('id')!r} is animated."
            self._draft.note(rules.ANIMATED, node, message)
        rest = inverse(pose) @ whole
        if not nearest_rotation(whole)[1]:
            message = f"The node {node.get('id')!r} scales or skews what it shows."
            self._draft.note(rules.SCALE, node, message)
        content = children(node, *_CONTENT)
        if content and not np.allclose(rest, np.eye(4), rtol=0.0, atol=1e-12):
            inner = self._draft.make("node")
            inner.append(self._draft.make("matrix", numbers_text(rest.ravel())))
            content[0].addprevious(inner)
            for child in content:
                inner.append(detach(child))
        put_steps(node, pose_steps(self._draft, pose))
        if not at_top:
            message = f"The node {node.get('id')!r} was below other nodes."
            self._draft.note(rules.NODE_MOVED, node, message)
            self._lift(node)

    @staticmethod
    def _lift(node: etree._Element) -> None:
        top = node
        while (parent := top.getparent()) is not None and local(parent) == "node":
            top = parent
        detach(node)
        top.addnext(node)

    def _visual_scene(self) -> etree._Element:
        """The visual scene that is shown, or the first, or a new one."""
        if self._scene is None:
            scenes = {scene.get("id", ""): scene for scene in self._draft.all("visual_scene")}
            shown = first(self._draft.root, "scene", "instance_visual_scene")
            name = "" if shown is None else shown.get("url", "").strip().removeprefix("#")
            if name in scenes:
                self._scene = scenes[name]
            else:
                self._scene = next(iter(scenes.values()), None)
        if self._scene is None:
            library = self._draft.make("library_visual_scenes")
            name = self._ids.new("bullet-visual-scene")
            self._scene = self._draft.make("visual_scene", attributes={"id": name})
            library.append(self._scene)
            before = [c for c in self._draft.root if local(c).startswith(("library_", "asset"))]
            before[-1].addnext(library)
        return self._scene

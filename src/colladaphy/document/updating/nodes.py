"""Nodes that bodies are bound to: moved, given a frame within, added and taken out."""

from __future__ import annotations

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.updating.elements import (
    TRANSFORMS,
    child,
    children,
    drop,
    local,
    name_after,
    numbers,
    put,
    put_first,
)
from colladaphy.document.updating.owning import Owner
from colladaphy.links.names import c
from colladaphy.links.poses import Poses
from colladaphy.links.steps import step_matrix
from colladaphy.mapper.numbers import differs
from colladaphy.mapper.storing.turns import turns_of

__all__ = ["Nodes", "transforms_of"]

Floats = NDArray[np.float64]

_OURS = ("body_translate", "body_rotate", "body_matrix")


def transforms_of(poses: Poses, matrices: dict[int, Floats]) -> list[list[etree._Element]]:
    """The elements of transforms (n,): a translation and a rotation where they are needed, or a
    matrix where there is one."""
    turns, turned = turns_of(poses.orientations)
    moved = poses.moved & differs(poses.positions, np.zeros(3))
    turned &= poses.turned
    made: list[list[etree._Element]] = []
    places, angles = poses.positions.tolist(), turns.tolist()
    for row, (move, turn) in enumerate(zip(moved.tolist(), turned.tolist(), strict=True)):
        if row in matrices:
            made.append([_element("matrix", numbers(matrices[row]))])
            continue
        steps = []
        if move:
            steps.append(_element("translate", numbers(places[row])))
        if turn:
            steps.append(_element("rotate", numbers(angles[row])))
        made.append(steps)
    return made


def _element(name: str, text: str) -> etree._Element:
    made = etree.Element(c(name))
    made.text = text
    return made


class Nodes:
    """The nodes of a document that is being written."""

    def __init__(self, root: etree._Element, owner: Owner) -> None:
        self._root, self._owner = root, owner
        self._scene: etree._Element | None = None

    def before_steps(self, node: etree._Element) -> Floats | None:
        """What stands before the steps of a node that keeps them, 4x4; None for other nodes.

        Steps that turn or scale under a sid are what animations and kinematics take hold of.
        """
        steps = children(node, *TRANSFORMS)
        if not any(step.get("sid") for step in steps) or not any(map(_is_held, steps)):
            return None
        made: Floats = np.eye(4)
        for step in steps:
            if step.get("sid") not in _OURS:
                break
            values = np.array((step.text or "").split(), dtype=np.float64)
            made = made @ step_matrix(local(step), values)
        return made

    def precede(self, node: etree._Element, steps: list[etree._Element]) -> None:
        """Put transforms before those of a node, in place of what was put there before."""
        for step in children(node, *TRANSFORMS):
            if step.get("sid") in _OURS:
                drop(step)
        for step in steps:
            step.set("sid", f"body_{local(step)}")
        put_first(node, steps, "asset")

    def place(self, node: etree._Element, steps: list[etree._Element]) -> None:
        """Give a node other transforms; those that are kept in kind keep their attributes."""
        old = children(node, *TRANSFORMS)
        if len(old) == len(steps) and all(map(_alike, old, steps)):
            for before, after in zip(old, steps, strict=True):
                for inner in before:  # comments
                    before.remove(inner)
                before.text = after.text
            return
        sids = {local(before): before.get("sid") for before in reversed(old) if before.get("sid")}
        for before in old:
            drop(before)
        if "translate" in sids and not any(
            local(step) in ("translate", "matrix") for step in steps
        ):
            steps = [_element("translate", "0 0 0"), *steps]
        for step in steps:
            sid = sids.get(local(step))
            if sid is not None:
                step.set("sid", sid)
        put_first(node, steps, "asset")

    def wrap(self, node: etree._Element, steps: list[etree._Element]) -> None:
        """Put what is in a node into a node within, at some transforms."""
        inner = etree.Element(c("node"))
        content = [
            element for element in node
            if local(element) not in (*TRANSFORMS, "asset", "extra")
        ]  # fmt: skip
        if not any(isinstance(element.tag, str) for element in content):
            return
        for element in content:
            inner.append(element)
        put(node, inner, ("asset", *TRANSFORMS))
        put_first(inner, steps, "asset")

    def add(self, wanted: str, steps: list[etree._Element]) -> str:
        """A new node in the visual scene; gives its id."""
        node = etree.Element(c("node"))
        node.set("id", name_after(wanted, self._owner.taken))
        for step in steps:
            node.append(step)
        put(self._visual_scene(), node, ("asset", "node"))
        return node.get("id", "")

    def _visual_scene(self) -> etree._Element:
        """The one that is shown, or else the first one, or a new one."""
        if self._scene is not None:
            return self._scene
        effect = child(self._root, "scene")
        shown = None if effect is None else child(effect, "instance_visual_scene")
        scenes = list(self._root.iter(c("visual_scene")))
        wanted = "" if shown is None else shown.get("url", "")
        found = [scene for scene in scenes if f"#{scene.get('id')}" == wanted]
        if found or scenes:
            self._scene = (found or scenes)[0]
            return self._scene
        scene = etree.Element(c("visual_scene"))
        scene.set("id", name_after("VisualScene1", self._owner.taken))
        put(self._owner.library("library_visual_scenes"), scene, ("asset", "visual_scene"))
        if shown is None:
            shown = etree.Element(c("instance_visual_scene"))
            shown.set("url", f"#{scene.get('id')}")
            put(self._owner.scene(), shown, ("instance_physics_scene",))
        self._scene = scene
        return scene

    def remove_bare(self, nodes: list[etree._Element]) -> None:
        """Take out nodes that only said where bodies were, and that nothing refers to now."""
        bare = [node for node in nodes if node.get("name") is None and node.getparent() is not None
                and not [inner for inner in node if local(inner) not in TRANSFORMS]]  # fmt: skip
        if not bare:
            return
        wanted = {f"#{node.get('id')}" for node in bare} | {str(node.get("id")) for node in bare}
        used: set[str] = set()
        for element in self._root.iter(etree.Element):
            for name, value in element.items():
                head = str(value).partition("/")[0]
                if name != "id" and head in wanted:
                    used.add(head.removeprefix("#"))
        for node in bare:
            parent = node.getparent()
            needed = parent is not None and local(parent) in ("visual_scene", "library_nodes")
            if node.get("id") in used or (needed and not _has_siblings(node)):
                continue
            drop(node)


def _has_siblings(node: etree._Element) -> bool:
    """Whether there are other nodes beside one."""
    return any(
        next(node.itersiblings(c("node"), preceding=preceding), None) is not None
        for preceding in (False, True)
    )


def _is_held(step: etree._Element) -> bool:
    """Whether a step is one that others take hold of."""
    sid = step.get("sid")
    return bool(sid) and sid not in _OURS and local(step) not in ("matrix", "translate")


def _alike(before: etree._Element, after: etree._Element) -> bool:
    return before.tag == after.tag

"""The nodes of visual scenes as columns (COLLADA 1.5 §node)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.document.names import c
from colladaphy.mapper.columns.texts import Column, number_rows, whole_text

__all__ = ["NodeTable"]

Array = NDArray[Any]

# A node that is moved, then turned, and holds nothing.
_PLAIN = re.compile(
    r'<node id="([^"]*)"(?: name="[^"]*")?(?:/>|>\s*'
    r"(?:<translate>([^<]+)</translate>\s*)?(?:<rotate>([^<]+)</rotate>\s*)?</node>)"
)
_NODE, _TRANSLATE, _ROTATE = c("node"), c("translate"), c("rotate")
_OTHERS = frozenset(c(name) for name in ("matrix", "scale", "skew", "lookat"))
Place = tuple[str, str, str]
"""The id of a node, and the texts of its translation and rotation, empty for none."""


class NodeTable:
    """One row for each regular node that stands in a visual scene itself, not in another node.

    Such a node has at most one translation, then at most one rotation, and no other transform;
    whatever else it holds does not move it.
    """

    def __init__(self, root: etree._Element) -> None:
        places: list[Place] = []
        for library in root.iterchildren(c("library_visual_scenes")):
            for scene in library.iterchildren(c("visual_scene")):
                places += _plain_nodes(scene) or _nodes(scene)
        ids, translations, turns = zip(*places, strict=True) if places else ((), (), ())
        self.rows = {f"#{name}": row for row, name in enumerate(ids)}
        """The rows of the nodes by "#" and their id."""
        self.positions, _ = _numbers(translations, 3)
        self.turns, self.turned = _numbers(turns, 4)
        """Axis and angle in degrees, and where a rotation is stated."""
        if not len(self.positions) or not len(self.turns):
            self.rows = {}


def _numbers(texts: Column, width: int) -> tuple[Array, Array]:
    try:
        return number_rows(texts, width)
    except ValueError:
        return np.zeros((0, width)), np.zeros(0, dtype=np.bool_)


def _plain_nodes(scene: etree._Element) -> list[Place] | None:
    """All nodes of a scene of nothing but plain ones; None for other scenes."""
    text = whole_text(scene, "node")
    if text is None:
        return None
    found: list[Place] = _PLAIN.findall(text)
    # Each match holds one start tag, so all nodes were found, and none is in another one.
    count = len(found)
    if (
        text.count("<node ") + text.count("<node>") != count
        or sum(1 for _ in scene.iterchildren(_NODE)) != count
    ):
        return None
    return found


def _nodes(scene: etree._Element) -> list[Place]:
    """The regular nodes of any scene."""
    places: list[Place] = []
    for node in scene.iterchildren(_NODE):
        texts: dict[str, str] = {}
        for child in node:
            tag = child.tag
            if tag in _OTHERS:
                break
            if tag in (_TRANSLATE, _ROTATE):
                if _ROTATE in texts or tag in texts or len(child) or not child.text:
                    break
                texts[tag] = child.text
        else:
            name = node.get("id")
            if name is not None:
                places.append((name, texts.get(_TRANSLATE, ""), texts.get(_ROTATE, "")))
    return places

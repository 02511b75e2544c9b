"""The triangles of a mesh, from each of COLLADA's ways to write faces (COLLADA 1.5 §mesh)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from lxml import etree

from colladaphy.conform.bullet.markup import children
from colladaphy.conform.bullet.solids import Integers
from colladaphy.conform.downgrade.draft import local

__all__ = ["triangles_of"]

Corners = Sequence[int]


def triangles_of(mesh: etree._Element, count: int) -> Integers:
    """Indices (n, 3) of positions; faces that name one that is not there are left out."""
    found = [
        triangle
        for faces in mesh
        for polygon in _polygons(faces)
        for triangle in _fan(polygon)
        if max(triangle) < count
    ]  # fmt: skip
    return np.array(found, dtype=np.int64).reshape(-1, 3)


def _fan(polygon: Corners) -> Iterator[tuple[int, int, int]]:
    return ((polygon[0], a, b) for a, b in pairwise(polygon[1:]))


def _polygons(faces: etree._Element) -> Iterator[Corners]:
    kind = local(faces)
    if kind not in ("triangles", "polylist", "polygons", "trifans", "tristrips"):
        return
    for p in faces.iter(f"{{{etree.QName(faces).namespace}}}p"):
        corners = _corners(faces, p)
        if kind == "triangles":
            yield from (corners[i : i + 3] for i in range(0, len(corners) - 2, 3))
        elif kind == "polylist":
            yield from _listed(faces, corners)
        elif kind == "tristrips":
            for i in range(len(corners) - 2):
                a, b, c = corners[i : i + 3]
                yield (a, b, c) if i % 2 == 0 else (b, a, c)
        else:
            yield corners


def _corners(faces: etree._Element, p: etree._Element) -> Corners:
    """The indices of positions, which stand among those of normals and others."""
    inputs = children(faces, "input")
    stride = max((int(i.get("offset", "0")) for i in inputs), default=0) + 1
    own = next((int(i.get("offset", "0")) for i in inputs if i.get("semantic") == "VERTEX"), 0)
    return [int(word) for word in (p.text or "").split()][own::stride]


def _listed(faces: etree._Element, corners: Corners) -> Iterator[Corners]:
    start = 0
    for vcount in children(faces, "vcount"):
        for word in (vcount.text or "").split():
            yield corners[start : start + int(word)]
            start += int(word)

"""Closed meshes whose faces are wound both ways: what is outside is for all faces to say alike.

The standard has the corners of a face run counter-clockwise, seen from outside (COLLADA 1.5
§polygons). Where two faces along an edge run the same way, one of them does not. A surface that is
not closed has no outside, and stays as it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from colladaphy.conform import shape_rules
from colladaphy.conform.context import NS, Context, local
from colladaphy.conform.frames import Matrix
from colladaphy.conform.solids import are_usable, numbers_of

__all__ = ["mend_windings"]

_Integers = NDArray[np.int64]


@dataclass(slots=True)
class _Face:
    """A polygon: where its corners stand in the words of a `p`, and the points that they are."""

    p: etree._Element
    start: int
    count: int
    width: int
    points: list[int]


def mend_windings(context: Context) -> None:
    """Wind the faces of shapes' closed meshes alike, and outward where they were not."""
    if not context.wants(shape_rules.WINDING):
        return
    urls = {
        instance.get("url", "")
        for shape in context.all("shape")
        for instance in shape.iterchildren(NS + "instance_geometry")
    }
    for url in sorted(urls):
        geometry = context.by_url(url) if url.startswith("#") else None
        mesh = None if geometry is None else geometry.find(NS + "mesh")
        points = None if mesh is None else _points(context, mesh)
        if mesh is None or points is None or not _may_be_mixed(mesh, points):
            continue
        faces = _faces(mesh, points)
        edges = _edges(faces or [])
        if not faces or not _is_closed_and_mixed(edges[:, 0], edges[:, 1], len(points)):
            continue
        turned = _turned(faces, points)
        _turn(turned)
        if turned:
            message = (
                f"{len(turned)} of {len(faces)} faces of the closed mesh {url} were wound the "
                "other way; all are wound outward now"
            )
            context.note(shape_rules.WINDING, geometry, message)


def _points(context: Context, mesh: etree._Element) -> Matrix | None:
    """The positions of a mesh (n, 3)."""
    for user in mesh.iterfind(f"{NS}vertices/{NS}input"):
        source = context.by_url(user.get("source"))
        if user.get("semantic") != "POSITION" or source is None:
            continue
        accessor, array = source.find(f".//{NS}accessor"), source.find(f"{NS}float_array")
        values = numbers_of(array)
        if accessor is None or not values or not are_usable(values):
            return None
        if accessor.get("stride") != "3" or accessor.get("offset", "0") != "0":
            return None
        return np.asarray(values[: len(values) // 3 * 3]).reshape(-1, 3)
    return None


def _faces(mesh: etree._Element, points: Matrix) -> list[_Face] | None:
    """The polygons of a mesh; None where some are not told one by one, or name no point."""
    _, same = np.unique(points, axis=0, return_inverse=True)
    merged = same.ravel().tolist()
    found: list[_Face] = []
    for primitive in mesh.iterchildren(etree.Element):
        kind = local(primitive)
        if kind in ("trifans", "tristrips") or primitive.find(NS + "ph") is not None:
            return None
        if kind not in ("triangles", "polylist", "polygons"):
            continue
        offsets = {u.get("semantic"): u.get("offset", "0") for u in primitive.iter(NS + "input")}
        if not all(offset.isdecimal() for offset in offsets.values()) or "VERTEX" not in offsets:
            return None
        width, at = max(map(int, offsets.values())) + 1, int(offsets["VERTEX"])
        for p in primitive.iterchildren(NS + "p"):
            words = [] if len(p) else (p.text or "").split()
            if not all(word.isdecimal() for word in words) or len(words) % width:
                return None
            corners = [int(word) for word in words[at::width]]
            if any(corner >= len(merged) for corner in corners):
                return None
            counts = _counts(primitive, kind, len(corners))
            if sum(counts) != len(corners):
                return None
            start = 0
            for count in counts:
                ring = [merged[corner] for corner in corners[start : start + count]]
                found.append(_Face(p, start, count, width, ring))
                start += count
    return found


def _counts(primitive: etree._Element, kind: str, corners: int) -> list[int]:
    if kind == "polylist":
        words = (primitive.findtext(NS + "vcount") or "").split()
        return [int(word) for word in words if word.isdecimal()]
    return [3] * (corners // 3) if kind == "triangles" else [corners]


def _edges(faces: list[_Face]) -> _Integers:
    """From, to and face of every edge (n, 3)."""
    edges = [
        (a, b, number)
        for number, face in enumerate(faces)
        for a, b in zip(face.points, face.points[1:] + face.points[:1], strict=True)
        if a != b
    ]
    return np.asarray(edges, dtype=np.int64).reshape(-1, 3)


def _is_closed_and_mixed(a: _Integers, b: _Integers, count: int) -> bool:
    """Whether every edge from a to b has two faces, and some edge has both the same way."""
    _, owners = np.unique(np.minimum(a, b) * count + np.maximum(a, b), return_counts=True)
    return bool(np.all(owners == 2)) and len(np.unique(a * count + b)) < len(a)


def _may_be_mixed(mesh: etree._Element, points: Matrix) -> bool:
    """The same of a mesh of triangles alone, which most are; True where one has to look closer."""
    primitives = [child for child in mesh if child.find(NS + "p") is not None]
    _, same = np.unique(points, axis=0, return_inverse=True)
    starts, ends = [], []
    for primitive in primitives:
        offsets = {u.get("semantic"): u.get("offset", "0") for u in primitive.iter(NS + "input")}
        if local(primitive) != "triangles" or "VERTEX" not in offsets:
            return True
        for p in primitive.iterchildren(NS + "p"):
            try:
                words = np.array((p.text or "").split(), dtype=np.int64)
                width = max(map(int, offsets.values())) + 1
                corners = same.ravel()[words[int(offsets["VERTEX"]) :: width]].reshape(-1, 3)
            except (ValueError, IndexError, OverflowError):
                return True
            starts.append(corners.ravel())
            ends.append(np.roll(corners, -1, axis=1).ravel())
    if not starts:
        return False
    a, b = np.concatenate(starts), np.concatenate(ends)
    real = a != b
    return bool(np.any(real)) and _is_closed_and_mixed(a[real], b[real], len(points))


def _turned(faces: list[_Face], points: Matrix) -> list[_Face]:
    """The faces to turn round, by connected parts; none of a part that has no outside."""
    neighbours: dict[tuple[int, int], list[tuple[int, bool]]] = {}
    for a, b, number in _edges(faces).tolist():
        neighbours.setdefault((min(a, b), max(a, b)), []).append((number, a < b))
    beside: list[list[tuple[int, bool]]] = [[] for _ in faces]
    for (one, way), (other, same) in neighbours.values():
        beside[one].append((other, way == same))
        beside[other].append((one, way == same))
    merged = np.unique(points, axis=0)
    turn: dict[int, bool] = {}
    found: list[_Face] = []
    for start in range(len(faces)):
        if start in turn:
            continue
        turn[start], part, two_sided = False, [start], True
        for number in part:
            for other, differs in beside[number]:
                wanted = turn[number] != differs
                if other not in turn:
                    turn[other] = wanted
                    part.append(other)
                two_sided &= turn[other] == wanted
        if two_sided and any(turn[number] for number in part):
            inward = _volume([(faces[n], turn[n]) for n in part], merged) < 0.0
            found += [faces[number] for number in part if turn[number] != inward]
    return found


def _volume(part: list[tuple[_Face, bool]], points: Matrix) -> float:
    middle = points.mean(axis=0)
    total = 0.0
    for face, turned in part:
        ring = points[face.points] - middle
        fan = np.cross(ring[1:-1], ring[2:]) @ ring[0]
        total += float(fan.sum()) * (-1.0 if turned else 1.0)
    return total


def _turn(faces: list[_Face]) -> None:
    """Turn faces round, all of one `p` at once."""
    by_p: dict[etree._Element, list[_Face]] = {}
    for face in faces:
        by_p.setdefault(face.p, []).append(face)
    for p, own in by_p.items():
        words = (p.text or "").split()
        for face in own:
            first, last = face.start * face.width, (face.start + face.count) * face.width
            corners = [words[i : i + face.width] for i in range(first, last, face.width)]
            words[first:last] = [word for corner in reversed(corners) for word in corner]
        p.text = " ".join(words)

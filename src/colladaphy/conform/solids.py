"""Shapes that 1.5 has no element for: tapered solids as convex meshes, and ellipsoids.

All stand upright about y and about their centre, as the shapes of COLLADA do (§cylinder).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from lxml import etree

from colladaphy.conform.context import Context, append, text_of
from colladaphy.conform.numerals import plain_numbers

__all__ = [
    "SEGMENTS",
    "Ring",
    "add_solid",
    "are_usable",
    "ellipsoid",
    "tapered_capsule",
    "tapered_cylinder",
]

SEGMENTS = 32
_LARGEST = 1e100
Ring = tuple[float, float, float]
"""Height y and the radii along x and z of one horizontal outline."""


def tapered_cylinder(height: float, upper: Sequence[float], lower: Sequence[float]) -> list[Ring]:
    """Outlines of a cone's stump: `upper` radii at +height/2, `lower` ones at -height/2."""
    return [(height / 2, upper[0], upper[1]), (-height / 2, lower[0], lower[1])]


def tapered_capsule(height: float, upper: Sequence[float], lower: Sequence[float]) -> list[Ring]:
    """Outlines of the hull of two caps, whose centres are `height` apart.

    A cap is as high as its radius along x; where the cone between them touches each cap, one
    takes over from the other.
    """
    lift = (lower[0] - upper[0]) / height if height > 0 else 0.0
    touch = math.asin(min(1.0, max(-1.0, lift)))
    rings: list[Ring] = []
    for centre, radii, start, end in (
        (height / 2, upper, math.pi / 2, touch),
        (-height / 2, lower, touch, -math.pi / 2),
    ):
        steps = max(1, round(abs(start - end) / (2 * math.pi) * SEGMENTS))
        for step in range(steps + 1):
            angle = start + (end - start) * step / steps
            flat = max(0.0, math.cos(angle)) if 0 < step < steps else _flat(angle)
            rings.append((centre + radii[0] * math.sin(angle), radii[0] * flat, radii[1] * flat))
    return rings


def _flat(angle: float) -> float:
    return 0.0 if abs(abs(angle) - math.pi / 2) < 1e-12 else math.cos(angle)


def ellipsoid(context: Context, radii: str) -> etree._Element:
    """An ellipsoid with these radii along x, y and z: a capsule of no height has three of them."""
    capsule = context.make("capsule")
    capsule.append(context.make("height", "0"))
    capsule.append(context.make("radius", radii))
    return capsule


def _mesh(rings: Sequence[Ring]) -> tuple[list[tuple[float, float, float]], list[int]]:
    vertices: list[tuple[float, float, float]] = []
    outlines: list[list[int]] = []
    for y, rx, rz in rings:
        first = len(vertices)
        count = 1 if rx == 0.0 and rz == 0.0 else SEGMENTS
        for step in range(count):
            angle = 2 * math.pi * step / SEGMENTS
            vertices.append((rx * math.cos(angle), y, -rz * math.sin(angle)))
        outlines.append(list(range(first, first + count)))
    faces: list[int] = []
    for above, below in pairwise(outlines):
        for step in range(SEGMENTS):
            a, b = above[step % len(above)], above[(step + 1) % len(above)]
            c, d = below[step % len(below)], below[(step + 1) % len(below)]
            if a != b:
                faces += [a, c, b]
            if c != d:
                faces += [b, c, d]
    for outline, upward in ((outlines[0], True), (outlines[-1], False)):
        for i in range(1, len(outline) - 1):
            j, k = (i, i + 1) if upward else (i + 1, i)
            faces += [outline[0], outline[j], outline[k]]
    return vertices, faces


def add_solid(context: Context, wish: str, rings: Sequence[Ring]) -> str:
    """Add the convex mesh of these outlines to the geometries; returns its id."""
    vertices, faces = _mesh(rings)
    name = context.new_id(wish)
    make = context.make
    geometry, mesh = make("geometry", id=name), make("convex_mesh")
    source = make("source", id=context.new_id(f"{name}-positions"))
    numbers = " ".join(f"{value:.12g}" for vertex in vertices for value in vertex)
    array = make("float_array", numbers, count=str(3 * len(vertices)))
    array.set("id", context.new_id(f"{name}-positions-array"))
    accessor = make("accessor", source=f"#{array.get('id')}", count=str(len(vertices)), stride="3")
    for axis in "XYZ":
        accessor.append(make("param", name=axis, type="float"))
    common = make("technique_common")
    common.append(accessor)
    source.extend([array, common])
    points = make("vertices", id=context.new_id(f"{name}-vertices"))
    points.append(make("input", semantic="POSITION", source=f"#{source.get('id')}"))
    triangles = make("triangles", count=str(len(faces) // 3))
    triangles.append(make("input", semantic="VERTEX", source=f"#{points.get('id')}", offset="0"))
    triangles.append(make("p", " ".join(map(str, faces))))
    mesh.extend([source, points, triangles])
    geometry.append(mesh)
    append(context.library("geometries"), geometry)
    context.ids[name] = geometry
    return name


def are_usable(values: Sequence[float]) -> bool:
    """Whether one can compute with these numbers: finite, and their squares too."""
    return all(abs(value) < _LARGEST for value in values)  # false for NaN


def numbers_of(element: etree._Element | None) -> list[float]:
    """The numbers in an element's text; none where any word is no number."""
    text = "" if element is None else text_of(element)
    if not text:
        return []
    try:
        return [float(w) for w in (plain_numbers(text)[0] if "," in text else text).split()]
    except ValueError:
        return []

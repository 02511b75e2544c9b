"""Closed meshes whose faces are wound both ways."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from tests.conform.documents import C, codes, document, mended, physics

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [face for a, b, c, d in QUADS for face in ((a, b, c), (a, c, d))]
Face = tuple[int, ...]


def scene(points: list, faces: list[Face], kind: str = "triangles") -> etree._ElementTree:
    """A body of one mesh; each corner has an index of a normal, too, which is its number."""
    numbers = " ".join(str(float(v)) for point in points for v in point)
    corners = [[f"{corner} {n % 3}" for n, corner in enumerate(face)] for face in faces]
    count = f'count="{len(faces)}"'
    inputs = (
        '<input semantic="VERTEX" source="#g-v" offset="0"/>'
        '<input semantic="NORMAL" source="#g-p" offset="1"/>'
    )
    if kind == "polygons":
        content = "".join(f"<p>{' '.join(face)}</p>" for face in corners)
    else:
        content = f"<p>{' '.join(' '.join(face) for face in corners)}</p>"
        if kind == "polylist":
            content = f"<vcount>{' '.join(str(len(face)) for face in faces)}</vcount>" + content
    mesh = (
        f'<source id="g-p"><float_array id="g-a" count="{3 * len(points)}">{numbers}</float_array>'
        f'<technique_common><accessor source="#g-a" count="{len(points)}" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>'
        '</accessor></technique_common></source><vertices id="g-v"><input semantic="POSITION" '
        f'source="#g-p"/></vertices><{kind} {count}>{inputs}{content}</{kind}>'
    )
    tree = physics('<mass>1</mass><shape><instance_geometry url="#g"/></shape>')
    library = document(
        f'<library_geometries><geometry id="g"><mesh>{mesh}</mesh></geometry></library_geometries>'
    ).getroot()[1]
    tree.getroot().insert(1, library)
    return tree


def read(root: etree._Element, sizes: list[int]) -> list[list[tuple[int, int]]]:
    words = [int(word) for p in root.iter(C + "p") for word in p.text.split()]
    pairs = list(zip(words[::2], words[1::2], strict=True))
    ends = np.cumsum(sizes).tolist()
    return [pairs[end - size : end] for end, size in zip(ends, sizes, strict=True)]


def volume(points: list, faces: list) -> float:
    total = 0.0
    for face in faces:
        ring = np.array([points[corner] for corner, _ in face], float)
        total += sum(
            np.dot(ring[0], np.cross(ring[i], ring[i + 1])) for i in range(1, len(ring) - 1)
        )
    return total / 6


@pytest.mark.parametrize("kind", ["triangles", "polylist", "polygons"])
@given(flips=st.lists(st.booleans(), min_size=12, max_size=12))
def test_faces_are_wound_outward_whatever_was_turned(kind: str, flips: list[bool]) -> None:
    faces = TRIANGLES if kind == "triangles" else QUADS
    given_faces = [face[::-1] if flip else face for face, flip in zip(faces, flips, strict=False)]
    turned = flips[: len(faces)]
    root, findings = mended(scene(CUBE, given_faces, kind))
    found = read(root, [len(face) for face in faces])
    outward = volume(CUBE, found)
    if all(turned):
        assert (outward, findings) == (-8, [])  # wound alike: the reader's to judge
        return
    assert outward == 8
    assert codes(findings) == ({"repair-winding"} if any(turned) else set())
    for face, before in zip(found, given_faces, strict=True):
        # Every corner keeps what else belongs to it.
        assert sorted(face) == sorted((corner, n % 3) for n, corner in enumerate(before))
    if any(turned):
        assert findings[0].message.startswith(f"{sum(turned)} of {len(faces)} faces")


def test_corners_that_are_written_apart_are_one_point() -> None:
    points = [CUBE[corner] for face in TRIANGLES for corner in face]
    faces: list[Face] = [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(12)]
    faces[4] = faces[4][::-1]
    root, findings = mended(scene(points, faces))
    assert volume(points, read(root, [3] * 12)) == 8
    assert codes(findings) == {"repair-winding"}


def test_a_hollow_that_is_wound_inward_stays() -> None:
    inner = [(x / 2, y / 2, z / 2) for x, y, z in CUBE]
    hollow = [tuple(corner + 8 for corner in face[::-1]) for face in TRIANGLES]
    faces = [TRIANGLES[0][::-1], *TRIANGLES[1:], *hollow]
    root, _ = mended(scene([*CUBE, *inner], faces))
    assert volume([*CUBE, *inner], read(root, [3] * 24)) == 7


def test_what_is_not_closed_has_no_outside() -> None:
    faces = [TRIANGLES[0][::-1], *TRIANGLES[1:-1]]
    assert mended(scene(CUBE, faces))[1] == []


def test_a_surface_of_one_side_stays() -> None:
    """A projective plane of six points: closed, and not to be wound alike."""
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1),
             (1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)]  # fmt: skip
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1)]
    assert mended(scene(points, faces))[1] == []

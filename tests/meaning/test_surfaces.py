"""Surfaces are measured many at once, and each as if it were alone."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import colladaphy
from colladaphy.meaning import surface_table

HEAD = (
    '<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0"><asset>'
    "<created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>"
    "<library_geometries>"
)
TAIL = "</library_geometries></COLLADA>"
CUBE = list("000100110010001101111011")
FACES = ["0 3 2 1", "4 5 6 7", "0 1 5 4", "1 2 6 5", "2 3 7 6", "3 0 4 7"]


def fan(face: str) -> list[str]:
    first, *rest = face.split()
    return [f"{first} {one} {other}" for one, other in pairwise(rest)]


def strip(face: str) -> str:
    """The corners from both ends in turns."""
    left = face.split()
    return " ".join(left.pop(0 if place < 2 or place % 2 else -1) for place in range(len(left)))


def pieces(name: str, faces: list[str], primitive: str) -> str:
    """Faces as primitives of a kind; the last one of those of any kind is alone."""
    vertex = f'<input semantic="VERTEX" source="#{name}-v" offset="0"/>'
    if primitive == "several":
        cuts = {"triangles": (0, 2), "polylist": (2, 4), "polygons": (4, 5), "tristrips": (5, None)}
        parts = [pieces(name, faces[slice(*cut)], each) for each, cut in cuts.items()]
        return "".join(parts)
    if primitive == "triangles":
        lists = [" ".join(each for face in faces for each in fan(face))]
        count = sum(len(fan(face)) for face in faces)
    elif primitive == "polylist":
        lists, count = [" ".join(faces)], len(faces)
    else:
        lists = [strip(face) if primitive == "tristrips" else face for face in faces]
        count = len(faces)
    sizes = " ".join(str(len(face.split())) for face in faces)
    vcount = f"<vcount>{sizes}</vcount>" if primitive == "polylist" else ""
    inner = "".join(f"<p>{each}</p>" for each in lists)
    return f'<{primitive} count="{count}">{vertex}{vcount}{inner}</{primitive}>'


def geometry(name: str, points: list[str], faces: list[str], primitive: str = "polylist") -> str:
    return (
        f'<geometry id="{name}"><convex_mesh><source id="{name}-p"><float_array id="{name}-a" '
        f'count="{len(points)}">{" ".join(points)}</float_array><technique_common><accessor '
        f'source="#{name}-a" count="{len(points) // 3}" stride="3"><param name="X" type="float"/>'
        '<param name="Y" type="float"/><param name="Z" type="float"/></accessor>'
        f'</technique_common></source><vertices id="{name}-v"><input semantic="POSITION" '
        f'source="#{name}-p"/></vertices>{pieces(name, faces, primitive)}</convex_mesh></geometry>'
    )


def turned(face: str) -> str:
    return " ".join(reversed(face.split()))


KINDS = {
    "whole": (CUBE, FACES),
    "open": (CUBE, FACES[1:]),
    "inward": (CUBE, [turned(face) for face in FACES]),
    "mixed": (CUBE, [turned(FACES[0]), *FACES[1:]]),
    "flat": ([*CUBE[:12], *CUBE[:12]], FACES),
    # A pyramid into the cube in the place of the face on top.
    "dented": ([*CUBE, "0.5", "0.5", "0.5"],
               [FACES[0], *FACES[2:], "4 5 8", "5 6 8", "6 7 8", "7 4 8"]),
    # The corner is there twice, and is one for all that.
    "doubled": ([*CUBE, "1", "1", "1"], [*FACES[:3], "1 2 8 5", *FACES[4:]]),
    "beyond": (CUBE, [*FACES[:5], "3 0 4 9"]),
    "endless": ([*CUBE[:23], "INF"], FACES),
}  # fmt: skip
FOUND = {
    "open": "geometry-open", "inward": "geometry-inward", "mixed": "geometry-mixed-winding",
    "flat": "geometry-no-volume", "dented": "geometry-not-convex", "beyond": "geometry-index-range",
    "endless": "geometry-number",
}  # fmt: skip


def found(*names: str, primitive: str = "polylist") -> Counter[str]:
    text = "".join(geometry(f"g{at}", *KINDS[name], primitive) for at, name in enumerate(names))
    report = colladaphy.validate((HEAD + text + TAIL).encode())
    return Counter(finding.code for finding in report if finding.code.startswith("geometry-"))


@pytest.mark.parametrize("name", KINDS)
def test_a_surface_alone(name: str) -> None:
    assert found(name) == Counter([FOUND[name]] if name in FOUND else [])


@pytest.mark.parametrize("primitive", ["triangles", "polygons", "trifans", "tristrips", "several"])
@pytest.mark.parametrize("name", KINDS)
def test_faces_of_other_primitives(name: str, primitive: str) -> None:
    assert found(name, "whole", primitive=primitive) == Counter(
        [FOUND[name]] if name in FOUND else []
    )


@given(st.lists(st.sampled_from(sorted(KINDS)), min_size=1, max_size=8), st.integers(1, 200))
def test_many_at_once(names: list[str], at_once: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(surface_table, "_AT_ONCE", at_once)
        assert found(*names) == Counter(FOUND[name] for name in names if name in FOUND)

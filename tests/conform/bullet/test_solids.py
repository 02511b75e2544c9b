"""Volumes and centres of meshes of any size."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.conform.bullet.conftest import Export
from tests.conform.bullet.test_bullet import body, codes, document
from tests.conform.documents import MESH

from colladaphy.conform.bullet.solids import mesh_solid

TETRAHEDRON = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


@given(exponent=st.integers(-330, 308), far=st.floats(-100, 100))
def test_a_tetrahedron_of_any_size(exponent: int, far: float) -> None:
    size = float(f"1e{exponent}")  # its cube may be out of range
    place = far * size if abs(far * size) < 1e307 else 0.0
    solid = mesh_solid(TETRAHEDRON * size + place, FACES)
    if -90 < exponent < 102:
        assert solid is not None
        assert solid.volume == pytest.approx(size**3 / 6, rel=1e-6)
        assert solid.center == pytest.approx(np.full(3, place + size / 4), abs=1e-6 * size)
    elif not -110 < exponent < 104:  # 1e103 cubed is too great, a sixth of it is not
        assert solid is None


@given(st.lists(st.floats(), min_size=12, max_size=12))
def test_any_numbers(numbers: list[float]) -> None:
    solid = mesh_solid(np.array(numbers).reshape(-1, 3), FACES)
    if solid is not None:
        assert 0.0 < solid.volume < math.inf
        assert np.all(np.isfinite(solid.center))


def test_a_mesh_too_great_to_weigh_is_reported(export: Export) -> None:
    huge = MESH.format("g").replace(">0 0 0 1", ">0 0 0 1e200").replace(" 0 1 0 ", " 0 1e200 0 ")
    huge = huge.replace("0 0 0 1<", "0 0 0 1e200<").replace(
        "0 1 0 0 0 1e200", "0 1e200 0 0 0 1e200"
    )
    geometry = f"<geometry id='g'><mesh>{huge}</mesh></geometry>"
    library = f"<library_geometries>{geometry}</library_geometries>"
    shape = "<shape><instance_geometry url='#g'/></shape>"
    _, findings = export(document(bodies=body(shape, "<dynamic>true</dynamic>"), libraries=library))
    assert "mass-unknown" in codes(findings)

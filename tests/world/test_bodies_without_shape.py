"""Bodies of mass and inertia that have no shape."""

from __future__ import annotations

import io

import numpy as np
import pytest

import colladaphy
from colladaphy.errors import WorldError
from colladaphy.world import BodyColumns, Kind, World, compare


def test_it_has_its_mass_and_inertia_and_neither_material_nor_volume() -> None:
    world = World()
    body = world.create_body(7, (1, 2, 3), 5.0, (1, 2, 2.5), name="link")
    assert (body.kind, body.mass, body.uid, body.name) == (Kind.EMPTY, 5.0, 7, "link")
    assert np.array_equal(body.inertia, np.diag((1, 2, 2.5)))
    assert body.material is None
    assert (body.volume, body.density) == (0.0, 0.0)


def test_a_point_has_no_inertia() -> None:
    assert not World().create_body(0, (0, 0, 0), 1.0).inertia.any()


def test_in_a_union_its_mass_counts_and_its_lack_of_a_material_does_not() -> None:
    world = World()
    ball = world.create_sphere(0, (0, 0, 0), 1.0, "iron", mass=3.0, inertia=(1, 1, 1))
    point = world.create_body(0, (4, 0, 0), 1.0)
    union = world.create_union(0, [ball, point])
    assert np.array_equal(union.position, (1, 0, 0))
    # 3 at 1 and 1 at 3 from the centre: 3 + 9 across, and the ball's own 1.
    assert np.allclose(union.inertia, np.diag((1, 13, 13)), rtol=1e-15)
    assert union.material is not None and union.material.name == "iron"


def test_many_of_them_need_their_masses_and_take_no_material() -> None:
    world = World()
    kinds = np.array([Kind.EMPTY, Kind.EMPTY])
    world.extend(BodyColumns(kinds=kinds, masses=np.array([1.0, 2.0])))
    assert world.masses.tolist() == [1.0, 2.0]
    with pytest.raises(WorldError, match="masses"):
        world.extend(BodyColumns(kinds=kinds))
    with pytest.raises(WorldError, match="material"):
        world.extend(BodyColumns(kinds=kinds, masses=np.ones(2), material_ids=np.zeros(2, int)))


@pytest.mark.parametrize("profile", ["compact", "none"])
def test_it_is_stored_as_the_hull_of_nothing_and_comes_back(profile: str) -> None:
    world = World()
    world.create_body(7, (1, 2, 3), 5.0, (1, 2, 2.5), name="link")
    stream = io.BytesIO()
    colladaphy.write(world, stream, options=colladaphy.WriteOptions(profile=profile))  # type: ignore[arg-type]
    stream.seek(0)
    assert colladaphy.validate(stream).errors == []
    stream.seek(0)
    document = colladaphy.read(stream)
    again = document.load()
    assert document.report.findings == []
    if profile == "compact":
        assert compare(world, again, unused_materials=True) == []
    (body,) = again.bodies
    assert body.kind is Kind.EMPTY
    assert (body.mass, body.position.tolist()) == (5.0, [1, 2, 3])
    assert np.array_equal(body.inertia, np.diag((1, 2, 2.5)))

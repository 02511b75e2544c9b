"""Worlds compared within a tolerance, and what the differences say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from tests.world.rebuilding import rebuilt

from colladaphy.errors import WorldError
from colladaphy.testing import worlds
from colladaphy.world import World, compare
from colladaphy.world.compare import differing
from colladaphy.world.differences import Difference


@given(st.floats(1e-12, 1e3), st.floats(-1e3, 1e3), st.floats(0, 1), st.floats(0, 10))
def test_numbers_are_apart_by_what_is_allowed(
    by: float, at: float, rtol: float, atol: float
) -> None:
    one, two = World(), World()
    one.create_sphere(1, (at, 0, 0), 1, "iron")
    two.create_sphere(1, (at + by, 0, 0), 1, "iron")
    apart = abs(float(two.positions[0, 0] - one.positions[0, 0]))
    assume(apart > 0)
    size = max(abs(at), abs(at + by))
    allowed = atol + rtol * size
    assume(abs(apart - allowed) > 1e-9 * (apart + allowed) or not (rtol or atol))
    found = differing(one, two, rtol, atol)
    if (rtol or atol) and apart < allowed:
        assert found == [] and compare(one, two, rtol, atol) == []
        return
    (difference,) = found
    assert (difference.kind, difference.id, difference.what) == ("body", 1, "positions")
    assert difference.apart == apart
    assert difference.relative == pytest.approx(apart / size)
    assert compare(one, two)[0].startswith(f"body 1, positions: [{at!r}")
    assert f"(apart by {apart:.3g}," in compare(one, two)[0]


@given(worlds(min_bodies=0), st.floats(0, 1), st.floats(0, 1))
def test_equal_worlds_are_equal_within_any_tolerance(
    world: World, rtol: float, atol: float
) -> None:
    assert compare(world, rebuilt(world), rtol, atol, unused_materials=True) == []


def test_all_kinds_of_differences() -> None:
    def make() -> World:
        world = World((0, 0, -9.81), time_step=0.01)
        box = world.create_box(1, (0, 0, 0), (1, 1, 1), "oak", name="box")
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        mesh = world.create_mesh(2, (3, 0, 0), corners, faces, "fir")
        world.attach_hinge_joint(box, mesh, axis=(0, 0, 1), name="hinge")
        world.set_pair("oak", "fir", restitution=0.5)
        return world

    one, two = make(), make()
    two.time_step = None
    two.gravity = (0, 0, -1)
    two.bodies[0].name = "crate"
    two.bodies[1].sleeping = True
    two.joints[0].angular_max = (0, 0, 1)
    two.set_pair("oak", "fir", restitution=0.25, dynamic_friction=0.5)
    two.create_sphere(9, (9, 9, 9), 1, "oak", name="new")
    two.next_body_sid = one.next_body_sid
    found = {(d.kind, d.id, d.what): d for d in differing(one, two)}
    assert set(found) == {
        ("world", None, "time_step"), ("world", None, "gravity"), ("body", 1, "name"),
        ("body", 2, "sleeping"), ("joint", 1, "angular_limits"), ("body", 3, "presence"),
        ("pair of materials", (3, 4), "restitution"),
        ("pair of materials", (3, 4), "dynamic_friction"),
    }  # fmt: skip
    assert found["world", None, "gravity"].apart == pytest.approx(8.81)
    assert found["pair of materials", (3, 4), "dynamic_friction"].first is None
    assert found["body", 3, "presence"] == Difference("body", 3, "presence", False, True)
    three = make()
    vertices = np.array(three.meshes[three.bodies[1].mesh.id].vertices)
    vertices[0] -= 1e-9
    four = make()
    assert compare(three, four) == []
    bent = World((0, 0, -9.81), time_step=0.01)
    bent.create_mesh(2, (3, 0, 0), vertices, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], "fir")
    straight = World((0, 0, -9.81), time_step=0.01)
    straight.create_mesh(2, (3, 0, 0), np.array(four.bodies[1].mesh.vertices),
                         [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], "fir")  # fmt: skip
    assert "mesh" in {d.what for d in differing(bent, straight)}
    assert compare(bent, straight, atol=1e-6) == []


def test_many_differences_of_a_column_are_counted() -> None:
    one, two = World(), World()
    for world in (one, two):
        for i in range(25):
            world.create_sphere(i, (i, 0, 0), 0.4, "iron")
    two.positions += 1
    lines = compare(one, two)
    assert len(lines) == 11 and lines[-1] == "body, positions: 15 more"
    assert len(differing(one, two)) == 25


@pytest.mark.parametrize(
    "arguments", [(1,), (World(), World(), -1.0), (World(), World(), 0.0, np.inf),
                  (World(), World(), "tight")],
)  # fmt: skip
def test_impossible_comparisons(arguments: Any) -> None:
    with pytest.raises(WorldError, match="physics-argument"):
        compare(World(), *arguments[-1:]) if len(arguments) == 1 else compare(*arguments)

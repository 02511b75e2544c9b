"""World → file → World gives equal columns, to the last bit (thesis 6.1)."""

from __future__ import annotations

import io

import pytest
from hypothesis import given, settings

import colladaphy
from colladaphy.mapper import WriteOptions
from colladaphy.testing import worlds
from colladaphy.world import World, compare


def there_and_back(world: World, **options: object) -> tuple[World, colladaphy.Document]:
    stream = io.BytesIO()
    colladaphy.write(world, stream, options=WriteOptions(**options))
    document = colladaphy.read(stream.getvalue())
    return document.load(), document


@settings(max_examples=60)
@given(worlds(min_bodies=0))
def test_every_world_comes_back_exactly(world: World) -> None:
    again, document = there_and_back(world)
    assert compare(world, again) == []
    assert [finding.code for finding in document.report] == []


@settings(max_examples=25)
@given(worlds(min_bodies=0))
def test_with_a_full_profile_too(world: World) -> None:
    again, document = there_and_back(world, profile="full")
    assert compare(world, again) == []
    assert [finding.code for finding in document.report] == []


@pytest.mark.parametrize(
    "options",
    [{"shape_weight": "density"}, {"redundant": True}, {"group": lambda body: str(body.uid % 3)}],
    ids=["density", "redundant", "groups"],
)
@settings(max_examples=20)
@given(world=worlds(min_bodies=0))
def test_with_every_option(world: World, options: dict[str, object]) -> None:
    again, _ = there_and_back(world, **options)
    assert compare(world, again) == []


@pytest.mark.parametrize("place", [(0, 0, 12), (0, 0, -7), (5e5, 0, -3e5)])
def test_a_tilted_plane_far_out_in_a_union(place: tuple[float, float, float]) -> None:
    """What is left of its displacement is as exact as what it is left of."""
    world = World()
    plane = world.create_plane(1, (0, 1, 0), 0, "iron", fixed=True)
    inner = world.create_union(2, [plane], position=(0, 0, 0))
    inner.position = place
    world.create_union(3, [inner], position=(0, 0, 0))
    again, document = there_and_back(world, shape_weight="density")
    assert compare(world, again) == []
    assert [finding.code for finding in document.report] == []


@settings(max_examples=15)
@given(worlds(min_bodies=0))
def test_the_same_world_gives_the_same_bytes(world: World) -> None:
    first, second = io.BytesIO(), io.BytesIO()
    colladaphy.write(world, first)
    again, _ = there_and_back(world)
    colladaphy.write(again, second)
    assert first.getvalue() == second.getvalue()

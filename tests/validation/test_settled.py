"""Documents that need no mending are described and converted without it, and no other way."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from hypothesis import given, settings
from lxml import etree

import colladaphy
from colladaphy.document import api
from colladaphy.source import load
from colladaphy.testing import worlds
from colladaphy.validation import mending, statistics
from colladaphy.world import World, compare


def both(data: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every way of reading says the same, whether or not it is known that nothing is to mend."""
    quick = statistics.describe(data), mending.mend(data), colladaphy.read(data, repair=True)
    with monkeypatch.context() as patch:
        patch.setattr(api, "is_settled", lambda columns, convention: False)
        assert api.settled_document(load(data)) is None
        slow = statistics.describe(data), mending.mend(data), colladaphy.read(data, repair=True)
    assert quick[0] == slow[0]
    assert etree.tostring(quick[1].tree) == etree.tostring(slow[1].tree)
    assert list(quick[1].report) == list(slow[1].report)
    assert quick[1].bodies() == slow[1].bodies()
    assert compare(quick[2].load(), slow[2].load()) == []
    assert list(quick[2].report) == list(slow[2].report)
    assert quick[2].tolerant and slow[2].tolerant
    assert etree.tostring(quick[2].tree) == etree.tostring(slow[2].tree)


def stored(world: World) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return stream.getvalue()


@given(world=worlds())
@settings(max_examples=20)
def test_worlds(world: World) -> None:
    with pytest.MonkeyPatch.context() as patch:
        both(stored(world), patch)


def test_a_large_world(monkeypatch: pytest.MonkeyPatch) -> None:
    """Large enough for `accepts` to be asked for it; the quick way is taken."""
    world = World()
    for number in range(400):
        world.create_sphere(number, (3 * number, 0, 0), 1, "iron")
    world.create_plane(400, (0, 0, 1), -1, "granite", fixed=True)
    data = stored(world)
    assert api.settled_document(load(data)) is not None
    both(data, monkeypatch)


def test_what_is_not_valid_is_not_settled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World()
    for number in range(400):
        world.create_sphere(number, (3 * number, 0, 0), 1, "iron")
    data = stored(world).replace(b"<radius>1</radius>", b"<radius>1,5</radius>", 1)
    assert api.settled_document(load(data)) is None
    assert len(mending.mend(data).report) == 1
    both(data, monkeypatch)

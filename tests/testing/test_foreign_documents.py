"""Documents in the manner of other programs: the library reads them as they were meant."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from tests.producers.world_oracle import assert_means
from tests.testing.collecting import drawn, smallest

import colladaphy
from colladaphy.testing import FOREIGN_PRODUCERS, ForeignDocument, foreign_documents
from colladaphy.world import World, rotations


@pytest.fixture(scope="module")
def many() -> list[ForeignDocument]:
    return drawn(foreign_documents(), 300)


def test_every_producer_occurs(many: list[ForeignDocument]) -> None:
    assert {document.producer for document in many} == set(FOREIGN_PRODUCERS)
    assert {"bullet", "nxustream2", "openrave", "openhrp3", "ros", "thesis"} < set(
        FOREIGN_PRODUCERS
    )
    assert any(document.habits for document in many)


@pytest.mark.parametrize("producer", FOREIGN_PRODUCERS)
def test_the_world_is_what_the_scene_means(producer: str) -> None:
    """Against the oracle, which works with matrices and calls nothing that made the World."""
    for document in drawn(foreign_documents(producer), 10):
        assert document.producer == producer
        assert_means(document.world, document.meant)


def everything_in_the_world(world: World) -> list[np.ndarray]:
    """What does not depend on which axes a body has."""
    turns = [rotations.to_matrix(body.orientation) for body in world.bodies]
    pairs = zip(turns, world.bodies, strict=True)
    inertias = [turn @ body.inertia @ turn.T for turn, body in pairs]
    places = []
    for joint in world.joints:
        for body, (point, turn) in ((joint.body1, joint.frame1), (joint.body2, joint.frame2)):
            outer = np.eye(3) if body is None else rotations.to_matrix(body.orientation)
            at = np.zeros(3) if body is None else np.asarray(body.position)
            places.append(np.append(at + outer @ point, outer @ rotations.to_matrix(turn)))
    return [
        world.positions, world.masses, np.array(inertias), world.fixed, world.linear_velocities,
        world.angular_velocities, np.array(places), world.gravity,
        np.array([joint.linear_max for joint in world.joints]),
        np.array([joint.angular_min for joint in world.joints]),
    ]  # fmt: skip


@settings(max_examples=60)
@given(document=foreign_documents())
def test_loading_comes_to_the_world_that_was_meant(document: ForeignDocument) -> None:
    loaded = colladaphy.read(document.data, repair=True).load()
    pairs = zip(
        everything_in_the_world(loaded), everything_in_the_world(document.world), strict=True
    )
    for found, meant in pairs:
        assert np.allclose(found, meant, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("producer", FOREIGN_PRODUCERS)
def test_without_habits_nothing_but_the_producer_speaks(producer: str) -> None:
    for document in drawn(foreign_documents(producer, habits=False), 5):
        assert document.habits == frozenset()


def test_the_simplest_document_is_short() -> None:
    document = smallest(foreign_documents("bullet"), lambda document: True)
    assert len(document.meant.links) == 1
    assert len(document.data) < 3000


@pytest.mark.parametrize("names", ["unreal", ["bullet", "unreal"], []])
def test_unknown_producers_are_refused(names: str | list[str]) -> None:
    with pytest.raises(ValueError, match=r"no producer 'unreal'; there are bullet|name a producer"):
        foreign_documents(names)

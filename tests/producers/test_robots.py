"""Robots of OpenRAVE, ROS and OpenHRP3 come in with the meaning that their author gave them."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.producers.checking import accept, codes
from tests.producers.world_oracle import assert_means

from colladaphy.testing.producers import robots
from colladaphy.testing.producers.truth import Link, Scene, Solid

SOME_QUIRKS = st.sets(st.sampled_from(robots.QUIRKS)).map(frozenset)


@settings(max_examples=25)
@given(scene=robots.robots(), producer=st.sampled_from(sorted(robots.TOOLS)), quirks=SOME_QUIRKS)
def test_any_mixture_of_deviations(scene: Scene, producer: str, quirks: frozenset[str]) -> None:
    scene = robots.meant(scene, quirks)
    world = accept(robots.write(scene, producer, quirks))
    assert_means(world, scene)


@settings(max_examples=10)
@given(scene=robots.robots(("box", "sphere", "cylinder", "capsule")), quirks=SOME_QUIRKS)
def test_primitives(scene: Scene, quirks: frozenset[str]) -> None:
    scene = robots.meant(scene, quirks)
    world = accept(robots.write(scene, "openrave", quirks - {"no-shapes"}))
    assert_means(world, scene)


@pytest.mark.parametrize("producer", sorted(robots.TOOLS))
@pytest.mark.parametrize("quirk", [None, *robots.QUIRKS])
def test_each_deviation(producer: str, quirk: str | None) -> None:
    quirks = frozenset() if quirk is None else frozenset({quirk})
    scene = robots.meant(example(), quirks)
    data = robots.write(scene, producer, quirks)
    assert_means(accept(data, cli=True), scene)
    assert codes(data)["convention-chosen"] == 1


def example() -> Scene:
    """Three links in a chain, turned, away from the origin."""
    links = tuple(
        Link(
            name=f"rigid{number}",
            steps=(("translate", (0.5, 0.25, 1.0)), ("rotate", (0.0, 0.6, 0.8, 35.0 * number))),
            solids=(Solid("mesh", (0.1, 0.2, 0.3), (("translate", (0.05, 0.0, 0.1)),)),),
            mass=1.5 + number,
            centre=(("translate", (0.05, 0.01, 0.1)), ("rotate", (0.0, 0.0, 1.0, 20.0))),
            inertia=(0.05, 0.04, 0.03),
            parent=number - 1 if number else None,
        )
        for number in range(3)
    )
    root = (("translate", (3.0, -4.0, 0.5)), ("rotate", (0.0, 0.0, 1.0, 90.0)))
    return Scene(links, root=root)


def test_frames_are_those_of_the_instanced_root() -> None:
    quirks = frozenset({"nodes-in-library", "library-root-moved", "moved-joints"})
    scene = robots.meant(example(), quirks)
    assert_means(accept(robots.write(scene, "openrave", quirks)), scene)

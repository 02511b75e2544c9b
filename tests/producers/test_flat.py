"""Scenes of modellers and physics engines come in with the meaning that their author gave them."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.producers.checking import accept
from tests.producers.world_oracle import assert_means

from colladaphy.testing.foreign_documents import scenes_of
from colladaphy.testing.producers import flat, habits
from colladaphy.testing.producers.habits import PRODUCERS
from colladaphy.testing.producers.truth import Joint, Link, Scene, Solid

NAMES = sorted(PRODUCERS.keys() - {"chimera"})


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=20)
@given(data=st.data())
def test_any_mixture_of_deviations(name: str, data: st.DataObject) -> None:
    producer = PRODUCERS[name]
    scene = data.draw(scenes_of(name))
    quirks = frozenset()
    if producer.may:
        quirks = data.draw(st.sets(st.sampled_from(producer.may)).map(frozenset))
    assert_means(accept(flat.write(scene, producer, quirks)), scene)


CASES = [
    (name, quirk) for name, producer in sorted(PRODUCERS.items()) for quirk in (None, *producer.may)
]


@pytest.mark.parametrize(("name", "quirk"), CASES)
def test_each_deviation(name: str, quirk: str | None) -> None:
    producer = PRODUCERS[name]
    scene = habits.meant(example(producer), producer)
    data = flat.write(scene, producer, frozenset() if quirk is None else frozenset({quirk}))
    assert_means(accept(data, cli=quirk is None), scene)


def example(producer: habits.Producer) -> Scene:
    """Two bodies of all kinds that the producer knows, and a joint between them."""
    shift = (("translate", (0.5, 0.0, -0.25)), ("rotate", (0.0, 0.6, 0.8, 30.0)))
    sizes = {"box": (0.5, 1.0, 1.5), "mesh": (0.25, 0.5, 0.75), "sphere": (0.5,)}
    solids = tuple(
        Solid(kind, sizes.get(kind, (0.25, 1.5)), shift if number else ())
        for number, kind in enumerate(producer.kinds)
    )
    place = (("translate", (1.0, 2.0, 3.0)), ("rotate", (1.0, 0.0, 0.0, 45.0)))
    centre = (("translate", (0.125, 0.0, 0.0)), ("rotate", (0.0, 0.0, 1.0, 15.0)))
    links = tuple(
        Link(
            name=f"link{number}",
            steps=place[: number + 1],
            solids=solids if number else solids[-1:],
            mass=2.5,
            centre=centre if producer.centred else None,
            inertia=(2.0, 1.5, 1.0) if producer.centred else None,
            velocity=(1.0, 0.0, -2.0) if producer.moving and number else (0.0, 0.0, 0.0),
            spin=(0.0, 3.5, 0.25) if producer.moving and number else (0.0, 0.0, 0.0),
            fixed=not number,
        )
        for number in range(2)
    )
    inf = float("inf")
    joint = Joint("hinge", 0, 1, (place, centre), angular=((0.0, -45.0, -inf), (0.0, 90.0, inf)))
    return Scene(links, (joint,) if producer.joints else ())

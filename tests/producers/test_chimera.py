"""Blender/Chimera: no scene, targets that are not there, meshes in shapes, three radii."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.producers.checking import accept, codes
from tests.producers.test_flat import example
from tests.producers.world_oracle import assert_means

from colladaphy.testing.foreign_documents import scenes_of
from colladaphy.testing.producers import flat, habits
from colladaphy.testing.producers.habits import PRODUCERS

CHIMERA = PRODUCERS["chimera"]


@settings(max_examples=20)
@given(data=st.data())
def test_any_mixture_of_deviations(data: st.DataObject) -> None:
    scene = data.draw(scenes_of("chimera"))
    quirks = data.draw(st.sets(st.sampled_from(CHIMERA.may)).map(frozenset))
    assert_means(accept(flat.write(scene, CHIMERA, quirks)), scene)


@pytest.mark.parametrize("quirk", [None, *CHIMERA.may])
def test_each_deviation(quirk: str | None) -> None:
    scene = habits.meant(example(CHIMERA), CHIMERA)
    data = flat.write(scene, CHIMERA, frozenset() if quirk is None else frozenset({quirk}))
    assert_means(accept(data, cli=quirk is None), scene)
    assert codes(data)["repair-sphere-radius"] == 1

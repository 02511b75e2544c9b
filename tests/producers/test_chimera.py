"""Blender/Chimera: no scene, targets that are not there, meshes in shapes, three radii."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.producers import flat
from tests.producers.checking import accept, codes
from tests.producers.flat import PRODUCERS
from tests.producers.test_flat import example, meant_by
from tests.producers.world_oracle import assert_means

CHIMERA = PRODUCERS["chimera"]


@settings(max_examples=20)
@given(data=st.data())
def test_any_mixture_of_deviations(data: st.DataObject) -> None:
    scene = data.draw(meant_by("chimera"))
    quirks = data.draw(st.sets(st.sampled_from(CHIMERA.may)).map(frozenset))
    assert_means(accept(flat.write(scene, CHIMERA, quirks)), scene)


@pytest.mark.parametrize("quirk", [None, *CHIMERA.may])
def test_each_deviation(quirk: str | None) -> None:
    scene = flat.meant(example(CHIMERA), CHIMERA)
    data = flat.write(scene, CHIMERA, frozenset() if quirk is None else frozenset({quirk}))
    assert_means(accept(data, cli=quirk is None), scene)
    assert codes(data)["repair-sphere-radius"] == 1

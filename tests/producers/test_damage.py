"""Whatever happens to a file: it comes in, valid, and with one meaning, or it is refused."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.producers.checking import accept
from tests.producers.damage import damaged
from tests.producers.test_flat import example as flat_example
from tests.producers.test_robots import example as robot_example

from colladaphy.errors import ColladaError
from colladaphy.testing.producers import flat, habits, robots
from colladaphy.testing.producers.habits import PRODUCERS


def _files() -> dict[str, bytes]:
    quirks = frozenset({"binds", "contact-extra", "profile"})
    files = {"robot": robots.write(robot_example(), "ros", quirks)}
    for name, producer in PRODUCERS.items():
        scene = habits.meant(flat_example(producer), producer)
        files[name] = flat.write(scene, producer, frozenset({"effects"} & {*producer.may}))
    return files


FILES = _files()


@pytest.mark.parametrize("name", sorted(FILES))
@settings(max_examples=25)
@given(random=st.randoms(use_true_random=False))
def test_damaged_files_come_in_or_are_refused(name: str, random: Random) -> None:
    try:
        accept(damaged(FILES[name], random), errors=True, outside=False)
    except ColladaError as error:
        # A unit of length that has no length is beyond repair.
        assert [finding.code for finding in error.findings] == ["physics-dimension"]

"""What must hold of files as other programs write them."""

from __future__ import annotations

from random import Random

from hypothesis import strategies as st
from tests.producers import flat, robots
from tests.producers.checking import accept
from tests.producers.damage import damaged
from tests.producers.flat import PRODUCERS
from tests.producers.test_damage import FILES
from tests.producers.test_flat import NAMES, meant_by
from tests.producers.truth import Scene
from tests.producers.world_oracle import assert_means

from colladaphy.errors import ColladaError
from tools.fuzz.registry import note, of

__all__: list[str] = []


def _flat() -> st.SearchStrategy[tuple[str, Scene, frozenset[str]]]:
    """A producer, a scene that it can write, and how it deviates."""

    @st.composite
    def drawn(draw: st.DrawFn) -> tuple[str, Scene, frozenset[str]]:
        name = draw(st.sampled_from(NAMES))
        may = PRODUCERS[name].may
        quirks = draw(st.sets(st.sampled_from(may))) if may else set()
        return name, draw(meant_by(name)), frozenset(quirks)

    return drawn()


def _quirks() -> st.SearchStrategy[frozenset[str]]:
    return st.sets(st.sampled_from(robots.QUIRKS)).map(frozenset)


def _damaged() -> st.SearchStrategy[bytes]:
    seeds = st.integers(0, 2**32)
    files = st.sampled_from(sorted(FILES.items()))
    return st.builds(lambda file, seed: damaged(file[1], Random(seed)), files, seeds)


@of(_flat)
def producer_flat(drawn: tuple[str, Scene, frozenset[str]]) -> None:
    """Scenes of modellers and engines come in with the meaning that their author gave them."""
    name, scene, quirks = drawn
    assert_means(accept(note(flat.write(scene, PRODUCERS[name], quirks))), scene)


@of(robots.robots, lambda: st.sampled_from(sorted(robots.TOOLS)), _quirks)
def producer_robots(scene: Scene, producer: str, quirks: frozenset[str]) -> None:
    """Robots come in with the meaning that their author gave them."""
    scene = robots.meant(scene, quirks)
    assert_means(accept(note(robots.write(scene, producer, quirks))), scene)


@of(_damaged, weight=2)
def producer_damaged(document: bytes) -> None:
    """Damaged files come in, valid and with one meaning, or are refused."""
    try:
        accept(note(document), errors=True, outside=False)
    except ColladaError as error:
        # A unit of length that has no length is beyond repair.
        assert [finding.code for finding in error.findings] == ["physics-dimension"]

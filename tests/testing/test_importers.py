"""The battery for importers: ours passes, and each fault of another is found and told."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import settings
from lxml import etree

import colladaphy
from colladaphy import ColladaError
from colladaphy.testing import CHECKS, check_importer
from colladaphy.world import World

EXAMPLES = max(15, settings().max_examples // 4)
C = "{http://www.collada.org/2008/03/COLLADASchema}"


def ours(data: bytes) -> World:
    return colladaphy.read(data).load()


def written(world: World) -> bytes:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    return stream.getvalue()


def test_ours_passes() -> None:
    report = check_importer(ours, written, refuses=ColladaError, examples=EXAMPLES)
    assert report.passed
    assert tuple(report.counts) == CHECKS
    assert all(count >= EXAMPLES for count in report.counts.values()), report.counts
    assert str(report).splitlines()[0].startswith("passed  meaning (")


def without(tag: str) -> Callable[[bytes], World]:
    """An importer that does not know an element."""

    def load(data: bytes) -> World:
        root = etree.fromstring(data)
        etree.strip_elements(root, C + tag, with_tail=False)
        return ours(etree.tostring(root))

    return load


def test_what_an_importer_does_not_know_is_found_and_shown() -> None:
    report = check_importer(without("velocity"), checks=["meaning"], examples=200, raises=False)
    (failure,) = report.failures
    assert failure.check == "meaning" and "linear_velocities" in failure.message
    assert failure.document is not None and failure.document.count(b"<velocity>") == 1
    assert len(failure.document) < 5000
    text = str(report)
    assert text.startswith("failed  meaning (") and "<velocity>" in text
    assert "documents of physics mean what they say" in text


def test_it_raises_with_the_report() -> None:
    with pytest.raises(AssertionError, match="failed  meaning") as caught:
        check_importer(without("gravity"), checks=["meaning"], examples=100)
    assert "gravity" in str(caught.value)


class _Forgetful:
    """Loads right once."""

    def __init__(self) -> None:
        self._seen: set[bytes] = set()

    def __call__(self, data: bytes) -> World:
        if data in self._seen:
            raise KeyError("loaded before")
        self._seen.add(data)
        return ours(data)


def by_position(data: bytes) -> World:
    """Takes what stands first among the libraries for the models."""
    root = etree.fromstring(data)
    libraries = [child.tag for child in root if "library_" in str(child.tag)]
    if libraries != sorted(libraries):
        raise ValueError("libraries in another order")
    return ours(data)


def common_profile(data: bytes) -> World:
    return colladaphy.read(data).load(prefer="profile")


def one_more_gram(world: World) -> bytes:
    world.masses[:] = world.masses + 0.001
    return written(world)


def no_schema(world: World) -> bytes:
    return written(world).replace(b"<asset>", b"<asset><nonsense/>", 1)


@pytest.mark.parametrize(
    ("load", "store", "check", "message"),
    [
        (_Forgetful(), None, "again", "KeyError: 'loaded before'"),
        (by_position, None, "alike", "ValueError: libraries in another order"),
        (common_profile, None, "edited", "it means another World"),
        (without("dynamic_friction"), None, "worlds", "the World that was written differs"),
        (ours, one_more_gram, "stored", "what was stored is another World"),
        (ours, no_schema, "stored", "what was stored is not valid"),
    ],
)
def test_each_check_finds_its_fault(load: Any, store: Any, check: str, message: str) -> None:
    report = check_importer(load, store, checks=[check], examples=300, raises=False)
    (failure,) = report.failures
    assert failure.check == check and failure.message.startswith(message)
    assert failure.document is not None
    assert isinstance(failure.error, Exception)


def test_worlds_may_differ_within_a_tolerance() -> None:
    def single(data: bytes) -> World:
        world = ours(data)
        world.positions[:] = world.positions.astype("f4")
        return world

    assert not check_importer(single, checks=["worlds"], examples=80, raises=False).passed
    assert check_importer(single, checks=["worlds"], examples=40, rtol=1e-6, atol=1e-30).passed


def test_what_is_loaded_need_not_be_a_world() -> None:
    def count(data: bytes) -> int:
        return len(ours(data).bodies)

    def differ(world: World, found: int) -> list[str]:
        return [] if len(world.bodies) == found else [f"{found} bodies"]

    assert check_importer(count, compare=differ, checks=["meaning"], examples=EXAMPLES).passed
    with pytest.raises(AssertionError, match="load made a int, not a World"):
        check_importer(count, checks=["meaning"], examples=5)


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(ValueError, match="no check 'speed'; there are meaning"):
        check_importer(ours, checks=["speed"])
    with pytest.raises(ValueError, match="the check 'stored' needs `store`"):
        check_importer(ours, checks=["stored"])
    with pytest.raises(ValueError, match="the check 'refused' needs `refuses`"):
        check_importer(ours, checks=["refused"])


def test_other_errors_than_its_own_are_found() -> None:
    def load(data: bytes) -> World:
        etree.fromstring(data)
        return ours(data)

    report = check_importer(
        load, checks=["refused"], refuses=ColladaError, examples=100, raises=False
    )
    (failure,) = report.failures
    assert failure.message.startswith("XMLSyntaxError: ") and failure.document is not None

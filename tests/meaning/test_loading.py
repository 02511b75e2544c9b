"""What validation calls valid, loading takes without an error.

Over documents of the whole schema, Worlds that were stored and edited, documents as producers
write them, and all the documents of the rules.
"""

from __future__ import annotations

import io
import random
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.meaning.test_cases import FAULTS, NEAR, Case

import colladaphy
from colladaphy import World
from colladaphy.testing import documents, worlds
from colladaphy.validation.mending import mend, serialise

some = settings(max_examples=20, deadline=None, suppress_health_check=list(HealthCheck))


def check(data: bytes | Path) -> None:
    """A document that is called valid must load, and to call one so must not raise."""
    report = colladaphy.validate(data)
    # A reference out of the document's folder is not wrong, but is not followed either.
    if report.valid and not any(finding.code == "io-reference-refused" for finding in report):
        document = colladaphy.read(data)
        document.load()


@some
@given(documents())
def test_documents_of_the_whole_schema(document: bytes) -> None:
    check(document)


@some
@given(documents(areas=["physics"]))
def test_documents_of_physics(document: bytes) -> None:
    check(document)


@some
@given(worlds(min_bodies=0, extreme=True))
def test_stored_worlds(world: World) -> None:
    target = io.BytesIO()
    colladaphy.write(world, target)
    check(target.getvalue())


_NUMBER = re.compile(rb"(?<=[> ])-?[0-9][0-9.e+-]*(?=[< ])")
_REFERENCE = re.compile(rb'(?<=")#?[A-Za-z]+[0-9]+(?=")')
_ODD = (b"0", b"-1", b"NaN", b"INF", b"-INF", b"1e999", b"1e-320", b"1e308", b"")


def edited(data: bytes, chance: random.Random, times: int) -> bytes:
    """A document with some numbers and references replaced."""
    for _ in range(times):
        pattern = chance.choice((_NUMBER, _NUMBER, _REFERENCE))
        found = list(pattern.finditer(data))
        if not found:
            continue
        place = chance.choice(found)
        others = [*_ODD] if pattern is _NUMBER else [m.group() for m in found] + [b"#none", b""]
        data = data[: place.start()] + chance.choice(others) + data[place.end() :]
    return data


@some
@given(worlds(min_bodies=0, extreme=False), st.integers(0, 2**32), st.integers(1, 3))
def test_edited_worlds(world: World, seed: int, times: int) -> None:
    """Numbers and references are replaced by others, and by such as have no meaning."""
    target = io.BytesIO()
    colladaphy.write(world, target)
    check(edited(target.getvalue(), random.Random(seed), times))


@pytest.mark.parametrize("case", FAULTS + NEAR)
def test_documents_of_the_rules(case: Case, tmp_path: Path) -> None:
    case.report(tmp_path)
    check(tmp_path / "case.dae")


def test_real_files_after_they_are_mended(corpus_dir: Path) -> None:
    for path in sorted(corpus_dir.glob("*.dae")):
        if path.name == "colladatools-simple-arm-hostile.dae":
            continue  # no XML, be it mended
        check(serialise(mend(path).tree))


def test_what_is_updated_is_not_stale(corpus_dir: Path) -> None:
    """Bodies that have moved say so in both profiles, be they meshes about other centres."""
    for path in sorted(corpus_dir.glob("bullet-*.dae")):
        document = colladaphy.read(path, repair=True)
        world = document.load()
        for body in world.bodies:
            if not body.fixed:
                body.position = [value + 0.125 for value in body.position]
                body.linear_velocity = (0.1, 0.2, 0.3)
        document.update(world)
        target = io.BytesIO()
        document.write(target)
        report = colladaphy.validate(target.getvalue())
        assert [str(finding) for finding in report if finding.stage == "profile"] == [], path.name


@some
@given(worlds(min_bodies=0, extreme=True))
def test_what_is_stored_is_not_stale(world: World) -> None:
    target = io.BytesIO()
    colladaphy.write(world, target)
    report = colladaphy.validate(target.getvalue())
    assert [str(finding) for finding in report if finding.code == "profile-old-value"] == []

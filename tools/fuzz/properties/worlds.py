"""What must hold of every World."""

from __future__ import annotations

import io
from random import Random

import numpy as np
from hypothesis import strategies as st
from tests.world.changing import change
from tests.world.rebuilding import rebuilt

import colladaphy
from colladaphy import Document, World, WriteOptions, compare
from colladaphy.engines import create_engine
from colladaphy.errors import EngineError
from colladaphy.findings import Severity
from colladaphy.source import pack
from colladaphy.testing import worlds
from tools.fuzz.registry import note, of

__all__: list[str] = []

OPTIONS: list[dict[str, object]] = [
    {}, {"profile": "full"}, {"shape_weight": "density"}, {"redundant": True},
    {"group": lambda body: str(body.uid % 3)}, {"tessellate": True}, {"materials": "all"},
    {"kinematics": True},
]  # fmt: skip


def _seeds() -> st.SearchStrategy[int]:
    return st.integers(0, 2**32)


def _options() -> st.SearchStrategy[int]:
    return st.integers(0, len(OPTIONS) - 1)


def _engines() -> st.SearchStrategy[str]:
    return st.sampled_from(["pymunk", "mujoco"])


def written(world: World, **options: object) -> bytes:
    """A World as a document."""
    stream = io.BytesIO()
    colladaphy.write(world, stream, options=WriteOptions(**options))  # type: ignore[arg-type]
    return note(stream.getvalue())


def stored(world: World) -> Document:
    """The document that a World is written to."""
    return colladaphy.read(written(world))


def reads_back(document: Document, world: World) -> None:
    """What is written of a document gives a World to the last bit, without a finding about it."""
    stream = io.BytesIO()
    document.write(stream, check=False)
    assert compare(colladaphy.read(note(stream.getvalue())).load(), world) == []
    found = [
        str(each) for each in document.report if each.code in ("store-inexact", "profile-stale")
    ]
    assert found == []


@of(worlds, _options, weight=3)
def world_file(world: World, option: int) -> None:
    """World → file → World gives equal Worlds, and equal files from these."""
    before = rebuilt(world)
    data = written(world, **OPTIONS[option])
    assert compare(world, before) == []
    document = colladaphy.read(data)
    again = document.load()
    assert compare(world, again) == []
    if "materials" not in OPTIONS[option]:  # of which those that no body has are not loaded
        assert written(again, **OPTIONS[option]) == data
    if option < 2:
        assert [str(finding) for finding in document.report] == []


@of(worlds)
def world_archive(world: World) -> None:
    """A World comes back from an archive, too, with what else is in it."""
    data = pack(written(world), name="scenes/a world.dae", others={"scenes/other": b"\0"})
    document = colladaphy.read(data)
    assert compare(world, document.load()) == []
    assert document.archive is not None


@of(worlds)
def world_validates(world: World) -> None:
    """What is written of a World has no error of form, and loads if it has none at all."""
    data = written(world)
    report = colladaphy.validate(data)
    formal = [str(each) for each in report.errors if each.stage in ("io", "xml", "schema", "link")]
    assert formal == []
    colladaphy.read(data).load()


@of(worlds, _seeds)
def world_updated(world: World, seed: int) -> None:
    """A World that changed is written back into its document, to the last bit."""
    document, random = stored(world), Random(seed)
    changed = document.load()
    change(changed, random)
    document.update(changed)
    reads_back(document, changed)


@of(worlds, worlds)
def world_replaced(first: World, second: World) -> None:
    """Any World takes the place of any other in its document."""
    first.unit_name, first.unit_meter = second.unit_name, second.unit_meter
    first.up_axis = second.up_axis
    document = stored(first)
    document.update(second)
    reads_back(document, stored(second).load())


@of(worlds, _engines, st.booleans, weight=2)
def world_runs(world: World, name: str, everyday: bool) -> None:
    """An engine runs a World or refuses it with reasons; nothing else happens to it."""
    if everyday or world.time_step is None:
        world.time_step = 1 / 240
    world.engine_state = None
    before = rebuilt(world)
    engine = create_engine(name)
    findings = engine.check(world)
    assert compare(world, before) == []
    refused = any(finding.severity is Severity.ERROR for finding in findings)
    try:
        engine.load(world)
    except EngineError as error:
        codes = {finding.code for finding in error.findings}
        assert refused or codes == {"engine-library"}
        assert codes and compare(world, before) == []
        return
    assert not refused
    try:
        engine.step(3)
    except EngineError as error:
        codes = {finding.code for finding in error.findings}
        assert codes and codes <= {"engine-diverged", "engine-library"}
        return
    engine.store(world)
    assert world.step_count == before.step_count + 3
    assert np.isfinite(world.positions).all()
    again, _ = world_again(world)
    assert compare(world, again) == []


def world_again(world: World) -> tuple[World, Document]:
    """A World that was written and read."""
    document = stored(world)
    return document.load(), document

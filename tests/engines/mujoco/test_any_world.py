"""Whatever a World holds, it is run or refused with reasons, and never crashes the engine."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from tests.world.rebuilding import rebuilt

from colladaphy.engines import create_engine
from colladaphy.errors import EngineError
from colladaphy.findings import Severity
from colladaphy.testing import worlds
from colladaphy.world import World, compare


@settings(max_examples=60)
@given(worlds(min_bodies=0, max_bodies=6))
def test_any_world_is_run_or_refused(world: World) -> None:
    before = rebuilt(world)
    engine = create_engine("mujoco")
    findings = engine.check(world)
    assert compare(world, before) == []
    world.time_step = before.time_step = 1 / 240
    world.engine_state = before.engine_state = None
    refused = any(finding.severity is Severity.ERROR for finding in findings)
    try:
        engine.load(world)
    except EngineError as error:
        codes = {finding.code for finding in error.findings}
        assert refused or codes == {"engine-library"}
        assert compare(world, before) == []
        return
    assert not refused
    try:
        engine.step(3)
    except EngineError as error:
        codes = {finding.code for finding in error.findings}
        assert codes <= {"engine-diverged", "engine-library"}
        assert compare(world, before) == []
        return
    engine.store(world)
    assert world.step_count == before.step_count + 3
    again = create_engine("mujoco")
    again.load(world)
    try:
        engine.step(2)
    except EngineError as error:
        assert {finding.code for finding in error.findings} <= {"engine-diverged"}
        with pytest.raises(EngineError, match="engine-diverged"):
            again.step(2)
        return
    again.step(2)
    engine.store(world)
    twin = rebuilt(world)
    again.store(twin)
    assert compare(world, twin) == []

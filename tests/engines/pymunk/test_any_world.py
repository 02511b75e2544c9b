"""Whatever a World holds, it is run or refused with reasons, and never crashes the engine."""

from __future__ import annotations

from hypothesis import given
from tests.world.rebuilding import rebuilt

from colladaphy.engines.pymunk_engine import PymunkEngine
from colladaphy.errors import EngineError
from colladaphy.findings import Severity
from colladaphy.testing import worlds
from colladaphy.world import World, compare


@given(worlds(min_bodies=0, max_bodies=6))
def test_any_world_is_run_or_refused(world: World) -> None:
    before = rebuilt(world)
    engine = PymunkEngine()
    findings = engine.check(world)
    assert compare(world, before) == []
    world.time_step = before.time_step = 1 / 240
    world.engine_state = before.engine_state = None
    refused = any(finding.severity is Severity.ERROR for finding in findings)
    try:
        engine.load(world)
    except EngineError as error:
        assert refused and error.findings
        assert all(finding.message for finding in error.findings)
        assert compare(world, before) == []
        return
    assert not refused
    try:
        engine.step(3)
    except EngineError as error:
        assert [finding.code for finding in error.findings] == ["engine-diverged"]
        return
    engine.store(world)
    assert world.step_count == before.step_count + 3

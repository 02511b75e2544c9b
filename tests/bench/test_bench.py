"""The measuring itself, on tiny sizes; nothing here depends on how fast anything is."""

from __future__ import annotations

from pathlib import Path

import pytest
from tools.bench import __main__ as command
from tools.bench.measuring import exponent, interleaved, peak_memory
from tools.bench.steps import STEPS, document

import colladaphy


def test_the_file_is_what_it_claims_to_be() -> None:
    data = document(7)
    assert data == document(7)
    assert colladaphy.validate(data).valid
    world = colladaphy.read(data).load()
    assert len(world.bodies) == 7
    assert len({body.material.name for body in world.bodies}) == 1
    assert len({tuple(body.position) for body in world.bodies}) == 7
    assert all(any(body.linear_velocity) and any(body.angular_velocity) for body in world.bodies)


def test_every_step_is_measured_against_the_first(tmp_path: Path) -> None:
    file = tmp_path / "a.dae"
    file.write_bytes(document(3))
    timings = interleaved(file, STEPS, repeat=1)
    assert list(timings) == list(STEPS)
    assert timings["parse"].ratio == 1.0
    assert all(timing.seconds > 0 and timing.ratio > 0 for timing in timings.values())


def test_growth() -> None:
    assert exponent({10: 1.0}) is None
    assert exponent({10: 5.0, 100: 50.0, 1000: 500.0}) == pytest.approx(1.0)
    assert exponent({10: 5.0, 100: 500.0}) == pytest.approx(2.0)


def test_peak_memory_is_that_of_a_process_of_its_own(tmp_path: Path) -> None:
    file = tmp_path / "a.dae"
    file.write_bytes(document(3))
    assert 5 < peak_memory("parse", file) < 500


def test_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--bodies", "3,2", "--repeat", "1", "--stock-up-to", "2", "--no-memory"]
    assert command.main(arguments) == 0
    printed = capsys.readouterr().out
    assert printed.index("xsdata parse             2") < printed.index("parse                    3")
    assert "stock xsdata was measured up to 2 bodies only" in printed
    assert "exponent" in printed

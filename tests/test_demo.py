"""The thesis's six self-consistency cases (6.1) come back to the last bit."""

from __future__ import annotations

from pathlib import Path

import pytest

from colladaphy import demo
from colladaphy.world import World


@pytest.mark.parametrize(("name", "build"), demo.CASES, ids=[name for name, _ in demo.CASES])
def test_case_is_identical(name: str, build: object, tmp_path: Path) -> None:
    outcome = demo.run_case(name, build, tmp_path / "case.dae")  # type: ignore[arg-type]
    assert outcome.differences == []
    assert outcome.findings == 0


def test_sizes_are_those_of_the_thesis() -> None:
    box = demo.open_box()
    assert len(box.bodies) == 5 + 12
    assert len(box.joints) == 6
    assert len(demo.many_bodies().bodies) >= 2000


def test_main_keeps_the_files_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert demo.main(tmp_path / "out") == 0
    assert len(list((tmp_path / "out").glob("*.dae"))) == 6
    assert capsys.readouterr().out.count("identical") == 6


def test_a_difference_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    worlds = iter([demo.turned_boxes(2), demo.turned_boxes(3)])

    def build() -> World:
        return next(worlds)

    monkeypatch.setattr(demo, "CASES", (("boxes", build),))
    monkeypatch.setattr("colladaphy.world.compare", lambda first, second: ["a difference"])
    assert demo.main(tmp_path) == 1
    assert "DIFFERENT" in capsys.readouterr().out

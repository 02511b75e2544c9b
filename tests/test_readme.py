"""The README's examples run as they stand, one after the other in one folder."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

README = Path(__file__).resolve().parent.parent / "README.md"
BLOCKS = re.findall(r"```python\n(.*?)```", README.read_text("utf-8"), re.DOTALL)


def test_the_examples_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert len(BLOCKS) == 7
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for number, block in enumerate(BLOCKS):
        exec(compile(block, f"README.md, example {number + 1}", "exec"), names)
        if (scene := tmp_path / "scene.dae").exists() and not (tmp_path / "found.dae").exists():
            (tmp_path / "found.dae").write_bytes(scene.read_bytes())
    lines = capsys.readouterr().out.splitlines()
    assert "[]" in lines, "the run that is resumed is the run that went on"
    assert (tmp_path / "mended.dae").read_bytes()

"""Progress: shown on a terminal after a second, never elsewhere, and gone afterwards."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tests.engines.scenes import SCENES

import colladaphy
from colladaphy.cli import progress
from colladaphy.cli.progress import Bar, waiting

SLOWLY = """
import time
from colladaphy.cli.progress import Bar, waiting
from colladaphy.cli.console import note
with waiting("Loading [this]"):
    time.sleep({first})
    note("a line")
bar = Bar("step", 40, unit="steps")
for done in range(40):
    time.sleep({each})
    bar(done)
bar.clear()
note("the end")
"""


def on_a_terminal(code: str, expected: int = 0, *, until: str | None = None) -> str:
    """What a process writes to a terminal that is its standard error; interrupted at `until`."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "120"}
    process = subprocess.Popen([sys.executable, "-c", code], stderr=theirs, env=environment)
    os.close(theirs)
    text = b""
    while True:
        try:
            part = os.read(ours, 65536)
        except OSError:  # all is read
            break
        if not part:
            break
        text += part
        if until is not None and until.encode() in text:
            process.send_signal(signal.SIGINT)
            until = None
    assert process.wait() == expected
    os.close(ours)
    return text.decode()


def screen(text: str) -> list[str]:
    """What stays of it: lines that were not erased."""
    lines = [""]
    rest = text.replace("\r\n", "\n")
    while rest:
        if rest.startswith("\033["):
            end = next(i for i, letter in enumerate(rest[2:], 2) if letter.isalpha())
            number = int(rest[2:end] or 1) if rest[2:end].isdigit() or not rest[2:end] else 0
            if rest[end] == "K":
                lines[-1] = ""
            if rest[end] == "A":
                for _ in range(number):
                    lines.pop()
            rest = rest[end + 1 :]
            continue
        if rest[0] == "\n":
            lines.append("")
        elif rest[0] != "\r":
            lines[-1] += rest[0]
        rest = rest[1:]
    return [line for line in lines if line.strip()]


def test_what_takes_long_is_shown_and_leaves_no_trace() -> None:
    text = on_a_terminal(SLOWLY.format(first=1.6, each=0.04))
    assert "Loading [this]" in text and "steps a second" in text and "/40" in text
    assert screen(text) == ["a line", "the end"]


def test_what_is_short_shows_nothing() -> None:
    text = on_a_terminal(SLOWLY.format(first=0, each=0))
    assert screen(text) == ["a line", "the end"] and "Loading" not in text and "step" not in text


def test_nothing_is_written_where_nobody_looks_on(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress, "_PATIENCE", 0.0)
    monkeypatch.setattr(progress, "_PAUSE", 0.0)
    with waiting("Loading"):
        time.sleep(0.05)
    bar = Bar("step", 2)
    bar(1)
    bar.clear()
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys, "stderr", None)  # it may be closed
    with waiting("Loading"):
        Bar("step", 2)(1)


def test_a_long_run_shows_its_steps(tmp_path: Path) -> None:
    file = tmp_path / "scene.dae"
    colladaphy.write(SCENES["pile"](), file)
    code = (
        "from colladaphy.cli import run; "
        f"raise SystemExit(run(['simulate', {str(file)!r}, '--steps', '100000000', "
        f"'--checkpoint-dir', {str(tmp_path / 'c')!r}]))"
    )
    text = on_a_terminal(code, expected=130, until="steps a second")
    assert "scene.dae: step" in text and "steps a second" in text
    assert any(line.startswith("Interrupted at step") for line in screen(text))

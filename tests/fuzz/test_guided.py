"""Fuzzing guided by coverage: its corpus, its inputs, and what is said without atheris."""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest
from lxml import etree
from tools.fuzz import guided, keeping

import colladaphy

CORPUS = sorted(guided.CORPUS.glob("*.dae"))


def test_the_corpus_holds_what_the_code_is_there_for() -> None:
    assert len(CORPUS) >= 20
    verdicts = [colladaphy.validate(path).valid for path in CORPUS]
    assert True in verdicts and False in verdicts
    loaded = [colladaphy.read(path, repair=True).load() for path in CORPUS]
    assert sum(len(world.bodies) for world in loaded) > 20
    assert sum(len(world.joints) for world in loaded) > 2


def test_structured_inputs_are_documents() -> None:
    chance = random.Random(1)
    made = {guided.structured(chance.randbytes(chance.randrange(40))) for _ in range(60)}
    assert len(made) > 30
    for data in made:
        assert etree.fromstring(data).tag.endswith("}COLLADA")
    assert guided.input_of("bytes", b"<a/>") == b"<a/>"


def test_what_it_runs_takes_anything() -> None:
    for data in (b"", b"<a/>", CORPUS[0].read_bytes()):
        guided.check(data)


def test_without_a_build_of_atheris_it_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(guided, "is_installed", lambda: False)

    def fail(command: list[str], **_: object) -> subprocess.CompletedProcess[bytes]:
        assert command[-1] == "atheris"
        return subprocess.CompletedProcess(command, 1)

    monkeypatch.setattr(guided.subprocess, "run", fail)
    assert guided.main(["--minutes", "0.1"]) == 2
    assert "pip has no build of it for Python" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["bytes", "structured"])
def test_what_fails_is_kept(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As libFuzzer leaves it: a file of the input, and the error in what it says."""

    def run(command: list[str], **_: object) -> subprocess.CompletedProcess[str]:
        prefix = next(word for word in command if word.startswith("-artifact_prefix="))
        Path(prefix.partition("=")[2], "crash-1").write_bytes(b"\1\2\3")
        said = "IndexError: index -1\nstat::number_of_executed_units: 7\n"
        return subprocess.CompletedProcess(command, 77, "", said)

    monkeypatch.setattr(guided, "is_installed", lambda: True)
    monkeypatch.setattr(guided.subprocess, "run", run)
    assert guided.main([f"--{kind}", "--regressions", str(tmp_path)]) == 1
    (path,) = tmp_path.glob("*.json")
    name, (data,) = keeping.read(path)
    assert name == guided.PROPERTY and data == guided.input_of(kind, b"\1\2\3")
    said = capsys.readouterr().out
    assert f"{kind}: 7 inputs" in said and "FAILED IndexError: index -1" in said

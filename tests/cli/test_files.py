"""What commands do with files: streams that are closed or full, outputs that would destroy."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from tests.cli.test_commands import OLD, VALID, Runner

from colladaphy.source import pack


@pytest.fixture
def cli(capfd: pytest.CaptureFixture[str]) -> Runner:
    return Runner(capfd)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "old.dae"
    path.write_bytes(OLD)
    return path


def shell(command: str, *arguments: Path) -> subprocess.CompletedProcess[str]:
    """Run `command` in a shell; $0 is the program, $1 … are the arguments."""
    program = [sys.executable, "-m", "colladaphy"]
    script = command.replace("colladaphy", '"$0" -m colladaphy')
    names = [program[0], *map(str, arguments)]
    return subprocess.run(["sh", "-c", script, *names], capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("command", ["validate - <&-", "info - <&-", 'convert "$1" - >&-'])
def test_closed_streams_are_an_input_or_output_error(file: Path, command: str) -> None:
    done = shell(f"colladaphy {command}", file)
    assert done.returncode == 2
    assert "is closed" in done.stdout + done.stderr  # validate reports it with the rest
    assert "Traceback" not in done.stderr
    assert "fault" not in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("command", ["validate", "info"])
def test_a_full_disk_is_an_output_error(file: Path, command: str) -> None:
    done = shell(f'colladaphy {command} "$1" >/dev/full', file)
    assert done.returncode == 2
    assert "No space left" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("command", [["convert", "IN", "OUT"], ["repair", "IN"], ["info", "IN"]])
def test_an_unknown_convention_is_a_matter_of_usage(
    cli: Runner, file: Path, tmp_path: Path, command: list[str]
) -> None:
    names = {"IN": file, "OUT": tmp_path / "out.dae"}
    output = cli(*(names.get(word, word) for word in command), "--convention", "opnrave")
    assert output.code == 2
    assert "openrave" in output.err
    assert file.read_bytes() == OLD


@pytest.mark.parametrize("which", ["IN", "OUT", "link"])
def test_a_report_replaces_no_document(cli: Runner, file: Path, tmp_path: Path, which: str) -> None:
    target, link = tmp_path / "out.dae", tmp_path / "link"
    link.symlink_to(file)
    report = {"IN": file, "OUT": target, "link": link}[which]
    output = cli("convert", file, target, "--report", report)
    assert output.code == 2
    assert file.read_bytes() == OLD
    assert not target.exists()


def test_an_archive_under_another_name_keeps_its_files(cli: Runner, tmp_path: Path) -> None:
    path = tmp_path / "scene.dae"
    path.write_bytes(pack(OLD, name="a.dae", others={"textures/wood.png": b"PNG"}))
    assert cli("repair", path, "--in-place").code == 0
    with zipfile.ZipFile(path) as archive:
        assert archive.read("textures/wood.png") == b"PNG"
        assert b"2008/03" in archive.read("a.dae")
    out = tmp_path / "out.dae"
    assert cli("convert", path, out).code == 0
    assert out.read_bytes().startswith(VALID[:5])

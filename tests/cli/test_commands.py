"""The command line: exit codes, formats, one clear message for every fault, no traceback."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from colladaphy.cli import run
from colladaphy.cli.group import COMMANDS
from colladaphy.source import pack, parse

VALID = b"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
</COLLADA>
"""
INVALID = VALID.replace(b"<modified>2010-01-01T00:00:00Z</modified>", b"")
OLD = b"""<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
  <library_nodes/>
</COLLADA>
"""


class Output:
    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err


class Runner:
    def __init__(self, capfd: pytest.CaptureFixture[str]) -> None:
        self._capfd = capfd

    def __call__(self, *arguments: object) -> Output:
        self._capfd.readouterr()
        code = run([str(argument) for argument in arguments])
        sys.stdout.flush()
        captured = self._capfd.readouterr()
        assert "Traceback" not in captured.err
        assert code != 3, captured.err
        return Output(code, captured.out, captured.err)


@pytest.fixture
def cli(capfd: pytest.CaptureFixture[str]) -> Runner:
    return Runner(capfd)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "a file ä.dae"
    path.write_bytes(VALID)
    return path


def test_validate(cli: Runner, file: Path) -> None:
    result = cli("validate", file)
    assert (result.code, result.out, result.err) == (0, f"{file}: valid\n", "")
    file.write_bytes(INVALID)
    result = cli("validate", file)
    assert result.code == 1
    assert "schema-missing-element" in result.out
    assert result.out.startswith(f"{file}:3:3: error: <asset> lacks ")


def test_validate_as_json(cli: Runner, file: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken.dae"
    broken.write_bytes(INVALID)
    result = cli("validate", "--format", "json", file, broken)
    data = json.loads(result.out)
    assert result.code == 1
    assert [entry["path"] for entry in data["files"]] == [str(file), str(broken)]
    assert [entry["valid"] for entry in data["files"]] == [True, False]
    assert data["files"][1]["counts"]["error"] == 1
    missing = cli("validate", "--format", "json", file, tmp_path / "none.dae")
    data = json.loads(missing.out)
    assert missing.code == 2
    assert data["files"][1]["findings"][0]["code"] == "io-missing"


def test_the_fail_level(cli: Runner, file: Path) -> None:
    scene = b'<scene><instance_visual_scene url="#none"/></scene></COLLADA>'
    file.write_bytes(VALID.replace(b"</COLLADA>", scene))
    result = cli("validate", file)
    assert result.code == 0 and result.out.endswith("valid (1 warning)\n")
    assert cli("validate", file, "--fail-level", "warning").code == 1
    assert cli("validate", file, "--fail-level", "hint").code == 1


@pytest.mark.parametrize("command", ["validate", "info", "convert", "repair"])
def test_limits_can_be_set(cli: Runner, file: Path, command: str) -> None:
    target = [file.with_name("out.dae")] if command in ("convert", "repair") else []
    long = b"<!--" + b"x" * 11_000_000 + b"--></COLLADA>"
    file.write_bytes(VALID.replace(b"</COLLADA>", long))
    refused = cli(command, file, *target)
    assert refused.code == 1
    assert "--limit text=" in refused.out + refused.err
    assert cli(command, file, *target, "--limit", "text=12000000").code == 0
    target = ["-o", *target] if target else []
    for wrong in ("text", "text=x", "nothing=1", "text=0"):
        assert cli(command, file, *target, "--limit", wrong).code == 2


@pytest.mark.parametrize("command", ["validate", "info", "convert", "repair"])
@pytest.mark.parametrize(
    ("content", "code", "words"),
    [
        (VALID[:150], 1, "ends too early"),
        (b"<!DOCTYPE html><html><body/></html>", 1, "HTML page"),
        (b"<!DOCTYPE COLLADA>" + VALID, 1, "DOCTYPE"),
        (b"", 1, "empty"),
        (b"\x00\x01\x02", 1, "not XML"),
        (b"<sdf/>", 1, "<sdf>"),
        (b"PK\x03\x04", 1, "archive"),
        (None, 2, "not exist"),
        ("folder", 2, "folder"),
    ],
)
def test_bad_input_is_one_clear_error(
    cli: Runner, tmp_path: Path, command: str, content: bytes | str | None, code: int, words: str
) -> None:
    path = tmp_path / "in.dae"
    if content == "folder":
        path.mkdir()
    elif isinstance(content, bytes):
        path.write_bytes(content)
    target = [tmp_path / "out.dae"] if command in ("convert", "repair") else []
    result = cli(command, path, *target)
    said = result.out + result.err
    expected = 2 if words == "archive" and command != "validate" else code
    assert result.code == expected, said
    assert words in said
    assert said.count("error: ") == 1
    assert not (tmp_path / "out.dae").exists()
    if isinstance(content, bytes):
        assert path.read_bytes() == content


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["validate"],
        ["convert", "only-one.dae"],
        ["nothing"],
        ["validate", "--format", "xml", "a.dae"],
        ["validate", "--nothing", "a.dae"],
        ["explain", "nothing"],
        ["rules", "--stage", "nothing"],
        ["repair", "a.dae", "--only", "nothing"],
    ],
)
def test_wrong_usage(cli: Runner, arguments: list[str]) -> None:
    result = cli(*arguments)
    assert result.code == 2
    assert result.err


def test_misspellings_are_answered(cli: Runner) -> None:
    assert "validate" in cli("vlidate").err
    assert "xml-doctype" in cli("explain", "xml-doctipe").err


def test_names_that_begin_with_a_dash(
    cli: Runner, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("-x.dae").write_bytes(VALID)
    assert cli("validate", "--", "-x.dae").code == 0
    assert cli("validate", "./-x.dae").code == 0


def test_standard_streams(cli: Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(INVALID)))
    result = cli("validate", "-")
    assert result.code == 1 and result.out.endswith("-: not valid (1 error)\n")
    done = subprocess.run(
        [sys.executable, "-m", "colladaphy", "convert", "-", "-"], input=OLD, capture_output=True
    )
    assert done.returncode == 0
    assert parse(done.stdout).tree.getroot().get("version") == "1.5.0"


def test_convert(cli: Runner, tmp_path: Path) -> None:
    source, target = tmp_path / "old.dae", tmp_path / "new.dae"
    source.write_bytes(OLD)
    result = cli("convert", source, target)
    assert (result.code, result.out) == (0, "")
    assert "upgrade-version" in result.err
    assert source.read_bytes() == OLD
    assert cli("validate", target).code == 0
    first = target.read_bytes()
    report = tmp_path / "report.json"
    result = cli("convert", source, "-o", target, "--report", report)
    assert (result.code, result.err) == (0, "")
    assert target.read_bytes() == first
    codes = {entry["code"] for entry in json.loads(report.read_text())["files"][0]["findings"]}
    assert "upgrade-version" in codes
    cli("convert", source, "-o", target, "--report", tmp_path / "report.txt")
    assert "upgrade-version" in (tmp_path / "report.txt").read_text()


def test_convert_keeps_an_archive_whole(cli: Runner, tmp_path: Path) -> None:
    source, target = tmp_path / "old.zae", tmp_path / "new.zae"
    source.write_bytes(pack(OLD, name="x.dae", others={"a.png": b"png"}))
    assert cli("convert", source, target).code == 0
    parsed = parse(target)
    assert parsed.member == "x.dae"
    assert parsed.open_relative("a.png").data == b"png"
    assert cli("convert", source, tmp_path / "new.dae").code == 0
    assert cli("convert", tmp_path / "new.dae", "-o", target).code == 0
    assert parse(target).member == "scene.dae"


@pytest.mark.parametrize("reader", ["collada-1.4", "bullet"])
def test_convert_for_readers_of_1_4(
    cli: Runner, tmp_path: Path, corpus_dir: Path, reader: str
) -> None:
    source, target = corpus_dir / "bullet-jenga.dae", tmp_path / "out.dae"
    assert cli("convert", source, target, "--for", reader).code == 0
    root = parse(target).tree.getroot()
    assert (
        root.tag.startswith("{http://www.collada.org/2005/11/") and root.get("version") == "1.4.1"
    )
    before, after = (
        json.loads(cli("info", path, "--format", "json").out)["world"] for path in (source, target)
    )
    assert before["bodies"] == after["bodies"] > 0


def test_output_that_cannot_be_written(cli: Runner, file: Path, tmp_path: Path) -> None:
    result = cli("convert", file, tmp_path / "none" / "out.dae")
    assert result.code == 2
    assert "cannot be written" in result.err


def test_repair(cli: Runner, tmp_path: Path) -> None:
    path, target = tmp_path / "old.dae", tmp_path / "new.dae"
    path.write_bytes(OLD)
    dry = cli("repair", path, "--dry-run")
    assert dry.code == 0 and "upgrade-version" in dry.err and "repair-empty-library" in dry.err
    assert path.read_bytes() == OLD
    diff = cli("repair", path, "--dry-run", "--diff")
    assert "-  <library_nodes/>" in diff.out.splitlines()
    assert diff.out.startswith(f"--- {path}")
    assert cli("repair", path, target).code == 0
    assert path.read_bytes() == OLD
    assert cli("validate", target).code == 0
    assert cli("repair", path, "--in-place").code == 0
    assert path.read_bytes() == target.read_bytes()
    assert (tmp_path / "old.dae.bak").read_bytes() == OLD
    assert "nothing to change" in cli("repair", path, "--in-place").err
    assert not (tmp_path / "old.dae.bak2").exists()


def test_what_cannot_be_repaired_stays(cli: Runner, tmp_path: Path) -> None:
    path = tmp_path / "old.dae"
    path.write_bytes(OLD)
    result = cli("repair", path, "--in-place", "--only", "upgrade-version")
    assert result.code == 1
    assert "schema-missing-element" in result.err
    assert path.read_bytes() == OLD


def test_info(cli: Runner, file: Path) -> None:
    result = cli("info", file)
    assert result.code == 0
    assert "COLLADA 1.5.0" in result.out and "Y_UP" in result.out
    facts = json.loads(cli("info", "--format", "json", file).out)
    assert facts["version"] == "1.5.0"
    assert facts["unit"] == {"name": "meter", "meter": 1.0}
    assert facts["document"]["rigid_body"] == 0


def test_rules_and_explain(cli: Runner) -> None:
    result = cli("rules")
    assert result.code == 0 and "xml-doctype" in result.out
    rules = json.loads(cli("rules", "--stage", "xml", "--format", "json").out)
    assert {rule["stage"] for rule in rules} == {"xml"}
    explained = cli("explain", "xml-doctype")
    assert explained.code == 0 and "DOCTYPE" in explained.out


@pytest.mark.parametrize("command", list(COMMANDS))
def test_every_command_has_help(cli: Runner, command: str) -> None:
    result = cli(command, "--help")
    assert result.code == 0
    assert result.out.startswith(f"Usage: colladaphy {command}")


def loaded_by(*arguments: str) -> set[str]:
    code = (
        "import sys\nfrom colladaphy.cli import run\n"
        f"run({list(arguments)!r})\nprint('MODULES', *sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stderr.rpartition("MODULES")[2].split())


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["validate", "--help"]])
def test_help_loads_nothing_heavy(arguments: list[str]) -> None:
    loaded = loaded_by(*arguments)
    heavy = ("lxml", "numpy", "xsdata", "pymunk", "mujoco", "rich", "hypothesis")
    assert loaded.isdisjoint(heavy)
    assert not any(name.startswith("colladaphy_schema") for name in loaded)


def test_as_a_module(file: Path) -> None:
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        [sys.executable, "-m", "colladaphy", "validate", str(file)],
        capture_output=True,
        text=True,
        env=environment,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("valid\n")


def test_a_reader_that_stops_early(file: Path) -> None:
    done = subprocess.run(
        f'"{sys.executable}" -m colladaphy rules | head -1',
        shell=True,
        capture_output=True,
        text=True,
    )
    assert done.stdout.count("\n") == 1
    assert "Traceback" not in done.stderr and "BrokenPipe" not in done.stderr


def test_no_colour_in_files(cli: Runner, file: Path) -> None:
    file.write_bytes(INVALID)
    assert "\033" not in cli("validate", file).out


def test_the_jenga_scene(cli: Runner, corpus_dir: Path, tmp_path: Path) -> None:
    """What a user does with a real file: convert it, validate it, and find the same bodies."""
    source, target = corpus_dir / "bullet-jenga.dae", tmp_path / "out.dae"
    assert cli("convert", source, target).code == 0
    assert cli("validate", target).code == 0
    before = json.loads(cli("info", source, "--format", "json").out)
    after = json.loads(cli("info", target, "--format", "json").out)
    assert before["version"] == "1.4.0" and after["version"] == "1.5.0"
    assert before["world"]["bodies"] > 0
    for key in ("bodies", "kinds", "joints", "unions", "fixed"):
        assert before["world"][key] == after["world"][key]


@pytest.mark.parametrize(
    "arguments", [["--help"], ["validate", "--help"], ["rules"], ["explain", "xml-doctype"]]
)
def test_what_needs_no_numbers_starts_without_numpy(arguments: list[str]) -> None:
    code = (
        "import sys\n"
        "from colladaphy.cli import run\n"
        f"code = run({arguments!r})\n"
        "heavy = {'numpy', 'lxml', 'xsdata', 'pymunk', 'colladaphy_schema'} & set(sys.modules)\n"
        "sys.exit(f'{heavy} after {code}' if heavy or code else 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_validate_leaves_alone_what_it_does_not_need(file: Path) -> None:
    code = (
        "import sys\n"
        "from colladaphy.cli import run\n"
        f"run(['validate', {str(file)!r}])\n"
        "rooms = {name.split('.')[1] for name in sys.modules if name.startswith('colladaphy.')}\n"
        "print(*sorted(rooms & {'engines', 'mapper', 'world', 'document', 'exchange', 'view'}))\n"
        "print('pymunk' in sys.modules, 'colladaphy.conform.pipeline' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.splitlines()[1:] == ["", "False False"], done.stdout + done.stderr

"""Every option of ``validate``, as its users meet it."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from colladaphy.cli import run
from colladaphy.cli.progress import counting
from colladaphy.validation.formats import FORMATS

VALID = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
</COLLADA>
"""
INVALID = VALID.replace("<asset>", '<asset wrong="1">')
WARNING = VALID.replace(
    "</COLLADA>", '<scene><instance_visual_scene url="#none"/></scene></COLLADA>'
)
OLD = VALID.replace("2008/03", "2005/11").replace("1.5.0", "1.4.1")
MANY = VALID.replace(
    "</COLLADA>", "<library_nodes>" + '\n<node wrong="1"/>' * 9 + "</library_nodes></COLLADA>"
)


class Output:
    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err
        self.lines = out.splitlines()


class Runner:
    def __init__(self, capfd: pytest.CaptureFixture[str]) -> None:
        self._capfd = capfd

    def __call__(self, *arguments: object) -> Output:
        self._capfd.readouterr()
        code = run(["validate", *map(str, arguments)])
        sys.stdout.flush()
        captured = self._capfd.readouterr()
        assert code != 3 and "Traceback" not in captured.err, captured.err
        return Output(code, captured.out, captured.err)


@pytest.fixture
def validate(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Runner:
    """Runs in a folder with a valid and an invalid document, and one with a warning."""
    monkeypatch.chdir(tmp_path)
    Path("sub").mkdir()
    Path("good.dae").write_text(VALID)
    Path("sub/bad.DAE").write_text(INVALID)
    Path("warned.dae").write_text(WARNING)
    return Runner(capfd)


def codes(output: Output) -> list[str]:
    data = json.loads(output.out)
    return [found["code"] for file in data["files"] for found in file["findings"]]


@pytest.mark.parametrize("form", FORMATS)
def test_every_format(validate: Runner, form: str) -> None:
    result = validate(".", "--format", form)
    assert (result.code, result.err) == (1, "")
    assert "schema-unknown-attribute" in result.out and "link-missing" in result.out
    if form in ("json", "sarif", "gitlab"):
        json.loads(result.out)


def test_the_default_is_full_and_ends_with_the_sums(validate: Runner) -> None:
    result = validate(".")
    assert result.out == validate(".", "--format", "full").out
    assert re.fullmatch(
        r"3 files: 2 valid, 1 not; 2 findings of 2 kinds(, \d mendable)?", result.lines[-1]
    )
    assert any(line.endswith("^^^^^^^^^") for line in result.lines)


def test_reports_to_files(validate: Runner) -> None:
    result = validate(".", "--report", "sarif=a.sarif", "--report", "junit=b.xml", "-q",
                      "--format", "concise")  # fmt: skip
    assert result.code == 1 and len(result.lines) == 2
    assert json.loads(Path("a.sarif").read_text())["version"] == "2.1.0"
    assert Path("b.xml").read_text().startswith("<?xml")
    assert validate(".", "--format", "sarif").out == Path("a.sarif").read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--report", "sarif"], "FORMAT=FILE"),
        (["--report", "xml=a"], "FORMAT=FILE"),
        (["--report", "json=a", "--report", "sarif=./a"], "another report"),
        (["--select", "nothing"], "no code 'nothing'"),
        (["--ignore", "link-mising"], "Did you mean link-missing"),
        (["--severity", "link"], "CODE=LEVEL"),
        (["--severity", "link=bad"], "CODE=LEVEL"),
        (["--severity", "lnk=error"], "no code 'lnk'"),
        (["--exclude", "!"], "--exclude"),
        (["--max-findings", "-1"], "--max-findings"),
        (["--jobs", "-1"], "--jobs"),
        (["--format", "json", "--statistics"], "--statistics"),
        (["--config", "a", "--isolated"], "--isolated"),
        (["--collada-14", "info"], "--collada-14"),
        (["--config", "none.toml"], "config-unreadable"),
        (["--baseline", "none.json"], "config-baseline-unreadable"),
    ],
)
def test_wrong_usage(validate: Runner, arguments: list[str], words: str) -> None:
    result = validate("good.dae", *arguments)
    assert (result.code, result.out) == (2, "")
    assert words in result.err


@pytest.mark.parametrize("option", ["--write-baseline={}", "--report=json={}"])
def test_documents_are_never_written_over(validate: Runner, option: str) -> None:
    for arguments in (["good.dae"], ["."], ["*.dae"]):
        result = validate(*arguments, option.format("./good.dae"))
        assert (result.code, result.out) == (2, "")
        assert "another file of this command" in result.err
    assert Path("good.dae").read_text() == VALID


def test_select_ignore_and_severity(validate: Runner) -> None:
    def found(*arguments: str) -> list[str]:
        return codes(validate(".", "--format", "json", *arguments))

    assert sorted(found()) == ["link-missing", "schema-unknown-attribute"]
    assert found("--select", "link") == ["link-missing"]
    assert found("--select", "physics,schema-unknown") == ["schema-unknown-attribute"]
    assert found("--ignore", "schema") == ["link-missing"]
    assert found("--ignore", "all", "--select", "link,schema-unknown") != []
    assert found("--ignore", "link", "--ignore", "schema") == []
    result = validate(".", "--ignore", "all")
    assert result.code == 0
    assert result.lines[-1] == "3 files: 3 valid; 2 left out by the configuration"
    assert validate("warned.dae", "--severity", "link-missing=error").code == 1
    assert validate("sub", "--severity", "schema=warning,link=hint").code == 0


def test_documents_that_cannot_be_read_are_told_whatever_is_ignored(validate: Runner) -> None:
    Path("good.dae").write_text("<COLLADA")
    result = validate("good.dae", "none.dae", "--ignore", "all", "--format", "json")
    assert result.code == 2
    assert [code.partition("-")[0] for code in codes(result)] == ["xml", "io"]


@pytest.mark.parametrize(("level", "code"), [("error", 0), ("warning", 1), ("hint", 1)])
def test_the_fail_level(validate: Runner, level: str, code: int) -> None:
    assert validate("warned.dae", "--fail-level", level).code == code


def test_exit_codes(validate: Runner) -> None:
    assert validate("good.dae").code == 0
    assert validate("sub").code == 1
    assert validate("good.dae", "sub", "none.dae").code == 2
    assert validate("sub", "--exit-zero").code == 0
    assert validate("none.dae", "--exit-zero").code == 2
    told = re.findall(r"^ +([0-3])  ", validate("--help").out, re.MULTILINE)
    assert told == ["0", "1", "2", "3"]


def test_collada_1_4(validate: Runner) -> None:
    Path("old.dae").write_text(OLD)
    assert validate("old.dae").code == 1
    warned = validate("old.dae", "--collada-14", "warning")
    assert warned.code == 0 and "1 warning" in warned.lines[-1]
    assert validate("old.dae", "--collada-14", "ignore").lines == ["old.dae: valid"]
    Path("colladaphy.toml").write_text('collada-14 = "ignore"')
    assert validate("old.dae").lines == ["old.dae: valid"]
    assert validate("old.dae", "--collada-14", "error").code == 1
    # It is checked as what it is.
    Path("old.dae").write_text(OLD.replace("<asset>", '<asset wrong="1">'))
    assert validate("old.dae").code == 1


def test_exclusion(validate: Runner) -> None:
    assert validate(".", "--exclude", "sub/").code == 0
    assert validate("sub/bad.DAE", "--exclude", "sub/").code == 1
    assert validate("sub/bad.DAE", "good.dae", "--exclude", "sub/", "--force-exclude").code == 0


def test_the_configuration(validate: Runner) -> None:
    Path("colladaphy.toml").write_text('ignore = ["schema"]\nfail-level = "warning"')
    assert validate("sub").code == 0
    assert validate("warned.dae").code == 1
    assert validate("warned.dae", "--fail-level", "error").code == 0
    # What is chosen by option wins, if it says as much.
    assert validate("sub", "--select", "schema-unknown-attribute").code == 1
    assert validate("sub", "--isolated").code == 1
    other = Path("other.toml")
    other.write_text('[per-file."sub/*"]\nseverity = { schema = "hint" }')
    assert validate("sub", "--config", other).code == 0
    other.write_text("nothing = 1")
    result = validate("sub", "--config", other)
    assert result.code == 2
    assert result.err.startswith("other.toml: error: There is no key 'nothing'")


def test_a_faulty_configuration_stops_before_anything_is_checked(validate: Runner) -> None:
    Path("sub/colladaphy.toml").write_text("x = 1")
    result = validate("good.dae", "sub")
    assert (result.code, result.out) == (2, "")


def test_the_baseline(validate: Runner) -> None:
    result = validate(".", "--write-baseline", "known.json")
    assert (result.code, result.out) == (0, "")
    assert result.err == "2 findings written to known.json.\n"
    result = validate(".", "--baseline", "known.json")
    assert (result.code, result.err) == (0, "")
    assert result.lines[-1] == "3 files: 3 valid; 2 known from the baseline"
    Path("colladaphy.toml").write_text('baseline = "known.json"')
    assert validate(".").code == 0
    Path("good.dae").write_text(INVALID)
    assert validate(".").code == 1
    Path("sub/bad.DAE").write_text(VALID)
    assert "1 of the baseline's findings are gone" in validate(".").err
    # It is written anew without regard to what was known.
    assert validate(".", "--write-baseline", "known.json").err.startswith("2 findings")
    assert validate("none.dae", "--write-baseline", "known.json").code == 2


def test_the_cap(validate: Runner) -> None:
    Path("many.dae").write_text(MANY)

    def shown(*arguments: str) -> int:
        lines = validate("many.dae", "--format", "concise", *arguments).lines
        return sum(line.startswith("many.dae:") and "[schema-" in line for line in lines)

    assert "… and 4 more like it" in validate("many.dae").out
    assert shown() == 5 + 1
    assert shown("--max-findings", "2") == 2 + 1
    assert shown("--max-findings", "0") == 9
    result = validate("many.dae", "--max-findings", "1", "--format", "json")
    assert len(codes(result)) == 9


def test_statistics_and_quiet(validate: Runner) -> None:
    result = validate(".", "--statistics")
    assert result.code == 1
    assert re.match(r"1  link-missing +(\[\*\])? ", result.lines[0])
    assert result.lines[-1].startswith("3 files: ")
    assert validate("good.dae", "-q").out == ""
    assert len(validate(".", "--format", "concise", "--quiet").lines) == 2


def test_several_files_at_once_give_the_same_report(validate: Runner) -> None:
    for number in range(6):
        Path(f"more{number}.dae").write_text(INVALID if number % 2 else MANY)
    Path("none.zae").write_bytes(b"PK\x03\x04")
    arguments = [".", "missing.dae", "--format", "json", "--ignore", "link"]
    one = validate(*arguments)
    assert one.code == 2
    for jobs in ("3", "0"):
        several = validate(*arguments, "-j", jobs)
        assert (several.code, several.out) == (one.code, one.out)


def test_standard_input(validate: Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    def given(text: str) -> None:
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))

    given(INVALID)
    result = validate("-")
    assert result.code == 1
    assert result.lines[0].startswith("-:3:3: error: ") and result.lines[2].startswith("3 | ")
    given(INVALID)
    Path("colladaphy.toml").write_text('[per-file."sub/*"]\nignore = ["schema"]')
    assert validate("-", "--stdin-name", "sub/x.dae").out.startswith("sub/x.dae: valid (1 left")
    Path("colladaphy.toml").unlink()
    given(VALID)
    assert validate("-", "good.dae", "-").lines[-1] == "2 files: 2 valid"
    # Without -, the name of standard input is no other file's.
    assert "^^^" in validate("sub/bad.DAE", "--stdin-name", "sub/bad.DAE").out
    given(VALID)
    result = validate("-", "--limit", "bytes=5")
    assert (result.code, "io-too-large" in result.out) == (2, True)
    monkeypatch.setattr("sys.stdin", None)
    result = validate("-", "sub")
    assert result.code == 2 and "Standard input is closed" in result.out
    assert "schema-unknown-attribute" in result.out


def test_folders_and_patterns(validate: Runner) -> None:
    files = [file["path"] for file in json.loads(validate(".", "--format", "json").out)["files"]]
    assert files == ["good.dae", "warned.dae", str(Path("sub/bad.DAE"))]
    assert validate("**/*.DAE").code == 1
    assert validate("*.dae").lines[-1].startswith("2 files: 2 valid")
    Path("empty").mkdir()
    for nothing in ("empty", "x*.dae"):
        result = validate(nothing, "good.dae")
        assert result.code == 2 and "good.dae: valid" in result.lines


def test_the_schema_of_the_json_format(validate: Runner) -> None:
    result = validate("--json-schema")
    assert result.code == 0
    assert json.loads(result.out)["$id"] == "urn:colladaphy:schema:report:1"


@pytest.mark.parametrize(
    ("variables", "coloured"),
    [
        ({}, False),
        ({"FORCE_COLOR": "1"}, True),
        ({"FORCE_COLOR": ""}, False),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
        ({"FORCE_COLOR": "1", "NO_COLOR": ""}, True),
    ],
)
def test_colour(
    validate: Runner, monkeypatch: pytest.MonkeyPatch, variables: dict[str, str], coloured: bool
) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    for form in ("full", "concise"):
        assert ("\033[" in validate("sub", "--format", form).out) is coloured
    for form in set(FORMATS) - {"full", "concise"}:
        assert "\033" not in validate("sub", "--format", form).out


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("patience", "shown"), [(0.0, True), (60.0, False)])
def test_progress_of_long_runs(
    monkeypatch: pytest.MonkeyPatch, patience: float, shown: bool
) -> None:
    import time

    monkeypatch.setattr("colladaphy.cli.progress._PATIENCE", patience)
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")

    def slow() -> object:
        for number in range(3):
            time.sleep(0.05)
            yield number

    seen = []
    for item in counting(slow(), 3, "checking"):  # type: ignore[arg-type]
        seen.append(item)
        text = terminal.getvalue()  # while an item is in use, nothing is in its report's way
        assert text == "" or text.endswith("\r\033[1A\033[2K")
    assert seen == [0, 1, 2]
    assert ("checking 2/3" in terminal.getvalue()) is shown


def test_no_progress_where_nobody_looks_on(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("colladaphy.cli.progress._PATIENCE", 0.0)
    assert list(counting(iter("ab"), 2, "checking")) == ["a", "b"]
    assert capsys.readouterr().err == ""


def test_names_that_no_console_can_show(validate: Runner) -> None:
    path = Path("\udcff\033[31m.dae")
    try:
        path.write_text(INVALID)
    except (OSError, UnicodeError):
        pytest.skip("the file system has no such names")
    for form in FORMATS:
        done = subprocess.run(
            [sys.executable, "-m", "colladaphy", "validate", os.fsencode(path), "--format", form],
            capture_output=True,
        )
        assert done.returncode == 1, done.stderr
        assert b"\033" not in done.stdout


UNNEEDED = {
    "colladaphy.validation.baseline", "colladaphy.validation.behind",
    "colladaphy.validation.fingerprints", "colladaphy.validation.reporters.excerpts",
    "colladaphy.conform.pipeline", "concurrent.futures", "hashlib", "importlib.metadata",
    "multiprocessing", "pathspec", "rich", "tomllib", "zipfile",
}  # fmt: skip


def test_a_valid_file_needs_few_modules(tmp_path: Path) -> None:
    (tmp_path / "a.dae").write_text(VALID)
    code = (
        "import sys\nfrom colladaphy.cli import run\nassert run(['validate', 'a.dae']) == 0\n"
        "print('MODULES', *sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert UNNEEDED.isdisjoint(done.stdout.partition("MODULES")[2].split())


@pytest.mark.skipif(sys.platform == "win32", reason="the time of processes is told otherwise")
def test_a_valid_file_costs_little_more_than_the_libraries(tmp_path: Path) -> None:
    """Of the 0.2 s of CPU that a small file may take, numpy, lxml and click take a half."""
    import resource

    (tmp_path / "a.dae").write_text(VALID)
    environment = os.environ | {"PYTHONPYCACHEPREFIX": str(tmp_path / "compiled")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)

    def spent(*arguments: str) -> float:
        def total() -> float:
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return usage.ru_utime + usage.ru_stime

        times = []
        for _ in range(6):
            before = total()
            subprocess.run([sys.executable, *arguments], cwd=tmp_path, env=environment, check=True,
                           capture_output=True)  # fmt: skip
            times.append(total() - before)
        return min(times)

    libraries = spent("-c", "import click, lxml.etree, numpy")
    assert spent("-m", "colladaphy", "validate", "a.dae") < 2.5 * libraries


@pytest.mark.parametrize(("asked", "threads"), [(None, "1"), ("3", "3")])
def test_a_command_starts_no_threads_for_matrices(asked: str | None, threads: str) -> None:
    """They would take longer than a small file."""
    code = (
        "import os, sys, colladaphy.cli\n"
        "before = 'numpy' in sys.modules\n"
        "try: colladaphy.cli.main(['--version'])\n"
        "finally: print(before, os.environ['OPENBLAS_NUM_THREADS'])"
    )
    environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_NUM_THREADS"}
    if asked is not None:
        environment["OPENBLAS_NUM_THREADS"] = asked
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True,
                          text=True, check=True)  # fmt: skip
    assert done.stdout.splitlines()[-1] == f"False {threads}"

"""Configurations: where they are found, what they decide, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.validation.results import CODES, finding

from colladaphy.errors import ConfigurationError
from colladaphy.findings import Report, Severity
from colladaphy.validation import all_rules
from colladaphy.validation.configuration import Configurations, read_configuration
from colladaphy.validation.settings import Settings, fatal

NAMES = st.lists(st.sampled_from(["all", *CODES, *{code.partition("-")[0] for code in CODES}]))


def written(folder: Path, text: str, name: str = "colladaphy.toml") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_text(text, "utf-8")
    return path


@given(st.sampled_from(CODES), NAMES, NAMES)
def test_the_name_that_says_more_decides(code: str, select: list[str], ignore: list[str]) -> None:
    settings = Settings(select=tuple(select), ignore=tuple(ignore))

    def said(names: list[str]) -> int:
        """How many parts of the code a name fixes, at best."""
        parts = code.split("-")
        given = [0 if name == "all" else len(name.split("-")) for name in names
                 if name == "all" or parts[: len(name.split("-"))] == name.split("-")]  # fmt: skip
        return max(given, default=-1)

    assert settings.reports(code) == (fatal(code) or said(select) > said(ignore))


def test_what_keeps_a_document_from_being_read_is_always_reported() -> None:
    settings = Settings(select=(), ignore=("all",), severity={"all": Severity.HINT})
    codes = {rule.code for rule in all_rules() if settings.reports(rule.code)}
    stages = {code.partition("-")[0] for code in codes}
    assert stages == {"io", "xml"} and "io-reference-missing" not in codes
    assert settings.level(finding("xml-doctype")) is Severity.ERROR
    assert settings.level(finding("link-missing")) is Severity.HINT


def test_severities_and_what_is_left_out() -> None:
    settings = Settings(
        ignore=("link-missing",),
        severity={"physics": Severity.ERROR, "physics-mass-value": Severity.INFO},
    )
    report = Report("a.dae", [finding("link-missing"), finding("physics-mass-value"),
                              finding("physics-inertia-zero", severity=Severity.HINT)])  # fmt: skip
    applied, ignored = settings.apply(report)
    assert ignored == 1
    assert [(found.code, found.severity) for found in applied] == [
        ("physics-mass-value", Severity.INFO),
        ("physics-inertia-zero", Severity.ERROR),
    ]


@pytest.mark.parametrize("level", list(Severity))
def test_what_is_grave(level: Severity) -> None:
    settings = Settings(fail_level=level)
    grave = [one for one in Severity if settings.grave(finding(severity=one))]
    assert grave == list(Severity)[: list(Severity).index(level) + 1]


def test_the_whole_configuration(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        """
        select = ["schema", "link"]
        ignore = ["link-missing"]
        fail-level = "warning"
        collada-14 = "ignore"
        exclude = ["build/", "*.bak.dae"]
        baseline = "known.json"
        [severity]
        link = "info"
        [per-file."legacy/*.dae"]
        ignore = ["schema-duplicate-id"]
        severity = { schema = "hint" }
        collada-14 = "warning"
        [per-file."legacy/worst.dae"]
        select = []
        """,
    )
    known = read_configuration(path)
    assert known.settings_of(tmp_path / "a.dae") == Settings(
        ("schema", "link"), ("link-missing",), {"link": Severity.INFO}, None, Severity.WARNING
    )
    assert known.settings_of(tmp_path / "legacy" / "a.dae") == Settings(
        ("schema", "link"),
        ("link-missing", "schema-duplicate-id"),
        {"link": Severity.INFO, "schema": Severity.HINT},
        Severity.WARNING,
        Severity.WARNING,
    )
    assert known.settings_of(tmp_path / "legacy" / "worst.dae").select == ()
    assert known.baseline == tmp_path / "known.json"
    assert known.excludes(tmp_path / "sub" / "build" / "a.dae")
    assert known.excludes(tmp_path / "a.bak.dae")
    assert not known.excludes(tmp_path / "a.dae")
    assert not known.excludes(tmp_path.parent / "build" / "a.dae")


def test_configurations_are_looked_for_from_a_files_folder_upwards(tmp_path: Path) -> None:
    written(tmp_path, 'ignore = ["link"]')
    written(tmp_path / "a" / "b", '[tool.colladaphy]\nignore = ["schema"]', "pyproject.toml")
    # Of another tool, and one that is not looked at as there is a nearer one.
    written(tmp_path / "a" / "c", '[tool.other]\nx = "colladaphy"', "pyproject.toml")
    written(tmp_path / "a" / "b", 'ignore = ["asset"]')
    written(tmp_path / "d", '[tool.colladaphy]\nignore = ["scene"]', "pyproject.toml")
    known = Configurations()

    def ignored(*parts: str) -> tuple[str, ...]:
        folder = tmp_path.joinpath(*parts)
        folder.mkdir(parents=True, exist_ok=True)
        return known.of(folder).settings.ignore

    assert ignored("a") == ignored("a", "c") == ignored("x", "y") == ("link",)
    assert ignored("a", "b") == ignored("a", "b", "deep", "er") == ("asset",)
    assert ignored("d", "deep") == ("scene",)


def test_pyproject_that_is_named_may_say_nothing(tmp_path: Path) -> None:
    path = written(tmp_path, "[project]\nname = 'x'", "pyproject.toml")
    assert read_configuration(path).settings == Settings()


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("select = [,]", "config-syntax", "line 1"),
        ("selekt = []", "config-unknown-key", "'selekt'. Did you mean 'select'?"),
        ("zzz = 1", "config-unknown-key", "There are select"),
        ('ignore = ["link-mising"]', "config-unknown-code", "Did you mean link-missing"),
        ('ignore = ["lin"]', "config-unknown-code", "'lin'"),
        ('ignore = "link"', "config-wrong-value", "ignore is 'link'; it must be a list of strings"),
        ("ignore = [1]", "config-wrong-value", "a list of strings"),
        ('severity = "error"', "config-wrong-value", "a table"),
        ('severity = { link = "bad" }', "config-wrong-value", "severity.link is 'bad'"),
        ('severity = { lnk = "info" }', "config-unknown-code", "'lnk'"),
        ('fail-level = "never"', "config-wrong-value", "one of error, warning, info, hint"),
        ('collada-14 = "info"', "config-wrong-value", "one of error, warning, ignore"),
        ("collada-14 = []", "config-wrong-value", "one of error, warning, ignore"),
        ("baseline = 1", "config-wrong-value", "the name of a file"),
        ('baseline = ""', "config-wrong-value", "the name of a file"),
        ("exclude = 3", "config-wrong-value", "a list of strings"),
        ('exclude = ["!"]', "config-wrong-value", "exclude: "),
        ("per-file = []", "config-wrong-value", "a table"),
        ('[per-file."a"]\nexclude = []', "config-unknown-key", "exclude"),
        ('[per-file."a"]\nselect = ["x"]', "config-unknown-code", "'x'"),
    ],
)
@pytest.mark.parametrize("name", ["colladaphy.toml", "pyproject.toml"])
def test_faults_are_told(tmp_path: Path, text: str, code: str, words: str, name: str) -> None:
    if name == "pyproject.toml":
        text = "[tool.colladaphy]\n" + text.replace("[per-file", "[tool.colladaphy.per-file")
        words = words.replace("line 1", "line 2")
    path = written(tmp_path, text, name)
    for attempt in (lambda: read_configuration(path), lambda: Configurations().of(tmp_path)):
        with pytest.raises(ConfigurationError) as caught:
            attempt()
        (found,) = caught.value.findings
        assert (found.code, found.file) == (code, str(path))
        plain = words.replace("'selekt'", "'tool.colladaphy.selekt'") if "tool" in text else words
        assert plain in found.message, found.message
        assert found.hint


def test_configurations_that_cannot_be_read(tmp_path: Path) -> None:
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(ConfigurationError) as caught:
            read_configuration(path)
        assert caught.value.findings[0].code == "config-unreadable"
    (tmp_path / "colladaphy.toml").write_bytes(b'ignore = ["\xff"]')
    with pytest.raises(ConfigurationError, match="config-syntax"):
        Configurations().of(tmp_path)

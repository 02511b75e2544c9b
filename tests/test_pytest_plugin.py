"""The plugin's profiles, in a run of pytest of its own."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from tests.conftest import ROOT

TEST = """
from hypothesis import given, settings
from hypothesis import strategies as st

count = 0

@given(st.integers())
def test_numbers(number):
    global count
    count += 1

def test_how_many():
    own = settings()
    print("examples", own.max_examples, count, own.derandomize, own.deadline)
"""


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    (folder / "test_some.py").write_text(TEST)
    command = [sys.executable, "-m", "pytest", "-q", "-s", "-p", "no:cacheprovider",
               "--rootdir", str(folder), "test_some.py"]  # fmt: skip
    return subprocess.run(
        [*command, *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ("profile", "most", "derandomized"),
    [("quick", 20, False), ("ci", 100, True), ("nightly", 5000, False)],
)
def test_profiles(tmp_path: Path, profile: str, most: int, derandomized: bool) -> None:
    done = run(tmp_path, "--colladaphy-profile", profile)
    assert done.returncode == 0, done.stdout
    assert f"examples {most} {most} {derandomized} None" in done.stdout


def test_without_the_option_nothing_changes(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(
        "from hypothesis import settings\n"
        "settings.register_profile('own', max_examples=7)\n"
        "settings.load_profile('own')\n"
    )
    assert "examples 7 7 " in run(tmp_path).stdout
    assert "examples 20 20 " in run(tmp_path, "--colladaphy-profile", "quick").stdout


def test_unknown_profiles_are_refused(tmp_path: Path) -> None:
    done = run(tmp_path, "--colladaphy-profile", "weekly")
    assert done.returncode == 4 and "invalid choice: 'weekly'" in done.stderr


def test_it_is_an_entry_point_that_needs_nothing_else() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["entry-points"]["pytest11"] == {"colladaphy": "colladaphy.pytest_plugin"}
    code = (
        "import sys\nbefore = set(sys.modules)\nimport colladaphy.pytest_plugin\n"
        "assert not {'hypothesis', 'numpy', 'lxml', 'pytest'} & (set(sys.modules) - before)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

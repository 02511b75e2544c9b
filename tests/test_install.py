"""What users install: the wheel holds all that is needed, and works without the checkout."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
DOCUMENT = """<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
<asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
</COLLADA>"""


def build(kind: str, folder: Path) -> Path:
    command = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (path,) = folder.iterdir()
    return path


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build("wheel", tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("installed")
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index"]
    subprocess.run([*command, "--target", str(folder), str(wheel)], check=True)
    return folder


def run(installed: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=installed.parent,
        env=os.environ | {"PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
    )


def test_the_wheel_holds_schema_and_generated_package(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {
        "colladaphy/__init__.py",
        "colladaphy/py.typed",
        "colladaphy/gate/schema.py",
        "colladaphy/validation/reporters/report.schema.json",
        "colladaphy_schema/__init__.py",
        "colladaphy_schema/py.typed",
    } <= names
    for path in (ROOT / "schema").rglob("*.xsd"):
        assert f"colladaphy/schema/{path.relative_to(ROOT / 'schema').as_posix()}" in names
    for folder, home in (
        ("src/colladaphy", "colladaphy"),
        ("generated/colladaphy_schema", "colladaphy_schema"),
    ):
        for path in (ROOT / folder).rglob("*.py"):
            assert f"{home}/{path.relative_to(ROOT / folder).as_posix()}" in names
    assert not any(name.startswith(("tests/", "tools/")) for name in names)


def test_the_wheel_holds_what_testing_needs(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        points = next(name for name in names if name.endswith("entry_points.txt"))
        said = archive.read(points).decode()
    for kind, pattern in (("cases", "*.toml"), ("bases", "*.dae")):
        files = sorted((ROOT / "tests" / "meaning" / kind).glob(pattern))
        assert files
        for path in files:
            assert f"colladaphy/testing/breaking/meaning/{kind}/{path.name}" in names
    assert "[pytest11]\ncolladaphy = colladaphy.pytest_plugin" in said


def test_the_sdist_holds_what_the_wheel_is_built_from(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with tarfile.open(build("sdist", tmp_path_factory.mktemp("sdist"))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {
        "pyproject.toml",
        "schema/document.xsd",
        "generated/colladaphy_schema/__init__.py",
        "src/colladaphy/__init__.py",
        "tests/conftest.py",
    } <= names


def test_an_installed_wheel_works_without_the_checkout(installed: Path) -> None:
    code = (
        "import colladaphy, colladaphy.gate, colladaphy_schema as s\n"
        "print(colladaphy.__file__, s.__file__, colladaphy.gate.schema_folder())\n"
        f"assert colladaphy.validate({DOCUMENT!r}.encode()).valid\n"
        f"assert colladaphy.read({DOCUMENT!r}.encode()).root.asset\n"
    )
    done = run(installed, "-c", code)
    assert done.returncode == 0, done.stderr
    assert all(Path(place).is_relative_to(installed) for place in done.stdout.split())


def test_the_installed_command(installed: Path) -> None:
    path = installed.parent / "scene.dae"
    path.write_text(DOCUMENT, "utf-8")
    done = run(installed, str(installed / "bin" / "colladaphy"), "validate", "scene.dae")
    assert (done.returncode, done.stdout, done.stderr) == (0, "scene.dae: valid\n", "")
    assert run(installed, "-m", "colladaphy", "--version").stdout.startswith("colladaphy ")

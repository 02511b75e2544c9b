"""What is imported when, and that the package is what the generator makes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tools.bindings import __main__ as command
from tools.bindings.generate import SCHEMA, TARGET, drift, generate, install, texts

import colladaphy_schema

ROOT = Path(__file__).resolve().parents[2]


def modules_after(code: str) -> set[str]:
    """The modules of the package that a fresh interpreter has after running `code`."""
    show = "import sys; print(*[m for m in sys.modules if m.startswith('colladaphy_schema.')])"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{show}"], capture_output=True, text=True, check=True
    )
    return {name.removeprefix("colladaphy_schema.") for name in done.stdout.split()}


PHYSICS = """
from lxml import etree
from colladaphy_schema.codec import decode_document, encode_document
text = '''<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
<asset><created>2024-01-01T00:00:00Z</created><modified>2024-01-01T00:00:00Z</modified></asset>
<library_physics_models><physics_model><rigid_body sid="b"><technique_common><shape><sphere>
<radius>1</radius></sphere></shape></technique_common></rigid_body></physics_model>
</library_physics_models></COLLADA>'''
root = decode_document(etree.fromstring(text))
encode_document(root)
"""


def test_the_package_alone_imports_no_area() -> None:
    assert modules_after("import colladaphy_schema") == set()


def test_physics_imports_what_it_builds_on_and_no_more() -> None:
    loaded = modules_after("from colladaphy_schema import RigidBodyType")
    assert "physics" in loaded
    assert not {name for name in loaded if name.startswith("fx_")}
    assert not loaded & {"document", "scene", "materials", "kinematics", "effects"}


def test_reading_and_writing_a_physics_document_imports_no_effects() -> None:
    loaded = modules_after(PHYSICS)
    assert {"physics", "physics_codec", "core_codec", "document_codec"} <= loaded
    assert not {name for name in loaded if name.startswith(("fx_", "effects", "kinematics"))}
    assert not loaded & {"materials", "brep", "controllers", "animation", "images", "formulas"}


def test_every_class_is_found_by_name() -> None:
    assert colladaphy_schema.Collada.__module__ == "colladaphy_schema.document"
    assert colladaphy_schema.MaterialType.__module__ == "colladaphy_schema.materials"
    assert colladaphy_schema.Body.__module__ == "colladaphy_schema.pe"
    for name in dir(colladaphy_schema):
        assert getattr(colladaphy_schema, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'Nothing'"):
        _ = colladaphy_schema.Nothing


@pytest.fixture(scope="module")
def fresh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return generate(SCHEMA, tmp_path_factory.mktemp("fresh"))


def test_the_package_has_not_drifted(fresh: Path) -> None:
    assert drift(fresh, TARGET) == []


def test_drift_is_found_and_mended(fresh: Path, tmp_path: Path) -> None:
    copy = tmp_path / "package"
    assert install(fresh, copy) == len(texts(fresh))
    assert drift(fresh, copy) == []
    physics = copy / "physics.py"
    physics.write_text(physics.read_text("utf-8").replace("sid:", "sidd:", 1), "utf-8")
    (copy / "core.py").unlink()
    (copy / "mine.py").write_text("", "utf-8")
    report = drift(fresh, copy)
    assert [line for line in report if not line.startswith(" ")] == [
        "core.py: missing",
        "mine.py: not generated",
        "physics.py: 2 lines differ",
    ]
    assert install(fresh, copy) == 3
    assert drift(fresh, copy) == []
    assert not (copy / "mine.py").exists()


def test_the_command_says_what_drifted(
    tmp_path: Path, fresh: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    copy = tmp_path / "package"
    install(fresh, copy)
    monkeypatch.setattr(command, "generated", lambda schema: Ready(fresh))
    assert command.main(["--check", "--target", str(copy)]) == 0
    (copy / "core.py").write_text("mutated\n", "utf-8")
    assert command.main(["--check", "--target", str(copy)]) == 1
    assert "core.py" in capsys.readouterr().out
    assert command.main(["--target", str(copy)]) == 0
    assert command.main(["--check", "--target", str(copy)]) == 0


class Ready:
    """A context manager around what is there already."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __enter__(self) -> Path:
        return self.path

    def __exit__(self, *_: object) -> None:
        return None


def test_generation_does_not_depend_on_the_hash_seed(fresh: Path, tmp_path: Path) -> None:
    code = (
        "from pathlib import Path; from tools.bindings.generate import SCHEMA, generate;"
        f"generate(SCHEMA, Path({str(tmp_path)!r}))"
    )
    env = {**os.environ, "PYTHONHASHSEED": "12345"}
    subprocess.run([sys.executable, "-c", code], check=True, env=env, cwd=ROOT)
    assert drift(tmp_path / "colladaphy_schema", fresh) == []

"""docs/validate.md says what is so."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

from ruamel.yaml import YAML

from colladaphy.cli.validate import command
from colladaphy.validation.configuration import read_configuration
from colladaphy.validation.formats import FORMATS
from colladaphy.validation.reporters.json import json_schema

PAGE = (Path(__file__).resolve().parent.parent / "docs" / "validate.md").read_text("utf-8")
DOCUMENT = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <asset><created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>
  <library_physics_models>
    <physics_model id="model">
      <rigid_body sid="ball"><technique_common>
        <dynamic>true</dynamic><mass>-2</mass>
        <shape><sphere><radius>1</radius></sphere></shape>
      </technique_common></rigid_body>
    </physics_model>
  </library_physics_models>
</COLLADA>
"""


def blocks(language: str) -> list[str]:
    found = re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    assert found
    return found


def test_the_finding_that_is_shown(tmp_path: Path) -> None:
    (tmp_path / "scene.dae").write_text(DOCUMENT, "utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "colladaphy", "validate", "scene.dae"],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert [done.stdout] == blocks("text")


def test_the_configuration_that_is_shown(tmp_path: Path) -> None:
    (text,) = blocks("toml")
    path = tmp_path / "colladaphy.toml"
    path.write_text(text, "utf-8")
    known = read_configuration(path)
    assert known.settings_of(tmp_path / "legacy" / "a" / "b.dae").ignore[-1] == (
        "schema-duplicate-id"
    )


def test_the_report_that_is_shown() -> None:
    (text,) = blocks("json")
    shown, schema = json.loads(text), json.loads(json_schema())
    assert set(shown) == set(schema["properties"])
    assert set(shown["summary"]) == set(schema["$defs"]["summary"]["properties"])
    assert set(shown["files"][0]) == set(schema["$defs"]["file"]["properties"])


def test_all_formats_and_options_are_told() -> None:
    assert re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE) == list(FORMATS)
    known = {option for parameter in command.params for option in parameter.opts}
    told = set(re.findall(r"--[a-z][a-z0-9-]+", PAGE))
    assert told == {option for option in known if option.startswith("--")} - {"--quiet", "--jobs"}


def test_the_recipes_are_yaml() -> None:
    for text in blocks("yaml"):
        assert YAML(typ="safe", pure=True).load(text)

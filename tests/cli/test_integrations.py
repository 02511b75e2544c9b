"""What other systems run: the GitHub action and the pre-commit hook of this repository."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML
from tests.cli.test_validate import INVALID, VALID

ROOT = Path(__file__).resolve().parents[2]


def read(name: str) -> Any:
    return YAML(typ="safe", pure=True).load(ROOT / name)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "good one.dae").write_text(VALID)
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "BAD.DAE").write_text(INVALID)
    return tmp_path


def test_the_action_keeps_to_githubs_schema() -> None:
    vendored = resources.files("check_jsonschema") / "builtin_schemas/vendor/github-actions.json"
    schema = json.loads(vendored.read_text("utf-8"))
    action = read("action.yml")
    jsonschema.Draft7Validator(schema).validate(action)
    used = set(re.findall(r"inputs\.([\w-]+)", (ROOT / "action.yml").read_text()))
    assert used == set(action["inputs"])


def act(folder: Path, **inputs: str) -> tuple[int, str, str]:
    """Run the action's last step as GitHub does: its script in bash, its inputs as variables."""
    action = read("action.yml")
    step = action["runs"]["steps"][-1]
    values = {name: str(told["default"]) for name, told in action["inputs"].items()} | inputs
    environment = dict(os.environ)
    for name, value in step["env"].items():
        found = re.fullmatch(r"\$\{\{ inputs\.([\w-]+) \}\}", value)
        environment[name] = values[found[1]] if found else sys.executable
    output = folder / "output.txt"
    environment["GITHUB_OUTPUT"] = str(output)
    done = subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],
        cwd=folder, env=environment, capture_output=True, text=True,
    )  # fmt: skip
    assert not done.stderr, done.stderr
    return done.returncode, done.stdout, output.read_text()


def test_the_action(folder: Path) -> None:
    code, out, output = act(folder)
    assert (code, output) == (1, "exit-code=1\n")
    assert out.startswith("::error title=schema-unknown-attribute,file=sub/BAD.DAE,line=3,col=3::")
    assert "2 files: 1 valid, 1 not" in out


def test_the_inputs_of_the_action(folder: Path) -> None:
    code, _, output = act(folder, files="good one.dae\nsub/*.DAE\n",
                          arguments="--severity=schema=warning\n", sarif="a b.sarif",
                          junit="out.xml")  # fmt: skip
    assert (code, output) == (0, "exit-code=0\n")
    assert json.loads((folder / "a b.sarif").read_text())["version"] == "2.1.0"
    assert (folder / "out.xml").read_text().startswith("<?xml")
    # What is given is never run.
    code, _, _ = act(folder, files="$(touch run)\n; touch run", arguments="")
    assert code == 2 and not (folder / "run").exists()


def test_the_pre_commit_hook(folder: Path) -> None:
    (hook,) = read(".pre-commit-hooks.yaml")
    assert [name for name in ("a.dae", "A.DAE", "x.zae", "x.dae.txt", "dae")
            if re.search(hook["files"], name)] == ["a.dae", "A.DAE", "x.zae"]  # fmt: skip

    def commit(*files: str) -> subprocess.CompletedProcess[str]:
        program, *arguments = shlex.split(hook["entry"])
        assert program == "colladaphy"
        return subprocess.run(
            [sys.executable, "-m", program, *arguments, *hook["args"], *files],
            cwd=folder, capture_output=True, text=True,
        )  # fmt: skip

    assert commit("good one.dae").returncode == 0
    done = commit("good one.dae", "sub/BAD.DAE")
    assert done.returncode == 1 and "schema-unknown-attribute" in done.stdout
    (folder / "colladaphy.toml").write_text('exclude = ["sub/"]')
    assert commit("good one.dae", "sub/BAD.DAE").returncode == 0

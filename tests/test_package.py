"""The package itself: what it offers, and what importing it costs."""

from __future__ import annotations

import subprocess
import sys

import pytest

import colladaphy

HEAVY = ("lxml", "numpy", "xsdata", "pymunk", "mujoco", "rich", "click", "hypothesis")


def modules_after(statement: str) -> set[str]:
    """The names of the modules that a fresh interpreter holds after `statement`."""
    code = f"import sys\n{statement}\nprint('\\n'.join(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_import_loads_nothing_heavy() -> None:
    loaded = modules_after("import colladaphy")
    assert loaded.isdisjoint(HEAVY)
    assert not any(name.startswith("colladaphy_schema") for name in loaded)


@pytest.mark.parametrize("name", colladaphy.__all__)
def test_every_public_name_exists(name: str) -> None:
    assert getattr(colladaphy, name) is not None


def test_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no_such_name"):
        colladaphy.no_such_name  # noqa: B018 (the access is what is tested)


def test_the_function_validate_wins_over_any_module_of_that_name() -> None:
    code = "import colladaphy.cli, colladaphy.validation; import colladaphy\n"
    code += "assert callable(colladaphy.validate), colladaphy.validate"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_world_needs_no_xml() -> None:
    loaded = modules_after("import colladaphy; colladaphy.World")
    assert "lxml" not in loaded
    assert not any(name.startswith("colladaphy_schema") for name in loaded)

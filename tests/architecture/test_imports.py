"""No circle of modules: lazy imports and those of type checkers included.

That imports point down the list of rooms is for import-linter to hold (pyproject.toml).
"""

from __future__ import annotations

from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp
import pytest

HOME = Path(__file__).resolve().parents[2] / "src" / "colladaphy"


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("colladaphy", exclude_type_checking_imports=False, cache_dir=None)


def test_the_graph_sees_lazy_imports_and_those_of_type_checkers(graph: grimp.ImportGraph) -> None:
    assert len(graph.modules) == len(list(HOME.rglob("*.py")))
    of_validate = graph.find_modules_directly_imported_by("colladaphy.cli.validate")
    assert {"colladaphy.validation.session", "colladaphy.source.limits"} <= of_validate


def test_no_circle_of_modules(graph: grimp.ImportGraph) -> None:
    imported = {name: graph.find_modules_directly_imported_by(name) for name in graph.modules}
    try:
        TopologicalSorter(imported).prepare()
    except CycleError as error:
        pytest.fail("imports go in a circle: " + " <- ".join(error.args[1]))


def test_no_room_imports_the_front_of_the_house(graph: grimp.ImportGraph) -> None:
    """`colladaphy` itself offers every room, so that whoever imports it may reach any of them."""
    users = graph.find_modules_that_directly_import("colladaphy")
    rooms = {name.split(".")[1] for name in users}
    assert rooms <= {"cli", "demo", "__main__"}

"""The properties that are fuzzed hold of a few values each time, and of what was found once."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from tests.conftest import ROOT
from tools.fuzz import keeping
from tools.fuzz.registry import all_properties

EXAMPLES = max(5, settings().max_examples // 5)
"""Of each property; `make fuzz` takes very many more."""
FOUND = sorted((ROOT / "tests" / "regressions").glob("*.json"))


@pytest.mark.parametrize("name", sorted(all_properties()))
def test_properties_hold(name: str) -> None:
    prop = all_properties()[name]

    @settings(max_examples=EXAMPLES, suppress_health_check=list(HealthCheck))
    @given(prop.values())
    def run(values: tuple[object, ...]) -> None:
        prop.check(*values)

    run()


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_what_was_found_once_holds_ever_after(path: Path) -> None:
    name, values = keeping.read(path)
    all_properties()[name].check(*values)


def test_there_is_what_was_found() -> None:
    assert FOUND
    assert {keeping.read(path)[0] for path in FOUND} <= all_properties().keys()

"""The tests of docs/testing.md run as they stand there."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

PAGE = Path(__file__).resolve().parents[2] / "docs" / "testing.md"
BLOCKS = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
TESTS = re.findall(r"^def (test_\w+)", "\n".join(BLOCKS), re.MULTILINE)


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """What the blocks define, one after the other."""
    found: dict[str, Any] = {}
    for number, block in enumerate(BLOCKS):
        exec(compile(block, f"docs/testing.md, block {number + 1}", "exec"), found)
    return found


def test_there_are_tests() -> None:
    assert "test_importer_finds_every_body" in TESTS


@pytest.mark.parametrize("name", TESTS)
def test_what_the_page_shows(name: str, names: dict[str, Any]) -> None:
    test = names[name]
    if hasattr(test, "hypothesis"):  # not what runs properties of its own
        test = settings(max_examples=20, deadline=None)(test)
    test()


def test_what_the_page_says_of_another_reader(names: dict[str, Any]) -> None:
    report = names["report_on_pycollada"](names["physics_documents"]())
    (failure,) = report.failures
    assert failure.message.startswith("it means another World:\nno geometry fills [[")
    assert failure.document is not None
    assert b"convex_mesh" in failure.document or not _is_dense(failure.document)
    documents = names["physics_documents"](profiles=False, oddities=False)
    plain = documents.filter(lambda data: b"convex_mesh" not in data and _is_dense(data))
    report = names["report_on_pycollada"](plain)
    assert report.passed, report


def _is_dense(document: bytes) -> bool:
    """Whether every accessor reads all numbers of its array, three by three."""
    steps = re.findall(rb'stride="(\d+)"( offset="\d+")?', document)
    return {(b"3", b"")}.issuperset(steps)


def test_the_first_is_five_lines_long() -> None:
    """From the import of the strategy on, without the importer and what writes the file."""
    body = BLOCKS[0][BLOCKS[0].index("@given") :]
    assert len(body.splitlines()) == 5


def test_every_strategy_is_on_the_page() -> None:
    import colladaphy.testing as testing

    text = PAGE.read_text("utf-8")
    strategies = [name for name in testing.__all__ if name.islower()]
    helpers = {"covering_documents", "crowd"}
    assert [name for name in strategies if name not in helpers and f"`{name}(" not in text] == []

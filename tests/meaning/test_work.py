"""Rules look at all elements of a kind at once, and not one by one."""

from __future__ import annotations

import sys
from types import FrameType
from typing import Any

import pytest
from tools.bench.kinds import KINDS

import colladaphy

ROOM = f"{colladaphy.__name__}/meaning/"
FEW = 25
"""Lines a body, as some texts are looked up; what is done for whole arrays takes none."""


def lines(data: bytes) -> int:
    """Lines of the rules' Python that a check takes."""
    count = 0

    def step(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal count
        if ROOM not in frame.f_code.co_filename:
            return None
        count += event == "line"
        return step

    before = sys.gettrace()
    sys.settrace(step)
    try:
        colladaphy.validate(data)
    finally:
        sys.settrace(before)
    return count


@pytest.mark.parametrize("kind", [kind for kind in KINDS if not kind.startswith("one ")])
def test_a_body_takes_few_lines(kind: str) -> None:
    few, many = (KINDS[kind].document(count) for count in (200, 400))
    colladaphy.validate(few)  # what is imported and made once
    assert lines(many) - lines(few) < 200 * FEW

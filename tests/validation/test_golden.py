"""The reports of a folder of documents, word by word; tests.validation.golden writes them."""

from __future__ import annotations

import pytest
from tests.validation.golden import GOLDEN, golden

from colladaphy.validation.formats import FORMATS


@pytest.mark.parametrize("form", FORMATS)
def test_golden_reports(form: str) -> None:
    assert golden(form) == (GOLDEN / f"{form}.txt").read_text("utf-8")


def test_there_are_no_others() -> None:
    assert {path.stem for path in GOLDEN.iterdir()} == set(FORMATS)

"""Whatever a valid document holds, its export for Bullet is valid 1.4.1 that Bullet can follow."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from lxml import etree

from colladaphy.conform.exporting import export
from colladaphy.testing import covering_documents, documents


@pytest.mark.parametrize("areas", [["physics"], None])
def test_any_document(areas: list[str] | None) -> None:
    @settings(max_examples=25)
    @given(document=documents() if areas is None else documents(areas=areas))
    def run(document: bytes) -> None:
        export(etree.ElementTree(etree.fromstring(document)), "bullet")

    run()


def test_the_series_that_covers_the_schema() -> None:
    for document in covering_documents():
        export(etree.ElementTree(etree.fromstring(document)), "bullet")

"""What the tests of the export for Bullet share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from collada.schema import ColladaValidator
from lxml import etree

from colladaphy.conform.bullet import for_bullet
from colladaphy.findings import Finding

ROOT = Path(__file__).resolve().parents[3]
Export = Callable[[bytes], tuple[bytes, list[Finding]]]


@pytest.fixture(scope="session")
def export() -> Export:
    """Export a document; it must be valid before and after, and stay untouched."""
    schema_1_5 = etree.XMLSchema(etree.parse(ROOT / "schema" / "document.xsd"))
    schema_1_4: etree.XMLSchema = ColladaValidator().COLLADA_SCHEMA_1_4_1_INSTANCE

    def run(data: bytes) -> tuple[bytes, list[Finding]]:
        old = etree.ElementTree(etree.fromstring(data))
        schema_1_5.assertValid(old)
        before = etree.tostring(old)
        new, findings = for_bullet(old)
        assert etree.tostring(old) == before
        text = etree.tostring(new)
        schema_1_4.assertValid(etree.ElementTree(etree.fromstring(text)))
        assert etree.tostring(for_bullet(old)[0]) == text
        return text, findings

    return run

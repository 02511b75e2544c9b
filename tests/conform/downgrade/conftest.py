"""Both oracles: the project's 1.5 schema before, the 1.4.1 schema that pycollada ships after."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from collada.schema import ColladaValidator
from lxml import etree

from colladaphy.conform.downgrade import to_collada_1_4
from colladaphy.findings import Finding

ROOT = Path(__file__).resolve().parents[3]
NS15 = "http://www.collada.org/2008/03/COLLADASchema"
NS14 = "http://www.collada.org/2005/11/COLLADASchema"

Downgrade = Callable[[str], tuple[etree._ElementTree, list[Finding]]]


@pytest.fixture(scope="session")
def schema_1_5() -> etree.XMLSchema:
    return etree.XMLSchema(etree.parse(ROOT / "schema" / "document.xsd"))


@pytest.fixture(scope="session")
def schema_1_4() -> etree.XMLSchema:
    schema: etree.XMLSchema = ColladaValidator().COLLADA_SCHEMA_1_4_1_INSTANCE
    return schema


def document(body: str, asset: str = "", attributes: str = "") -> str:
    return (
        f'<COLLADA xmlns="{NS15}" version="1.5.0" {attributes}><asset>'
        f"<created>2024-01-01T00:00:00Z</created><modified>2024-01-01T00:00:00Z</modified>{asset}"
        f"</asset>{body}</COLLADA>"
    )


@pytest.fixture
def downgrade(schema_1_5: etree.XMLSchema, schema_1_4: etree.XMLSchema) -> Downgrade:
    """Downgrade a document from its text; both ends are checked, and that it is untouched."""

    def run(text: str) -> tuple[etree._ElementTree, list[Finding]]:
        old = etree.ElementTree(etree.fromstring(text))
        schema_1_5.assertValid(old)
        before = etree.tostring(old)
        new, findings = to_collada_1_4(old)
        assert etree.tostring(old) == before
        again, same = to_collada_1_4(old)
        assert etree.tostring(again) == etree.tostring(new)
        assert same == findings
        schema_1_4.assertValid(new)
        # What is written is what is meant: prefixes and all.
        schema_1_4.assertValid(etree.ElementTree(etree.fromstring(etree.tostring(new))))
        return new, findings

    return run

"""Any valid 1.5 document becomes a valid 1.4.1 document, and nothing of it disappears."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given, settings
from lxml import etree

from colladaphy.conform.downgrade import rules, to_collada_1_4
from colladaphy.testing import covering_documents, documents

# What these change is said otherwise, not kept word by word.
REWORDED = {
    rule.code
    for rule in (
        rules.CAPSULE_RADIUS,
        rules.OPAQUE_CHANGED,
        rules.BODY_ID,
        rules.SCHEMA_HINT,
    )
}


def words(root: etree._Element) -> Counter[str]:
    """Every word of every text and attribute; without names, the version, a third equal radius."""
    found: Counter[str] = Counter()
    for element in root.iter(etree.Element):
        text = (element.text or "").split()
        parent = element.getparent()
        if parent is not None and etree.QName(parent).localname == "capsule":
            text = [*{*text}]
        found.update(text)
        found.update(
            word
            for key, value in element.attrib.items()
            if key != "name"
            for word in str(value).split()
        )
    found.subtract([root.get("version", "")])
    return found


def check(document: bytes, schema: etree.XMLSchema) -> None:
    old = etree.fromstring(document)
    tree, findings = to_collada_1_4(etree.ElementTree(old))
    new = etree.fromstring(etree.tostring(tree))
    schema.assertValid(etree.ElementTree(new))
    if not REWORDED & {finding.code for finding in findings}:
        assert words(old) - words(new) == Counter()


@settings(max_examples=50)
@given(document=documents())
def test_any_document(document: bytes, schema_1_4: etree.XMLSchema) -> None:
    check(document, schema_1_4)


def test_the_series_that_covers_the_schema(schema_1_4: etree.XMLSchema) -> None:
    for document in covering_documents():
        check(document, schema_1_4)


@pytest.mark.parametrize("area", ["physics", "scene"])
def test_areas(area: str, schema_1_4: etree.XMLSchema) -> None:
    @settings(max_examples=25)
    @given(document=documents(areas=[area]))
    def run(document: bytes) -> None:
        check(document, schema_1_4)

    run()

from __future__ import annotations

from typing import Any

import pytest
from lxml import etree
from tests.conform.downgrade.conftest import NS14, document

from colladaphy.conform import exporting
from colladaphy.conform.downgrade import rules
from colladaphy.errors import SchemaError
from colladaphy.findings import Rule
from colladaphy.gate import schema


@pytest.mark.parametrize("target", exporting.TARGETS)
def test_bytes_of_a_valid_document(target: exporting.Target) -> None:
    tree = etree.ElementTree(etree.fromstring(document("<!--ü-->")))
    data, _ = exporting.export(tree, target)
    assert data.startswith(b"<?xml version='1.0' encoding='UTF-8'?>\n")
    assert etree.fromstring(data).tag == f"{{{NS14}}}COLLADA"
    assert exporting.export(tree, target)[0] == data


def test_only_valid_documents_are_given_out() -> None:
    tree = etree.ElementTree(etree.fromstring(document("<library_nodes/>")))
    with pytest.raises(SchemaError) as error:
        exporting.export(tree, "collada-1.4")
    assert error.value.findings[0].code == rules.INVALID.code
    assert "library_nodes" in str(error.value)


def test_without_pycollada_what_is_known_by_construction_is_checked(monkeypatch: Any) -> None:
    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(schema, "import_module", missing)
    schema.schema_1_4.cache_clear()
    try:
        tree = etree.ElementTree(etree.fromstring(document("<library_nodes/>")))
        data, _ = exporting.export(tree, "collada-1.4")
        assert b"library_nodes" in data
        with pytest.raises(SchemaError):
            exporting.export(etree.ElementTree(etree.fromstring("<html/>")), "collada-1.4")
    finally:
        schema.schema_1_4.cache_clear()


def test_another_target() -> None:
    tree = etree.ElementTree(etree.fromstring(document("")))
    with pytest.raises(ValueError, match="choose one of bullet"):
        exporting.export(tree, "unity")  # type: ignore[arg-type]


def test_every_rule_is_listed_once() -> None:
    listed = [rule.code for rule in rules.RULES]
    assert len({*listed}) == len(listed)
    assert {rule.code for rule in vars(rules).values() if isinstance(rule, Rule)} == {*listed}
    assert all(rule.stage == "downgrade" for rule in rules.RULES)

"""Every real file becomes valid, keeps its physics, and is left alone the second time."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from colladaphy.conform import conform

SCHEMA = Path(__file__).resolve().parents[2] / "schema" / "document.xsd"
CORPUS = Path(__file__).resolve().parents[3] / "shared" / "corpus"
MALFORMED = "colladatools-simple-arm-hostile.dae"
FILES = sorted(path.name for path in CORPUS.glob("*.dae") if path.name != MALFORMED)


@pytest.fixture(scope="module")
def schema() -> etree.XMLSchema:
    return etree.XMLSchema(etree.parse(str(SCHEMA)))


@pytest.mark.parametrize("name", FILES)
def test_every_file_becomes_valid_and_stays_as_it_is(
    name: str, corpus_dir: Path, schema: etree.XMLSchema
) -> None:
    tree = etree.parse(str(corpus_dir / name))
    before = etree.tostring(tree)
    result, findings = conform(tree, file=name)
    assert etree.tostring(tree) == before
    assert schema.validate(result), schema.error_log
    assert findings
    again, more = conform(result)
    assert more == []
    assert etree.tostring(again) == etree.tostring(result)

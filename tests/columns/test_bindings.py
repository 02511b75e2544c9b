"""Columns and objects of the same document say the same; what columns write, they read again."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from lxml import etree
from tests.columns.agreement import assert_agree
from tests.conftest import CORPUS

from colladaphy import gate
from colladaphy.columns.reading import Document
from colladaphy.columns.writing import document_bytes
from colladaphy.conform import conform
from colladaphy.testing import covering_documents, documents
from colladaphy_schema.codec import decode_document
from colladaphy_schema.document_columns import ColladaRows

COLLADA = "{http://www.collada.org/2008/03/COLLADASchema}COLLADA"


def root_of(document: Document) -> ColladaRows:
    return document.rows(ColladaRows, COLLADA)


def assert_same(data: bytes) -> None:
    """Columns say what objects say, and what is written from them says it again."""
    tree = etree.ElementTree(etree.fromstring(data))
    objects = [decode_document(tree)]
    rows = root_of(Document.of(data, tree))
    assert_agree(rows, objects)
    text = document_bytes(rows)
    again = root_of(Document.of(text))
    assert_agree(again, objects)
    assert document_bytes(again) == text
    assert gate.is_valid_text(text)


DOCUMENTS = list(covering_documents())


@pytest.mark.parametrize("number", range(len(DOCUMENTS)))
def test_every_declaration_of_the_schema(number: int) -> None:
    assert_same(DOCUMENTS[number])


@given(documents())
def test_documents_of_the_whole_schema(document: bytes) -> None:
    assert_same(document)


FILES = sorted(path.name for path in CORPUS.glob("*.dae") if "hostile" not in path.name)


@pytest.mark.parametrize("name", FILES)
def test_files_of_other_programs(name: str, corpus_dir: Path) -> None:
    """Real files, repaired first; as they were written then, and with their comments."""
    repaired, _ = conform(etree.parse(str(corpus_dir / name)), file=name)
    assert_same(etree.tostring(repaired, encoding="UTF-8"))

"""What must hold of every valid document, and of what is nearly one."""

from __future__ import annotations

import io

from hypothesis import strategies as st
from lxml import etree
from tests.columns.test_bindings import assert_same

import colladaphy
from colladaphy import ColladaError, Document
from colladaphy.conform import conform
from colladaphy.conform.exporting import export
from colladaphy.errors import XmlError
from colladaphy.gate import gate
from colladaphy.testing import documents, mutants
from tools.fuzz.registry import note, of

__all__ = ["physics", "saved", "valid_loads"]


def physics() -> st.SearchStrategy[bytes]:
    """Documents of the area of physics."""
    return documents(areas=["physics"])


def saved(document: Document) -> bytes:
    """A document as it is written."""
    stream = io.BytesIO()
    document.write(stream, check=False)
    return stream.getvalue()


def valid_loads(data: bytes) -> None:
    """A document that is called valid must load, and to call one so must not raise."""
    report = colladaphy.validate(data)
    # A reference out of the document's folder is not wrong, but is not followed either.
    if report.valid and not any(finding.code == "io-reference-refused" for finding in report):
        colladaphy.read(data).load()


@of(documents, weight=2)
def document_columns(document: bytes) -> None:
    """Document → objects → columns → document say the same."""
    assert_same(note(document))


@of(documents)
def document_saved(document: bytes) -> None:
    """What is not edited is saved as it was, also after its objects were made."""
    found = colladaphy.read(note(document))
    assert found.root is not None
    canonical = [
        etree.tostring(etree.fromstring(data), method="c14n2") for data in (document, saved(found))
    ]
    assert canonical[0] == canonical[1]


@of(documents)
def document_loads(document: bytes) -> None:
    """What validation calls valid, loading takes; documents of the whole schema."""
    valid_loads(note(document))


@of(physics)
def document_loads_physics(document: bytes) -> None:
    """What validation calls valid, loading takes; documents of physics."""
    valid_loads(note(document))


@of(mutants, weight=2)
def document_repair(document: bytes) -> None:
    """A repair makes a document valid, or says why not; a second one changes nothing."""
    tree = etree.ElementTree(etree.fromstring(note(document)))
    before = etree.tostring(tree)
    mended, _ = conform(tree)
    assert etree.tostring(tree) == before
    faults = gate(mended)
    try:
        read = colladaphy.read(document, repair=True)
    except XmlError:  # of a root that nobody could mend
        return
    except ColladaError:
        assert faults
        return
    assert not faults
    once = saved(read)
    again, changes = conform(etree.ElementTree(etree.fromstring(once)))
    assert [str(change) for change in changes] == []
    assert etree.tostring(again) == etree.tostring(etree.fromstring(once))
    assert gate(again) == []


@of(documents, lambda: st.sampled_from(["bullet", "collada-1.4"]))
def document_exported(document: bytes, target: str) -> None:
    """Any valid document becomes a valid one of 1.4.1, and a valid one of 1.5 again."""
    data, _ = export(etree.ElementTree(etree.fromstring(note(document))), target)  # type: ignore[arg-type]
    colladaphy.read(data, repair=True)

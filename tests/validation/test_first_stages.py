"""Every rule before meaning has a document in which it is not kept, and one that nearly is such.

The rules of the rooms `source`, `gate` and `validation` are told by these stages; those of
`meaning` have their cases in tests/meaning.
"""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from runpy import run_path

import pytest

import colladaphy
from colladaphy import Limits
from colladaphy.errors import ColladaError
from colladaphy.source import pack
from colladaphy.validation.baseline import Baseline
from colladaphy.validation.catalogue import rule_modules
from colladaphy.validation.configuration import read_configuration

HEAD = (
    b'<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0"><asset>'
    b"<created>2010-01-01T00:00:00Z</created><modified>2010-01-01T00:00:00Z</modified></asset>"
)
END = b"</COLLADA>"
VALID = HEAD + END


def nodes(content: bytes) -> bytes:
    return HEAD + b"<library_nodes>" + content + b"</library_nodes>" + END


def declared(encoding: str, text: str, real: str) -> bytes:
    head = f'<?xml version="1.0" encoding="{encoding}"?>'.encode()
    return head + nodes(b'<node id="a" name="' + text.encode(real) + b'"/>')


def archive(*entries: tuple[str, bytes]) -> bytes:
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, data in entries:
            packed.writestr(name, data)
    return stream.getvalue()


def extra(content: bytes) -> bytes:
    start = b'<extra><technique profile="pe" xmlns:pe="urn:colladaphy:pe:1">'
    return HEAD + start + content + b"</technique></extra>" + END


def deep(levels: int) -> bytes:
    inner = b'<extra><technique profile="x">' + b"<x>" * levels + b"</x>" * levels
    return HEAD + inner + b"</technique></extra>" + END


SMALL = Limits(bytes=len(VALID), depth=20, text=1000, elements=30, archive_entries=3,
               archive_ratio=2, total=10**9)  # fmt: skip

# A code, a document that is not well, one that nearly is such, and perhaps limits.
DOCUMENTS: list[tuple[str, bytes, bytes, Limits | None]] = [
    ("io-too-large", VALID + b" ", VALID, SMALL),
    ("io-archive-broken", pack(VALID)[:-40], pack(VALID), None),
    ("io-archive-unsafe", archive(("../a.dae", VALID)), archive(("b..c/a.dae", VALID)), None),
    ("io-archive-bomb", archive(*((f"{n}.txt", b"") for n in range(4)), ("a.dae", VALID)),
     archive(("1.txt", b""), ("2.txt", b""), ("a.dae", VALID)), Limits(archive_entries=3)),
    ("io-archive-root", archive(("a.dae", VALID), ("b.dae", VALID)),
     archive(("a.dae", VALID), ("b.dxe", VALID)), None),
    ("xml-empty", b"", VALID, None),
    ("xml-not-xml", b"COLLADA", b"\n" + VALID, None),
    ("xml-html", b"<html><body/></html>",
     VALID.replace(END, b"<!-- <html><body/></html> -->" + END), None),
    ("xml-doctype", b"<!DOCTYPE COLLADA>" + VALID, b"<!-- <!DOCTYPE COLLADA> -->" + VALID, None),
    ("xml-malformed", nodes(b"<node></nodes>"), nodes(b"<node></node>"), None),
    ("xml-encoding", declared("utf-8", "ä", "latin-1"), declared("iso-8859-1", "ä", "latin-1"),
     None),
    ("xml-truncated", HEAD, VALID, None),
    ("xml-trailing", VALID + b"<a/>", VALID + b"<!-- a -->", None),
    ("xml-too-deep", deep(18), deep(16), Limits(depth=20)),
    ("xml-text-too-long", nodes(b'<node name="' + b"x" * 1001 + b'"/>'),
     nodes(b'<node name="' + b"x" * 999 + b'"/>'), Limits(text=1000)),
    ("xml-too-many-elements", nodes(b"<node/>" * 26), nodes(b"<node/>" * 25),
     Limits(elements=30)),
    ("xml-wrong-root", b'<sdf xmlns="http://www.collada.org/2008/03/COLLADASchema"/>',
     VALID.replace(b"<COLLADA xmlns=", b"<c:COLLADA xmlns:c=").replace(b"<asset>", b"<c:asset>")
     .replace(b"<created>", b"<c:created>").replace(b"</created>", b"</c:created>")
     .replace(b"<modified>", b"<c:modified>").replace(b"</modified>", b"</c:modified>")
     .replace(b"</asset>", b"</c:asset>").replace(END, b"</c:COLLADA>"), None),
    ("xml-wrong-namespace", VALID.replace(b"http://www", b"urn:www"), VALID, None),
    ("schema-wrong-namespace", VALID.replace(b"2008/03", b"2009/03"), VALID, None),
    ("schema-version-1-4", VALID.replace(b"2008/03", b"2005/11").replace(b"1.5.0", b"1.4.1"),
     VALID, None),
    ("schema-unexpected-element", nodes(b"<node/><light/>"), nodes(b"<node/>"), None),
    ("schema-missing-element", VALID.replace(b"<modified>2010-01-01T00:00:00Z</modified>", b""),
     VALID, None),
    ("schema-unknown-element", extra(b"<pe:nothing/>"), extra(b"<nothing xmlns=''/>"), None),
    ("schema-unexpected-content", nodes(b"<node>text</node>"), nodes(b"<node> \n </node>"), None),
    ("schema-invalid-value", nodes(b'<node id="1a"/>'), nodes(b'<node id="a1"/>'), None),
    ("schema-wrong-length", nodes(b"<node><scale>1 2</scale></node>"),
     nodes(b"<node><scale>1 2 3</scale></node>"), None),
    ("schema-missing-attribute", nodes(b"<node><instance_node/></node><node id='a'/>"),
     nodes(b"<node><instance_node url='#a'/></node><node id='a'/>"), None),
    ("schema-unknown-attribute", nodes(b'<node a="1"/>'), nodes(b'<node name="1"/>'), None),
    ("schema-duplicate-id", nodes(b"<node id='a'/><node id='a'/>"),
     nodes(b"<node id='a' sid='a'/><node id='A'/>"), None),
]  # fmt: skip
ELSEWHERE = {
    # Nothing to read: `validate` raises them. The files of references are in tests/meaning.
    "io-missing", "io-folder", "io-unreadable", "io-not-binary",
    # Of references, which tests/meaning has cases of, and of writing.
    "io-reference-missing", "io-reference-refused",
    "io-companion-taken", "io-companion-left", "io-companion-merged", "io-output-failed",
    # Of repair and of other packages.
    "repair-encoding", "repair-undeclared-prefix", "config-extension-broken",
    # For what libxml2 may say beyond what COLLADA's schema leads to today.
    "schema-broken-key", "schema-violation",
    # Of large documents: tests/validation/test_behind.py.
    "schema-large",
}  # fmt: skip


def codes(data: bytes, limits: Limits | None) -> set[str]:
    return {finding.code for finding in colladaphy.validate(data, limits=limits)}


@pytest.mark.parametrize(
    ("code", "faulty", "near", "limits"), DOCUMENTS, ids=[case[0] for case in DOCUMENTS]
)
def test_documents(code: str, faulty: bytes, near: bytes, limits: Limits | None) -> None:
    assert codes(faulty, limits) == {code}
    assert codes(near, limits) == set()


@pytest.mark.parametrize(
    ("code", "faulty", "near"),
    [
        ("io-missing", "none.dae", "good.dae"),
        ("io-folder", "folder.dae", "good.dae"),
        ("io-unreadable", "a\0b", "good.dae"),
    ],
)
def test_files(tmp_path: Path, code: str, faulty: str, near: str) -> None:
    (tmp_path / "good.dae").write_bytes(VALID)
    (tmp_path / "folder.dae").mkdir()
    assert colladaphy.validate(tmp_path / near).findings == []
    with pytest.raises(ColladaError) as caught:
        colladaphy.validate(tmp_path / faulty)
    assert [finding.code for finding in caught.value.findings] == [code]


BASELINE = '{"version": 1, "findings": []}'
CONFIGURATIONS: list[tuple[str, Callable[[Path], object], str | None, str]] = [
    ("config-unreadable", read_configuration, None, ""),
    ("config-syntax", read_configuration, "select = [,]", "select = []"),
    ("config-unknown-key", read_configuration, "selct = []", "select = []"),
    ("config-unknown-code", read_configuration, 'select = ["lin"]', 'select = ["link"]'),
    ("config-wrong-value", read_configuration, 'select = "link"', 'select = ["link"]'),
    ("config-baseline-unreadable", Baseline.read, None, BASELINE),
    ("config-baseline-broken", Baseline.read, '{"version": 2, "findings": []}', BASELINE),
]


@pytest.mark.parametrize(("code", "read", "faulty", "near"), CONFIGURATIONS)
def test_configurations(
    tmp_path: Path, code: str, read: Callable[[Path], object], faulty: str | None, near: str
) -> None:
    path = tmp_path / "file"
    if faulty is not None:
        path.write_text(faulty)
    with pytest.raises(ColladaError) as caught:
        read(path)
    assert [finding.code for finding in caught.value.findings] == [code]
    path.write_text(near)
    assert read(path)


def test_every_rule_has_a_fault_and_a_near_miss() -> None:
    known = {case[0] for case in (*DOCUMENTS, *CONFIGURATIONS)}
    for name, path in rule_modules().items():
        if name.split(".")[1] in ("source", "gate", "validation"):
            for rule in run_path(str(path))["RULES"]:
                assert (rule.code in known) != (rule.code in ELSEWHERE), rule.code

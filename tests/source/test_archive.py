"""Archives: what a .zae may hold, and what is refused before anything is unpacked."""

from __future__ import annotations

import io
import stat
import warnings
import zipfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.errors import ColladaError, InputError
from colladaphy.source import Limits, pack, parse

DATA = b"<COLLADA><a/></COLLADA>"


def archive(entries: dict[str, bytes] | list[tuple[str | zipfile.ZipInfo, bytes]]) -> bytes:
    buffer = io.BytesIO()
    pairs = entries.items() if isinstance(entries, dict) else entries
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name, data in pairs:
            file.writestr(name, data, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def refused(data: bytes, **limits: int) -> str:
    with pytest.raises(InputError) as caught:
        parse(data, Limits(**limits))
    return caught.value.findings[0].code


def manifest(name: str) -> bytes:
    return f"<dae_root>{name}</dae_root>".encode()


def test_the_only_document_is_the_root() -> None:
    parsed = parse(archive({"folder/scene.DAE": DATA, "image.png": b"png"}))
    assert parsed.member == "folder/scene.DAE"
    assert parsed.base is None
    assert parsed.open_relative("../image.png").data == b"png"


@pytest.mark.parametrize("url", ["b.dae", "./b.dae", "b.dae#scene", "./x/../b.dae", " b.dae "])
def test_the_manifest_names_the_root(url: str) -> None:
    data = archive({"manifest.xml": manifest(url), "a.dae": b"<COLLADA/>", "b.dae": DATA})
    assert parse(data).member == "b.dae"


def test_names_are_urls_in_the_manifest() -> None:
    data = archive({"manifest.xml": manifest("a%20b/%C3%A4.dae"), "a b/ä.dae": DATA})
    assert parse(data).member == "a b/ä.dae"


@pytest.mark.parametrize(
    "entries",
    [
        {"image.png": b"png"},
        {"a.dae": DATA, "b.dae": DATA},
        {"manifest.xml": manifest("c.dae"), "a.dae": DATA},
        {"manifest.xml": manifest("../a.dae"), "a.dae": DATA},
        {"manifest.xml": manifest(""), "a.dae": DATA},
        {"manifest.xml": b"<dae_root>a.dae", "a.dae": DATA},
        {"manifest.xml": b"<!DOCTYPE a><dae_root>a.dae</dae_root>", "a.dae": DATA},
    ],
)
def test_no_telling_which_is_the_document(entries: dict[str, bytes]) -> None:
    assert refused(archive(entries)) == "io-archive-root"


def link(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name)
    info.create_system = 3
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return info


@pytest.mark.parametrize(
    "entries",
    [
        [("a.dae", DATA), ("../../evil", b"x")],
        [("a.dae", DATA), ("x/../../evil", b"x")],
        [("a.dae", DATA), ("..\\evil", b"x")],
        [("a.dae", DATA), ("/etc/evil", b"x")],
        [("a.dae", DATA), ("\\evil", b"x")],
        [("a.dae", DATA), ("C:\\evil", b"x")],
        [("a.dae", DATA), (link("b.dae"), b"/etc/passwd")],
        [("a.dae", DATA), ("inner.zip", b"x")],
        [("a.dae", DATA), ("inner.ZAE", b"x")],
        [("a.dae", DATA), ("a.dae", DATA)],
        [("a.dae", DATA), ("./a.dae", DATA)],
        [("a.dae", archive({"b.dae": DATA}))],
    ],
)
def test_unsafe_entries(entries: list[tuple[str | zipfile.ZipInfo, bytes]]) -> None:
    assert refused(archive(entries)) == "io-archive-unsafe"


def test_bombs() -> None:
    big = b"<COLLADA>" + b" " * 9_000_000 + b"</COLLADA>"
    bomb = archive({"a.dae": big})
    assert refused(bomb) == "io-archive-bomb"
    parse(bomb, Limits(archive_ratio=2000))
    assert refused(bomb, archive_ratio=2000, bytes=8_000_000) == "io-archive-bomb"
    assert refused(bomb, archive_ratio=2000, total=8_000_000) == "io-archive-bomb"
    many = archive({f"{i}.txt": b"" for i in range(20)} | {"a.dae": DATA})
    parse(many, Limits(archive_entries=21))
    assert refused(many, archive_entries=20) == "io-archive-bomb"


def test_a_size_that_lies() -> None:
    """The declared size is not believed: what streams out is counted."""
    data = bytearray(archive({"a.dae": b"<COLLADA>" + b" " * 9_000_000 + b"</COLLADA>"}))
    for magic, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        at = data.find(magic) + offset
        data[at : at + 4] = (100).to_bytes(4, "little")
    assert refused(bytes(data)) in {"io-archive-bomb", "io-archive-broken"}


def test_entries_share_the_total() -> None:
    data = archive({"a.dae": DATA, "b.png": b"x" * 50})
    parsed = parse(data, Limits(total=100))
    parsed.open_relative("b.png")
    with pytest.raises(InputError):
        parsed.open_relative("b.png")


def test_broken_archives() -> None:
    good = archive({"a.dae": DATA * 50})
    assert refused(good[:-30]) == "io-archive-broken"
    assert refused(b"PK\x03\x04" + b"\0" * 50) == "io-archive-broken"
    at = good.find(b"a.dae") + 12
    assert refused(good[:at] + bytes([good[at] ^ 0xFF]) + good[at + 1 :]) == "io-archive-broken"
    encrypted = bytearray(good)
    encrypted[encrypted.find(b"PK\x01\x02") + 8] |= 1
    assert refused(bytes(encrypted)) == "io-archive-broken"


@pytest.mark.parametrize("url", ["../x", "/x", "http://a/b", "sub/../../x"])
def test_references_out_of_the_archive(url: str) -> None:
    with pytest.raises(InputError) as caught:
        parse(archive({"a.dae": DATA})).open_relative(url)
    assert caught.value.findings[0].code == "io-reference-refused"


def test_packing_is_reproducible_and_reads_back(tmp_path: Path) -> None:
    data = pack(DATA, name="a b.dae", others={"z.png": b"z", "b.png": b"b"})
    assert data == pack(DATA, name="a b.dae", others={"b.png": b"b", "z.png": b"z"})
    parsed = parse(data)
    assert parsed.member == "a b.dae"
    assert parsed.open_relative("z.png").data == b"z"
    assert parsed.archive is not None
    assert parsed.archive.names == ("a b.dae", "b.png", "manifest.xml", "z.png")
    path = tmp_path / "x.zae"
    path.write_bytes(data)
    assert parse(path).file == f"{path}!a b.dae"
    with pytest.raises(ValueError, match="twice"):
        pack(DATA, others={"scene.dae": b""})


_GOOD = pack(DATA)


@given(st.integers(0, len(_GOOD) - 1), st.binary(min_size=1, max_size=6))
@settings(max_examples=200)
def test_damage_gives_a_tree_or_an_error_of_ours(at: int, junk: bytes) -> None:
    try:
        parse(_GOOD[:at] + junk + _GOOD[at + len(junk) :])
    except ColladaError as error:
        assert error.findings

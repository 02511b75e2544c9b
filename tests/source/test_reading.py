"""Where a document can come from, and which files it can reach."""

from __future__ import annotations

import io
import os
from pathlib import Path

import pytest

from colladaphy.errors import InputError, XmlError
from colladaphy.source import Limits, parse, parse_loaded

DATA = b"<COLLADA><a/></COLLADA>"


def refused(source: object, **limits: int) -> str:
    with pytest.raises(InputError) as caught:
        parse(source, Limits(**limits))  # type: ignore[arg-type]
    return caught.value.findings[0].code


@pytest.mark.parametrize(
    "name",
    ["a b.dae", "Größe 日本.dae", "-v.dae", "--help", "a#b?c%20.dae", "x\ny.dae", "none"],
)
def test_odd_file_names(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(DATA)
    assert parse(path).file == str(path)
    assert parse(str(path)).base == tmp_path
    with path.open("rb") as stream:
        assert parse(stream).base == tmp_path


def test_a_leading_dash_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("-x.dae").write_bytes(DATA)
    assert parse("-x.dae").file == "-x.dae"


def test_a_name_that_is_not_unicode(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/\xff.dae"
    try:
        Path(os.fsdecode(path)).write_bytes(DATA)
    except OSError:
        pytest.skip("the file system takes Unicode names only")
    parsed = parse(Path(os.fsdecode(path)))
    assert parsed.file is not None
    parsed.file.encode()
    assert parsed.file.endswith("\\xff.dae")


def test_bytes_and_file_objects() -> None:
    for source in (DATA, bytearray(DATA), memoryview(DATA), io.BytesIO(DATA)):
        parsed = parse(source)
        assert (parsed.file, parsed.base, parsed.member) == (None, None, None)


def test_what_cannot_be_read(tmp_path: Path) -> None:
    assert refused(tmp_path / "none.dae") == "io-missing"
    assert refused(tmp_path / "no" / "folder.dae") == "io-missing"
    assert refused(tmp_path) == "io-folder"
    assert refused("a\0b.dae") == "io-unreadable"
    assert refused("<COLLADA/>") == "io-missing"
    assert refused(io.StringIO("<COLLADA/>")) == "io-not-binary"
    closed = io.BytesIO(DATA)
    closed.close()
    assert refused(closed) == "io-unreadable"
    with pytest.raises(TypeError):
        parse(12)  # type: ignore[arg-type]


@pytest.mark.parametrize("part", [5, 1.5, [b"<"], object()])
def test_a_stream_that_gives_no_bytes(part: object) -> None:
    class Odd:
        def read(self, size: int = -1) -> object:
            return part

    assert refused(Odd()) == "io-unreadable"


def test_a_name_that_no_file_can_have() -> None:
    assert refused("half a pair \ud800.dae") == "io-unreadable"


def test_limits_that_are_none() -> None:
    with pytest.raises(InputError, match=r"colladaphy.Limits\(...\), not as 5"):
        parse(DATA, 5)  # type: ignore[arg-type]


def test_a_failing_disk() -> None:
    class Broken(io.RawIOBase):
        def read(self, size: int = -1) -> bytes:
            raise OSError(5, "Input/output error")

    assert refused(Broken()) == "io-unreadable"


def test_size_limit(tmp_path: Path) -> None:
    path = tmp_path / "a.dae"
    path.write_bytes(DATA)
    for source in (DATA, path, io.BytesIO(DATA)):
        assert refused(source, bytes=len(DATA) - 1) == "io-too-large"
    parse(path, Limits(bytes=len(DATA)))


def test_an_endless_stream_is_stopped() -> None:
    class Endless(io.RawIOBase):
        def read(self, size: int = -1) -> bytes:
            return b"<" * size

    assert refused(Endless(), bytes=1000) == "io-too-large"


def test_relative_files(tmp_path: Path) -> None:
    folder = tmp_path / "scene"
    (folder / "parts").mkdir(parents=True)
    (folder / "main.dae").write_bytes(DATA)
    (folder / "parts" / "a b.dae").write_bytes(b"<COLLADA><b/></COLLADA>")
    (folder / "image.png").write_bytes(b"png")
    parsed = parse(folder / "main.dae")
    assert parsed.open_relative("./image.png").data == b"png"
    other = parse_loaded(parsed.load_relative("parts/a%20b.dae#model"))
    assert other.tree.getroot()[0].tag == "b"
    assert other.open_relative("../image.png").data == b"png"
    assert other.open_relative(r"..\image.png").data == b"png"


@pytest.mark.parametrize(
    "url",
    [
        "http://example.org/a.dae",
        "https://example.org/a.dae",
        "file:///etc/passwd",
        "//host/share/a.dae",
        r"\\host\share\a.dae",
        r"C:\a.dae",
        "/etc/passwd",
        "%2Fetc%2Fpasswd",
        "../secret",
        "parts/../../secret",
        "%2e%2e/secret",
        "link",
        "linked/secret",
        "http://[",
        "a%00b",
        "#id",
        "",
        "parts",
    ],
)
def test_references_that_are_refused(tmp_path: Path, url: str) -> None:
    folder = tmp_path / "scene"
    (folder / "parts").mkdir(parents=True)
    (tmp_path / "secret").write_bytes(b"secret")
    (folder / "main.dae").write_bytes(DATA)
    (folder / "link").symlink_to(tmp_path / "secret")
    (folder / "linked").symlink_to(tmp_path)
    with pytest.raises(InputError) as caught:
        parse(folder / "main.dae").open_relative(url)
    assert caught.value.findings[0].code == "io-reference-refused"


def test_a_reference_to_nothing(tmp_path: Path) -> None:
    (tmp_path / "main.dae").write_bytes(DATA)
    with pytest.raises(InputError) as caught:
        parse(tmp_path / "main.dae").open_relative("none.dae")
    assert caught.value.findings[0].code == "io-reference-missing"
    with pytest.raises(InputError) as caught:
        parse(DATA).open_relative("none.dae")
    assert caught.value.findings[0].code == "io-reference-refused"


def test_files_of_one_document_share_a_budget(tmp_path: Path) -> None:
    (tmp_path / "main.dae").write_bytes(DATA)
    (tmp_path / "image.png").write_bytes(b"x" * 40)
    parsed = parse(tmp_path / "main.dae", Limits(total=100))
    parsed.open_relative("image.png")
    with pytest.raises(InputError) as caught:
        parsed.open_relative("image.png")
    assert caught.value.findings[0].code == "io-too-large"


def test_the_corpus_is_parsed(corpus_dir: Path) -> None:
    for path in sorted(corpus_dir.glob("*.dae")):
        if "hostile" in path.name:
            with pytest.raises(XmlError):
                parse(path)
        else:
            assert parse(path).tree.getroot().tag.endswith("}COLLADA")

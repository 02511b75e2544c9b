"""Saving is atomic, keeps permissions, and says what to do when it cannot be done."""

from __future__ import annotations

import errno
import io
import os
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from colladaphy.errors import OutputError
from colladaphy.source import save


def failure(target: object) -> str:
    with pytest.raises(OutputError) as caught:
        save(b"new", target)  # type: ignore[arg-type]
    (finding,) = caught.value.findings
    assert finding.code == "io-output-failed" and finding.hint
    return finding.message


@pytest.mark.parametrize("name", ["a.dae", "-a b ä.dae", "x" * 250])
def test_new_and_existing_files(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    save(b"old", path)
    save(b"new", str(path))
    assert path.read_bytes() == b"new"
    assert [entry.name for entry in tmp_path.iterdir()] == [name]


def test_permissions(tmp_path: Path) -> None:
    path = tmp_path / "a.dae"
    plain = tmp_path / "plain"
    plain.touch()
    save(b"old", path)
    assert path.stat().st_mode == plain.stat().st_mode
    path.chmod(0o640)
    save(b"new", path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    path = tmp_path / "link.dae"
    path.symlink_to(tmp_path / "real" / "a.dae")
    save(b"new", path)
    assert path.is_symlink()
    assert (tmp_path / "real" / "a.dae").read_bytes() == b"new"


def test_targets_that_cannot_be_written(tmp_path: Path) -> None:
    assert "folder does not exist" in failure(tmp_path / "none" / "a.dae")
    assert "is a folder" in failure(tmp_path)
    (tmp_path / "file").touch()
    assert "not a folder" in failure(tmp_path / "file" / "a.dae")
    assert "too long" in failure(tmp_path / ("x" * 300))
    failure("a\0b")


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (errno.ENOSPC, "disk is full"),
        (errno.EROFS, "read-only"),
        (errno.EACCES, "permission"),
        (errno.EIO, "Input/output"),
    ],
)
@pytest.mark.parametrize("step", ["open", "fsync", "replace"])
def test_an_error_at_any_step_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, text: str, step: str
) -> None:
    path = tmp_path / "a.dae"
    path.write_bytes(b"old")

    def fail(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    with monkeypatch.context() as patch:
        if step == "replace":
            patch.setattr(Path, "replace", fail)
        else:
            patch.setattr(os, step, fail)
        message = failure(path)
    assert text in message
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.dae"]


def test_an_interrupt_cleans_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", interrupt)
        with pytest.raises(KeyboardInterrupt):
            save(b"new", tmp_path / "a.dae")
    assert list(tmp_path.iterdir()) == []


def test_the_new_file_is_complete_before_it_takes_the_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.dae"
    path.write_bytes(b"old")
    steps: list[str] = []
    real_fsync, real_replace = os.fsync, Path.replace

    def fsync(descriptor: int) -> None:
        steps.append("fsync folder" if stat.S_ISDIR(os.fstat(descriptor).st_mode) else "fsync file")
        real_fsync(descriptor)

    def replace(source: Path, target: Path) -> Path:
        assert source.read_bytes() == b"new" and target.read_bytes() == b"old"
        assert source.parent == target.parent
        steps.append("replace")
        return real_replace(source, target)

    monkeypatch.setattr(os, "fsync", fsync)
    monkeypatch.setattr(Path, "replace", replace)
    save(b"new", path)
    assert steps == ["fsync file", "replace", "fsync folder"]


def test_file_objects() -> None:
    stream = io.BytesIO()
    save(b"new", stream)
    assert stream.getvalue() == b"new"
    failure(io.StringIO())
    stream.close()
    failure(stream)


def test_a_stream_that_takes_less_than_it_is_given() -> None:
    class Slow(io.RawIOBase):
        data = b""

        def write(self, data: object) -> int:
            self.data += bytes(data)[:1]  # type: ignore[call-overload]
            return 1

    slow = Slow()
    save(b"new", slow)
    assert slow.data == b"new"


def test_a_device(tmp_path: Path) -> None:
    save(b"new", "/dev/null")


def test_what_killed_writers_left_is_swept(tmp_path: Path) -> None:
    gone = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"],
                          capture_output=True, text=True, check=True).stdout.strip()  # fmt: skip
    ages = {
        f".colladaphy-{gone}-0123456789abcdef.tmp": 120,  # of a process that is no more
        f".colladaphy-{gone}-0123456789abcdee.tmp": 0,  # of another computer's, perhaps
        f".colladaphy-{os.getpid()}-0123456789abcdef.tmp": 120,  # is being written
        ".colladaphy-0123456789abcdef.tmp": 2 * 86400,
        "mine.tmp": 2 * 86400,
    }
    now = time.time()
    for name, age in ages.items():
        (tmp_path / name).write_bytes(b"half")
        os.utime(tmp_path / name, (now - age, now - age))
    save(b"new", tmp_path / "a.dae")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        ["a.dae", "mine.tmp", *list(ages)[1:3]]
    )


@pytest.mark.parametrize("target", [None, 5, b"a.dae", "half a pair \ud800.dae"])
def test_what_cannot_be_written_to(tmp_path: Path, target: object) -> None:
    if isinstance(target, str):
        target = str(tmp_path / target)
    with pytest.raises(OutputError, match="io-output-failed"):
        save(b"data", target)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []

"""Which documents arguments mean."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from colladaphy.validation.configuration import Configuration, Configurations
from colladaphy.validation.gathering import gather
from colladaphy.validation.patterns import Patterns


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("b.dae", "A.DAE", "c.txt", "sub/d.Zae", "sub/deep/e.dae", ".git/x.dae",
                 "node_modules/y.dae", "build/z.dae", "empty/none.txt", "odd[1].dae"):  # fmt: skip
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def files(*arguments: str, exclude: tuple[str, ...] = (), force: bool = False) -> list[str]:
    found = gather(arguments, Configurations(), Patterns.of(exclude), force_exclude=force)
    assert found.faults == []
    return [Path(name).as_posix() for name in found.files]


def test_folders_are_searched_through(tree: Path) -> None:
    everything = ["A.DAE", "b.dae", "odd[1].dae", "build/z.dae", "sub/d.Zae", "sub/deep/e.dae"]
    assert files(".") == everything
    assert files("sub") == ["sub/d.Zae", "sub/deep/e.dae"]
    assert files(str(tree)) == [f"{tree.as_posix()}/{name}" for name in everything]


def test_patterns(tree: Path) -> None:
    assert files("*.dae") == ["b.dae", "odd[1].dae"]
    assert files("**/deep/*", "build/**") == ["sub/deep/e.dae", "build/z.dae"]
    assert files("**/[bz].dae") == ["b.dae", "build/z.dae"]
    assert files("s?b") == ["sub/d.Zae", "sub/deep/e.dae"]
    # A file of that very name is no pattern.
    assert files("odd[1].dae") == ["odd[1].dae"]


def test_what_is_named_twice_is_checked_once(tree: Path) -> None:
    assert files("b.dae", "./b.dae", "-", str(tree / "b.dae"), "-") == ["b.dae", "-"]
    Path("link.dae").symlink_to("b.dae")
    assert files("link.dae", "b.dae") == ["link.dae"]


def test_names_are_taken_as_they_are(tree: Path) -> None:
    assert files("none.dae", "c.txt", "-") == ["none.dae", "c.txt", "-"]


def test_exclusion(tree: Path) -> None:
    assert files(".", exclude=("build", "/sub/deep/", "A.*", "odd*")) == ["b.dae", "sub/d.Zae"]
    assert files(".", exclude=("*", "!b.dae")) == ["b.dae"]
    assert files("build/z.dae", exclude=("build",)) == ["build/z.dae"]
    assert files("build/z.dae", "b.dae", exclude=("build",), force=True) == ["b.dae"]
    assert files("**/z.dae", "b.dae", exclude=("build",)) == ["b.dae"]


def test_the_configuration_excludes(tree: Path) -> None:
    (tree / "colladaphy.toml").write_text('exclude = ["build/", "sub"]')
    # Deeper files have a configuration of their own, which excludes nothing.
    (tree / "sub" / "deep" / "colladaphy.toml").touch()
    assert files(".") == ["A.DAE", "b.dae", "odd[1].dae", "sub/deep/e.dae"]
    found = gather(["."], Configurations(Configuration()))
    assert len(found.files) == 6


@pytest.mark.parametrize(
    ("argument", "code", "words"),
    [("empty", "io-folder", "no .dae or .zae"), ("x*.dae", "io-missing", "No file fits")],
)
def test_what_means_nothing(tree: Path, argument: str, code: str, words: str) -> None:
    (found,) = gather([argument], Configurations()).faults
    assert (found.code, found.file) == (code, argument)
    assert words in found.message


def test_folders_that_cannot_be_read(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = os.scandir

    def refusing(path: str) -> object:
        if str(path).endswith("deep"):
            raise PermissionError(13, "Permission denied", str(path))
        return real(path)

    monkeypatch.setattr(os, "scandir", refusing)
    found = gather(["sub"], Configurations())
    assert [fault.code for fault in found.faults] == ["io-unreadable"]
    assert found.files == [str(Path("sub") / "d.Zae")]

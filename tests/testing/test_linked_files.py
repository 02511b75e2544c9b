"""Documents in several files mean what they mean in one."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import given, settings
from tests.testing.collecting import drawn, smallest

import colladaphy
from colladaphy.testing import LinkedFiles, linked_files
from colladaphy.world import compare


@settings(max_examples=max(20, settings().max_examples // 2))
@given(files=linked_files())
def test_all_files_are_valid_and_mean_what_one_means(files: LinkedFiles) -> None:
    alone = colladaphy.read(files.alone).load()
    with TemporaryDirectory() as folder:
        path = files.save(Path(folder))
        assert compare(alone, colladaphy.read(path).load()) == []
        for name in files.files:
            report = colladaphy.validate(Path(folder, name))
            assert report.valid, (name, [str(finding) for finding in report])
    assert compare(alone, colladaphy.read(files.archive()).load()) == []


def test_files_lead_to_each_other() -> None:
    many = drawn(linked_files(), 100)
    assert max(len(files.files) for files in many) > 2
    assert any(b"main.dae#" in data for files in many for data in files.files.values())
    assert any(b"%20" in data for files in many for data in files.files.values())
    assert all(files.main == "main.dae" for files in many)
    for folder in ("geometries", "nodes", "physics_materials", "physics_models", "physics_scenes"):
        needle = f"<library_{folder}".encode()
        assert any(
            needle in data
            for files in many
            for name, data in files.files.items()
            if name != files.main
        )


def test_the_simplest_is_one_file() -> None:
    assert len(smallest(linked_files(), lambda files: True).files) == 1

"""Reading and writing: files, archives, streams; edits; nothing invalid is ever written."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from tests.mapper.documents import body, collada, instance, model, scene, simple

import colladaphy
from colladaphy.world import World, compare


def a_world() -> World:
    world = World(gravity=(0, 0, -9.81))
    world.create_sphere(1, (1, 2, 3), 0.5, "iron")
    return world


@pytest.mark.parametrize("name", ["a.dae", "a.zae", "b.DAE", "b.ZAE"])
def test_files_and_archives(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    colladaphy.write(a_world(), path)
    assert path.read_bytes().startswith(b"PK" if name.lower().endswith("zae") else b"<?xml")
    assert compare(a_world(), colladaphy.read(path).load()) == []
    assert colladaphy.validate(path).valid


def test_streams() -> None:
    stream = io.BytesIO()
    colladaphy.write(a_world(), stream)
    stream.seek(0)
    assert len(colladaphy.read(stream).load().bodies) == 1
    assert len(colladaphy.read(stream.getvalue()).load().bodies) == 1


def test_a_document_is_written_as_it_was_read(tmp_path: Path) -> None:
    data = simple(after="<extra><technique profile='x'><a/></technique></extra>")
    document = colladaphy.read(data)
    document.write(tmp_path / "a.dae")
    again = colladaphy.read(tmp_path / "a.dae")
    assert compare(document.load(), again.load()) == []
    assert b'profile="x"' in (tmp_path / "a.dae").read_bytes()


def test_edits_of_the_root_are_written(tmp_path: Path) -> None:
    document = colladaphy.read(simple())
    document.root.asset.title = "edited"
    document.write(tmp_path / "a.dae")
    assert b"<title>edited</title>" in (tmp_path / "a.dae").read_bytes()


def test_edits_of_the_root_are_loaded() -> None:
    document = colladaphy.read(simple())
    assert document.up_axis == "Z_UP"
    document.root.asset.title = "edited"
    assert "edited" in [element.text for element in document.tree.getroot().iter("{*}title")]
    assert len(document.load().bodies) == 1


def test_invalid_edits_are_not_written(tmp_path: Path) -> None:
    target = tmp_path / "a.dae"
    target.write_bytes(b"before")
    document = colladaphy.read(simple())
    root = document.tree.getroot()
    for shape in list(root.iter("{*}shape")):
        parent = shape.getparent()
        assert parent is not None
        parent.remove(shape)
    with pytest.raises(colladaphy.SchemaError):
        document.write(target)
    assert target.read_bytes() == b"before"


def test_strict_reading_raises_with_all_findings() -> None:
    data = simple().replace(b"<radius>1</radius>", b"<radius>one</radius>")
    data = data.replace(b"<mass>1</mass>", b"<mass>heavy</mass>")
    with pytest.raises(colladaphy.SchemaError) as caught:
        colladaphy.read(data)
    assert len(caught.value.findings) >= 2


def test_a_tolerant_document_reports_and_goes_on() -> None:
    data = simple().replace(b'target="#n"', b'target="#nowhere"')
    with pytest.raises(colladaphy.DocumentError):
        colladaphy.read(data).load()
    document = colladaphy.Document(colladaphy.read(data).tree, tolerant=True)
    assert len(document.load().bodies) == 0
    assert "link-missing" in [finding.code for finding in document.report]


def test_limits_are_respected() -> None:
    with pytest.raises(colladaphy.ColladaError):
        colladaphy.read(simple(), limits=colladaphy.Limits(elements=5))


def test_names_of_every_kind_survive(tmp_path: Path) -> None:
    world = a_world()
    for name in ('<&>"', "  two  blanks ", "\ttab\n\r", "é中😀", ""):
        world.create_sphere(1, (0, 0, 0), 1.0, "iron", name=name)
    world.name = " \n& "
    colladaphy.write(world, tmp_path / "a.dae")
    assert compare(world, colladaphy.read(tmp_path / "a.dae").load()) == []


def test_a_world_without_bodies(tmp_path: Path) -> None:
    colladaphy.write(World(), tmp_path / "a.dae")
    assert compare(World(), colladaphy.read(tmp_path / "a.dae").load()) == []


def test_scenes_of_a_document_without_any() -> None:
    data = collada(model(body()), scene(instance()), effects=())
    assert len(list(colladaphy.read(data).scenes)) == 1


def test_other_files_of_an_archive_are_kept(tmp_path: Path) -> None:
    from colladaphy.source import pack

    (tmp_path / "a.zae").write_bytes(
        pack(simple(), name="in/scene.dae", others={"in/picture.png": b"pixels", "note.txt": b"n"})
    )
    document = colladaphy.read(tmp_path / "a.zae")
    document.write(tmp_path / "b.zae")
    again = colladaphy.read(tmp_path / "b.zae")
    assert again.archive is not None
    assert again.archive.read("in/picture.png") == b"pixels"
    assert again.archive.read("note.txt") == b"n"
    assert again.archive.root() == "in/scene.dae"


def test_an_archive_of_any_name_stays_one(tmp_path: Path) -> None:
    from colladaphy.source import pack

    path = tmp_path / "archive.dae"
    path.write_bytes(pack(simple(), others={"picture.png": b"pixels"}))
    document = colladaphy.read(path)
    document.write(tmp_path / "plain.dae")
    assert colladaphy.read(tmp_path / "plain.dae").archive is None
    document.write(path)
    again = colladaphy.read(path)
    assert again.archive is not None and again.archive.read("picture.png") == b"pixels"
    with (tmp_path / "stream.zae").open("wb") as stream:
        document.write(stream)
    again = colladaphy.read(tmp_path / "stream.zae")
    assert again.archive is not None and again.archive.read("picture.png") == b"pixels"


def test_archives_can_be_written_often(tmp_path: Path) -> None:
    from colladaphy.source import pack

    others = {"noise.bin": bytes(range(256)) * 16}
    (tmp_path / "a.zae").write_bytes(pack(simple(), others=others))
    limits = colladaphy.Limits(total=3 * 4096)
    document = colladaphy.read(tmp_path / "a.zae", limits=limits)
    for _ in range(5):
        document.write(tmp_path / "b.zae")


def test_another_document_of_an_archive_keeps_its_name(tmp_path: Path) -> None:
    from colladaphy.source import pack

    root = simple().replace(b'url="#m"', b'url="b.dae#m"')
    (tmp_path / "a.zae").write_bytes(pack(root, name="a.dae", others={"b.dae": simple()}))
    document = colladaphy.read(tmp_path / "a.zae")
    related = document.resolve("b.dae#m", document.tree.getroot()).document
    related.root.asset.title = "related"
    related.write(tmp_path / "b.zae")
    again = colladaphy.read(tmp_path / "b.zae")
    assert again.member == "b.dae" and again.root.asset.title == "related"
    assert again.archive is not None and again.archive.read("a.dae") == root


def test_findings_are_logged_too(caplog: pytest.LogCaptureFixture) -> None:
    document = colladaphy.read(simple("<shape><sphere><radius>0</radius></sphere></shape>"))
    document.load()
    assert "load-empty-shape" in caplog.text


def test_nothing_is_printed_without_a_handler() -> None:
    import subprocess
    import sys

    data = simple("<shape><sphere><radius>0</radius></sphere></shape>")
    script = f"import colladaphy; colladaphy.read({data!r}).load()"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
    assert done.stderr == b""
    assert done.stdout == b""

"""A World becomes one more scene of a document, and everything else stays as it was."""

from __future__ import annotations

import io

import pytest
from hypothesis import given, settings
from lxml import etree
from tests.mapper.documents import simple

import colladaphy
from colladaphy.testing import worlds
from colladaphy.world import World, compare


def written(document: colladaphy.Document) -> bytes:
    """What is written of a document, whatever it means."""
    stream = io.BytesIO()
    document.write(stream, check=False)
    return stream.getvalue()


def a_document(world: World) -> colladaphy.Document:
    """A World as a document with a comment and foreign content."""
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    extra = b"<!--note--><extra><technique profile='x'><a/></technique></extra></COLLADA>"
    return colladaphy.read(stream.getvalue().replace(b"</COLLADA>", extra))


@settings(max_examples=20)
@given(worlds(min_bodies=0))
def test_both_scenes_are_as_they_were(world: World) -> None:
    document = a_document(world)
    before = etree.tostring(document.tree, method="c14n")
    document.add_scene(world, "again")
    document = colladaphy.read(written(document))
    assert [scene.id for scene in document.scenes.instantiated] == ["Scene1", "again"]
    assert compare(document.scenes["again"].load(), world) == []
    assert compare(document.scenes["Scene1"].load(), world) == []
    assert len(document.load().bodies) == 2 * len(world.bodies)
    root = document.tree.getroot()
    for element in list(root.iter(etree.Element)):
        reference = element.get("id") or element.get("url", "")
        parent = element.getparent()
        if parent is not None and reference.lstrip("#").startswith("again"):
            parent.remove(element)
    for library in list(root.iterchildren("{*}*")):
        if etree.QName(library).localname.startswith("library_") and not len(library):
            root.remove(library)
    tail = etree.tostring(root, method="c14n").split()
    assert tail == before.split()


def test_into_a_document_without_scene() -> None:
    data = simple()
    start, end = data.index(b"<scene>"), data.index(b"</scene>") + len(b"</scene>")
    document = colladaphy.read(data[:start] + data[end:])
    world = World(up_axis="Z_UP")
    world.create_sphere(1, (1, 2, 3), 0.5, "iron")
    document.root.asset.title = "edited"
    scene = document.add_scene(world, "new")
    assert scene.is_instantiated
    assert compare(scene.load(), world) == []
    assert document.root.asset.title == "edited"
    assert "s" in document.scenes


def test_what_cannot_be_added() -> None:
    document = colladaphy.read(simple())
    before = written(document)
    for id in ("s", "", "1a", "a b"):
        with pytest.raises(colladaphy.DocumentError):
            document.add_scene(World(), id)
    with pytest.raises(colladaphy.DocumentError, match="store-unit"):
        document.add_scene(World(unit=("inch", 0.0254)), "new")
    with pytest.raises(colladaphy.DocumentError, match="store-unit"):
        document.add_scene(World(up_axis="Y_UP"), "new")
    assert written(document) == before

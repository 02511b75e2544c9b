"""Long texts that are written in pieces, so that every reader takes them."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

import colladaphy
from colladaphy.conform.exporting import export
from colladaphy.source import splitting
from colladaphy.source.splitting import with_short_texts
from colladaphy.testing import worlds
from colladaphy.world import World, compare

_texts = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]) | st.just(" "))


@given(st.lists(st.tuples(_texts, _texts), max_size=5), st.integers(1, 40))
def test_the_texts_stay_what_they_are(texts: list[tuple[str, str]], longest: int) -> None:
    root = etree.Element("root")
    for attribute, text in texts:
        child = etree.SubElement(root, "child", value=attribute)
        child.text = text
        child.append(etree.Comment("x" * 50))
        child.tail = text
    data = etree.tostring(root, encoding="UTF-8", xml_declaration=True)
    made = with_short_texts(data, longest)
    again = etree.fromstring(made)
    for one, two in zip(root.iter("root", "child"), again.iter("root", "child"), strict=True):
        assert "".join(one.xpath("text()")) == "".join(two.xpath("text()"))
        assert dict(one.attrib) == dict(two.attrib)
    assert with_short_texts(data, len(data)) == data


def test_no_text_is_longer() -> None:
    data = b"<a>" + b" ".join(b"%d" % number for number in range(200_000)) + b"</a>"
    made = with_short_texts(data, 100_000)
    pieces = etree.fromstring(made).xpath("text()")
    assert max(map(len, pieces)) < 100_100
    assert len(pieces) > 10
    assert " ".join("".join(pieces).split()) == data[3:-4].decode()


@settings(max_examples=15, deadline=None)
@given(world=worlds())
def test_worlds_in_pieces_are_read_as_they_are(world: World) -> None:
    stream = io.BytesIO()
    colladaphy.write(world, stream)
    data = with_short_texts(stream.getvalue(), 25)
    for repair in (False, True):
        assert compare(world, colladaphy.read(data, repair=repair).load()) == []


def grid(count: int) -> World:
    """A mesh of a box whose faces have count² squares of two triangles."""
    world = World()
    line = np.linspace(-1.0, 1.0, count + 1) / 3.0
    first, second = (part.ravel() for part in np.meshgrid(line, line, indexing="ij"))
    corner = np.arange(count)[:, None] * (count + 1) + np.arange(count)
    squares = np.stack([corner, corner + count + 1, corner + count + 2, corner + 1], axis=-1)
    squares = squares.reshape(-1, 4)
    faces = np.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
    side = np.full_like(first, 1.0 / 3.0)
    points, triangles = [], []
    for axis in range(3):
        for sign in (1.0, -1.0):
            one = np.roll(np.stack([first, second, sign * side], axis=1), axis, axis=1)
            triangles.append((faces if sign > 0 else faces[:, ::-1]) + sum(map(len, points)))
            points.append(one)
    unique, where = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    world.create_mesh(1, (0, 0, 0), unique, where.reshape(-1)[np.concatenate(triangles)], "iron")
    return world


def test_a_large_mesh_is_read_under_the_usual_limits(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    world = grid(40)
    colladaphy.write(world, tmp_path / "mesh.dae")
    assert b"<!--" not in (tmp_path / "mesh.dae").read_bytes()
    tight = colladaphy.Limits(text=60_000)
    with pytest.raises(colladaphy.ColladaError):
        colladaphy.read(tmp_path / "mesh.dae", limits=tight)
    monkeypatch.setattr(splitting.with_short_texts, "__defaults__", (50_000,))
    colladaphy.write(world, tmp_path / "pieces.dae")
    read = colladaphy.read(tmp_path / "pieces.dae", limits=tight)
    assert compare(world, read.load()) == []
    read.root.asset.title = "edited"
    read.write(tmp_path / "edited.dae")
    again = colladaphy.read(tmp_path / "edited.dae", limits=tight)
    assert compare(world, again.load()) == []
    data, _ = export(again.tree, "bullet")
    saved = colladaphy.read(data, repair=True, limits=tight).load()
    assert np.array_equal(saved.bodies[0].mesh.vertices, world.bodies[0].mesh.vertices)

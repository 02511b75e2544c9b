"""Writing and reading Worlds in the tests of the thesis."""

from __future__ import annotations

import io

import colladaphy
from colladaphy.mapper import WriteOptions
from colladaphy.world import World

__all__ = ["document_of", "element_texts", "text_of"]


def text_of(world: World, **options: object) -> str:
    stream = io.BytesIO()
    colladaphy.write(world, stream, options=WriteOptions(**options))  # type: ignore[arg-type]
    return stream.getvalue().decode()


def document_of(world: World, **options: object) -> colladaphy.Document:
    return colladaphy.read(text_of(world, **options).encode())


def element_texts(document: colladaphy.Document, path: str) -> list[str]:
    """The texts of the elements on a path of COLLADA names, from anywhere."""
    steps = "/".join(f"{{*}}{name}" for name in path.split("/"))
    return [element.text or "" for element in document.tree.getroot().iterfind(f".//{steps}")]

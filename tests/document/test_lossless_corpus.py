"""Documents are carried through: read, edit one value, write, and only that value is another.

The oracle walks two canonical forms side by side and knows nothing of how a document is saved.
"""

from __future__ import annotations

import dataclasses
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from lxml import etree

import colladaphy
from colladaphy.document import Document
from colladaphy.testing import documents
from colladaphy_schema.physics import LibraryPhysicsModelsType

EXPECTED_FILES = 15
HEAD = b"<!-- before --><?before the root?><!--\n third -->"
TAIL = b"<!-- after --><?after the root?><!-- last -->"


def written(document: Document) -> bytes:
    """What is written of a document, whatever it means."""
    stream = io.BytesIO()
    document.write(stream, check=False)
    return stream.getvalue()


def canonical(tree: etree._ElementTree | bytes) -> bytes:
    """The canonical form, comments included."""
    if isinstance(tree, bytes):
        tree = etree.fromstring(tree).getroottree()
    return etree.tostring(tree, method="c14n", with_comments=True)


def around(root: etree._Element) -> list[etree._Element]:
    """Every node of a document, with those outside of the root."""
    before = list(root.itersiblings(preceding=True))
    return [*before[::-1], *root.iter(), *root.itersiblings()]


def differences(first: bytes, second: bytes) -> list[str]:
    """What differs between two canonical forms, one line for each text or attribute."""
    one, other = (around(etree.fromstring(data)) for data in (first, second))
    if [str(node.tag) for node in one] != [str(node.tag) for node in other]:
        return ["other nodes", "in another order"]
    found = []
    for old, new in zip(one, other, strict=True):
        if old.nsmap != new.nsmap:
            found.append(f"namespaces of {old.tag}: {old.nsmap}, {new.nsmap}")
        found += [
            f"{part} of {old.tag}: {getattr(new, part)!r}"
            for part in ("text", "tail")
            if getattr(old, part) != getattr(new, part)
        ]
        names = {*old.keys(), *new.keys()} if isinstance(old.tag, str) else set()
        found += [
            f"@{name} of {old.tag}: {new.get(name)!r}"
            for name in sorted(names)
            if old.get(name) != new.get(name)
        ]
    return found


def masses(root: Any) -> list[Any]:
    return [
        body.technique_common.mass
        for library in root.choice
        if isinstance(library, LibraryPhysicsModelsType)
        for model in library.physics_model
        for body in model.rigid_body
        if body.technique_common.mass is not None
    ]


def test_the_corpus_but_for_one_mass(corpus_dir: Path) -> None:
    readable = edited = 0
    for path in sorted(corpus_dir.glob("*.dae")):
        try:
            document = colladaphy.read(path, repair=True)
        except colladaphy.ColladaError:
            continue
        readable += 1
        before = written(document)
        assert canonical(before) == canonical(document.tree), path.name
        found = masses(document.root)
        assert written(document) == before, path.name
        for mass in found[len(found) // 2 :][:1]:
            mass.value += 1.5
            changes = differences(canonical(before), canonical(written(document)))
            assert len(changes) == 1, path.name
            assert changes[0].startswith("text of ") and "}mass: " in changes[0], path.name
            edited += 1
            mass.value -= 1.5
    assert readable >= EXPECTED_FILES and edited >= EXPECTED_FILES - 3


def test_comments_and_foreign_content_of_a_real_file(corpus_dir: Path) -> None:
    """A document's own remarks stay, in and around the root, when something else changes."""
    data = written(colladaphy.read(corpus_dir / "bullet-spherebox-b.dae", repair=True))
    start, end = data.index(b"<COLLADA"), data.rindex(b"</COLLADA>")
    extra = (
        b'<!-- inside --><extra><technique profile="mine" xmlns:m="urn:m">'
        b"<m:a m:b=' 1 '><!--x--><b xmlns=''/>tail</m:a><?mine too?></technique></extra>"
    )
    data = data[:start] + HEAD + data[start:end] + extra + b"</COLLADA>" + TAIL
    for repair in (False, True):
        document = colladaphy.read(data, repair=repair)
        assert canonical(written(document)) == canonical(data)
        masses(document.root)[0].value = 77.5
        once = written(document)
        assert differences(canonical(data), canonical(once)) == [
            "text of {http://www.collada.org/2008/03/COLLADASchema}mass: '77.5'"
        ]
        assert once.startswith(b"<?xml") and b"UTF-8" in once[:50]


def values(item: Any) -> Iterator[tuple[Any, Any, Any]]:
    """Every single number of dataclasses: who holds it, under which name or index, and it."""
    if dataclasses.is_dataclass(item):
        parts: Any = [(field.name, getattr(item, field.name)) for field in dataclasses.fields(item)]
    elif isinstance(item, list):
        parts = list(enumerate(item))
    else:
        return
    for key, value in parts:
        if isinstance(value, bool | int | float):
            yield item, key, value
        else:
            yield from values(value)


def another(value: Any) -> Any:
    if isinstance(value, bool):
        return not value
    return value + 1 if isinstance(value, int) else 0.125 if value != 0.125 else 0.25


@settings(max_examples=40)
@given(documents(), st.data())
def test_any_document_but_for_one_number(data: bytes, source: st.DataObject) -> None:
    start = data.index(b"<", data.index(b"?>"))
    data = data[:start] + HEAD + data[start:].rstrip() + TAIL
    document = colladaphy.read(data)
    assert canonical(written(document)) == canonical(data)
    found = list(values(document.root))
    assert canonical(written(document)) == canonical(data)
    assume(found)
    holder, key, value = source.draw(st.sampled_from(found))
    if isinstance(holder, list):
        holder[key] = another(value)
    else:
        setattr(holder, key, another(value))
    try:
        changes = differences(canonical(data), canonical(written(document)))
    except colladaphy.SchemaError:
        assume(False)  # the schema has limits for some numbers
    assert len(changes) == 1, changes


@pytest.mark.parametrize("repair", [False, True])
def test_what_stands_around_the_root_keeps_its_order(repair: bool) -> None:
    data = next(iter(colladaphy.testing.covering_documents()))
    start = data.index(b"<", data.index(b"?>"))
    data = data[:start] + HEAD + data[start:].rstrip() + TAIL
    document = colladaphy.read(data, repair=repair)
    document.root.asset.title = "edited"
    nodes = [str(node) for node in around(document.tree.getroot()) if node.getparent() is None]
    assert len(nodes) == 7
    assert differences(canonical(data), canonical(written(document)))
    text = written(document)
    assert text.index(b"before -->") < text.index(b"third") < text.index(b"COLLADA")
    assert text.index(b"after -->") < text.index(b"?after") < text.index(b"last -->")

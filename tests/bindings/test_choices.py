"""Names for what stands in a choice: they say what the list or value says, and no more."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from lxml import etree
from mypy import api

from colladaphy.testing import covering_documents, documents
from colladaphy_schema import BoxType, RigidBodyTypeTechniqueCommonShape, SphereType, TranslateType
from colladaphy_schema.choices import Every, One
from colladaphy_schema.codec import decode_document
from colladaphy_schema.nodes import AnyElement

USER = """
from typing import assert_type

from colladaphy_schema import (
    BoxType, Collada, LibraryPhysicsModelsType, RigidBodyTypeTechniqueCommonShape, RotateType
)

shape = RigidBodyTypeTechniqueCommonShape()
assert_type(shape.box, BoxType | None)
shape.box = BoxType(half_extents=[1.0, 2.0, 3.0])
assert_type(shape.rotate, tuple[RotateType, ...])


def models(root: Collada) -> int:
    assert_type(root.library_physics_models, tuple[LibraryPhysicsModelsType, ...])
    return sum(len(library.physics_model) for library in root.library_physics_models)
"""


def _objects(item: Any) -> Iterator[Any]:
    if is_dataclass(item) and not isinstance(item, type):
        yield item
        for field in fields(item):
            value = getattr(item, field.name)
            for child in value if isinstance(value, list) else (value,):
                yield from _objects(child)


def _named(kind: type) -> dict[str, Any]:
    return {
        name: entry
        for base in reversed(kind.__mro__)
        for name, entry in vars(base).items()
        if isinstance(entry, One | Every)
    }


def _check(item: Any) -> int:
    """The objects in the choices of an object are those that its names lead to."""
    names = _named(type(item))
    choices = [field for field in fields(item) if len(field.metadata.get("choices", ())) > 1]
    held = [
        id(value)
        for field in choices
        for entry in [getattr(item, field.name)]
        for value in (entry if isinstance(entry, list) else [entry])
        if is_dataclass(value) and not isinstance(value, AnyElement)
    ]
    found = []
    for name in names:
        value = getattr(item, name)
        found += [id(each) for each in (value if isinstance(value, tuple) else (value,))
                  if each is not None]  # fmt: skip
    assert Counter(found) == Counter(held)
    return len(held)


def test_every_choice_of_the_schema_is_reached_by_name() -> None:
    checked = sum(
        _check(item)
        for document in covering_documents()
        for item in _objects(decode_document(etree.fromstring(document)))
    )
    assert checked > 1000


@given(document=documents(size=30, xsi_types=True))
def test_generated_documents(document: bytes) -> None:
    for item in _objects(decode_document(etree.fromstring(document))):
        _check(item)


def test_what_is_set_replaces_what_is_there() -> None:
    shape = RigidBodyTypeTechniqueCommonShape()
    assert shape.box is None and shape.sphere is None
    shape.box = box = BoxType(half_extents=[1, 2, 3])
    assert shape.choice is box and shape.box is box
    shape.sphere = SphereType(radius=1)
    assert shape.box is None and shape.choice == SphereType(radius=1)
    shape.box = None
    assert shape.sphere == SphereType(radius=1)
    shape.sphere = None
    assert shape.choice is None
    with pytest.raises(TypeError, match="BoxType"):
        shape.box = SphereType(radius=1)  # type: ignore[assignment]


def test_lists_are_changed_themselves() -> None:
    shape = RigidBodyTypeTechniqueCommonShape()
    shape.translate_or_rotate.append(TranslateType(value=[1, 2, 3]))
    assert [step.value for step in shape.translate] == [[1, 2, 3]]
    assert shape.rotate == ()
    with pytest.raises(AttributeError, match="translate_or_rotate"):
        shape.translate = ()  # type: ignore[assignment]


def test_type_checkers_know_them(tmp_path: Path) -> None:
    user = tmp_path / "user.py"
    user.write_text(USER)
    config = tmp_path / "mypy.ini"
    config.write_text("[mypy]\nstrict = true\n")
    out, error, code = api.run([str(user), "--config-file", str(config)])
    assert code == 0, out + error

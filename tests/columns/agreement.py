"""Compares columns with the objects of the same document, field by field."""

from __future__ import annotations

import dataclasses
import math
import struct
from enum import Enum
from typing import Any, ForwardRef, get_args

import numpy as np
from xsdata.models.datatype import XmlDateTime

from colladaphy_schema.nodes import AnyElement
from colladaphy_schema.rows import Child, Column, Lists, Masked, Rows

XML = "http://www.w3.org/XML/1998/namespace"


def assert_agree(rows: Rows, objects: list[Any], path: str = "") -> None:
    """Everything that the rows say, and nothing else of what they can say, is in the objects."""
    assert len(rows) == len(objects), path
    fields = rows.FIELDS
    for field in fields:
        here = f"{path}/{field.name}"
        if isinstance(field, Column):
            assert_column(rows, field, objects, here)
        else:
            assert_children(rows, field, objects, here)
    groups = {field.group for field in fields if field.group}
    for number in groups:
        assert_order(rows, [field for field in fields if field.group == number], objects, path)


def contents(item: Any) -> dict[str, list[Any]]:
    """Everything in an object by the name of the attribute or element; "" for the text."""
    found: dict[str, list[Any]] = {}
    for tag, value in sequence(item):
        found.setdefault(tag, []).append(value)
    return found


def sequence(item: Any) -> list[tuple[str, Any]]:
    """The same in the order of the object's fields."""
    if isinstance(item, AnyElement):
        return [("", item)]
    found: list[tuple[str, Any]] = []
    for field in dataclasses.fields(item):
        value = getattr(item, field.name)
        kind = field.metadata.get("type")
        name = field.metadata.get("name", field.name)
        home = getattr(getattr(item, "Meta", None), "namespace", "")
        space = field.metadata.get("namespace", "" if kind == "Attribute" else home)
        tokens = field.metadata.get("tokens", False)
        if kind is None:
            found.append(("", value))
        elif kind == "Attribute":
            found.append((f"xml:{name}" if space == XML else name, value))
        elif kind == "Element":
            many = str(field.type).startswith("list[list[" if tokens else "list[")
            values = value if many else [] if value is None else [value]
            found += [(f"{{{space}}}{name}", one) for one in values]
        elif kind == "Elements":
            several = str(field.type).startswith("list[")
            values = value if several else [] if value is None else [value]
            found += [(branch_of(one, field.metadata["choices"], home), one) for one in values]
        elif kind == "Wildcard":
            for one in value if isinstance(value, list) else [value]:
                if dataclasses.is_dataclass(one) and hasattr(type(one), "Meta"):
                    meta = type(one).Meta
                    found.append((f"{{{meta.namespace}}}{meta.name}", one))
    return found


def branch_of(value: Any, choices: tuple[dict[str, Any], ...], home: str) -> str:
    for choice in choices:
        kind = choice["type"]
        names = {name_of(part) for part in (kind, *get_args(kind))}
        if isinstance(value, AnyElement) and "object" in names:
            return f"{{{choice.get('namespace', home)}}}{choice['name']}"
        kinds = type(value).__mro__[:-1] if dataclasses.is_dataclass(value) else (type(value),)
        if any(cls.__name__ in names for cls in kinds):
            return f"{{{choice.get('namespace', home)}}}{choice['name']}"
    raise AssertionError(f"{value!r} is none of {choices}")


def name_of(kind: Any) -> str:
    if isinstance(kind, ForwardRef):
        return kind.__forward_arg__
    return getattr(kind, "__name__", str(kind))


def plain_value(value: Any) -> Any:
    """A value of an object as columns have it."""
    if isinstance(value, Enum):
        return plain_value(value.value)
    if isinstance(value, list | tuple):
        return [plain_value(one) for one in value]
    if isinstance(value, float):
        return "nan" if math.isnan(value) else struct.pack(">d", value)
    if isinstance(value, AnyElement):
        return value.text or ""
    return value


def column_values(rows: Rows, column: Column[Any]) -> list[Any]:
    """The values of a column as Python's own, None where there are none."""
    found = getattr(rows, column.name)
    present = [True] * len(rows)
    if isinstance(found, Masked):
        assert column.optional
        present, found = found.present.tolist(), found.values
    elif isinstance(found, Lists):
        if found.present is not None:
            present = found.present.tolist()
        found = [found[row] for row in range(len(found))]
    elif isinstance(found, np.ndarray):
        assert not (column.optional and column.default is None)
    assert len(found) == len(rows)
    values = [one.tolist() if isinstance(one, np.ndarray | np.generic) else one for one in found]
    return [one if there else None for one, there in zip(values, present, strict=True)]


def assert_column(rows: Rows, column: Column[Any], objects: list[Any], path: str) -> None:
    found = column_values(rows, column)
    for row, (item, actual) in enumerate(zip(objects, found, strict=True)):
        said = contents(item) if dataclasses.is_dataclass(item) else {"": [item]}
        expected = said.get(column.tag, [None])
        assert len(expected) == 1, path
        wanted = expected[0]
        if wanted == [] and actual is None:
            continue
        assert same(wanted, actual, column.kind), f"{path} [{row}]: {wanted!r} is not {actual!r}"


def same(wanted: Any, actual: Any, kind: str) -> bool:
    if isinstance(wanted, Enum):
        wanted = wanted.value
    if isinstance(wanted, AnyElement):
        wanted = wanted.text or ""
    if wanted is None or actual is None:
        return wanted is actual
    if isinstance(wanted, XmlDateTime):
        return XmlDateTime.from_string(actual) == wanted
    if isinstance(wanted, list | tuple):
        return len(wanted) == len(actual) and all(
            same(one, other, kind) for one, other in zip(wanted, actual, strict=True)
        )
    if isinstance(wanted, bytes):
        import base64

        return wanted == (bytes.fromhex(actual) if kind == "hex" else base64.b64decode(actual))
    return type(plain_value(wanted)) is type(plain_value(actual)) and plain_value(
        wanted
    ) == plain_value(actual)


def assert_children(rows: Rows, child: Child[Any], objects: list[Any], path: str) -> None:
    found = getattr(rows, child.name)
    assert isinstance(found, child.type)
    owner: list[int] = []
    inside: list[Any] = []
    for row, item in enumerate(objects):
        here = contents(item).get(child.tag, [])
        owner += [row] * len(here)
        inside += here
    assert found.owner.tolist() == owner, path
    assert found.owners == len(rows), path
    assert found.is_whole == (owner == list(range(len(rows)))), path
    if len(found):
        assert_agree(found, inside, path)


def assert_order(rows: Rows, fields: list[Any], objects: list[Any], path: str) -> None:
    """Where several kinds of children alternate, their numbers tell how."""
    tags = {field.tag for field in fields}
    placed: list[list[tuple[int, str]]] = [[] for _ in objects]
    for field in fields:
        if not isinstance(field, Child):
            continue
        found = getattr(rows, field.name)
        assert found.order is not None
        for owner, number in zip(found.owner.tolist(), found.order.tolist(), strict=True):
            placed[owner].append((number, field.tag))
    if not all(isinstance(field, Child) for field in fields):
        return
    for item, numbers in zip(objects, placed, strict=True):
        assert [tag for _, tag in sorted(numbers)] == [
            tag for tag, _ in sequence(item) if tag in tags
        ], path

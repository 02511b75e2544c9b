"""Writing columns: rows made by hand, or read, as a document in the order of the schema.

The rows of a whole document are turned into one template a kind. What all rows have exactly one of
becomes a part of the template around it, so that a record of a few dozen elements is one flat list
of literals and texts.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.cells import Cells, cells
from colladaphy.columns.pieces import Kind, Part, Repeated, Slot, Spread, Template, in_turn
from colladaphy.errors import SchemaError
from colladaphy_schema.rows import Child, Column, Rows

__all__ = ["document_bytes", "document_chunks"]

Array = NDArray[Any]
Parts = list[str | Part]

_COLLADA = "http://www.collada.org/2008/03/COLLADASchema"
_PREFIXES = {
    _COLLADA: "",
    "urn:colladaphy:pe:1": "pe",
    "http://www.w3.org/1998/Math/MathML": "mml",
}
_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
# Elements whose children have a line each, beside the libraries.
_LINED = {
    "COLLADA", "asset", "scene", "physics_model", "physics_scene", "instance_physics_model",
    "visual_scene", "kinematics_scene",
}  # fmt: skip


def document_bytes(root: Rows) -> bytes:
    """A document (UTF-8) of `ColladaRows` of one row.

    SchemaError where a column or a child is missing that the schema asks for, or does not fit.
    """
    # What is written grows in place, so that the text is in memory once.
    target = BytesIO()
    target.writelines(document_chunks(root))
    return target.getvalue()


def document_chunks(root: Rows) -> Iterator[bytes]:
    """The same in pieces of some hundred kilobytes; all of it is checked before the first one."""
    if len(root) != 1:
        raise SchemaError(f"a document has one root: these are {len(root)} {type(root).__name__}")
    template = Template(_element(root, f"{{{_COLLADA}}}COLLADA", "", _HEAD), 1)
    return _encoded(template)


def _encoded(template: Template) -> Iterator[bytes]:
    for text in template.stream(0, 1):
        yield text.encode()
    yield b"\n"


class _Content:
    """The content of elements: its parts, and which rows have any."""

    def __init__(self, count: int) -> None:
        self.parts: Parts = []
        self._there: Array | None = np.zeros(count, np.bool_)

    def add(self, parts: Parts, there: Array | None = None) -> None:
        """Add what the rows `there` have; None for all of them."""
        self.parts += parts
        if there is None:
            self._there = None
        elif self._there is not None:
            self._there[there] = True

    def closed(self, name: str, line: str) -> Parts:
        """With the ends of the start tag and of the element."""
        end = f"{line}</{name}>"
        there = self._there
        if there is None or (len(there) and bool(there.all())):
            return [">", *self.parts, end]
        if not there.any():
            return ["/>"]
        return [_either(there, "/>", ">"), *self.parts, _either(there, "", end)]


def _either(there: Array, without: str, with_any: str) -> Slot:
    table = np.array([without, with_any], dtype=object)
    places = there.astype(np.int8)
    return Slot(lambda begin, end: table[places[begin:end]].tolist())


def _element(rows: Rows, tag: str, around: str, before: str) -> Parts:
    """The parts of elements of a name within the namespace of their parents."""
    name, uri, declared = _name(tag, around)
    local = name.rpartition(":")[2]
    line = "\n" if local in _LINED or local.startswith("library_") else ""
    parts: Parts = [f"{before}<{name}{declared}"]
    content = _Content(len(rows))
    for _, fields in groupby(type(rows).FIELDS, key=_grouping):
        group = list(fields)
        field = group[0]
        if field.group:
            _choice(rows, group, uri, line, content)
        elif isinstance(field, Child):
            _choice(rows, [field], uri, line, content)
        elif field.form == "attribute":
            parts += _attribute(rows, field)
        elif field.form == "text":
            found = cells(rows, field)
            content.add([""] if found is None else [found.part])
        else:
            _choice(rows, [field], uri, line, content)
    return [*parts, *content.closed(name, line)]


def _grouping(field: Column[Any] | Child[Any]) -> object:
    return field.group or field.name


def _name(tag: str, around: str) -> tuple[str, str, str]:
    """A name as it is written, its namespace, and a declaration of that if it is new here."""
    uri, _, local = tag[1:].partition("}")
    prefix = _PREFIXES[uri]
    if uri == around or (not prefix and around):
        declared = ""
    else:
        declared = f' xmlns{":" if prefix else ""}{prefix}="{uri}"'
    return (f"{prefix}:{local}" if prefix else local), uri, declared


def _attribute(rows: Rows, column: Column[Any]) -> Parts:
    found = cells(rows, column)
    if found is None:
        return []
    parts: Parts = [f' {column.tag}="', found.part, '"']
    if found.there is None:
        return parts
    return [Spread(len(rows), [(Template(parts, len(found.there)), found.there)])]


def _choice(
    rows: Rows, group: list[Column[Any] | Child[Any]], uri: str, line: str, content: _Content
) -> None:
    """Add the elements of a field, or the alternatives of a choice."""
    many = any(isinstance(field, Child) and field.many for field in group)
    kinds: list[Kind] = []
    for field in group:
        if isinstance(field, Child):
            found = _children(rows, field, uri, line)
        else:
            found = _simple(rows, field, uri, line)
        if found is None:
            continue
        parts, owner, order = found
        if owner is None and len(group) == 1:
            content.add(parts)
            return
        count = len(rows) if owner is None else len(owner)
        there = np.arange(count) if owner is None else owner
        kinds.append((Template(parts, count), there, order))
    if not kinds:
        return
    turns = in_turn(kinds, len(rows)) if many or len(kinds) == 1 else None
    everything = np.concatenate([owner for _, owner, _ in kinds])
    if turns is not None:
        for kind in turns:
            if len(kind[1]) == len(rows) and _is_each(kind[1]):
                content.add(list(kind[0].parts))
            else:
                part = Repeated(len(rows), [kind]) if many else Spread(len(rows), [kind[:2]])
                content.add([part], kind[1])
    elif many:
        content.add([Repeated(len(rows), kinds)], everything)
    else:
        counts = np.bincount(everything, minlength=len(rows))
        if counts.max() > 1:
            names = ", ".join(field.name for field in group)
            raise SchemaError(
                f"{type(rows).__name__}, row {int(np.argmax(counts > 1))}: more than one of "
                f"{names}, where the schema allows one"
            )
        content.add([Spread(len(rows), [kind[:2] for kind in kinds])], everything)


def _is_each(owner: Array) -> bool:
    return bool(np.array_equal(owner, np.arange(len(owner))))


def _simple(
    rows: Rows, column: Column[Any], uri: str, line: str
) -> tuple[Parts, Array | None, None] | None:
    """Elements that have nothing but a text."""
    found: Cells | None = cells(rows, column)
    if found is None:
        return None
    name, _, declared = _name(column.tag, uri)
    return [f"{line}<{name}{declared}>", found.part, f"</{name}>"], found.there, None


def _children(
    rows: Rows, child: Child[Any], uri: str, line: str
) -> tuple[Parts, Array | None, Array | None] | None:
    """The elements of a name in all rows, the row of each (None: each has one), their order."""
    found: Rows = getattr(rows, child.name)
    place = f"{type(rows).__name__}.{child.name}"
    if not isinstance(found, child.type):
        raise SchemaError(f"{place} is a {type(found).__name__}: it needs {child.type.__name__}")
    owner = None if found.is_whole and len(found) == len(rows) else found.owner
    if owner is not None:
        _check_owners(place, owner, len(rows), len(found))
        if not child.many and len(owner) and bool((owner[1:] == owner[:-1]).any()):
            row = int(owner[:-1][owner[1:] == owner[:-1]][0])
            raise SchemaError(f"{place}: row {row} has more than one, where the schema allows one")
    required = not (child.many or child.optional)
    if owner is not None and required and len(owner) < len(rows):
        row = int(np.flatnonzero(np.bincount(owner, minlength=len(rows)) == 0)[0])
        raise SchemaError(f"{place} is missing in row {row}: the schema asks for one in each")
    if not len(found):
        return None
    return _element(found, child.tag, uri, line), owner, _order(place, found)


def _check_owners(place: str, owner: Array, parents: int, count: int) -> None:
    if len(owner) != count:
        raise SchemaError(f"{place} has {len(owner)} owners for {count} rows: give one for each")
    if count and (owner.min() < 0 or owner.max() >= parents):
        raise SchemaError(f"{place} has owners beyond the {parents} rows of its parent")
    if bool((owner[1:] < owner[:-1]).any()):
        raise SchemaError(f"{place} has owners that descend: sort its rows by `owner`")


def _order(place: str, rows: Rows) -> Array | None:
    if rows.order is not None and len(rows.order) != len(rows):
        raise SchemaError(f"{place} has {len(rows.order)} numbers of order for {len(rows)} rows")
    return rows.order

"""The values behind inputs: how many in an item, numbers or names (COLLADA 1.5 §input).

Rules about the values themselves look only at those that are of the kind that is needed.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from typing import NamedTuple

from colladaphy.findings import Severity
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.arrays import NUMBER_ARRAYS, TOKEN_ARRAYS, params_of, sources_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.inputs import PRIMITIVES, inputs_of, needed_by

__all__ = ["CHECKS", "meant_by", "unfit_inputs"]


class _Need(NamedTuple):
    """What a semantic needs; any number of values where `widths` is empty."""

    widths: tuple[int, ...]
    numbers: bool = True


_MESH = {
    "POSITION": _Need((3, 4)),
    "NORMAL": _Need((3,)),
    "TANGENT": _Need((3, 4)),
    "BINORMAL": _Need((3,)),
    "TEXTANGENT": _Need((3, 4)),
    "TEXBINORMAL": _Need((3,)),
    "TEXCOORD": _Need((1, 2, 3, 4)),
    "COLOR": _Need((3, 4)),
}
_STANDARD = ("VERTEX", "UV", *_MESH)
_NEEDS: dict[str, dict[str, _Need]] = {
    **dict.fromkeys((*PRIMITIVES, "vertices"), _MESH),
    "joints": {"JOINT": _Need((1,), numbers=False), "INV_BIND_MATRIX": _Need((16,))},
    "vertex_weights": {"JOINT": _Need((1,), numbers=False), "WEIGHT": _Need((1,))},
    "targets": {"MORPH_TARGET": _Need((1,), numbers=False), "MORPH_WEIGHT": _Need((1,))},
    "sampler": {
        "INPUT": _Need((1,)),
        "OUTPUT": _Need(()),
        "IN_TANGENT": _Need(()),
        "OUT_TANGENT": _Need(()),
        "INTERPOLATION": _Need((1,), numbers=False),
    },
}


def unfit_inputs(context: Context) -> dict[int, str]:
    """The rows of inputs whose values are of another kind than they need, with why."""
    return context.shared(_unfit)


def _unfit(context: Context) -> dict[int, str]:
    inputs, table = inputs_of(context), sources_of(context)
    params = params_of(context)
    found: dict[int, str] = {}
    owners: dict[int, dict[str, _Need]] = {}
    for row, owner in enumerate(inputs.owners.tolist()):
        source = int(inputs.sources[row])
        if source < 0:
            continue
        if owner not in owners:
            owners[owner] = _NEEDS.get(context.name(owner), {})
        semantic = inputs.semantics[row]
        need = owners[owner].get(semantic)
        accessor, array = int(table.accessors[source]), int(table.arrays[source])
        if need is None or accessor < 0 or array < 0:
            continue
        kind = context.name(array)
        if kind in (TOKEN_ARRAYS if need.numbers else NUMBER_ARRAYS):
            wanted = "numbers" if need.numbers else "names"
            found[row] = f"{semantic} needs {wanted}, but its values are in a <{kind}>."
            continue
        width = params.width(accessor, int(table.steps[source]))
        if need.widths and width not in need.widths:
            wanted = " or ".join(map(str, need.widths))
            found[row] = f"{semantic} needs {wanted} values in an item, but there are {width}."
    return found


def semantics(context: Context) -> Iterator[Hit]:
    """Inputs whose values are of another kind."""
    inputs, table = inputs_of(context), sources_of(context)
    told: set[tuple[int, str]] = set()
    for row, message in unfit_inputs(context).items():
        semantic = inputs.semantics[row]
        key = (int(inputs.sources[row]), semantic)
        if key in told:
            continue
        told.add(key)
        grave = semantic in ("POSITION", "JOINT", "WEIGHT", "INV_BIND_MATRIX", "INPUT", "OUTPUT")
        yield Hit(geometry_rules.INPUT_VALUES, int(inputs.elements[row]), message,
                  (int(table.accessors[inputs.sources[row]]),), "source",
                  Severity.ERROR if grave else Severity.WARNING)  # fmt: skip


def readable(context: Context) -> Iterator[Hit]:
    """Sources that inputs lead to, and that say nothing of how to read them."""
    inputs, table = inputs_of(context), sources_of(context)
    told: set[int] = set()
    for row, source in enumerate(inputs.sources.tolist()):
        if source >= 0 and table.accessors[source] < 0 and source not in told:
            told.add(source)
            element = int(table.elements[source])
            message = f"{context.label(element)} has no <accessor>, and an input leads to it."
            yield Hit(geometry_rules.ACCESSOR_MISSING, element, message,
                      (int(inputs.elements[row]),))  # fmt: skip


def spellings(context: Context) -> Iterator[Hit]:
    """Semantics that are misspelled; a program may have others of its own."""
    inputs = inputs_of(context)
    meant = {name: meant_by(name) for name in set(inputs.semantics)}
    for row, semantic in enumerate(inputs.semantics):
        name, owner = meant[semantic], int(inputs.owners[row])
        # That an element lacks what it needs is told there.
        kind = context.name(owner)
        if name is None or name in needed_by(kind) or kind not in (*PRIMITIVES, "vertices"):
            continue
        message = f"There is no semantic {semantic!r} in the standard, but there is {name!r}."
        yield Hit(geometry_rules.SEMANTIC, int(inputs.elements[row]), message, (owner,), "semantic",
                  hint=f"Write {name!r}.")  # fmt: skip


def meant_by(semantic: str) -> str | None:
    """The semantic of the standard that one is a misspelling of; None for others."""
    if semantic in _STANDARD:
        return None
    plain = semantic.upper().replace("_", "")
    for name in _STANDARD:
        if plain in (name, f"{name}S"):
            return name
    # What only adds to one is another: COLOR2, POSITIONT.
    if semantic.startswith(_STANDARD):
        return None
    close = get_close_matches(semantic, _STANDARD, 1, 0.85)
    return close[0] if close else None


def vertices(context: Context) -> Iterator[Hit]:
    """Vertices with more positions than normals, or the other way round."""
    inputs, table = inputs_of(context), sources_of(context)
    for element in context.ordinals("vertices", "control_vertices").tolist():
        first = inputs.named(element, "POSITION")
        count = None if first < 0 else inputs.count(first)
        for row in inputs.of(element):
            other = inputs.count(row)
            if row == first or count is None or other is None or other == count:
                continue
            if short := inputs.short(row, count) or inputs.short(first, other):
                yield short
                continue
            message = f"There are {count} positions, but {other} values of {inputs.semantics[row]}."
            yield Hit(geometry_rules.VERTEX_COUNT, int(inputs.elements[row]), message,
                      (int(table.accessors[inputs.sources[row]]),), "source")  # fmt: skip


def names(context: Context) -> Iterator[Hit]:
    """Parameters of one accessor that have the same name.

    Tangents have X and Y for each dimension of what they are the tangents of.
    """
    inputs, table = inputs_of(context), sources_of(context)
    tangents = [row for row, semantic in enumerate(inputs.semantics)
                if semantic.endswith("_TANGENT") and inputs.sources[row] >= 0]  # fmt: skip
    several = set(table.accessors[inputs.sources[tangents]].tolist()) if tangents else set()
    for accessor, each in params_of(context).each():
        if accessor in several:
            continue
        seen: dict[str, int] = {}
        for name, _, element in each:
            first = seen.setdefault(name, element)
            if name and first != element:
                message = f"Another parameter of the accessor is named {name!r}."
                yield Hit(geometry_rules.PARAM_TWICE, element, message, (first,), "name")


CHECKS = (semantics, spellings, readable, vertices, names)

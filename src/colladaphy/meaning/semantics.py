"""The values behind inputs: how many in an item, numbers or names (COLLADA 1.5 §input).

Rules about the values themselves look only at those that are of the kind that is needed.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct, numbered
from colladaphy.findings import Severity
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.array_table import NUMBER_ARRAYS, TOKEN_ARRAYS, accessors_of
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.inputs import PRIMITIVES, inputs_of, needed_by
from colladaphy.meaning.source_table import sources_of

__all__ = ["CHECKS", "meant_by", "unfit_inputs"]

Array = NDArray[Any]


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
_WHOLE = ("int_array", "bool_array")
_GRAVE = ("POSITION", "JOINT", "WEIGHT", "INV_BIND_MATRIX", "INPUT", "OUTPUT")
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
    rows = np.flatnonzero((inputs.sources >= 0) & (inputs.kinds >= 0))
    rows = rows[(np.append(table.arrays, -1)[inputs.sources[rows]] >= 0)]
    names = context.columns.index.codes[inputs.owners[rows]]
    # There are few kinds of inputs, of elements of few names.
    keys = names.astype(np.int64) * len(inputs.kinds_texts) + inputs.kinds[rows]
    found: dict[int, str] = {}
    firsts, which = numbered(keys)
    for kind, first in enumerate(rows[firsts].tolist()):
        semantic = inputs.semantic(first)
        need = _NEEDS.get(context.name(int(inputs.owners[first])), {}).get(semantic)
        if need is not None:
            found.update(_unlike(context, rows[which == kind], semantic, need))
    return dict(sorted(found.items()))


def _unlike(context: Context, rows: Array, semantic: str, need: _Need) -> Iterator[tuple[int, str]]:
    """The inputs of one kind whose values are of another one."""
    sources, table = inputs_of(context).sources[rows], sources_of(context)
    widths = table.widths[sources]
    wrong = context.is_named(
        table.arrays[sources], *(TOKEN_ARRAYS if need.numbers else NUMBER_ARRAYS)
    )
    if semantic == "POSITION":
        wrong |= context.is_named(table.arrays[sources], *_WHOLE)
    others = ~np.isin(widths, need.widths) if need.widths else np.zeros_like(wrong)
    for row, is_wrong, source, width in zip(
        *(column[wrong | others].tolist() for column in (rows, wrong, sources, widths)), strict=True
    ):
        if is_wrong:
            wanted = "numbers" if need.numbers else "names"
            kind = context.name(int(table.arrays[source]))
            wanted = "real numbers" if kind in _WHOLE and need.numbers else wanted
            article = "an" if kind[0] in "iI" else "a"
            yield row, f"{semantic} needs {wanted}, but its values are in {article} <{kind}>."
        else:
            wanted = " or ".join(map(str, need.widths))
            yield row, f"{semantic} needs {wanted} values in an item, but there are {width}."


def semantics(context: Context) -> Iterator[Hit]:
    """Inputs whose values are of another kind; those of one source are told once."""
    inputs, table = inputs_of(context), sources_of(context)
    told: set[int] = set()
    unfit = unfit_inputs(context)
    whole = np.append(context.is_named(table.arrays, *_WHOLE), False)[inputs.sources]
    light = {row: inputs.semantic(row) not in _GRAVE or bool(whole[row]) for row in unfit}
    for row in sorted(unfit, key=lambda row: (light[row], row)):
        source = int(inputs.sources[row])
        if source in told:
            continue
        told.add(source)
        yield Hit(geometry_rules.INPUT_VALUES, int(inputs.elements[row]), unfit[row],
                  (int(table.accessors[source]),), "source",
                  Severity.WARNING if light[row] else Severity.ERROR)  # fmt: skip


def readable(context: Context) -> Iterator[Hit]:
    """Sources that inputs lead to, and that say nothing of how to read them."""
    inputs, table = inputs_of(context), sources_of(context)
    lacking = np.append(table.accessors < 0, False)[inputs.sources]
    told: set[int] = set()
    for row in np.flatnonzero(lacking).tolist():
        source = int(inputs.sources[row])
        if source not in told:
            told.add(source)
            element = int(table.elements[source])
            message = f"{context.label(element)} has no <accessor>, and an input leads to it."
            yield Hit(geometry_rules.ACCESSOR_MISSING, element, message,
                      (int(inputs.elements[row]),))  # fmt: skip


def spellings(context: Context) -> Iterator[Hit]:
    """Semantics that are misspelled; a program may have others of its own."""
    inputs = inputs_of(context)
    meant = {text: name for text in inputs.kinds_texts if (name := meant_by(text))}
    for row in np.flatnonzero(inputs.are(*meant)).tolist():
        semantic, owner = inputs.semantic(row), int(inputs.owners[row])
        name = meant[semantic]
        # That an element lacks what it needs is told there.
        kind = context.name(owner)
        if name in needed_by(kind) or kind not in (*PRIMITIVES, "vertices"):
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
    rows = np.flatnonzero(context.is_named(inputs.owners, "vertices", "control_vertices"))
    firsts = inputs.first(inputs.owners[rows], "POSITION")
    counts, others = np.append(inputs.counts, -1)[firsts], inputs.counts[rows]
    unlike = (counts >= 0) & (others >= 0) & (counts != others)
    # Knots are more than points, by the degree.
    unlike &= ~inputs.are("KNOT", "KNOT_U", "KNOT_V")[rows]
    strays: dict[int, list[int]] = {}
    for row, first in zip(rows[unlike].tolist(), firsts[unlike].tolist(), strict=True):
        strays.setdefault(first, []).append(row)
    for first, found in strays.items():
        count, other = int(inputs.counts[first]), int(inputs.counts[found[0]])
        owned = inputs.of(int(inputs.owners[first]))
        if len(found) > 1 and all(
            int(inputs.counts[row]) == other
            for row in owned
            if row != first and not inputs.semantic(row).startswith("KNOT")
        ):
            # It is the positions that are others than all the rest.
            message = f"There are {count} positions, but {other} values of all other inputs."
            yield inputs.short(first, other) or Hit(
                geometry_rules.VERTEX_COUNT, int(inputs.elements[first]), message,
                (int(table.accessors[inputs.sources[first]]),), "source",
            )  # fmt: skip
            continue
        for row in found:
            other = int(inputs.counts[row])
            if short := inputs.short(row, count) or inputs.short(first, other):
                yield short
                continue
            message = f"There are {count} positions, but {other} values of {inputs.semantic(row)}."
            yield Hit(geometry_rules.VERTEX_COUNT, int(inputs.elements[row]), message,
                      (int(table.accessors[inputs.sources[row]]),), "source")  # fmt: skip


def names(context: Context) -> Iterator[Hit]:
    """Parameters of one accessor that have the same name.

    Tangents have X and Y for each dimension of what they are the tangents of.
    """
    inputs, table, accessors = inputs_of(context), sources_of(context), accessors_of(context)
    named = np.flatnonzero(accessors.names > 0)
    keys = np.stack([accessors.owners[named], accessors.names[named]])
    order = np.lexsort(keys[::-1])
    same = (keys[:, order[1:]] == keys[:, order[:-1]]).all(axis=0)
    doubtful = distinct(keys[0, order[1:][same]])
    if not len(doubtful):
        return
    tangents = [text for text in inputs.kinds_texts if text.endswith("_TANGENT")]
    rows = np.flatnonzero(inputs.are(*tangents) & (inputs.sources >= 0))
    several = set(table.accessors[inputs.sources[rows]].tolist())
    for row in doubtful.tolist():
        accessor = int(accessors.elements[row])
        if accessor in several or _are_tangents(context, accessor, accessors.params_of(row)):
            continue
        seen: dict[str, int] = {}
        for name, _, element in accessors.params_of(row):
            first = seen.setdefault(name, element)
            if name and first != element:
                message = f"Another parameter of the accessor is named {name!r}."
                yield Hit(geometry_rules.PARAM_TWICE, element, message, (first,), "name")


def _are_tangents(context: Context, accessor: int, params: list[tuple[str, str, int]]) -> bool:
    """Whether it reads tangents of keys, though no input that says so leads to it."""
    names = [name for name, _, _ in params]
    pair = names[:2]
    if len(names) < 4 or names != pair * (len(names) // 2) or pair[0] == pair[1]:
        return False
    return int(context.ancestor(np.array([accessor]), "animation")[0]) >= 0


CHECKS = (semantics, spellings, readable, vertices, names)

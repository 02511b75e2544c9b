"""Values of sources: numbers that are none, directions that are none (COLLADA 1.5 §source)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from colladaphy.meaning import geometry_rules
from colladaphy.meaning.context import Context, FloatRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.inputs import PRIMITIVES, inputs_of
from colladaphy.meaning.semantics import unfit_inputs
from colladaphy.meaning.source_table import sources_of

__all__ = ["CHECKS"]


_DIRECTIONS = frozenset({"NORMAL", "TANGENT", "BINORMAL", "TEXTANGENT", "TEXBINORMAL"})


def numbers(context: Context) -> Iterator[Hit]:
    """Arrays with numbers that are not finite."""
    rows = context.rows(FloatRows, "float_array")
    values: Any = rows.value
    if not len(rows) or bool(np.isfinite(values.values).all()):
        return
    assert rows.ordinals is not None
    bad = np.flatnonzero(~np.isfinite(values.values))
    owner = np.searchsorted(values.offsets, bad, side="right") - 1
    arrays, first, counts = np.unique(owner, return_index=True, return_counts=True)
    for row, place, count in zip(arrays.tolist(), first.tolist(), counts.tolist(), strict=True):
        value = float(values.values[bad[place]])
        word = "NaN" if value != value else "INF" if value > 0 else "-INF"
        number = int(bad[place] - values.offsets[row]) + 1
        message = f"Value {number} is {word}"
        message += f", and {count - 1} more are not finite." if count > 1 else "."
        yield Hit(geometry_rules.NUMBER, int(rows.ordinals[row]), message)


def normals(context: Context) -> Iterator[Hit]:
    """Sources of directions with some that have no length."""
    inputs, table, unfit = inputs_of(context), sources_of(context), unfit_inputs(context)
    seen: set[int] = set()
    for row in np.flatnonzero(inputs.are(*_DIRECTIONS) & (inputs.sources >= 0)).tolist():
        source = int(inputs.sources[row])
        if source in seen or row in unfit:
            continue
        owner = int(inputs.owners[row])
        if context.name(owner) not in (*PRIMITIVES, "vertices"):
            continue  # there it means nothing, and that is told
        if context.name(owner) == "vertices" and inputs.named(owner, "POSITION") < 0:
            continue  # the semantic may be wrong, and that is told
        seen.add(source)
        items = table.numbers(source)
        if items is None or not len(items):
            continue
        flat = ~items[:, :3].any(axis=1)
        if bool(flat.any()):
            first = int(np.flatnonzero(flat)[0])
            message = f"{int(flat.sum())} of {len(items)} are 0 0 0, the first is number {first}."
            yield Hit(
                geometry_rules.NORMAL,
                int(table.arrays[source]),
                message,
                (int(inputs.elements[row]),),
            )


CHECKS = (numbers, normals)

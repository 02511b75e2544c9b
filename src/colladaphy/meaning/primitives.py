"""Primitives of meshes: counts, corners and indices (COLLADA 1.5 §triangles … §tristrips)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.distinct import distinct
from colladaphy.columns.spans import places_of
from colladaphy.meaning import geometry_rules
from colladaphy.meaning.context import Context
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.primitive_table import Group, Primitives, primitives_of
from colladaphy.meaning.semantics import unfit_inputs

__all__ = ["CHECKS", "miscounted"]

Array = NDArray[Any]


_PER_FACE = {"lines": 2, "triangles": 3}
_LEAST = {"linestrips": 2, "polygons": 3, "trifans": 3, "tristrips": 3}


def counts(context: Context) -> Iterator[Hit]:
    """Primitives whose counts and corners do not agree."""
    for hits in context.shared(_counted).values():
        yield from hits


def miscounted(context: Context) -> frozenset[int]:
    """The rows of primitives of which something of this kind is told."""
    return frozenset(context.shared(_counted))


def _counted(context: Context) -> dict[int, list[Hit]]:
    table = primitives_of(context)
    found: dict[int, list[Hit]] = {}
    # Without inputs nothing can be counted, and that is said by their rule.
    for row in np.flatnonzero(_doubtful(context, table) & table.has_inputs).tolist():
        group = table.group(row)
        if group.name == "polylist":
            hits = list(_polylist(group))
        elif group.name in _PER_FACE:
            hits = list(_faces(group))
        else:
            hits = list(_lists(context, group))
        if hits:
            found[row] = hits
    return found


def _doubtful(context: Context, table: Primitives) -> Array:
    """Which primitives (n,) do not have what their counts and corners say."""
    lists = np.flatnonzero(table.list_owners >= 0)
    owners, lengths = table.list_owners[lists], table.list_lengths[lists]
    totals = table.summed(lists, lengths)
    wanted = totals.copy()
    for name, corners in _PER_FACE.items():
        rows = table.kind(name)
        wanted[rows] = (table.counts * table.strides)[rows] * corners
    rows = np.flatnonzero(table.kind("polylist"))
    found: Array = wanted != totals
    found[rows] = table.vcounts[rows] < 0
    rows = rows[~found[rows]]
    sizes, counts = table.sizes_of(rows)
    owner = np.repeat(np.arange(len(rows)), counts)
    needed = np.bincount(owner, sizes, minlength=len(rows)) * table.strides[rows]
    found[rows] |= (counts != table.counts[rows]) | (needed != totals[rows])
    found[rows[owner[sizes < 3]]] = True
    # Lists of corners, be they lines, fans or polygons.
    several = table.kind(*_LEAST)
    plain = context.is_named(table.list_elements[lists], "p")
    found |= several & (table.summed(lists, plain) != table.counts)
    least = np.zeros(len(table.elements), np.int64)
    for name, corners in _LEAST.items():
        least[table.kind(name)] = corners
    whole, rest = np.divmod(lengths, table.strides[owners])
    found[owners[several[owners] & ((rest > 0) | (whole < least[owners]))]] = True
    return found


def _faces(group: Group) -> Iterator[Hit]:
    each = _PER_FACE[group.name] * group.stride
    there = sum(len(values) for _, values in group.parts)
    if there == group.count * each:
        return
    if there % each and group.parts:
        message = (
            f"{there} indices are no whole number of corners: {each} make one of {group.name}."
        )
        yield Hit(geometry_rules.INDEX_LACKING, group.parts[-1][0], message, (group.element,))
        return
    message = f"The count is {group.count}, but there are indices for {there // each}."
    yield Hit(geometry_rules.PRIMITIVE_COUNT, group.element, message, attribute="count")


def _lists(context: Context, group: Group) -> Iterator[Hit]:
    own = [part for part in group.parts if context.name(part[0]) == "p"]
    if len(own) != group.count:
        message = f"The count is {group.count}, but there are {len(own)} lists of indices."
        yield Hit(geometry_rules.PRIMITIVE_COUNT, group.element, message, attribute="count")
    for element, values in group.parts:
        if len(values) % group.stride:
            message = f"{len(values)} indices are not {group.stride} for every corner."
            yield Hit(geometry_rules.INDEX_LACKING, element, message, (group.element,))
        elif len(values) // group.stride < _LEAST[group.name]:
            message = f"There are {len(values) // group.stride} corners only."
            yield Hit(geometry_rules.FEW_CORNERS, element, message)


def _polylist(group: Group) -> Iterator[Hit]:
    there = sum(len(values) for _, values in group.parts)
    if group.vcount is None:
        if there or group.count:
            yield Hit(geometry_rules.VCOUNT, group.element, "The polylist has no <vcount>.")
        return
    element, sizes = group.vcount
    wanted = int(sizes.sum()) * group.stride
    if len(sizes) != group.count:
        if there == wanted:
            message = f"The count is {group.count}, but <vcount> has {len(sizes)} polygons."
            yield Hit(geometry_rules.PRIMITIVE_COUNT, group.element, message, (element,), "count")
        else:
            message = f"There are {len(sizes)} numbers of corners for {group.count} polygons."
            yield Hit(geometry_rules.VCOUNT, element, message, (group.element,))
    elif there % group.stride and group.parts:
        message = f"{there} indices are not {group.stride} for every corner."
        yield Hit(geometry_rules.INDEX_LACKING, group.parts[0][0], message, (group.element,))
    elif there != wanted:
        message = (
            f"The polygons have {int(sizes.sum())} corners, but there are indices for "
            f"{there // group.stride}."
        )
        yield Hit(geometry_rules.VCOUNT, element, message, (group.element,))
    few = int(np.count_nonzero(sizes < 3))
    if few and len(sizes) == group.count:
        yield Hit(
            geometry_rules.FEW_CORNERS,
            element,
            f"{few} of the polygons have fewer than three corners.",
        )


def indices(context: Context) -> Iterator[Hit]:
    """Indices past the ends of what they lead to.

    Where an index is lacking it is not told which of the others are wrong.
    """
    inputs, unfit, table = inputs_of(context), unfit_inputs(context), primitives_of(context)
    told: dict[int, Hit] = {}
    beyond: Counter[int] = Counter()
    for each in _beyond(context, table):
        group = table.group(each)
        limits: dict[int, tuple[int, str, int]] = {}
        seen: set[tuple[str, int]] = set()
        for row in inputs.of(group.element):
            kind = inputs.semantic(row), int(inputs.sets[row])
            if kind in seen:
                continue  # that it is there twice is told
            seen.add(kind)
            count = inputs.count(row)
            behind = inputs.named(int(inputs.targets[row]), "POSITION")
            if count is None or row in unfit or behind in unfit:
                continue
            offset = int(inputs.offsets[row])
            if offset not in limits or count < limits[offset][0]:
                limits[offset] = count, inputs.semantic(row), row
        for element, values in group.parts:
            if len(values) % (group.stride * _PER_FACE.get(group.name, 1)):
                continue  # which index is of what cannot be told
            for offset, (count, semantic, row) in sorted(limits.items()):
                mine = values[offset :: group.stride]
                if len(mine) and int(mine.max()) >= count:
                    if short := inputs.short(row, int(mine.max()) + 1):
                        yield short
                        break
                    target = int(inputs.targets[row])
                    message = (
                        f"The index {int(mine.max())} of {semantic} is past the last of "
                        f"{count} values, which is {count - 1}."
                    )
                    hit = Hit(geometry_rules.INDEX_RANGE, element, message, (group.element,))
                    told.setdefault(target, hit)
                    beyond[target] += 1
                    break
    for target, hit in told.items():
        # Lists of one geometry that all lead past the end are wrong there, and not each.
        more = f" {beyond[target] - 1} more lists do so." if beyond[target] > 1 else ""
        yield replace(hit, message=hit.message + more)


def _beyond(context: Context, table: Primitives) -> list[int]:
    """The primitives with an index past the end of anything that an input of its place leads to."""
    inputs = inputs_of(context)
    corners = np.ones(len(table.elements), np.int64)
    for name, count in _PER_FACE.items():
        corners[table.kind(name)] = count
    lists = np.flatnonzero((table.list_owners >= 0) & (table.list_lengths > 0))
    owners = table.list_owners[lists]
    whole = table.list_lengths[lists] % (table.strides * corners)[owners] == 0
    lists, owners = lists[whole], owners[whole]
    # What the indices at each place of a corner have to stay below, for each primitive.
    used = np.zeros(len(table.elements), np.bool_)
    used[owners] = True
    strides = np.where(used, table.strides, 0)
    firsts = np.cumsum(strides) - strides
    limits = np.full(int(strides.sum()), np.iinfo(np.int64).max)
    rows = np.flatnonzero((table.input_rows >= 0) & (inputs.counts >= 0))
    rows = rows[used[table.input_rows[rows]]]
    np.minimum.at(limits, firsts[table.input_rows[rows]] + inputs.offsets[rows],
                  inputs.counts[rows])  # fmt: skip
    found: set[int] = set()
    for stride in distinct(strides[owners]).tolist():
        mine = np.flatnonzero(strides[owners] == stride)
        starts, lengths = table.list_starts[lists[mine]], table.list_lengths[lists[mine]]
        indices = table.indices
        if int(lengths.sum()) < len(indices):
            indices = indices[places_of(starts, lengths)]
        most = np.maximum.reduceat(
            indices.reshape(-1, stride), (np.cumsum(lengths) - lengths) // stride
        )
        places = firsts[owners[mine]][:, None] + np.arange(stride)
        past = (most >= limits[places]).any(axis=1)
        found.update(owners[mine[past]].tolist())
    return sorted(found)


CHECKS = (counts, indices)

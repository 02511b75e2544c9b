"""Primitives of meshes: counts, corners and indices (COLLADA 1.5 §triangles … §tristrips)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.meaning import geometry_rules
from colladaphy.meaning.arrays import CountRows
from colladaphy.meaning.context import Context, IntegerRows
from colladaphy.meaning.hits import Hit
from colladaphy.meaning.inputs import PRIMITIVES, inputs_of
from colladaphy.meaning.semantics import unfit_inputs
from colladaphy_schema.rows import Lists

__all__ = ["CHECKS", "groups_of", "miscounted"]

Array = NDArray[Any]


_PER_FACE = {"lines": 2, "triangles": 3}
_LEAST = {"linestrips": 2, "polygons": 3, "trifans": 3, "tristrips": 3}


@dataclass(slots=True)
class _Group:
    """A primitive with its lists of indices."""

    element: int
    name: str
    count: int
    stride: int
    parts: list[tuple[int, Array]]
    """Elements p, or h, and their indices."""
    vcount: tuple[int, Array] | None


def _groups(context: Context) -> list[_Group]:
    inputs = inputs_of(context)
    made: dict[int, _Group] = {}
    for name in PRIMITIVES:
        rows = context.rows(CountRows, name)
        assert rows.ordinals is not None
        for element, count in zip(rows.ordinals.tolist(), rows.count.values.tolist(), strict=True):
            offsets = [int(inputs.offsets[row]) for row in inputs.of(element)]
            made[element] = _Group(element, name, count, max(offsets, default=0) + 1, [], None)
    for tag in ("p", "h"):
        lists = context.rows(IntegerRows, tag)
        if not len(lists):
            continue
        assert lists.ordinals is not None
        around = context.ancestor(lists.ordinals, *PRIMITIVES)
        values: Lists = lists.value
        for place, (element, owner) in enumerate(
            zip(lists.ordinals.tolist(), around.tolist(), strict=True)
        ):
            if owner in made:
                made[owner].parts.append((element, values[place]))
    sizes = context.rows(IntegerRows, "vcount")
    if len(sizes):
        assert sizes.ordinals is not None
        values = sizes.value
        for place, element in enumerate(sizes.ordinals.tolist()):
            owner = int(context.parent[element])
            if owner in made:
                made[owner].vcount = (element, values[place])
    return list(made.values())


def groups_of(context: Context) -> list[_Group]:
    """The primitives of a document."""
    return context.shared(_groups)


def counts(context: Context) -> Iterator[Hit]:
    """Primitives whose counts and corners do not agree."""
    for hits in context.shared(_counted).values():
        yield from hits


def miscounted(context: Context) -> frozenset[int]:
    """The primitives of which something of this kind is told."""
    return frozenset(context.shared(_counted))


def _counted(context: Context) -> dict[int, list[Hit]]:
    inputs = inputs_of(context)
    found: dict[int, list[Hit]] = {}
    for group in groups_of(context):
        if not inputs.of(group.element):
            continue  # said by the rule of inputs
        if group.name == "polylist":
            hits = list(_polylist(group))
        elif group.name in _PER_FACE:
            hits = list(_faces(group))
        else:
            hits = list(_lists(context, group))
        if hits:
            found[group.element] = hits
    return found


def _faces(group: _Group) -> Iterator[Hit]:
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


def _lists(context: Context, group: _Group) -> Iterator[Hit]:
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


def _polylist(group: _Group) -> Iterator[Hit]:
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
    inputs, unfit = inputs_of(context), unfit_inputs(context)
    told: dict[int, Hit] = {}
    beyond: Counter[int] = Counter()
    for group in groups_of(context):
        limits: dict[int, tuple[int, str, int]] = {}
        seen: set[tuple[str, int]] = set()
        for row in inputs.of(group.element):
            kind = inputs.semantics[row], int(inputs.sets[row])
            if kind in seen:
                continue  # that it is there twice is told
            seen.add(kind)
            count = inputs.count(row)
            behind = inputs.named(int(inputs.targets[row]), "POSITION")
            if count is None or row in unfit or behind in unfit:
                continue
            offset = int(inputs.offsets[row])
            if offset not in limits or count < limits[offset][0]:
                limits[offset] = count, inputs.semantics[row], row
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


CHECKS = (counts, indices)

"""Skins and morphs (COLLADA 1.5 §skin, §vertex_weights, §morph)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.columns.counting import counted
from colladaphy.columns.distinct import distinct
from colladaphy.findings import Severity
from colladaphy.links.rules import MISSING, WRONG_TYPE
from colladaphy.meaning import animation_rules
from colladaphy.meaning.array_table import CountRows
from colladaphy.meaning.context import Context, IntegerRows, NamedRows, TextRows
from colladaphy.meaning.hits import Hit, listed
from colladaphy.meaning.inputs import inputs_of
from colladaphy.meaning.scene import degenerate_matrices
from colladaphy.meaning.semantics import unfit_inputs
from colladaphy.meaning.source_table import sources_of
from colladaphy.meaning.vertex_counts import (
    base_of,
    geometry_size,
    odd_geometries,
    positions_of,
    short_positions,
)
from colladaphy_schema.rows import Rows

__all__ = ["CHECKS"]

Array = NDArray[Any]


def weights(context: Context) -> Iterator[Hit]:
    """The counts, indices and sums of the weights of skins."""
    rows = context.rows(CountRows, "vertex_weights")
    if not len(rows):
        return
    assert rows.ordinals is not None
    inputs, table = inputs_of(context), sources_of(context)
    sizes, pairs = _lists(context, rows, "vcount"), _lists(context, rows, "v")
    odd = odd_geometries(context)
    for row, (element, count) in enumerate(
        zip(rows.ordinals.tolist(), rows.count.values.tolist(), strict=True)
    ):
        mine = inputs.of(element)
        stride = max((int(inputs.offsets[each]) for each in mine), default=0) + 1
        vcount, v = sizes.get(row), pairs.get(row)
        length = 0 if vcount is None else len(vcount[1])
        skin = int(context.parent[element])
        geometry = base_of(context, skin)
        vertices = None if geometry in odd else geometry_size(context, geometry)
        if length != count:
            message = f"The count is {count}, but there are numbers of weights for {length}."
            yield Hit(animation_rules.SKIN_COUNT, element, message, (), "count")
            continue
        if vertices is not None and count != vertices:
            if short := short_positions(context, geometry, count):
                yield short
                continue
            message = f"There are weights for {count} vertices, but the geometry has {vertices}."
            yield Hit(animation_rules.SKIN_COUNT, element, message, (geometry,), "count")
            continue
        if vcount is None:
            continue
        total = int(vcount[1].sum())
        if v is None and not total:
            continue  # no vertex is moved
        if v is None or len(v[1]) != total * stride:
            there = 0 if v is None else len(v[1])
            message = f"{total} weights need {total * stride} indices, but there are {there}."
            yield Hit(
                animation_rules.SKIN_COUNT, element if v is None else v[0], message, (element,)
            )
            continue
        faulty = False
        for each in mine:
            limit = inputs.count(each)
            used = v[1][int(inputs.offsets[each]) :: stride]
            least = 0 if inputs.semantic(each) == "WEIGHT" else -1
            if limit is None or not len(used):
                continue
            if int(used.max()) >= limit or int(used.min()) < least:
                if short := inputs.short(each, int(used.max()) + 1):
                    yield short
                    faulty = True
                    break
                worst = int(used.max()) if int(used.max()) >= limit else int(used.min())
                message = (
                    f"The index {worst} of {inputs.semantic(each)} is not one of {limit} values."
                )
                yield Hit(animation_rules.SKIN_INDEX, v[0], message, (element,))
                faulty = True
                break
        which = inputs.named(element, "WEIGHT")
        if faulty or which < 0 or inputs.sources[which] < 0:
            continue
        numbers = table.numbers(int(inputs.sources[which]))
        if numbers is None or not np.isfinite(numbers).all():
            continue
        used = numbers[v[1][int(inputs.offsets[which]) :: stride], 0]
        if bool(np.any(used < 0.0)):
            message = f"A weight is {used[used < 0.0][0]:g}."
            yield Hit(animation_rules.SKIN_WEIGHT, v[0], message, (element,))
            continue
        owner = np.repeat(np.arange(count), vcount[1])
        sums = np.bincount(owner, used, minlength=count)
        wrong = np.flatnonzero((np.abs(sums - 1.0) > 0.01) & (vcount[1] > 0))
        if len(wrong):
            message = (
                f"The weights of {len(wrong)} vertices do not add up to 1: of vertex "
                f"{int(wrong[0])} to {sums[wrong[0]]:g}."
            )
            yield Hit(animation_rules.SKIN_SUM, v[0], message, (element,))


def _lists(context: Context, rows: Rows, name: str) -> dict[int, tuple[int, Array]]:
    found = context.children(rows, name, IntegerRows)
    assert found.ordinals is not None
    return {
        owner: (element, counted(found.value[place]))
        for place, (owner, element) in enumerate(
            zip(found.owner.tolist(), found.ordinals.tolist(), strict=True)
        )
    }


def geometries(context: Context) -> Iterator[Hit]:
    """Geometries with other vertices than all the skins and morphs of them are for."""
    inputs = inputs_of(context)
    for geometry, (wanted, users) in odd_geometries(context).items():
        row = positions_of(context, geometry)
        if short := inputs.short(row, wanted):
            yield short
            continue
        skinned = any(context.name(user) == "vertex_weights" for user in users)
        rule = animation_rules.SKIN_COUNT if skinned else animation_rules.MORPH_TARGETS
        message = (
            f"{context.label(geometry)} has {inputs.count(row)} vertices, but its skins and "
            f"morphs are for {wanted}."
        )
        accessor = int(sources_of(context).accessors[inputs.behind[row]])
        yield Hit(rule, accessor, message, (geometry, *users[:3]), "count")


def joints(context: Context) -> Iterator[Hit]:
    """Joints without matrices, and those that are no nodes."""
    elements = context.ordinals("joints")
    if not len(elements):
        return
    inputs, table = inputs_of(context), sources_of(context)
    nodes = context.rows(NamedRows, "node")
    sids = {sid for sid in nodes.sid if sid}
    skeletons = context.shared(_skeletons)
    told: set[int] = set()
    for element in elements.tolist():
        source = inputs.source(element, "JOINT")
        bind = inputs.source(element, "INV_BIND_MATRIX")
        if source >= 0 and bind >= 0:
            count, others = table.count(source), table.count(bind)
            if count is not None and others is not None and count != others:
                if short := table.short(source, others) or table.short(bind, count):
                    yield short
                    continue
                message = f"There are {count} joints and {others} inverse bind matrices."
                row = inputs.named(element, "INV_BIND_MATRIX")
                yield Hit(animation_rules.SKIN_BIND, int(inputs.elements[row]), message, (element,))
        if source < 0:
            continue
        words, array = table.words(source), int(table.arrays[source])
        if words is None or array in told:
            continue
        told.add(array)
        if context.name(array) == "IDREF_array":
            named = [context.target(word) for word in words]
            lost = [word for word, target in zip(words, named, strict=True) if target < 0]
            strange = [target for target in named if target >= 0 and context.name(target) != "node"]
            if lost:
                yield Hit(MISSING, array, f"There is no element of the id {listed(lost)}.",
                          severity=Severity.WARNING)  # fmt: skip
            elif strange:
                message = f"The joint {context.label(strange[0])} is not a <node>."
                yield Hit(WRONG_TYPE, array, message, (strange[0],), severity=Severity.WARNING)
        elif context.name(array) == "Name_array":
            controller = int(context.parent[context.parent[element]])
            if controller in context.shared(_lost_skeletons):
                continue  # that there is no such skeleton is told
            lost = [word for word in words if word not in sids]
            if lost:
                yield Hit(animation_rules.SKIN_JOINT, array, f"No node has the sid {listed(lost)}.")
                continue
            mine = skeletons.get(controller)
            lost = [] if mine is None else [word for word in words if word not in mine]
            if lost:
                message = f"No node of the skeleton has the sid {listed(lost)}."
                yield Hit(animation_rules.SKIN_JOINT, array, message)
        twice = [word for word, count in Counter(words).items() if count > 1]
        if twice and context.name(array) != "IDREF_array":
            message = f"The joint {listed(twice)} is there more than once."
            yield Hit(animation_rules.SKIN_JOINT_TWICE, array, message)


def _lost_skeletons(context: Context) -> frozenset[int]:
    """The controllers with an instance whose skeleton is no node of the document."""
    roots = context.rows(TextRows, "skeleton")
    if not len(roots):
        return frozenset()
    assert roots.ordinals is not None
    targets = context.targets(text.strip() for text in roots.value)
    lost = roots.ordinals[~context.is_named(targets, "node")]
    instances = context.at(Rows, distinct(context.parent[lost]))
    return frozenset(context.targets(context.texts(instances, "url")).tolist())


def _skeletons(context: Context) -> dict[int, set[str] | None]:
    """The sids below all skeletons of each controller; None where that cannot be told.

    Where one instance has no skeleton, or nodes are instanced below it, any node may be meant.
    """
    instances = context.rows(Rows, "instance_controller")
    if not len(instances):
        return {}
    assert instances.ordinals is not None
    roots = context.children(instances, "skeleton", TextRows)
    nodes = context.rows(NamedRows, "node")
    assert nodes.ordinals is not None
    by_node = dict(zip(nodes.ordinals.tolist(), nodes.sid, strict=True))
    inner: dict[int, list[int]] = {}
    for element in nodes.ordinals.tolist():
        inner.setdefault(int(context.parent[element]), []).append(element)
    holders = set(context.parent[context.ordinals("instance_node")].tolist())
    targets: list[list[int]] = [[] for _ in range(len(instances))]
    for owner, text in zip(roots.owner.tolist(), roots.value, strict=True):
        targets[owner].append(context.target(text.strip()))
    found: dict[int, set[str] | None] = {}
    for controller, starts in zip(
        context.targets(context.texts(instances, "url")).tolist(), targets, strict=True
    ):
        below: set[str] | None = set() if starts else None
        waiting = list(starts)
        while waiting and below is not None:
            node = waiting.pop()
            if node not in by_node or node in holders:
                below = None
                break
            below.add(by_node[node] or "")
            waiting += inner.get(node, ())
        if controller in found:
            known = found[controller]
            below = None if below is None or known is None else below & known
        found[controller] = below
    return found


def matrices(context: Context) -> Iterator[Hit]:
    """Inverse bind matrices that are flat, or written column by column."""
    inputs, table, unfit = inputs_of(context), sources_of(context), unfit_inputs(context)
    told: set[int] = set()
    for element in context.ordinals("joints").tolist():
        row = inputs.named(element, "INV_BIND_MATRIX")
        source = -1 if row < 0 else int(inputs.sources[row])
        items = None if source < 0 or row in unfit else table.numbers(source)
        if items is None or items.shape[1] != 16 or not np.isfinite(items).all() or source in told:
            continue
        told.add(source)
        wrong, flat = degenerate_matrices(items.reshape(-1, 4, 4))
        for each, what in ((wrong, "has another last row than 0 0 0 1"), (flat, "is flat")):
            if each.any():
                message = f"Matrix {int(np.flatnonzero(each)[0])} {what}"
                message += f", and {int(each.sum()) - 1} more." if each.sum() > 1 else "."
                yield Hit(animation_rules.SKIN_MATRIX, int(table.arrays[source]), message,
                          (int(inputs.elements[row]),))  # fmt: skip


def morphs(context: Context) -> Iterator[Hit]:
    """Targets of morphs that are not there, or do not fit."""
    elements = context.ordinals("targets")
    if not len(elements):
        return
    inputs, table = inputs_of(context), sources_of(context)
    for element in elements.tolist():
        source = inputs.source(element, "MORPH_TARGET")
        weights = inputs.source(element, "MORPH_WEIGHT")
        if source < 0:
            continue
        count = table.count(source)
        others = None if weights < 0 else table.count(weights)
        if count is not None and others is not None and count != others:
            if short := table.short(source, others) or table.short(weights, count):
                yield short
                continue
            message = f"There are {count} targets and {others} weights."
            yield Hit(animation_rules.MORPH_TARGETS, element, message)
            continue
        words, array = table.words(source), int(table.arrays[source])
        if words is None:
            continue
        found = [context.target(word) for word in words]
        lost = [word for word, target in zip(words, found, strict=True) if target < 0]
        if lost:
            yield Hit(MISSING, array, f"There is no geometry of the id {listed(lost)}.",
                      severity=Severity.WARNING)  # fmt: skip
            continue
        odd = odd_geometries(context)
        geometry = base_of(context, int(context.parent[element]))
        size = None if geometry in odd else geometry_size(context, geometry)
        for word, target in zip(words, found, strict=True):
            other = geometry_size(context, target)
            if context.name(target) not in ("geometry", "controller"):
                message = f"The target {word!r} is a <{context.name(target)}>, not a <geometry>."
                yield Hit(WRONG_TYPE, array, message, (target,), severity=Severity.WARNING)
                break
            if size is not None and other is not None and other != size and target not in odd:
                short = short_positions(context, target, size)
                if short := short or short_positions(context, geometry, other):
                    yield short
                    break
                message = f"The target {word!r} has {other} vertices, the geometry {size}."
                yield Hit(animation_rules.MORPH_TARGETS, array, message,
                          (element, target, geometry))  # fmt: skip
                break


CHECKS = (geometries, weights, joints, matrices, morphs)

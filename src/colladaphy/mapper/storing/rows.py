"""Rows made by hand: which rows of a parent have a child, and how the common ones are filled."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from colladaphy.world.masses import distinct
from colladaphy_schema.core_columns import (
    ExtraTypeRows,
    RotateTypeRows,
    TargetableFloat3TypeRows,
    TargetableFloatTypeRows,
    TechniqueTypeRows,
    TranslateTypeRows,
)
from colladaphy_schema.physics_columns import InstancePhysicsMaterialTypeRows
from colladaphy_schema.rows import Bools, Masked, Rows

__all__ = [
    "Index", "extra", "float1", "float3", "labelled", "masked", "material", "picked", "technique",
    "transforms", "where_there",
]  # fmt: skip

Array = NDArray[Any]
Index = Any
"""Rows of an array: a slice of all of them, or their numbers."""

R = TypeVar("R", bound=Rows)


def where_there(kind: type[R], there: Array) -> tuple[R, Index]:
    """Rows for those of a parent that have a child (n,), and the numbers of these."""
    if there.all():
        return kind(len(there)), slice(None)
    found = np.flatnonzero(there)
    return kind(len(found), found), found


def picked(texts: list[Any], index: Index) -> list[Any]:
    """Some of the texts."""
    if isinstance(index, slice):
        return texts[index]
    return [texts[row] for row in index.tolist()]


def masked(values: Array, there: Array) -> Masked[Array] | Array | None:
    """Values that some rows have: None where no row has one."""
    if not there.any():
        return None
    return values if there.all() else Masked(values, there)


def float1(values: Array, there: Array) -> TargetableFloatTypeRows:
    """Elements of one number."""
    rows, index = where_there(TargetableFloatTypeRows, there)
    rows.value = values[index]
    return rows


def float3(values: Array, there: Array) -> TargetableFloat3TypeRows:
    """Elements of three numbers."""
    rows, index = where_there(TargetableFloat3TypeRows, there)
    rows.value = values[index]
    return rows


def labelled(prefix: str, ids: Array) -> list[str]:
    """A prefix before each of the ids (n,)."""
    if len(ids) and ids[0] == ids[-1] and bool(np.all(ids == ids[0])):
        return [f"{prefix}{ids[0]}"] * len(ids)
    return [f"{prefix}{id}" for id in ids.tolist()]


def material(ids: Array, there: Array | None = None) -> InstancePhysicsMaterialTypeRows:
    """References to the materials (n,) of those rows that have one."""
    if there is None:
        there = np.ones(len(ids), np.bool_)
    rows, index = where_there(InstancePhysicsMaterialTypeRows, there)
    used, places = distinct(ids[index])
    urls = np.array(labelled("#Material", used), dtype=object)
    rows.url = urls[places].tolist()
    return rows


def technique(count: int, owner: Array | None = None) -> TechniqueTypeRows:
    """Techniques of the pe profile; what they hold is for the caller to add."""
    rows = TechniqueTypeRows(count, owner)
    rows.profile = ["pe"] * count
    return rows


def extra(content: TechniqueTypeRows) -> ExtraTypeRows:
    """Extra elements with a technique each."""
    rows = ExtraTypeRows(len(content))
    rows.technique = content
    return rows


def transforms(
    translations: tuple[Array, Bools], rotations: tuple[Array, Bools]
) -> tuple[TranslateTypeRows, RotateTypeRows]:
    """A translation and then a rotation, each where it is there: values (n, m) and masks (n,)."""
    moves, index = where_there(TranslateTypeRows, translations[1])
    moves.value = translations[0][index]
    moves.order = np.zeros(len(moves), np.int64)
    turns, index = where_there(RotateTypeRows, rotations[1])
    turns.value = rotations[0][index]
    turns.order = np.ones(len(turns), np.int64)
    return moves, turns

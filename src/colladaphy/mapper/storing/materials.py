"""Materials as physics materials, with extra values of the pe profile (thesis 4.4, listing 5)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.storing.arrangement import kept_names
from colladaphy.mapper.storing.rows import extra, labelled, masked, technique
from colladaphy_schema import pe_columns as pe
from colladaphy_schema.core_columns import TargetableFloatTypeRows
from colladaphy_schema.physics_columns import (
    PhysicsMaterialTypeRows,
    PhysicsMaterialTypeTechniqueCommonRows,
)

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["materials_of", "pairs_of"]

Array = NDArray[Any]


def materials_of(world: World, ids: Array, options: WriteOptions) -> PhysicsMaterialTypeRows:
    """The materials of some ids; those of the elements are made of them."""
    rows = PhysicsMaterialTypeRows(len(ids), np.zeros(len(ids), np.int64))
    names: list[str | None] = [world.materials.names[id] for id in ids.tolist()]
    rows.id = labelled("Material", ids)
    rows.name = names
    rows.technique_common = common = PhysicsMaterialTypeTechniqueCommonRows(len(ids))
    common.dynamic_friction = _values(world, "dynamic_friction", ids)
    common.restitution = _values(world, "restitution", ids)
    common.static_friction = _values(world, "static_friction", ids)
    if options.profile != "none":
        techniques = technique(len(ids))
        techniques.material = _exact(world, ids, names, options.profile == "full")
        rows.extra = extra(techniques)
    return rows


def _values(world: World, key: str, ids: Array) -> TargetableFloatTypeRows:
    rows = TargetableFloatTypeRows(len(ids))
    rows.value = world.materials.values(key, ids)
    return rows


def _exact(world: World, ids: Array, names: list[str | None], full: bool) -> pe.MaterialRows:
    values = world.materials.values
    rows = pe.MaterialRows(len(ids))
    rows.name = kept_names(names)
    rows.density = values("density", ids)
    rows.poisson_ratio = values("poisson_ratio", ids)
    rows.young_modulus = values("young_modulus", ids)
    rows.stiffness = values("stiffness", ids)
    rows.damping_normal = values("damping_normal", ids)
    rows.damping_tangential = values("damping_tangential", ids)
    if full:
        rows.dynamic_friction = values("dynamic_friction", ids)
        rows.restitution = values("restitution", ids)
        rows.static_friction = values("static_friction", ids)
    return rows


def pairs_of(world: World, ids: Array) -> pe.PairTypeRows:
    """What is set by hand for pairs of the materials that are written."""
    written = set(ids.tolist())
    pairs = [pair for pair in world.pair_overrides if {pair.first, pair.second} <= written]
    rows = pe.PairTypeRows(len(pairs), np.zeros(len(pairs), np.int64))
    rows.first = [f"#Material{pair.first}" for pair in pairs]
    rows.second = [f"#Material{pair.second}" for pair in pairs]
    rows.restitution = _given([pair.restitution for pair in pairs])
    rows.static_friction = _given([pair.static_friction for pair in pairs])
    rows.dynamic_friction = _given([pair.dynamic_friction for pair in pairs])
    return rows


def _given(values: list[float | None]) -> Any:
    there = np.array([value is not None for value in values], dtype=np.bool_)
    numbers = np.array([0.0 if value is None else value for value in values], dtype=np.float64)
    return masked(numbers, there)

"""Rigid bodies (thesis 5.4), primitives and unions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.numbers import differs
from colladaphy.mapper.storing.arrangement import Arrangement, kept_names
from colladaphy.mapper.storing.geometries import add_exact_geometry
from colladaphy.mapper.storing.leaves import Leaves
from colladaphy.mapper.storing.rows import (
    float1,
    float3,
    masked,
    material,
    technique,
    where_there,
)
from colladaphy.mapper.storing.tree import Tree
from colladaphy.mapper.storing.turns import mass_frames
from colladaphy.mapper.storing.unions import unions_of
from colladaphy.world.kinds import Kind
from colladaphy_schema import pe_columns as pe
from colladaphy_schema.core_columns import RotateTypeRows, TechniqueTypeRows, TranslateTypeRows
from colladaphy_schema.physics_columns import (
    RigidBodyTypeRows,
    RigidBodyTypeTechniqueCommonDynamicRows,
    RigidBodyTypeTechniqueCommonMassFrameRows,
    RigidBodyTypeTechniqueCommonRows,
    RigidBodyTypeTechniqueCommonShapeRows,
)

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions

__all__ = ["rigid_bodies"]

Array = NDArray[Any]

_UNION = int(Kind.UNION)


def rigid_bodies(
    arrangement: Arrangement,
    tree: Tree,
    leaves: Leaves,
    shapes: RigidBodyTypeTechniqueCommonShapeRows,
    labels: list[str],
    options: WriteOptions,
) -> RigidBodyTypeRows:
    """The rigid_body of each body; `labels` are their scoped ids."""
    rows = RigidBodyTypeRows(len(labels), arrangement.model)
    rows.sid = labels
    rows.name = arrangement.names
    rows.technique_common = _common(arrangement.bodies, leaves, shapes, options)
    if options.profile != "none":
        rows.technique = _profile(arrangement, tree, leaves, options)
    return rows


def _common(
    bodies: dict[str, Array],
    leaves: Leaves,
    shapes: RigidBodyTypeTechniqueCommonShapeRows,
    options: WriteOptions,
) -> RigidBodyTypeTechniqueCommonRows:
    count = len(bodies["sids"])
    united = bodies["kinds"] == _UNION
    rows = RigidBodyTypeTechniqueCommonRows(count)
    dynamic = RigidBodyTypeTechniqueCommonDynamicRows(count)
    dynamic.value = ~bodies["fixed"]
    rows.dynamic = dynamic
    if options.redundant:
        rows.mass = float1(bodies["masses"], np.ones(count, np.bool_))
        ids = np.where(united, _materials_of_unions(leaves, count), bodies["material_ids"])
        rows.instance_physics_material = material(ids, ids >= 0)
    elif united.any():
        # One after the other, in the order of the file.
        sums = np.bincount(leaves.owner, leaves.values["masses"], minlength=count)
        rows.mass = float1(
            bodies["masses"], united & differs(bodies["masses"][:, None], sums[:, None])
        )
    _add_inertia(rows, bodies["inertias"], leaves.per_body(leaves.says_inertia, count) | united)
    rows.shape = shapes
    return rows


def _materials_of_unions(leaves: Leaves, count: int) -> Array:
    """The material (n,) that all primitives of a body have, -1 for several."""
    found = np.full(count, -1)
    if len(leaves):
        starts = np.flatnonzero(np.append(True, leaves.owner[1:] != leaves.owner[:-1]))
        ids = leaves.values["material_ids"]
        low, high = (function.reduceat(ids, starts) for function in (np.minimum, np.maximum))
        found[leaves.owner[starts]] = np.where(low == high, low, -1)
    return found


def _add_inertia(rows: RigidBodyTypeTechniqueCommonRows, inertias: Array, wanted: Array) -> None:
    if not wanted.any():
        return
    frames = mass_frames(inertias, wanted)
    if frames.framed.any():
        mass_frame, index = where_there(RigidBodyTypeTechniqueCommonMassFrameRows, frames.framed)
        origins = TranslateTypeRows(len(mass_frame))
        origins.value = np.zeros((len(mass_frame), 3))
        mass_frame.translate = origins
        turns, picked = where_there(RotateTypeRows, frames.turned[index])
        turns.value = frames.turns[index][picked]
        mass_frame.rotate = turns
        rows.mass_frame = mass_frame
    rows.inertia = float3(frames.moments, frames.there)


def _profile(
    arrangement: Arrangement, tree: Tree, leaves: Leaves, options: WriteOptions
) -> TechniqueTypeRows:
    """What the common profile cannot say exactly, or all."""
    bodies, count = arrangement.bodies, len(arrangement.model)
    united = bodies["kinds"] == _UNION
    rows = pe.BodyRows(count)
    rows.uid = bodies["uids"]
    rows.name = kept_names(arrangement.names)
    full = options.profile == "full"
    says_mass = leaves.per_body(leaves.says_mass, count)
    if full:
        rows.fixed = bodies["fixed"]
        says_mass = says_mass | united
    rows.mass = masked(bodies["masses"], says_mass)
    says_inertia = leaves.per_body(leaves.says_inertia, count) | united
    rows.inertia = masked(bodies["inertias"].reshape(-1, 9), says_inertia)
    single = np.flatnonzero((leaves.exact_kinds >= 0) & ~leaves.is_member)
    if len(single):
        shapes = pe.ShapeTypeRows(len(single), leaves.owner[single])
        values = leaves.values
        add_exact_geometry(
            shapes, leaves.exact_kinds[single], values["dimensions"][single],
            values["positions"][single],
        )  # fmt: skip
        rows.shape = shapes
    if united.any():
        rows.union = unions_of(np.flatnonzero(united), tree, leaves, options)
    techniques = technique(count)
    techniques.body = rows
    return techniques

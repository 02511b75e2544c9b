"""Shapes of the common profile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import WorldError
from colladaphy.mapper.storing.geometries import PLANE, add_geometry, is_turned
from colladaphy.mapper.storing.leaves import Leaves
from colladaphy.mapper.storing.rows import float1, labelled, material, where_there
from colladaphy.mapper.storing.turns import turns_of
from colladaphy.mapper.tessellation import extent, tessellate
from colladaphy.world.kinds import Kind
from colladaphy.world.masses import distinct
from colladaphy.world.meshes import complete_shells
from colladaphy_schema.core_columns import RotateTypeRows, TranslateTypeRows
from colladaphy_schema.physics_columns import (
    RigidBodyTypeTechniqueCommonShapeHollowRows,
    RigidBodyTypeTechniqueCommonShapeRows,
)

if TYPE_CHECKING:
    from colladaphy.world import Mesh, World

__all__ = ["NO_SHAPE", "shapes_of", "tessellated"]

Array = NDArray[Any]
Steps = list[tuple[Array, Array]]

_EMPTY = int(Kind.EMPTY)
NO_SHAPE = "NoShape"
"""The id of the geometry that stands for no shape where the schema asks for one."""
_ONTO_X = np.array([0.0, 0.0, 1.0, -90.0])
"""Turns COLLADA's y axis of capsules and cylinders onto the World's x axis."""


def shapes_of(
    world: World, leaves: Leaves, stand_ins: list[str | None] | None
) -> RigidBodyTypeTechniqueCommonShapeRows:
    """The shape of each primitive; `stand_ins` are ids of the meshes that some are written as."""
    values = leaves.values
    rows = RigidBodyTypeTechniqueCommonShapeRows(len(leaves), leaves.owner)
    if values["hollow"].any():
        hollow, _ = where_there(RigidBodyTypeTechniqueCommonShapeHollowRows, values["hollow"])
        hollow.value = np.ones(len(hollow), np.bool_)
        rows.hollow = hollow
    rows.mass = float1(values["masses"], leaves.has_mass)
    if leaves.has_density.any():
        rows.density = float1(leaves.densities, leaves.has_density)
    empty = values["kinds"] == _EMPTY
    rows.instance_physics_material = material(values["material_ids"], ~empty)
    rows_of_urls: list[str | None] | None = None
    if stand_ins is not None or empty.any() or bool((values["mesh_ids"] >= 0).any()):
        rows_of_urls = _urls(values["mesh_ids"], empty, stand_ins)
    add_geometry(rows, values["kinds"], values["dimensions"], leaves.equations, rows_of_urls)
    _add_transforms(rows, world, leaves, stand_ins)
    return rows


def _urls(mesh_ids: Array, empty: Array, stand_ins: list[str | None] | None) -> list[str | None]:
    """References to geometries (k,), None for primitives."""
    there = np.flatnonzero(mesh_ids >= 0)
    urls = np.full(len(mesh_ids), None, dtype=object)
    if stand_ins is not None:
        urls[:] = [None if id is None else f"#{id}" for id in stand_ins]
    urls[there] = labelled("#Mesh", mesh_ids[there])
    urls[empty] = f"#{NO_SHAPE}"
    listed: list[str | None] = urls.tolist()
    return listed


def _add_transforms(
    rows: RigidBodyTypeTechniqueCommonShapeRows,
    world: World,
    leaves: Leaves,
    stand_ins: list[str | None] | None,
) -> None:
    """The pose in the rigid body, then what puts a geometry into the body's own frame."""
    values = leaves.values
    moves: Steps = []
    turns: Steps = []
    if leaves.poses is not None:
        # The equation of a plane says all.
        standing = leaves.is_member & (values["kinds"] != PLANE)
        there = np.flatnonzero(leaves.poses.moved & standing)
        moves.append((there, leaves.poses.positions[there]))
        there = np.flatnonzero(leaves.poses.turned & standing)
        said, turned = turns_of(leaves.poses.orientations[there])
        turns.append((there[turned], said[turned]))
    settled = np.flatnonzero(values["mesh_ids"] >= 0)
    if len(settled):
        centers = _centers(world, values["mesh_ids"][settled], values["hollow"][settled])
        off = (centers != 0.0).any(axis=1)
        moves.append((settled[off], -centers[off]))
    across = is_turned(values["kinds"])
    if stand_ins is not None:
        across &= np.fromiter((id is None for id in stand_ins), np.bool_, len(stand_ins))
    if across.any():
        there = np.flatnonzero(across)
        turns.append((there, np.broadcast_to(_ONTO_X, (len(there), 4))))
    if moves:
        owner, numbers, order = _in_order(moves, 0)
        translations = TranslateTypeRows(len(owner), owner, order=order)
        translations.value = numbers
        rows.translate = translations
    if turns:
        owner, numbers, order = _in_order(turns, 1)
        rotations = RotateTypeRows(len(owner), owner, order=order)
        rotations.value = numbers
        rows.rotate = rotations


def _centers(world: World, mesh_ids: Array, hollow: Array) -> Array:
    """The centres of mass (n, 3) in the frames of meshes."""
    centers = np.empty((len(mesh_ids), 3))
    for shell in (False, True):
        rows = np.flatnonzero(hollow == shell)
        used, places = distinct(mesh_ids[rows])
        known = world.meshes
        meshes = [known[id] for id in used.tolist()]
        if shell:
            complete_shells(meshes)
        if meshes:
            found = np.concatenate([mesh.center_of(shell) for mesh in meshes])
            centers[rows] = found.reshape(-1, 3)[places]
    return centers


def _in_order(steps: Steps, first: int) -> tuple[Array, Array, Array]:
    """Steps by the shape that they belong to: its row, their numbers, and their order within it."""
    owner = np.concatenate([rows for rows, _ in steps])
    numbers = np.concatenate([values for _, values in steps])
    order = np.repeat(np.arange(len(steps)) * 2 + first, [len(rows) for rows, _ in steps])
    if len(steps) == 1:
        return owner, numbers, order
    sorting = np.argsort(owner, kind="stable")
    return owner[sorting], numbers[sorting], order[sorting]


def tessellated(leaves: Leaves) -> tuple[list[str | None], list[tuple[str, Mesh]]]:
    """The ids of the meshes that stand for primitives (k,), and these meshes.

    The meshes are those of bodies, then those of members, by system id.
    """
    values = leaves.values
    stand_ins: list[str | None] = [None] * len(leaves)
    known: dict[tuple[Any, ...], str | None] = {}
    meshes = []
    kinds, sids = values["kinds"].tolist(), values["sids"].tolist()
    for row in np.lexsort((values["sids"], leaves.is_member)).tolist():
        kind = Kind(kinds[row])
        dimensions = tuple(values["dimensions"][row].tolist())
        size = extent(kind, dimensions)
        if size is None:
            continue
        key = (bool(leaves.is_member[row]), kind, *dimensions)
        if key not in known:
            mesh = _tessellated(kind, dimensions, size, row)
            known[key] = None if mesh is None else f"Shape{sids[row]}"
            if mesh is not None:
                meshes.append((f"Shape{sids[row]}", mesh))
        stand_ins[row] = known[key]
    return stand_ins, meshes


def _tessellated(kind: Kind, dimensions: tuple[float, ...], size: Array, row: int) -> Mesh | None:
    """The mesh of a primitive; None where it is too small, large or thin for arithmetic."""
    if not 1e-50 < np.min(size) <= np.max(size) < 1e50:
        return None
    try:
        return tessellate(kind, dimensions, row)
    except WorldError:
        return None  # no volume is left of it
